//! The cycle of goals of an exercise, and the length of each goal.

use crate::drills::Goal;

/// Default length of a run in points, and of a game or match in innings.
const DEFAULT_RUN_POINTS: u32 = 5;
const DEFAULT_INNINGS: u32 = 10;
/// Maximum length of a run in points, and of a game or match in innings.
const MAX_GOAL_LENGTH: u32 = 100;

/// The last length of each goal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths {
    /// Points of a run.
    run_points: u32,
    /// Innings of a game.
    game_innings: u32,
    /// Innings of a match.
    match_innings: u32,
}

impl Default for Lengths {
    fn default() -> Self {
        Self { run_points: DEFAULT_RUN_POINTS, game_innings: DEFAULT_INNINGS, match_innings: DEFAULT_INNINGS }
    }
}

impl Lengths {
    /// Returns the goal after `goal` in the cycle, with its last length.
    pub(super) fn next_goal(&mut self, goal: Goal) -> Goal {
        match goal {
            Goal::Free => Goal::Run(self.run_points),
            Goal::Run(points) => {
                self.run_points = points;
                Goal::Game { innings: self.game_innings }
            }
            Goal::Game { innings } => {
                self.game_innings = innings;
                Goal::Match { innings: self.match_innings, points: 0, against_coach: false }
            }
            Goal::Match { innings, points, against_coach } => {
                if points == 0 {
                    self.match_innings = innings;
                }
                let next = Goal::Match { innings: self.match_innings, points: 0, against_coach: true };
                if against_coach { Goal::Free } else { next }
            }
            Goal::Exam => Goal::Free,
        }
    }
}

/// Returns the goal with `more` points or innings added; without a limit of either, it stays.
pub(super) fn with_added_length(goal: Goal, more: i32) -> Goal {
    let counted = |count: u32| match count {
        0 => 0,
        _ => count.saturating_add_signed(more).clamp(1, MAX_GOAL_LENGTH),
    };
    match goal {
        Goal::Run(points) => Goal::Run(counted(points)),
        Goal::Game { innings } => Goal::Game { innings: counted(innings) },
        Goal::Match { innings, points: 0, against_coach } => {
            Goal::Match { innings: counted(innings), points: 0, against_coach }
        }
        Goal::Match { innings, points, against_coach } => {
            Goal::Match { innings, points: counted(points), against_coach }
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_without_a_limit_stays_without_one() {
        let goal = |innings, points| Goal::Match { innings, points, against_coach: true };
        assert_eq!(with_added_length(goal(0, 0), 1), goal(0, 0));
        assert_eq!(with_added_length(goal(0, 15), -1), goal(0, 14));
        assert_eq!(with_added_length(goal(1, 0), -1), goal(1, 0), "one inning at least");
        assert_eq!(with_added_length(Goal::Free, 1), Goal::Free);
    }
}
