//! What the app asks of this page.

use ratatui::layout::Position;

use super::{CalibrationPage, view};
use crate::terminal::{
    pages::{Page, PageArea, Target},
    ui::{Message, Typed, Ui},
};

impl Page for CalibrationPage {
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
        let taken = self.input.as_mut().and_then(super::Input::field_mut).is_some_and(|field| field.take(typed));
        if taken {
            self.message = None;
        }
        taken
    }
}
