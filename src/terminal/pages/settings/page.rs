//! What the app asks of this page.

use ratatui::layout::Position;

use super::{Input, LONGEST, SettingsPage, view};
use crate::terminal::{
    pages::{Page, PageArea, Target},
    ui::{Ui, message::Message},
};

impl Page for SettingsPage {
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> u16 {
        view::draw(self, area, ui)
    }

    fn target(&self, area: &PageArea, at: Position) -> Option<Target> {
        view::target(self, area, at)
    }

    fn message(&self) -> Option<&Message> {
        self.message.as_ref()
    }

    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn take_text(&mut self, text: &str) -> bool {
        let Some(Input::Value(typed)) = &mut self.input else { return false };
        for letter in text.chars().filter(|letter| !letter.is_control()) {
            if typed.len() + letter.len_utf8() <= LONGEST {
                typed.push(letter);
            }
        }
        self.message = None;
        true
    }
}
