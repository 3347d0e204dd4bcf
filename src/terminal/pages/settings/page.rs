//! What the app asks of this page.

use ratatui::layout::Position;

use super::{Input, SettingsPage, view};
use crate::terminal::{
    pages::{Page, PageArea, Target},
    ui::{Message, Typed, Ui},
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

    fn input(&mut self, typed: Typed) -> bool {
        let Some(Input::Value(value)) = &mut self.input else { return false };
        let taken = value.take(typed);
        if taken {
            self.message = None;
        }
        taken
    }
}
