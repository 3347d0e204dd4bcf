//! The view of the settings page: the list of settings or keys, and the description of the marked entry.

mod keys;
mod values;

use ratatui::{
    layout::{Margin, Position, Rect},
    style::Style,
};

use crate::terminal::{
    Capabilities, SettingsContext, SettingsPage,
    pages::{OpenQuestion, PageArea, PageView, Target, settings::Question},
    ui::{Message, Ui, below_title, shorten_start, split, write_paragraphs},
};

/// Width of the list: percent of the screen, and maximum columns.
const LIST: (u16, u16) = (54, 70);
/// Screen width from which on the description of a key is next to the list, columns; otherwise it has [`BELOW`] rows below the list.
const BESIDE: u16 = 100;
const BELOW: u16 = 7;
/// Panel height from which on there are blank rows between paragraphs.
const MIN_ROWS_WITH_GAPS: u16 = 10;

impl PageView for SettingsPage {
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message {
        let rest = area.header;
        let path = shorten_start(
            &self.places.settings.display().to_string(),
            usize::from(rest.width.saturating_sub(2)),
            ui.caps,
        );
        ui.buffer.set_string(rest.x + 1, rest.y, path, ui.theme.faint());
        let [list, words] = halves(self.page, area.body);
        let status_line = match self.page {
            SettingsContext::Keys => keys::draw(self, list, words, ui),
            _ => values::draw(self, list, words, ui),
        };
        self.message.clone().unwrap_or(Message::plain(status_line))
    }

    fn open_question(&self, caps: Capabilities) -> Option<OpenQuestion<'_>> {
        let typed = if let Some(Question::Value(typed)) = &self.question { Some(typed) } else { None };
        let asked = OpenQuestion::new(self.message.as_ref(), &question(self, caps)?, typed);
        Some(OpenQuestion { has_own_keys: matches!(self.question, Some(Question::Key)), ..asked })
    }

    fn target(&self, area: &PageArea, at: Position) -> Option<Target> {
        let [list, _] = halves(self.page, area.body);
        let below = below_title(list);
        let (line, mark) = match self.page {
            SettingsContext::Keys => (keys::list(self).entry_at(below, at.y), self.keys.mark),
            _ => (values::list(self).entry_at(below, at.y), self.mark),
        };
        list.contains(at).then(|| Target::list(line, mark))
    }
}

/// The open question as shown in the status line, without the typed text.
fn question(settings: &SettingsPage, caps: Capabilities) -> Option<String> {
    match settings.question.as_ref()? {
        Question::Value(typed) => {
            let (entry, is_other) = (settings.marked(), settings.different_value_in_file(settings.marked()).is_some());
            let keeps = if typed.text().is_empty() && is_other {
                format!(" (Enter alone keeps {})", (entry.get)(&settings.settings))
            } else {
                String::new()
            };
            Some(format!("{}{keeps} = ", entry.key))
        }
        Question::Key => Some(keys::new_key_prompt(settings)),
        Question::ReplaceKey(chord) => Some(keys::key_conflict_question(settings, *chord, caps)),
    }
}

/// The areas of the list and of the description.
fn halves(page: SettingsContext, area: Rect) -> [Rect; 2] {
    if page == SettingsContext::Keys && area.width < BESIDE {
        let list = Rect { height: area.height.saturating_sub(BELOW), ..area };
        return [list, Rect { y: list.bottom(), height: area.height - list.height, ..area }];
    }
    split((area.width * LIST.0 / 100).min(LIST.1), area)
}

/// Writes the description of the marked entry into a panel, with blank rows between the paragraphs if there is room.
fn write_words(paragraphs: Vec<(String, Style)>, area: Rect, ui: &mut Ui) {
    let blank = (area.height >= MIN_ROWS_WITH_GAPS).then(|| (String::new(), ui.theme.text()));
    let all: Vec<_> = paragraphs.into_iter().flat_map(|one| blank.clone().into_iter().chain([one])).collect();
    write_paragraphs(&all, area.inner(Margin::new(1, 0)), ui);
}
