//! Whether the program computes what it should.

use std::time::Instant;

use serde::Serialize;

use crate::study::self_test::{EngineTest, NetworkTest, engine, networks};

/// What came of the self-test.
#[derive(Serialize)]
pub struct Trial {
    /// None where it could not be tried, as is the next.
    pub engine: Option<EngineTest>,
    pub networks: Vec<NetworkTest>,
    pub seconds: f64,
    /// Why something could not be tried.
    errors: Vec<String>,
}

impl Trial {
    /// Takes about a second.
    pub fn run() -> Self {
        let start = Instant::now();
        let mut errors = Vec::new();
        let engine = engine().map_err(|error| errors.push(error.to_string())).ok();
        let networks = networks().map_err(|error| errors.push(error.to_string())).unwrap_or_default();
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
