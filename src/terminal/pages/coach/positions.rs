//! Typed and pasted ball positions: one ball or all three, in diamonds or a unit of length, or a share code.

use crate::{
    drills::{decode, is_code},
    game::Point,
    table::{BALLS, CueBall},
    terminal::{
        pages::coach::{CoachPage, question::Question},
        ui::{Message, TextField},
    },
};

/// Maximum length of a typed or pasted text, bytes: a share code with room to spare.
const MAX_TEXT_LENGTH: usize = 600;

impl CoachPage {
    /// Asks the user for ball positions.
    pub(super) fn ask_positions(&mut self) {
        self.playback.pause();
        self.question = Some(Question::Positions(TextField::new(MAX_TEXT_LENGTH)));
    }

    /// Puts the balls in the pasted positions.
    pub(super) fn paste(&mut self, text: &str) {
        if self.own_stroke.is_some() {
            let words = "pasted text not used: t asks for a stroke; Esc goes back to the balls";
            self.message = Some(Message::warning(words));
        } else if let Err(sentence) = self.apply_positions(text) {
            // The paste may be an accident, so there is no question that asks for a correction.
            self.message = Some(Message::warning(format!("pasted text not used: {sentence}")));
        }
    }

    /// Puts the balls in the positions of the text, or in those of a share code.
    ///
    /// # Errors
    /// Returns a message if the text contains no possible position.
    pub(super) fn apply_positions(&mut self, text: &str) -> Result<(), String> {
        // A longer text is neither positions nor a share code. It is cut so that an error message cannot repeat all of it.
        let end =
            (0..=MAX_TEXT_LENGTH.min(text.len())).rev().find(|end| text.is_char_boundary(*end)).unwrap_or_default();
        let text = text[..end].trim();
        if is_code(text) {
            let exercise = decode(text).map_err(|error| error.to_string())?;
            let table = exercise.table().map_err(|error| error.to_string())?;
            self.set_position(&table, exercise.layout, exercise.rule, CueBall::White);
            self.message = Some(Message::good(format!("the balls of \"{}\"; Enter asks the coach", exercise.title)));
            return Ok(());
        }
        let layout = self
            .layout()
            .with_positions(text, self.table(), self.cue_ball(), self.selected)
            .map_err(|error| error.to_string())?;
        let moved: Vec<usize> = (0..BALLS).filter(|ball| layout.balls[*ball] != self.layout().balls[*ball]).collect();
        self.cancel();
        self.set_layout(layout);
        let message = match moved[..] {
            _ if Point::of(self.query.rule, self.table(), &layout).red_first => {
                "this is the opening: red must be hit first".to_owned()
            }
            // Numbers without a unit have two meanings; the position on the table shows which one was taken.
            [ball] => {
                let [along, up] = self.table().to_diamonds(layout.balls[ball]).to_array();
                format!("{} lies at {along:.2}d,{up:.2}d", self.cue_ball().names()[ball])
            }
            _ => "the balls are in the typed positions".to_owned(),
        };
        self.message = Some(Message::good(format!("{message}; Enter asks the coach")));
        Ok(())
    }
}
