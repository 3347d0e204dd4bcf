//! Self-test of about a second: checks the engine by the bits of its shots, and the bundled networks by the points that they
//! score.

use std::time::Instant;

use serde::Serialize;

use super::fingerprint::{SHOTS, TEXTBOOK, hash};
use crate::{
    game::{Rule, scores},
    learning::{Policy, evaluation::held_out_layouts},
    physics::has_room,
    player::Skill,
    table::{Layout, Table},
};

/// Layouts per network: one or two tenths of a second for all of them.
const LAYOUTS: usize = 200;

/// Seed of these layouts.
const SEED: u64 = 23;

/// Least share of points of an intact network. Without execution errors, all networks but one score 0.7 or more, where the
/// standard error of 200 layouts is at most 0.032.
const MIN_SHARE: f64 = 0.6;

/// Least share for three-cushion on `thesis`, whose network scores 0.51 with a standard error of 0.035.
const MIN_SHARE_ON_THESIS: f64 = 0.35;

/// Result of the engine's test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct EngineTest {
    /// Number of shots played on `textbook`.
    pub shots: usize,
    /// Hash of their bits.
    pub hash: u64,
    /// Whether the hash is the expected one.
    pub is_right: bool,
}

/// Result of a bundled network's test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NetworkTest {
    /// The network's table.
    pub table: String,
    /// The network's rule.
    pub rule: &'static str,
    /// Number of layouts.
    pub layouts: usize,
    /// Number of points that its strokes score there.
    pub points: usize,
    /// Whether the number of points is high enough.
    pub is_right: bool,
}

/// Result of the self-test.
#[derive(Clone, Debug, Serialize)]
pub struct SelfTest {
    /// `None` if the test could not run.
    pub engine: Option<EngineTest>,
    /// Empty if a network could not be tested.
    pub networks: Vec<NetworkTest>,
    /// Duration of the test, s.
    pub seconds: f64,
    /// Reasons for which a part could not be tested.
    errors: Vec<String>,
}

impl SelfTest {
    /// Plays the shots of the [`fingerprint`](super::fingerprint), and the shots that every bundled network chooses.
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

    /// Returns a sentence for each problem.
    pub fn problems(&self) -> impl Iterator<Item = String> {
        let engine = self.engine.filter(|test| !test.is_right).map(|test| {
            format!(
                "the engine computes other shots than on other machines (hash {:016x}); please report it",
                test.hash
            )
        });
        let networks = self.networks.iter().filter(|test| !test.is_right).map(|test| {
            format!(
                "the networks for {} on \"{}\" score on only {} of {} layouts; please report it",
                test.rule, test.table, test.points, test.layouts
            )
        });
        self.errors.iter().cloned().chain(engine).chain(networks)
    }
}

fn networks() -> Result<Vec<NetworkTest>, String> {
    let mut tests = Vec::new();
    // Every bundled file: "textbook" has no networks of its own, and is played with those for players with errors.
    for (name, errs) in [("match", false), ("textbook", true), ("thesis", false)] {
        let table = Table::preset(name).map_err(|error| error.to_string())?;
        for rule in Rule::ALL {
            let Some(policy) = Policy::bundled_for(&table, rule, errs) else { continue };
            tests.push(network(&table, rule, &policy.map_err(|error| error.to_string())?));
        }
    }
    Ok(tests)
}

fn network(table: &Table, rule: Rule, policy: &Policy) -> NetworkTest {
    let layouts = held_out_layouts(table, LAYOUTS, SEED);
    let makes = |layout: &&Layout| {
        let cue = policy.propose(table, layout, &Skill::PERFECT);
        has_room(table, layout, &cue) && scores(rule, table, layout, &cue)
    };
    let points = layouts.iter().filter(makes).count();
    let least =
        if (table.name.as_str(), rule) == ("thesis", Rule::ThreeCushion) { MIN_SHARE_ON_THESIS } else { MIN_SHARE };
    let is_right = points as f64 >= least * LAYOUTS as f64;
    NetworkTest { table: table.name.clone(), rule: rule.name(), layouts: LAYOUTS, points, is_right }
}
