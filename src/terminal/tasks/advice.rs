//! Queries to the coach and its answers, as the screen needs them.

use std::{sync::Arc, time::Duration};

use crate::{
    coach::{Doubt, FirstContact, Map, Margin, Recommendation, Risk, Scatter, Shooter, Skill, systems::Guide},
    game::Rule,
    learning::Policy,
    statistics::SuccessRate,
    terminal::{Shot, Terms},
};

/// Policy and terms of a query to the coach. Two queries are equal if they have the same answer.
#[derive(Clone, Debug)]
pub struct CoachQuery {
    /// A policy trained by the user, with its name; `None` for the bundled policies.
    pub policy: Option<(String, Arc<Policy>)>,
    /// What counts as a point.
    pub rule: Rule,
    /// Skill of the player of the shot.
    pub skill: Skill,
    /// How uncertain the table's parameters and the balls' positions are.
    pub doubt: Doubt,
    /// Whether the next point counts too.
    pub plan: bool,
    /// Whether jumps and massés may be advised.
    pub jumps: bool,
    /// What the cue ball has to meet first.
    pub first: FirstContact,
}

impl Default for CoachQuery {
    fn default() -> Self {
        let (rule, skill, doubt, first) = (Rule::default(), Skill::EXPERT, Doubt::FULL, FirstContact::Any);
        Self { policy: None, rule, skill, doubt, plan: true, jumps: true, first }
    }
}

impl PartialEq for CoachQuery {
    fn eq(&self, other: &Self) -> bool {
        (self.terms(), self.doubt, self.jumps) == (other.terms(), other.doubt, other.jumps) && self.has_policy_of(other)
    }
}

impl CoachQuery {
    /// The terms that keys can change.
    pub const fn terms(&self) -> Terms {
        Terms { rule: self.rule, skill: self.skill, plan: self.plan, first: self.first }
    }

    /// Returns the query with other terms.
    #[must_use]
    pub fn with(&self, Terms { rule, skill, plan, first }: Terms) -> Self {
        Self { rule, skill, plan, first, ..self.clone() }
    }

    /// The player's skill, and how uncertain the table and the positions are.
    pub const fn shooter(&self) -> Shooter {
        Shooter { skill: self.skill, doubt: self.doubt }
    }

    /// Name of the policy, as shown to players.
    pub fn name(&self) -> &str {
        self.policy.as_ref().map_or("the bundled networks", |(name, _)| name)
    }

    /// Whether `other` uses the same policy; policies are never changed, only replaced.
    pub fn has_policy_of(&self, other: &Self) -> bool {
        match (&self.policy, &other.policy) {
            (None, None) => true,
            (Some((_, one)), Some((_, other))) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }
}

/// Cost of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Number of simulated shots.
    pub simulations: u64,
    /// How long the coach thought.
    pub elapsed: Duration,
}

/// A shot that the coach proposes.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The shot.
    pub shot: Arc<Shot>,
    /// The player's success rate, if known.
    pub made: Option<SuccessRate>,
    /// How often it would be missed if only one thing were uncertain, if known.
    pub risk: Option<Risk>,
    /// Probability of the next point, if known.
    pub next: Option<f64>,
    /// Whether the rate is that of a search that has not ended: from the errors by which the shot was selected, and too optimistic.
    pub is_early: bool,
}

/// The coach's advice on a layout.
#[derive(Clone, Debug)]
pub struct Advice {
    /// The recommended shot, then the alternatives.
    pub proposals: Vec<Proposal>,
    /// Seed of the query, which determines the errors by which its shots were judged.
    pub seed: u64,
    /// Cost of the answer, if it is to be shown.
    pub effort: Option<Effort>,
    /// The coach's full result, used to explain why its shot is best.
    pub found: Option<Arc<Recommendation>>,
}

/// Analysis of a shot.
#[derive(Clone, Debug)]
pub struct ShotAnalysis {
    /// How far each input may be off, if the shot makes the point.
    pub margins: Option<[Margin; 5]>,
    /// Map of the outcome over all tip contacts within the miscue limit, relative to the ball's centre.
    pub tip: Map,
    /// Map of the outcome over direction and speed around the stroke.
    pub aim: Map,
    /// The player's standard errors at this stroke.
    pub hand: Skill,
    /// Outcomes of many attempts of the player.
    pub scatter: Scatter,
    /// A diamond system's calculation for the shot, if it makes the point and a system applies.
    pub system: Option<Guide>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn queries_are_equal_if_their_values_are() {
        let query = CoachQuery::default();
        assert_eq!(query, query.clone());
        for other in [
            CoachQuery { rule: Rule::OneCushion, ..query.clone() },
            CoachQuery { skill: Skill::CLUB, ..query.clone() },
            CoachQuery { plan: false, ..query.clone() },
            CoachQuery { jumps: false, ..query.clone() },
            CoachQuery { first: FirstContact::Red, ..query.clone() },
            CoachQuery { doubt: Doubt::NONE, ..query.clone() },
        ] {
            assert_ne!(query, other);
        }
    }
}
