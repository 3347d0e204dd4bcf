//! The view of the calibration page: tests, strokes and values on the left, and the marked test or all values on the right.

mod list;
mod test;
mod values;

use ratatui::{
    layout::{Position, Rect},
    text::Span,
};

use crate::terminal::{
    Capabilities,
    pages::{
        OpenQuestion, PageArea, PageView, Target,
        calibration::{CalibrationPage, Question, SidePanel},
    },
    ui::{self, Message, TextField, Ui, columns, split},
};

/// Width of the left column: minimum, and on screens of at least [`WIDE`] columns.
const LIST: u16 = 31;
const LIST_WIDE: u16 = 41;
/// Screen width from which on the left column is wide, columns.
const WIDE: u16 = 110;

impl PageView for CalibrationPage {
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message {
        draw_header(self, area.header, ui);
        // At 80 columns the question for a mark takes two rows. The body gives up one, so that the question does not cover a mark.
        let is_asked = matches!(self.question, Some(Question::Marks(_))) && area.body.width < WIDE;
        let body = Rect { height: area.body.height.saturating_sub(u16::from(is_asked)), ..area.body };
        let [left, right] = halves(body);
        list::draw(self, left, ui);
        let says_results = match self.side {
            SidePanel::Test => test::draw(self, right, ui),
            SidePanel::Values => {
                values::draw(self, right, ui);
                false
            }
        };
        self.message.clone().unwrap_or_else(|| status_line(self, says_results))
    }

    fn open_question(&self, _: Capabilities) -> Option<OpenQuestion<'_>> {
        let (question, typed) = question(self)?;
        // The form for a stroke has only enough rows for its question.
        let has_own_keys = matches!(self.question, Some(Question::Marks(_)));
        let asked = OpenQuestion::new(self.message.as_ref().filter(|_| !has_own_keys), &question, typed);
        Some(OpenQuestion { has_own_keys, ..asked })
    }

    fn target(&self, area: &PageArea, at: Position) -> Option<Target> {
        let [left, _] = halves(area.body);
        let sheet = self.sheet();
        let rows = sheet.tests().count() as u16;
        let list = Rect { height: left.height.min(rows + 1), ..left };
        // The first row is the title.
        let line = at.y.checked_sub(left.y + 1).map(usize::from);
        (self.question.is_none() && list.contains(at)).then(|| Target::list(line, sheet.mark))
    }
}

/// The open question, and the text field of its answer.
fn question(page: &CalibrationPage) -> Option<(String, Option<&TextField>)> {
    Some(match page.question.as_ref()? {
        Question::Marks(form) => {
            let end = if form.far_end { "far end; " } else { "" };
            (end.to_owned() + &form.question(&page.table), Some(form.typed()))
        }
        Question::Name(field) => ("the table's name = ".to_owned(), Some(field)),
        Question::Replace(name) => (format!("there is a table called {name} already; replace it?"), None),
        Question::StartOver => ("start again? The entries are kept next to the file.".to_owned(), None),
    })
}

/// The default text of the status line; `says_results` if a panel shows what the marks say.
fn status_line(page: &CalibrationPage, says_results: bool) -> Message {
    let sheet = page.sheet();
    // A toast has shown the error already.
    if sheet.trouble.is_some() {
        return Message::warning("the entries cannot be read (F6: why); N moves the file aside and starts again");
    }
    if let Some(sentence) = &sheet.evaluation_error {
        return Message::warning(sentence.clone());
    }
    if sheet.entries.is_none() {
        return Message::plain("reading what was entered so far");
    }
    if sheet.is_evaluating() {
        return Message::plain("evaluating the marks");
    }
    if let Some(doubt) = sheet.doubt_about_last_stroke().filter(|_| !says_results) {
        return Message::warning(doubt);
    }
    let (entered, wanted) = sheet.count();
    match sheet.best_next_test() {
        Some(best) if entered == 0 => {
            Message::plain(format!("play a test, then Enter; {} helps most ({:.1} bits)", best.test, best.bits))
        }
        Some(best) if entered < wanted => {
            Message::plain(format!("next: {} helps most ({:.1} bits)", best.test, best.bits))
        }
        Some(best) => Message::good(format!(
            "all is entered: s saves the table; {} would still help most ({:.1} bits)",
            best.test, best.bits
        )),
        None if page.is_daily => {
            let play = sheet.judged.as_ref().and_then(|judged| judged.play);
            let today =
                play.map_or_else(String::new, |[before, now]| format!("today {}; ", now.describe_change_from(&before)));
            Message::good(format!("{today}both strokes are entered; N begins another day's check"))
        }
        None => Message::plain("choose a test, play it, and enter what was marked"),
    }
}

/// Draws the part of the first row after the tabs: what is measured, the table it starts from, and the number of entered strokes.
fn draw_header(page: &CalibrationPage, area: Rect, ui: &mut Ui) {
    let sheet = page.sheet();
    let (entered, wanted) = sheet.count();
    let count = format!("{entered} of {wanted} strokes ");
    let room = usize::from(area.width).saturating_sub(count.len() + 1);
    let name = if page.is_daily { page.table.name.clone() } else { sheet.prior_table(&page.table).0.name };
    let [long, short] = if page.is_daily { ["today's check of", "today:"] } else { ["your table, from", "from"] };
    let what =
        if long.len() + columns(&name) + 2 < room { format!("{long} {name}") } else { format!("{short} {name}") };
    ui::draw_header(&what, "", &Span::styled(count, ui.theme.faint()), area, ui);
}

/// The areas of the left column and of the panel next to it.
fn halves(area: Rect) -> [Rect; 2] {
    split(if area.width >= WIDE { LIST_WIDE } else { LIST }, area)
}
