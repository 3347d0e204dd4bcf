//! What the coach is asked for.

use std::{
    sync::{Arc, atomic::AtomicBool},
    time::Duration,
};

use super::{Doubt, FirstMet, Skill};
use crate::{game::Rule, physics::CueInputs, platform};

/// Who plays, and how much of the table and of the balls' places is in doubt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shooter {
    /// The hand's errors.
    pub skill: Skill,
    /// What is not known.
    pub doubt: Doubt,
}

impl Shooter {
    /// The doubt that counts: none for a perfect player.
    pub fn doubts(&self) -> Doubt {
        if self.skill.is_perfect() { Doubt::NONE } else { self.doubt }
    }
}

/// With nothing in doubt.
impl From<Skill> for Shooter {
    fn from(skill: Skill) -> Self {
        Self { skill, doubt: Doubt::NONE }
    }
}

/// What the coach is asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// What counts as a point.
    pub rule: Rule,
    /// Who is to play the shot. For a perfect player any shot that makes the point will do, and the first is the answer;
    /// for anybody else the whole budget goes into finding the one that this player makes most often. A perfect
    /// player's answer is the first point with a plan too.
    pub skill: Skill,
    /// How much of the table and of the balls' places is in doubt. A perfect player has no doubts.
    pub doubt: Doubt,
    /// Whether what comes next counts: shots are then ranked by their make probability times that of the shot after them.
    pub plan: bool,
    /// Whether jumps over a ball and massés may be advised; most clubs forbid them.
    pub jumps: bool,
    /// What the shot that is looked for, as it is meant, meets first. An attempt that begins otherwise by mistake and makes the point all the
    /// same counts.
    pub first: FirstMet,
    /// Time to look for a shot.
    pub budget: Duration,
    /// Simulations after which the search ends, or a little later: it ends between rounds.
    pub simulations: u64,
    /// Threads that work at it.
    pub threads: usize,
    /// Seed of the search: while time does not run out, the same request finds the same shot, with any number of threads.
    pub seed: u64,
    /// Shots of a former answer to the same question, the advice first. They take part again, and the advice stays unless another shot is
    /// clearly better: asking once more makes it no worse, and does not swap it for one that is as good.
    pub former: Vec<CueInputs>,
    /// Set from another thread, it ends the search.
    pub cancel: Arc<AtomicBool>,
}

impl Request {
    /// Who plays, and what is in doubt.
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
            first: FirstMet::Any,
            budget: Duration::from_millis(500),
            simulations: u64::MAX,
            threads: platform::threads(),
            seed: 0,
            former: Vec::new(),
            cancel: Arc::default(),
        }
    }
}
