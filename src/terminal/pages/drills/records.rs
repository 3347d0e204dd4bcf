//! State of the records screen: its scope, its scroll position, and the estimate of the player's skill.

use crate::coach::Skill;

/// The estimate of the player's skill from the results.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Estimate {
    /// Not requested yet.
    #[default]
    Unknown,
    /// Being computed.
    Working,
    /// The skill with a sentence on its accuracy. The skill is `None` if the results give only a bound.
    Known(Option<Skill>, String),
    /// The reason why there is no estimate.
    Missing(String),
}

/// State of the records screen.
#[derive(Debug, Default)]
pub struct Records {
    /// The exercise to which the screen can be limited.
    pub(super) exercise: Option<String>,
    /// Whether the screen shows all exercises although it could be limited to one.
    shows_all: bool,
    /// The estimate of the player's skill.
    pub estimate: Estimate,
    /// Number of requests for the estimate.
    asked: u64,
    top: usize,
}

impl Records {
    /// Opens the screen with the record of `exercise`, or of all exercises. The caller must read the sessions again.
    pub(super) fn open(&mut self, exercise: Option<String>) {
        self.exercise = exercise;
        self.shows_all = false;
        self.top = 0;
        if matches!(self.estimate, Estimate::Unknown | Estimate::Missing(_)) {
            self.estimate = Estimate::Working;
        }
    }

    /// Returns the number of a new request for the estimate.
    pub(super) const fn next_request(&mut self) -> u64 {
        self.asked += 1;
        self.asked
    }

    /// Handles the answer to request `number`; drops it if there is a later request.
    pub(super) fn on_estimate(&mut self, number: u64, estimate: Estimate) {
        if number == self.asked {
            self.estimate = estimate;
        }
    }

    /// The exercise whose record is shown; `None` for all exercises.
    pub fn scope(&self) -> Option<&str> {
        self.exercise.as_deref().filter(|_| !self.shows_all)
    }

    /// Switches between the record of all exercises and of the one.
    pub(super) const fn toggle_scope(&mut self) {
        self.shows_all = !self.shows_all;
        self.top = 0;
    }

    /// Number of sessions that are scrolled out at the top, of `all`.
    pub fn top(&self, all: usize) -> usize {
        self.top.min(all.saturating_sub(1))
    }

    /// Scrolls by lines, to earlier sessions if positive.
    pub(super) fn scroll(&mut self, lines: isize, all: usize) {
        self.top = self.top(all).saturating_add_signed(lines);
        self.top = self.top(all);
    }

    /// The estimated skill, if there is one.
    pub const fn skill(&self) -> Option<Skill> {
        if let Estimate::Known(skill, _) = &self.estimate { *skill } else { None }
    }
}
