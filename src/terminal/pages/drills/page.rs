//! What the app asks of this page.

use ratatui::layout::Position;

use super::{DrillsPage, Question, Screen, Turn, view};
use crate::{
    table::CueBall,
    terminal::{
        pages::{Page, PageArea, Target},
        ui::{Message, Typed, Ui},
    },
};

impl Page for DrillsPage {
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
        let taken = self.question.as_mut().and_then(Question::field_mut).is_some_and(|field| field.take(typed));
        if taken {
            self.message = None;
            self.search();
        }
        taken
    }

    fn tick(&mut self, seconds: f64) {
        if self.page() == Screen::Film {
            self.film.tick(seconds);
        } else if let Some(turn) = &mut self.turn {
            turn.tick(seconds);
        }
    }

    fn frame_interval(&self) -> Option<f64> {
        let is_moving = match self.page() {
            Screen::Exercise => self.turn.as_ref().is_some_and(Turn::is_moving),
            Screen::Film => self.film.playback.playing,
            _ => false,
        };
        is_moving.then_some(1.0 / 30.0)
    }

    fn cue_ball(&self) -> CueBall {
        self.turn.as_ref().map_or(CueBall::White, |turn| turn.cue_ball)
    }
}
