//! A second of work that tells whether this build computes what it should: the engine by the bits of its shots, the networks by
//! the points that they make.

use serde::Serialize;

use super::fingerprint::{SHOTS, TEXTBOOK, hash};
use crate::{
    game::{Rule, scores},
    learning::{Policy, PolicyError, evaluation::held_out_layouts},
    player::Skill,
    table::{PRESETS, Table, TableError},
};

/// Layouts of each network: a tenth of a second or two for all of them.
const LAYOUTS: usize = 200;

/// Their seed.
const SEED: u64 = 23;

/// The share of points below which a network is not what it was when it was bundled: without errors all but one make 0.85 and more,
/// and the standard error of 200 layouts is 0.025 at most there.
const LEAST: f64 = 0.7;

/// The same for three cushions on `thesis`, where it is 0.51 and the standard error 0.035.
const LEAST_OF_THESIS: f64 = 0.35;

/// What the engine has computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct EngineTest {
    /// Shots that were played on `textbook`.
    pub shots: usize,
    /// The number of their bits.
    pub hash: u64,
    /// Whether it is the number that every machine finds.
    pub is_right: bool,
}

/// What a bundled network has decided.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NetworkTest {
    /// Its table.
    pub table: String,
    /// Its rule.
    pub rule: &'static str,
    /// Layouts.
    pub layouts: usize,
    /// Points that its strokes make there.
    pub points: usize,
    /// Whether they are as many as they should be.
    pub is_right: bool,
}

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
pub enum SelfTestError {
    /// A bundled table is damaged.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A bundled network is damaged.
    #[error(transparent)]
    Policy(#[from] PolicyError),
}

/// Plays the shots of the [`fingerprint`](super::fingerprint).
///
/// # Errors
/// A damaged table.
pub fn engine() -> Result<EngineTest, SelfTestError> {
    let hash = hash(&Table::preset("textbook")?, 0.0);
    Ok(EngineTest { shots: SHOTS, hash, is_right: hash == TEXTBOOK })
}

/// Lets every bundled network decide, and plays what it decides.
///
/// # Errors
/// A damaged table or network.
pub fn networks() -> Result<Vec<NetworkTest>, SelfTestError> {
    let mut tests = Vec::new();
    for name in PRESETS {
        let table = Table::preset(name)?;
        for rule in Rule::ALL {
            // On a table without networks of its own it tries those for all tables like it.
            let Some(policy) = Policy::bundled_for(&table, rule, false) else { continue };
            tests.push(network(&table, rule, &policy?));
        }
    }
    Ok(tests)
}

fn network(table: &Table, rule: Rule, policy: &Policy) -> NetworkTest {
    let layouts = held_out_layouts(table, LAYOUTS, SEED);
    let makes = |layout: &&_| scores(rule, table, layout, &policy.propose(table, layout, &Skill::PERFECT));
    let points = layouts.iter().filter(makes).count();
    let least = if (table.name.as_str(), rule) == ("thesis", Rule::ThreeCushion) { LEAST_OF_THESIS } else { LEAST };
    let is_right = points as f64 >= least * LAYOUTS as f64;
    NetworkTest { table: table.name.clone(), rule: rule.name(), layouts: LAYOUTS, points, is_right }
}
