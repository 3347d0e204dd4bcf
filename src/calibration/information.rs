//! What another stroke of a test is expected to tell: by how much the constants' entropy falls, from the linearized model.

use super::{
    belief::Belief,
    forward::{Hand, STROKE, marks},
    protocol::Test,
};

/// Where derivatives are taken, in deviations.
const STEP: f64 = 0.02;

/// Bits that a stroke of `test` is expected to tell of the constants whose unknowns are `unknowns` with this covariance.
pub fn information(belief: &Belief, hand: &Hand, unknowns: &[f64], covariance: &[Vec<f64>], test: &Test) -> f64 {
    let seen = |unknowns: &[f64], stroke: &[f64; STROKE]| {
        let table = belief.table(unknowns);
        let (cue, layout) = hand.stroke(&table, test, stroke);
        marks(&table, test, &cue, &layout)
    };
    let still = [0.0; STROKE];
    let at = seen(unknowns, &still);
    let told: Vec<usize> = (0..at.len()).filter(|mark| at[*mark].is_some()).collect();
    // Derivatives of the marks in their standard errors; of one that is lost on the way, nothing is expected.
    let column = |moved: Vec<Option<f64>>| -> Vec<f64> {
        let slope = |mark: &usize| {
            let change = moved[*mark].zip(at[*mark]).map_or(0.0, |(moved, at)| moved - at);
            change / (STEP * test.marks[*mark].sure)
        };
        told.iter().map(slope).collect()
    };
    let by_constant: Vec<Vec<f64>> = (0..belief.count())
        .map(|index| {
            let mut moved = unknowns.to_vec();
            moved[index] += STEP;
            column(seen(&moved, &still))
        })
        .collect();
    let by_stroke: Vec<Vec<f64>> = (0..STROKE)
        .map(|index| {
            let mut moved = still;
            moved[index] += STEP;
            column(seen(unknowns, &moved))
        })
        .collect();
    let mut noise: Vec<Vec<f64>> = vec![vec![0.0; told.len()]; told.len()];
    let mut all = noise.clone();
    for row in 0..told.len() {
        for other in 0..told.len() {
            let own = f64::from(u8::from(row == other));
            noise[row][other] = own + by_stroke.iter().map(|slope| slope[row] * slope[other]).sum::<f64>();
            let spread = by_constant.iter().zip(covariance).map(|(slope, line)| {
                slope[row] * line.iter().zip(&by_constant).map(|(entry, slope)| entry * slope[other]).sum::<f64>()
            });
            all[row][other] = noise[row][other] + spread.sum::<f64>();
        }
    }
    (0.5 * (log_determinant(all) - log_determinant(noise)) / std::f64::consts::LN_2).max(0.0)
}

/// Of a positive definite matrix, by elimination.
fn log_determinant(mut matrix: Vec<Vec<f64>>) -> f64 {
    let mut sum = 0.0;
    for column in 0..matrix.len() {
        let pivot = matrix[column][column];
        sum += pivot.max(f64::MIN_POSITIVE).ln();
        let (above, below) = matrix.split_at_mut(column + 1);
        for line in below {
            let factor = line[column] / pivot;
            line.iter_mut().zip(&above[column]).for_each(|(entry, upper)| *entry -= factor * upper);
        }
    }
    sum
}
