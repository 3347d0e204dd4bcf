//! Key contexts: each page, each overlay and each question has its own keys.

use crossterm::event::KeyCode::Char;

use crate::terminal::{
    CalibrationContext, DrillContext, SettingsContext, TrainingContext, keymap::Chord, ui::is_typed,
};

/// The context in which a key is pressed; each has its own key bindings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyContext {
    /// The coach's page.
    Coach,
    /// The player's own stroke on the coach's page.
    OwnStroke,
    /// The table of another player who is being followed.
    Follow,
    /// A question of a page.
    Question {
        /// Whether the answer is typed; otherwise it is yes or no.
        is_typed: bool,
    },
    /// One of the training pages.
    Training(TrainingContext),
    /// One of the drill screens.
    Drill(DrillContext),
    /// One of the settings pages, or the request there to press a key.
    Settings(SettingsContext),
    /// The calibration page, or the input of marks there.
    Calibration(CalibrationContext),
    /// The command palette, over any of the others.
    CommandPalette,
}

impl KeyContext {
    /// The pages with their names, in the order of the screens.
    pub const PAGES: [(Self, &'static str); 18] = [
        (Self::Coach, "Coach"),
        (Self::OwnStroke, "Coach: your stroke"),
        (Self::Follow, "Following a player"),
        (Self::Drill(DrillContext::Library), "Drills: library"),
        (Self::Drill(DrillContext::Exam), "Drills: an exam begins"),
        (Self::Drill(DrillContext::Match), "Drills: a match begins"),
        (Self::Drill(DrillContext::Exercise), "Drills: exercise"),
        (Self::Drill(DrillContext::Result), "Drills: result of an exam"),
        (Self::Drill(DrillContext::Record), "Drills: record"),
        (Self::Drill(DrillContext::Films), "Drills: filmed shots"),
        (Self::Drill(DrillContext::Film), "Drills: a filmed shot"),
        (Self::Training(TrainingContext::Runs), "Training: runs"),
        (Self::Training(TrainingContext::Form), "Training: new run"),
        (Self::Training(TrainingContext::Watch), "Training: a run"),
        (Self::Training(TrainingContext::Compare), "Training: compare"),
        (Self::Settings(SettingsContext::Values), "Settings"),
        (Self::Settings(SettingsContext::Keys), "Settings: keys"),
        (Self::Calibration(CalibrationContext::Tests), "Calibration"),
    ];

    /// Whether letters are typed or are answers in this context: true for every context that is not a page.
    pub fn takes_letters(self) -> bool {
        Self::PAGES.iter().all(|(page, _)| *page != self)
    }

    /// Whether `pressed` types a character in this context, even if the user has bound it to something else.
    pub fn types(self, pressed: Chord) -> bool {
        let event = pressed.event();
        match self {
            Self::Question { is_typed: true }
            | Self::CommandPalette
            | Self::Drill(DrillContext::Search)
            | Self::Calibration(CalibrationContext::Marks) => is_typed(&event),
            Self::Training(TrainingContext::Form) => {
                matches!(event.code, Char('0'..='9')) && event.modifiers.is_empty()
            }
            _ => false,
        }
    }
}
