//! Evaluates a table's model on the film: one row of the report.

use std::time::Instant;

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::{
    chains,
    film::FilmedShot,
    shot_fit,
    systems::{self, Natural},
};
use crate::{
    physics::{BallState, Cushion},
    study::statistics::Spread,
    table::{Rail, Table},
};

/// The errors of a model on some shots of the film.
#[derive(Clone, Debug, Serialize)]
pub struct ModelErrors {
    /// Name of the model: a table and its model of the rails.
    pub model: String,
    /// Number of chains of four rails, and the median error at the fourth, diamonds.
    pub next_rail: (usize, f64),
    /// Number of chains of five rails, and the median error at the fifth, diamonds.
    pub rail_after: (usize, f64),
    /// Median delays of the ball at the fourth and at the fifth rail, s.
    pub late_s: [f64; 2],
    /// Number of whole shots, and the cue ball's median errors at 3, 4 and 5 s, cm.
    pub whole_cm: (usize, [f64; 3]),
    /// The best natural stroke of each diamond system.
    pub systems: Vec<Natural>,
    /// Computing time of a rail impact, ns.
    pub impact_ns: f64,
}

/// Evaluates a table on the film.
pub fn evaluate_model(name: &str, table: &Table, film: &[FilmedShot]) -> ModelErrors {
    let diamond = table.diamond();
    let median = |values: Vec<f64>| Spread::of(values).map_or(f64::NAN, |spread| spread.median);
    let [four, five] = [4, 5].map(|count| {
        let played: Vec<_> = chains::all(table, film, count).iter().map(|chain| chain.predict(table)).collect();
        let distances = played.iter().map(|played| played.distance / diamond).collect();
        let late = played.iter().map(|played| played.delay).collect();
        (played.len(), median(distances), median(late))
    });
    let shots: Vec<_> =
        film.iter().filter(|shot| shot.is_long_enough()).filter_map(|shot| shot_fit::fit_shot(table, shot)).collect();
    let error = |index: usize| 100.0 * median(shots.iter().map(|shot| shot.errors[index]).collect());
    ModelErrors {
        model: name.to_owned(),
        next_rail: (four.0, four.1),
        rail_after: (five.0, five.1),
        late_s: [four.2, five.2],
        whole_cm: (shots.len(), [0, 1, 2].map(error)),
        systems: systems::bundled().iter().map(|system| system.natural(table)).collect(),
        impact_ns: impact_time(table),
    }
}

/// Number of impacts in a timed round.
const IMPACTS: u32 = 2000;

/// Measures the computing time of a rail impact, ns: the minimum of several rounds over balls with many speeds and spins.
fn impact_time(table: &Table) -> f64 {
    let cushion = Cushion::of(table, Rail::Top);
    let balls: Vec<BallState> = (0..IMPACTS)
        .map(|n| {
            let [a, b, c] = [0.618, 0.755, 0.570].map(|step| (f64::from(n) * step).fract());
            let spin = DVec3::new(60.0 * (b - 0.5), 80.0 * (c - 0.5), 90.0 * (a - 0.5));
            BallState { position: DVec2::ZERO, velocity: DVec2::new(4.0 * (c - 0.5), 0.2 + 3.0 * a), spin }
        })
        .collect();
    let round = || {
        let begin = Instant::now();
        let mut sum = 0.0;
        for ball in &balls {
            let mut ball = *ball;
            cushion.resolve(table.radius, DVec2::NEG_Y, &mut ball);
            sum += ball.velocity.x + ball.spin.z;
        }
        std::hint::black_box(sum);
        1e9 * begin.elapsed().as_secs_f64() / f64::from(IMPACTS)
    };
    (0..7).map(|_| round()).fold(f64::INFINITY, f64::min)
}
