//! What the app asks of this page.

use ratatui::layout::Position;

use super::{Question, Screen, TrainingPage, replay, view};
use crate::terminal::{
    pages::{Page, PageArea, Target},
    ui::{Message, Typed, Ui},
};

impl Page for TrainingPage {
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
        let is_form = self.page() == Screen::Form;
        let taken = match &mut self.question {
            Some(Question::Name(name)) => name.take(typed),
            Some(_) => false,
            None => typed.letters().chars().fold(false, |taken, letter| taken | (is_form && self.form.typed(letter))),
        };
        if taken {
            self.message = None;
        }
        taken
    }

    fn tick(&mut self, seconds: f64) {
        if let Some(watch) = &mut self.watch {
            watch.replay.tick(seconds);
        }
    }

    fn frame_interval(&self) -> Option<f64> {
        let watch = self.watch.as_ref().filter(|_| self.page() == Screen::Watch)?;
        watch.replay.is_playing().then_some(replay::INTERVAL)
    }
}
