//! Validation of the calibration on simulated tables with known constants: how often its intervals contain the truth.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;

use super::{
    belief::Belief,
    calibrate::{CalibrationError, calibrate},
    estimate::{Estimate, Reading, Trial, estimate},
    forward::{STROKE_PARAMETERS, StrokeSpread},
    protocol::{PROTOCOL, Quantity, Test},
};
use crate::{
    statistics::normal_pair,
    table::{DoubtError, Table, TableDoubt, TableSampler},
};

/// Standard deviations of a club player's strokes from the requested ones.
const CLUB: StrokeSpread = StrokeSpread {
    speed: 0.1,
    direction: 0.25_f64.to_radians(),
    tip: 0.0325,
    elevation: 0.5_f64.to_radians(),
    line: 0.3_f64.to_radians(),
};

/// Half the width of a 95 % interval, in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// Coverage of a constant's intervals.
#[derive(Clone, Debug, Serialize)]
pub struct Coverage {
    /// Name of the constant.
    pub name: String,
    /// Number of tables whose 95 % interval contained the truth.
    pub held: usize,
    /// Prior standard deviation.
    pub before: f64,
    /// Mean posterior standard deviation.
    pub after: f64,
    /// Root mean square error of the posterior mean.
    pub error: f64,
}

/// Draws `count` tables from the doubt, simulates a club player who plays the whole protocol on each, and calibrates them.
///
/// # Errors
/// Fails if the doubt is not valid.
pub fn coverage(table: &Table, doubt: &TableDoubt, count: usize, seed: u64) -> Result<Vec<Coverage>, DoubtError> {
    let belief = Belief::new(table, doubt)?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let sampler = TableSampler::new(table, doubt, 1.0);
    let mut found: Vec<Coverage> = belief
        .constants()
        .map(|(name, _, before)| Coverage { name: name.to_owned(), held: 0, before, after: 0.0, error: 0.0 })
        .collect();
    for _ in 0..count {
        let truth = sampler.as_ref().map_or_else(|| table.clone(), |sampler| draw_valid_table(sampler, &mut rng));
        let trials = simulate_protocol(&truth, &mut rng);
        let Estimate { unknowns, covariance, .. } = estimate(&belief, &trials);
        let (values, covariance) = (belief.values(&unknowns), belief.covariance(&covariance));
        for (index, coverage) in found.iter_mut().enumerate() {
            let error = values[index] - TableDoubt::value(&truth, &coverage.name).unwrap_or_default();
            let deviation = covariance[index][index].sqrt();
            coverage.held += usize::from(error.abs() <= HALF_WIDTH * deviation);
            coverage.after += deviation / count as f64;
            coverage.error += error * error / count as f64;
        }
    }
    for coverage in &mut found {
        coverage.error = coverage.error.sqrt();
    }
    Ok(found)
}

/// Returns a true table drawn from the doubt about `table`, and its calibration by a simulated club player who plays the whole protocol.
///
/// # Errors
/// Fails if the doubt is not valid or contains no uncertain constant.
pub fn simulated_calibration(table: &Table, doubt: &TableDoubt, seed: u64) -> Result<[Table; 2], CalibrationError> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let truth = TableSampler::new(table, doubt, 1.0)
        .map_or_else(|| table.clone(), |sampler| draw_valid_table(&sampler, &mut rng));
    let trials: Vec<_> = simulate_protocol(&truth, &mut rng).into_iter().enumerate().collect();
    Ok([truth, calibrate("calibrated", table, doubt, &trials)?.table])
}

/// Draws a table until it is a valid one.
fn draw_valid_table(sampler: &TableSampler, rng: &mut Xoshiro256PlusPlus) -> Table {
    loop {
        let table = sampler.draw(|| normal_pair(rng)[0]);
        if toml::to_string(&table).is_ok_and(|text| Table::from_toml(&text).is_ok()) {
            return table;
        }
    }
}

/// Simulates the whole protocol as a club player plays and marks it.
pub fn simulate_protocol(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Vec<Trial> {
    let tests = PROTOCOL.iter().flat_map(|test| std::iter::repeat_n(test, test.repetitions));
    tests.map(|test| trial(table, test, rng)).collect()
}

/// Simulates one stroke. A mark that is not possible, because the ball has stopped before, is left out.
fn trial(table: &Table, test: &'static Test, rng: &mut Xoshiro256PlusPlus) -> Trial {
    let stroke: [f64; STROKE_PARAMETERS] = std::array::from_fn(|_| normal_pair(rng)[0]);
    let seen = CLUB.simulate_marks(table, test, false, &stroke);
    let readings = seen.into_iter().zip(test.marks).enumerate().filter_map(|(index, (seen, mark))| {
        let off = mark.standard_error * normal_pair(rng)[0];
        // Rounded to a tenth of a diamond, as a player writes it down.
        let written = |position: f64| (10.0 * (position + off)).round() / 10.0;
        let value = match mark.quantity {
            Quantity::Time(..) => seen? + off,
            Quantity::StopAlong(_) => {
                let (rails, position) = test.position(table, seen?);
                // A player repeats a stroke in which the ball has hit a rail; here the mark is left out.
                if test.rails == Some(0) && rails > 0 && test.balls.len() > 1 {
                    return None;
                }
                test.travel(table, rails, written(position))
            }
            _ => written(seen?),
        };
        Some(Reading { mark: index, value, standard_error: mark.standard_error })
    });
    Trial { test, is_turned: false, readings: readings.collect() }
}
