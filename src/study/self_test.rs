//! A second of work that tells whether this build computes what it should: the engine by the bits of its shots, the networks by
//! the points that they make.

use std::time::Instant;

use serde::Serialize;

use super::fingerprint::{SHOTS, TEXTBOOK, hash};
use crate::{
    game::{Rule, scores},
    learning::{Policy, evaluation::held_out_layouts},
    player::Skill,
    table::{PRESETS, Table},
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

/// What came of the test.
#[derive(Clone, Debug, Serialize)]
pub struct SelfTest {
    /// None where it could not be tried.
    pub engine: Option<EngineTest>,
    /// None of them where one could not be tried.
    pub networks: Vec<NetworkTest>,
    /// How long it took, s.
    pub seconds: f64,
    /// Why something could not be tried.
    errors: Vec<String>,
}

impl SelfTest {
    /// Plays the shots of the [`fingerprint`](super::fingerprint), lets every bundled network decide, and plays what it decides.
    pub fn run() -> Self {
        let start = Instant::now();
        let mut errors = Vec::new();
        let engine = Table::preset("textbook").map(|table| {
            let hash = hash(&table, 0.0);
            EngineTest { shots: SHOTS, hash, is_right: hash == TEXTBOOK }
        });
        let engine = engine.map_err(|error| errors.push(error.to_string())).ok();
        let networks = networks().map_err(|error| errors.push(error)).unwrap_or_default();
        Self { engine, networks, seconds: start.elapsed().as_secs_f64(), errors }
    }

    /// A sentence for each thing that is wrong.
    pub fn problems(&self) -> impl Iterator<Item = String> {
        let engine = self.engine.filter(|test| !test.is_right).map(|test| {
            format!(
                "the engine computes other shots than on other machines (hash {:016x}); please report it",
                test.hash
            )
        });
        let networks = self.networks.iter().filter(|test| !test.is_right).map(|test| {
            format!(
                "the networks for {} on \"{}\" make {} of {} points, which is too few; please report it",
                test.rule, test.table, test.points, test.layouts
            )
        });
        self.errors.iter().cloned().chain(engine).chain(networks)
    }
}

fn networks() -> Result<Vec<NetworkTest>, String> {
    let mut tests = Vec::new();
    for name in PRESETS {
        let table = Table::preset(name).map_err(|error| error.to_string())?;
        for rule in Rule::ALL {
            // On a table without networks of its own it tries those for all tables like it.
            let Some(policy) = Policy::bundled_for(&table, rule, false) else { continue };
            tests.push(network(&table, rule, &policy.map_err(|error| error.to_string())?));
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
