//! Expected information of one more stroke of a test: the decrease of the constants' entropy in the linearized model.

use std::f64::consts::LN_2;

use super::{
    belief::Belief,
    estimate::{STEP, perturbed},
    forward::{STROKE_PARAMETERS, StrokeSpread},
    protocol::Test,
};
use crate::statistics::half_log_determinant;

/// Returns the expected information, bits, of a stroke of `test` about constants whose unknowns have the means `unknowns` and this
/// covariance.
pub fn information(belief: &Belief, unknowns: &[f64], covariance: &[Vec<f64>], test: &Test) -> f64 {
    let seen = |unknowns: &[f64], stroke: &[f64; STROKE_PARAMETERS]| {
        StrokeSpread::ASSUMED.simulate_marks(&belief.table(unknowns), test, false, stroke)
    };
    let exact = [0.0; STROKE_PARAMETERS];
    let at = seen(unknowns, &exact);
    let marks: Vec<usize> = (0..at.len()).filter(|mark| at[*mark].is_some()).collect();
    // Derivatives of the marks in standard errors; 0 for a mark to which the ball does not get after the step.
    let column = |moved: Vec<Option<f64>>| -> Vec<f64> {
        let slope = |mark: &usize| {
            let change = moved[*mark].zip(at[*mark]).map_or(0.0, |(moved, at)| moved - at);
            change / (STEP * test.marks[*mark].standard_error)
        };
        marks.iter().map(slope).collect()
    };
    let slopes: Vec<Vec<f64>> = perturbed(unknowns, &exact, seen).map(column).collect();
    let (by_constant, by_stroke) = slopes.split_at(belief.count());
    let mut noise: Vec<Vec<f64>> = vec![vec![0.0; marks.len()]; marks.len()];
    let mut all = noise.clone();
    for row in 0..marks.len() {
        for other in 0..marks.len() {
            let own = f64::from(u8::from(row == other));
            noise[row][other] = own + by_stroke.iter().map(|slope| slope[row] * slope[other]).sum::<f64>();
            let spread = by_constant.iter().zip(covariance).map(|(slope, line)| {
                slope[row] * line.iter().zip(by_constant).map(|(entry, slope)| entry * slope[other]).sum::<f64>()
            });
            all[row][other] = noise[row][other] + spread.sum::<f64>();
        }
    }
    let nats = half_log_determinant(&all).zip(half_log_determinant(&noise)).map_or(0.0, |(all, noise)| all - noise);
    (nats / LN_2).max(0.0)
}
