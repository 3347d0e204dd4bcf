//! Private stand-in until simulator and coach land. Removed after the merge.
#![allow(missing_docs, clippy::all, clippy::pedantic)]
use crate::{
    game::Rule,
    physics::*,
    table::{Layout, LayoutError, Table},
};
use std::{
    sync::{Arc, atomic::AtomicBool},
    time::Duration,
};

#[derive(Debug)]
pub struct Coach(Table);
#[derive(Debug, Default, Clone)]
pub struct Request {
    pub rule: Rule,
    pub budget: Duration,
    pub seed: u64,
    pub cancel: Arc<AtomicBool>,
}
#[derive(Debug, Clone)]
pub struct Recommendation {
    pub cue: CueInputs,
    pub solved: bool,
    pub source: &'static str,
    pub simulations: u64,
    pub elapsed: Duration,
    pub policy_success: Option<f64>,
}
impl Coach {
    pub fn new(table: Table) -> Result<Self, std::io::Error> {
        Ok(Self(table))
    }
    pub fn recommend(&self, layout: &Layout, request: &Request) -> Result<Recommendation, LayoutError> {
        layout.validate(&self.0)?;
        let _ = &request.cancel;
        let d = layout.balls[1] - layout.balls[0];
        let phi = d.to_angle() + (0.6 * 2.0 * self.0.radius / d.length()).asin();
        Ok(Recommendation {
            cue: CueInputs { a: -0.12, b: 0.21, theta: 0.08, phi, speed: 2.5 },
            solved: true,
            source: "policy",
            simulations: 1,
            elapsed: Duration::from_millis(3),
            policy_success: None,
        })
    }
}
