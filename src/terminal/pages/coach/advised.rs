//! The coach's advice while the player browses it: the proposed shots, which of them is shown, and the analysis of each.

use std::sync::Arc;

use crate::{
    coach::{Recommendation, Why},
    terminal::{Advice, CoachQuery, Proposal, ShotAnalysis, pages::wrapping_index},
};

/// Advice on a layout.
#[derive(Clone, Debug)]
pub struct AdviceState {
    /// The query that this advice answers.
    pub query: CoachQuery,
    /// Why the first shot ranks first; `None` until that has been computed.
    pub why: Option<Why>,
    /// Random seed of the simulated errors with which the shots were judged.
    pub seed: u64,
    found: Option<Arc<Recommendation>>,
    /// All shots, the recommended one first.
    pub choices: Vec<Choice>,
    /// Index of the displayed shot.
    pub chosen: usize,
}

/// One of the proposed shots.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The shot.
    pub proposal: Proposal,
    /// Its analysis; `None` until that has been computed.
    pub study: Option<Arc<ShotAnalysis>>,
    /// The advice on the layout after the shot.
    pub next: Option<Advice>,
    /// Whether the analysis is complete.
    pub is_analysed: bool,
}

impl AdviceState {
    /// Creates the state from the `advice` that answers `query`; `None` if it contains no shot.
    pub fn new(query: CoachQuery, advice: Advice) -> Option<Self> {
        let choice = |proposal| Choice { proposal, study: None, next: None, is_analysed: false };
        let Advice { proposals, seed, found, .. } = advice;
        let choices: Vec<_> = proposals.into_iter().map(choice).collect();
        (!choices.is_empty()).then_some(Self { query, why: None, seed, found, choices, chosen: 0 })
    }

    /// The search result from which the first shot's ranking can be explained; `None` if another shot is shown or the explanation
    /// is known already.
    pub fn unexplained_search(&self) -> Option<&Arc<Recommendation>> {
        self.found.as_ref().filter(|_| self.chosen == 0 && self.why.is_none())
    }

    /// Index of the first simulated attempt with which the displayed shot was judged.
    pub fn judged_from(&self) -> usize {
        let Some(found) = &self.found else { return 0 };
        match self.chosen.checked_sub(1) {
            None => found.judged_from,
            Some(other) => found.alternatives.get(other).map_or(0, |other| other.judged_from),
        }
    }

    /// The displayed shot.
    pub fn choice(&self) -> &Choice {
        &self.choices[self.chosen]
    }

    /// Shows the shot with this index; the last one if the index is too large.
    pub fn show_shot(&mut self, shot: usize) {
        self.chosen = shot.min(self.choices.len() - 1);
    }

    /// Cycles through the shots: forwards if `shots` is positive, wrapping at the end.
    pub fn cycle(&mut self, shots: isize) {
        self.chosen = wrapping_index(self.chosen, shots, self.choices.len());
    }
}
