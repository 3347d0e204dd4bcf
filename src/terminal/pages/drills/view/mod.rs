//! The view of the drill page: library, exercise, exam, records and filmed shots.

mod exam;
mod exercise;
mod film;
mod films;
mod library;
mod match_setup;
mod panels;
mod panes;
mod record;
mod result;
mod score;

use ratatui::{
    layout::{Position, Rect},
    text::Span,
};

use crate::{
    coach::words::{PositionUnit, format_trimmed},
    drills::Record,
    table::{BALLS, CueBall, Layout, Table},
    terminal::{
        Capabilities, DrillContext, Mapping,
        pages::{
            OpenQuestion, PageArea, PageView, Target,
            drills::{DrillsPage, Question},
        },
        ui::{self, Message, TableView, Ui, draw_table},
        words::{self, skill_word},
    },
};

/// Maximum length of a readable line, columns.
const READABLE: u16 = 80;
/// Minimum height of the small table next to a list, rows.
const TABLE_ROWS: u16 = 9;

impl PageView for DrillsPage {
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message {
        let (header, body) = (area.header, area.body);
        let status_line = match (self.page(), &self.turn) {
            (DrillContext::Exam, Some(turn)) => exam::draw(self, turn, header, body, ui),
            (DrillContext::Exercise, Some(turn)) => exercise::draw(self, turn, header, body, ui),
            (DrillContext::Match, _) => match_setup::draw(self, header, body, ui),
            (DrillContext::Result, _) => result::draw(self, header, body, ui),
            (DrillContext::Record, _) => record::draw(self, header, body, ui),
            (DrillContext::Films, _) => films::draw(self, header, body, ui),
            (DrillContext::Film, _) => film::draw(self, header, body, ui),
            _ => library::draw(self, header, body, ui),
        };
        self.message.clone().unwrap_or(status_line)
    }

    fn open_question(&self, _: Capabilities) -> Option<OpenQuestion<'_>> {
        let question = self.question.as_ref()?;
        let asked = OpenQuestion::new(self.message.as_ref(), &question.text(), question.field());
        Some(OpenQuestion { has_own_keys: matches!(question, Question::Search { .. }), ..asked })
    }

    fn target(&self, area: &PageArea, at: Position) -> Option<Target> {
        match self.key_context() {
            DrillContext::Library | DrillContext::Search => library::target(self, area.body, at),
            DrillContext::Result => result::target(self, area.body, at),
            DrillContext::Films => films::target(self, area.body, at),
            // The mouse wheel scrolls the list, but it has no entries to mark.
            DrillContext::Record => area.body.contains(at).then_some(Target::List(None)),
            _ => None,
        }
    }
}

/// Draws the header of a screen, with the player whose errors are simulated.
fn draw_header(drills: &DrillsPage, title: &str, more: &str, area: Rect, ui: &mut Ui) {
    let player = Span::styled(format!("player: {} ", skill_word(drills.skill())), ui.theme.text());
    ui::draw_header(title, more, &player, area, ui);
}

/// Draws the balls on the largest table that leaves room for `rows` of text below it in `area`. Returns the area of the text, which is
/// `width` columns wide.
fn draw_preview(table: &Table, layout: &Layout, [width, rows]: [u16; 2], area: Rect, ui: &mut Ui) -> Rect {
    let room = Rect { height: area.height.saturating_sub(rows).max(TABLE_ROWS.min(area.height)), ..area };
    draw_table(&TableView::new(table, layout), room, ui);
    let outer = Mapping::fit(table, room).outer();
    let left = outer.x.min(area.right().saturating_sub(width + 1)).max(area.x + 1);
    Rect { x: left, y: outer.bottom(), width, height: area.bottom().saturating_sub(outer.bottom()) }
}

/// The high run; `None` if the order of makes and misses is not known.
fn high_run(record: &Record) -> Option<u32> {
    (record.innings > 0).then_some(record.high_run)
}

/// The high run as an appendix to other words.
fn best_run(record: &Record) -> String {
    high_run(record).map_or_else(String::new, |run| format!(", best run {run}"))
}

/// The positions of the balls, the cue ball first, measured from the lower left corner of the noses: in diamonds, as users type them,
/// or in millimetres.
fn position_words(table: &Table, layout: &Layout, cue_ball: CueBall, unit: PositionUnit) -> String {
    let place = |ball: usize| {
        let at = table.to_diamonds(layout.balls[ball]);
        let along = |diamonds: f64| match unit {
            PositionUnit::Diamonds => format_trimmed(diamonds, 2) + "d",
            PositionUnit::Mm => format_trimmed(1e3 * table.diamond() * diamonds, 0),
        };
        format!("{} {},{}", cue_ball.names()[ball], along(at.x), along(at.y))
    };
    let places: Vec<String> = (0..BALLS).map(place).collect();
    let what = if unit == PositionUnit::Mm { "balls, mm from the lower left corner" } else { "balls" };
    format!("{what}: {}", places.join("; "))
}

/// Formats a fraction as a percentage, like `55 %`.
fn percent_words(share: f64) -> String {
    format!("{} %", words::percent(share))
}
