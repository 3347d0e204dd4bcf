//! The cycle of goals of an exercise, and the length of each goal.

use crate::drills::Goal;

/// Default length of a run in points, and of a game or match in innings.
const FIRST_RUN: u32 = 5;
pub(super) const FIRST_GAME: u32 = 10;
/// Maximum length of a run in points, and of a game or match in innings.
const LONGEST: u32 = 100;

/// The last length of each goal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths {
    /// Points of a run.
    run: u32,
    /// Innings of a game.
    game: u32,
    /// Innings of a match.
    both: u32,
}

impl Default for Lengths {
    fn default() -> Self {
        Self { run: FIRST_RUN, game: FIRST_GAME, both: FIRST_GAME }
    }
}

impl Lengths {
    /// Returns the goal after `goal` in the cycle, with its last length.
    pub(super) fn next_goal(&mut self, goal: Goal) -> Goal {
        match goal {
            Goal::Free => Goal::Run(self.run),
            Goal::Run(points) => {
                self.run = points;
                Goal::Game { innings: self.game }
            }
            Goal::Game { innings } => {
                self.game = innings;
                Goal::Match { innings: self.both, against_coach: false }
            }
            Goal::Match { innings, against_coach } => {
                self.both = innings;
                if against_coach { Goal::Free } else { Goal::Match { innings, against_coach: true } }
            }
            Goal::Exam => Goal::Free,
        }
    }
}

/// Returns the goal with `more` points or innings added.
pub(super) fn longer(goal: Goal, more: i32) -> Goal {
    let counted = |count: u32| count.saturating_add_signed(more).clamp(1, LONGEST);
    match goal {
        Goal::Run(points) => Goal::Run(counted(points)),
        Goal::Game { innings } => Goal::Game { innings: counted(innings) },
        Goal::Match { innings, against_coach } => Goal::Match { innings: counted(innings), against_coach },
        other => other,
    }
}
