//! The app's interface to the coach page.

use super::{CoachPage, SPINNER_INTERVAL, question::Question};
use crate::{
    table::CueBall,
    terminal::{
        pages::Page,
        ui::{Message, TextField, Typed},
    },
};

impl Page for CoachPage {
    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn field_mut(&mut self) -> Option<&mut TextField> {
        match self.question.as_mut()? {
            Question::Positions(typed) | Question::Stroke(typed) | Question::Title(typed, _) => Some(typed),
            Question::Replace(_) => None,
        }
    }

    fn input(&mut self, typed: Typed) -> bool {
        if self.followed().is_some() {
            return false;
        }
        let taken = self.field_mut().is_some_and(|field| field.handle(typed));
        if let (Typed::Paste(text), false) = (typed, self.question.is_some()) {
            // Text that is pasted while no question is open contains ball positions.
            self.paste(text);
            return true;
        }
        if taken {
            self.message = None;
        }
        taken
    }

    fn tick(&mut self, seconds: f64) {
        if let Some(pending) = &mut self.pending {
            pending.elapsed += seconds;
        }
        if let Some(duration) = self.shot().map(|shot| shot.recording.duration()) {
            self.playback.tick(seconds, duration);
        }
    }

    fn frame_interval(&self) -> Option<f64> {
        if self.playback.playing { Some(1.0 / 30.0) } else { self.pending.as_ref().map(|_| SPINNER_INTERVAL) }
    }

    fn cue_ball(&self) -> CueBall {
        Self::cue_ball(self)
    }
}
