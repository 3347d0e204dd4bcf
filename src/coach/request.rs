//! The input of a recommendation.

use std::{
    sync::{Arc, atomic::AtomicBool},
    time::Duration,
};

use super::{Doubt, FirstContact, Skill};
use crate::{game::Rule, physics::CueInputs, platform};

/// A player, and the uncertainty about the table and the ball positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shooter {
    /// The player's execution errors.
    pub skill: Skill,
    /// The uncertainty.
    pub doubt: Doubt,
}

impl Shooter {
    /// Returns the effective doubt: none for a perfect player.
    pub fn effective_doubt(&self) -> Doubt {
        if self.skill.is_perfect() { Doubt::NONE } else { self.doubt }
    }
}

/// A shooter without doubt.
impl From<Skill> for Shooter {
    fn from(skill: Skill) -> Self {
        Self { skill, doubt: Doubt::NONE }
    }
}

/// The input of a recommendation.
#[derive(Clone, Debug)]
pub struct Request {
    /// What counts as a point.
    pub rule: Rule,
    /// The player. For a perfect player the first shot found that makes the point is the answer, with a plan too. For
    /// any other player the whole budget is used to find the shot that this player makes most often.
    pub skill: Skill,
    /// The uncertainty about the table and the ball positions. A perfect player has no doubts.
    pub doubt: Doubt,
    /// Whether the next shot counts: shots are then ranked by their make probability times that of the shot after them.
    pub plan: bool,
    /// Whether jumps over a ball and massés may be recommended; most clubs forbid them.
    pub jumps: bool,
    /// What the cue ball must hit first when the shot is played as intended. An attempt that begins otherwise by
    /// mistake and still makes the point counts.
    pub first: FirstContact,
    /// Time limit of the search.
    pub budget: Duration,
    /// Simulations after which the search ends. A minimum of work is always done, and the shots that were found are judged in
    /// addition: see `carom recommend` in `docs/command-line.md`.
    pub simulations: u64,
    /// Worker threads.
    pub threads: usize,
    /// Seed of the search. Unless time runs out, the same request finds the same shot with any number of threads.
    pub seed: u64,
    /// Shots of an earlier answer to the same question, the recommended one first. They compete again, and the
    /// recommendation changes only if another shot is clearly better.
    /// A repeated request therefore never gives a worse shot, nor swaps one for an equally good one.
    pub former: Vec<CueInputs>,
    /// Ends the search when set from another thread.
    pub cancel: Arc<AtomicBool>,
}

impl Request {
    /// Returns the player, and what is in doubt.
    pub const fn shooter(&self) -> Shooter {
        Shooter { skill: self.skill, doubt: self.doubt }
    }
}

impl Default for Request {
    fn default() -> Self {
        Self {
            rule: Rule::default(),
            skill: Skill::PERFECT,
            doubt: Doubt::NONE,
            plan: false,
            jumps: true,
            first: FirstContact::Any,
            budget: Duration::from_millis(500),
            simulations: u64::MAX,
            threads: platform::thread_count(),
            seed: 0,
            former: Vec::new(),
            cancel: Arc::default(),
        }
    }
}
