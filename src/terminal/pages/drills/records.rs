//! The page of records: of which exercise, how far it is scrolled, and the estimate of the player's skill.

use crate::coach::Skill;

/// What the results say of the player's skill.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Estimate {
    /// Nobody has asked.
    #[default]
    Unknown,
    /// It is being worked out.
    Working,
    /// The skill, where it is more than a bound, with a sentence on how sure that is.
    Known(Option<Skill>, String),
    /// Why there is none.
    Missing(String),
}

/// The page of records.
#[derive(Debug, Default)]
pub struct Records {
    /// The exercise that it can show alone.
    pub(super) exercise: Option<String>,
    /// Whether it shows all exercises all the same.
    shows_all: bool,
    /// The estimate of the player's skill.
    pub estimate: Estimate,
    /// How many times it was asked for.
    asked: u64,
    top: usize,
}

impl Records {
    /// Opens the page with the record of `exercise`, or of all, whose sessions are about to be read.
    pub(super) fn open(&mut self, exercise: Option<String>) {
        self.exercise = exercise;
        self.shows_all = false;
        self.top = 0;
        if matches!(self.estimate, Estimate::Unknown | Estimate::Missing(_)) {
            self.estimate = Estimate::Working;
        }
    }

    /// Gives the number of a question for the player's skill.
    pub(super) const fn ask(&mut self) -> u64 {
        self.asked += 1;
        self.asked
    }

    /// The answer to question `number`; one that took longer than a later one is dropped.
    pub(super) fn estimated(&mut self, number: u64, estimate: Estimate) {
        if number == self.asked {
            self.estimate = estimate;
        }
    }

    /// The exercise whose record is shown; `None` for all.
    pub fn scope(&self) -> Option<&str> {
        self.exercise.as_deref().filter(|_| !self.shows_all)
    }

    /// Shows the record of all exercises, or of the one again.
    pub(super) const fn toggle_scope(&mut self) {
        self.shows_all = !self.shows_all;
        self.top = 0;
    }

    /// Sessions that are scrolled over, of `all`.
    pub fn top(&self, all: usize) -> usize {
        self.top.min(all.saturating_sub(1))
    }

    /// Scrolls by lines, to earlier sessions where positive.
    pub(super) fn scroll(&mut self, lines: isize, all: usize) {
        self.top = self.top(all).saturating_add_signed(lines);
        self.top = self.top(all);
    }

    /// The estimated skill.
    pub const fn skill(&self) -> Option<Skill> {
        if let Estimate::Known(skill, _) = &self.estimate { *skill } else { None }
    }
}
