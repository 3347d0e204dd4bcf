//! The coach's advice as the player goes through it: its shots, which of them is shown, and what is known of each.

use std::sync::Arc;

use crate::{
    coach::{Recommendation, Why},
    terminal::{Advice, CoachQuery, Proposal, ShotAnalysis, pages::around},
};

/// Advice on a layout.
#[derive(Clone, Debug)]
pub struct AdviceState {
    /// What was asked.
    pub query: CoachQuery,
    /// Why the first shot leads, once that is known.
    pub why: Option<Why>,
    /// Tells by which errors the shots were judged.
    pub seed: u64,
    found: Option<Arc<Recommendation>>,
    /// All shots, the recommended one first.
    pub choices: Vec<Choice>,
    /// The place of the one that is shown.
    pub chosen: usize,
}

/// One of the shots.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The shot.
    pub proposal: Proposal,
    /// The closer look at it.
    pub study: Option<Arc<ShotAnalysis>>,
    /// The advice on where it leaves the balls.
    pub next: Option<Advice>,
    /// Whether all is known that will be.
    pub is_studied: bool,
}

impl AdviceState {
    /// `advice` that `query` gave; `None` if it is empty.
    pub fn new(query: CoachQuery, advice: Advice) -> Option<Self> {
        let choice = |proposal| Choice { proposal, study: None, next: None, is_studied: false };
        let Advice { proposals, seed, found, .. } = advice;
        let choices: Vec<_> = proposals.into_iter().map(choice).collect();
        (!choices.is_empty()).then_some(Self { query, why: None, seed, found, choices, chosen: 0 })
    }

    /// What the first shot's lead follows from, while that one is shown and it is not known why it leads.
    pub fn unexplained(&self) -> Option<&Arc<Recommendation>> {
        self.found.as_ref().filter(|_| self.chosen == 0 && self.why.is_none())
    }

    /// The first of the attempts by which the shot that is shown was judged.
    pub fn judged_from(&self) -> usize {
        self.found.as_ref().filter(|_| self.chosen == 0).map_or(0, |found| found.judged_from)
    }

    /// The one that is shown.
    pub fn choice(&self) -> &Choice {
        &self.choices[self.chosen]
    }

    /// Shows the shot at this place, or the last one.
    pub fn show(&mut self, shot: usize) {
        self.chosen = shot.min(self.choices.len() - 1);
    }

    /// Shows another shot, the next where positive; after the last comes the first.
    pub fn turn(&mut self, shots: isize) {
        self.chosen = around(self.chosen, shots, self.choices.len());
    }
}
