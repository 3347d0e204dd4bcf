//! What the coach is asked and what it answers, as the screen needs it.

use std::{sync::Arc, time::Duration};

use crate::{
    coach::{Doubt, FirstMet, Map, Margin, Recommendation, Risk, Scatter, Shooter, Skill, systems::Guide},
    game::Rule,
    learning::Policy,
    statistics::SuccessRate,
    terminal::{Shot, Terms},
};

/// Whose advice is asked, and for what. Two are equal if they ask the same.
#[derive(Clone, Debug)]
pub struct CoachQuery {
    /// A policy that a user has trained, with its name; without one the bundled ones are asked.
    pub policy: Option<(String, Arc<Policy>)>,
    /// What counts as a point.
    pub rule: Rule,
    /// Who is to play the shot.
    pub skill: Skill,
    /// How much of the table and of the balls' places is in doubt.
    pub doubt: Doubt,
    /// Whether the next point counts too.
    pub plan: bool,
    /// Whether jumps and massés may be advised.
    pub jumps: bool,
    /// What the cue ball is to meet first.
    pub first: FirstMet,
}

impl Default for CoachQuery {
    fn default() -> Self {
        let (rule, skill, doubt, first) = (Rule::default(), Skill::EXPERT, Doubt::FULL, FirstMet::Any);
        Self { policy: None, rule, skill, doubt, plan: true, jumps: true, first }
    }
}

impl PartialEq for CoachQuery {
    fn eq(&self, other: &Self) -> bool {
        (self.terms(), self.doubt, self.jumps) == (other.terms(), other.doubt, other.jumps) && self.has_policy_of(other)
    }
}

impl CoachQuery {
    /// What a key turns of it.
    pub const fn terms(&self) -> Terms {
        Terms { rule: self.rule, skill: self.skill, plan: self.plan, first: self.first }
    }

    /// The same on other terms.
    #[must_use]
    pub fn with(&self, Terms { rule, skill, plan, first }: Terms) -> Self {
        Self { rule, skill, plan, first, ..self.clone() }
    }

    /// Who plays, and what is in doubt.
    pub const fn shooter(&self) -> Shooter {
        Shooter { skill: self.skill, doubt: self.doubt }
    }

    /// The policy's name, in the words of players.
    pub fn name(&self) -> &str {
        self.policy.as_ref().map_or("the bundled networks", |(name, _)| name)
    }

    /// Whether `other` is asked the same policy; a policy is never changed, only replaced.
    pub fn has_policy_of(&self, other: &Self) -> bool {
        match (&self.policy, &other.policy) {
            (None, None) => true,
            (Some((_, one)), Some((_, other))) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }
}

/// What an answer has cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Shots that were simulated.
    pub simulations: u64,
    /// How long the coach thought.
    pub elapsed: Duration,
}

/// A shot that the coach proposes.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The shot.
    pub shot: Arc<Shot>,
    /// How often the player makes it, if that is known.
    pub made: Option<SuccessRate>,
    /// What would miss it by itself, if that is known.
    pub risk: Option<Risk>,
    /// Probability of the point after this one, if it is known.
    pub next: Option<f64>,
    /// Whether the search had not ended: the share of points is then from the errors that it was chosen by, which flatters.
    pub is_early: bool,
}

/// The coach's advice on a layout.
#[derive(Clone, Debug)]
pub struct Advice {
    /// The shot that it recommends, then the others that may be chosen.
    pub proposals: Vec<Proposal>,
    /// The question's seed, which tells by which errors its shots were judged.
    pub seed: u64,
    /// What it has cost, if that is to be shown.
    pub effort: Option<Effort>,
    /// What the coach has found, where it is asked why its shot leads.
    pub found: Option<Arc<Recommendation>>,
}

/// A closer look at a shot.
#[derive(Clone, Debug)]
pub struct ShotAnalysis {
    /// How far off each input may be, if the shot makes the point.
    pub margins: Option<[Margin; 5]>,
    /// The outcome over all tips that do not slip off, as changes from the ball's centre.
    pub tip: Map,
    /// The outcome over direction and speed around the stroke.
    pub aim: Map,
    /// The player's standard errors at this stroke.
    pub hand: Skill,
    /// What comes of many attempts of the player.
    pub scatter: Scatter,
    /// What a player counts on the diamonds for it, if it makes the point and a system applies.
    pub system: Option<Guide>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn queries_are_equal_where_they_are_asked_the_same() {
        let query = CoachQuery::default();
        assert_eq!(query, query.clone());
        for other in [
            CoachQuery { rule: Rule::OneCushion, ..query.clone() },
            CoachQuery { skill: Skill::CLUB, ..query.clone() },
            CoachQuery { plan: false, ..query.clone() },
            CoachQuery { jumps: false, ..query.clone() },
            CoachQuery { first: FirstMet::Red, ..query.clone() },
            CoachQuery { doubt: Doubt::NONE, ..query.clone() },
        ] {
            assert_ne!(query, other);
        }
    }
}
