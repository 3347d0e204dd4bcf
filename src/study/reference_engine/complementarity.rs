//! Forces that obey all laws at once: pushes that are complementary to the rates of opening, and frictions within their
//! disks that are complementary to the slips they would let begin.
//!
//! Each law says that its force is the projection of itself less a multiple of its rate: on what is not negative, or on
//! the disk. Newton's method on these equations (Alart and Curnier 1991) ends in a few steps where it starts near the
//! solution; sweeps of the projections themselves bring it there.

use super::{Real, linear::solve};

/// Newton's steps in a row.
const STEPS: usize = 24;

/// Series of sweeps between them, each twice as long as the last.
const ROUNDS: usize = 8;

/// What the forces of one law must do.
#[derive(Clone, Copy, Debug)]
pub enum Law<R> {
    /// A push is not negative, nor is the rate of opening, and one of the two is zero.
    Push,
    /// A friction that holds with up to so much per mass, m/s².
    Hold(R),
    /// A contact's friction that holds with up to a share of the push at this index, or any friction.
    Grip(Option<R>, usize),
}

/// The forces of one law: one unknown, or two for a friction in a plane.
#[derive(Clone, Copy, Debug)]
pub struct Block<R> {
    /// Index of the first unknown.
    pub at: usize,
    /// Number of unknowns.
    pub axes: usize,
    /// The law.
    pub law: Law<R>,
}

/// A problem: rates of change are `rates + matrix forces`.
pub struct Problem<'a, R> {
    /// Rates of change per unit of each force.
    pub matrix: &'a [Vec<R>],
    /// Rates of change without any unknown force.
    pub rates: &'a [R],
    /// The laws.
    pub blocks: &'a [Block<R>],
}

impl<R: Real> Problem<'_, R> {
    /// Forces that obey all laws; `None` if none are found.
    pub fn solve(&self) -> Option<Vec<R>> {
        let mut forces = vec![R::zero(); self.rates.len()];
        for round in 0..ROUNDS {
            if let Some(solution) = self.newton(forces.clone()) {
                return Some(solution);
            }
            for _ in 0..8 << round {
                self.sweep(&mut forces);
            }
        }
        None
    }

    fn rate(&self, row: usize, forces: &[R]) -> R {
        self.matrix[row].iter().zip(forces).fold(self.rates[row], |sum, (entry, force)| sum + *entry * *force)
    }

    /// A block's forces less a multiple of their rates, before the projection.
    fn trial(&self, block: &Block<R>, forces: &[R]) -> ([R; 2], R) {
        let rows = block.at..block.at + block.axes;
        let stiff = rows.clone().fold(R::zero(), |largest, i| largest.max(self.matrix[i][i]));
        let step = R::of(1.0) / stiff;
        let mut trial = [R::zero(); 2];
        for (trial, row) in trial.iter_mut().zip(rows) {
            *trial = forces[row] - step * self.rate(row, forces);
        }
        (trial, step)
    }

    /// Radius of a friction's disk; `None` for one without any.
    fn radius(law: Law<R>, forces: &[R]) -> Option<R> {
        match law {
            Law::Push => None,
            Law::Hold(limit) => Some(limit),
            Law::Grip(friction, push) if forces[push] > R::zero() => friction.map(|mu| mu * forces[push]),
            Law::Grip(..) => Some(R::zero()),
        }
    }

    fn projected(&self, block: &Block<R>, forces: &[R]) -> [R; 2] {
        let ([x, y], _) = self.trial(block, forces);
        if let Law::Push = block.law {
            return [x.max(R::zero()), y];
        }
        let size = (x * x + y * y).sqrt();
        match Self::radius(block.law, forces) {
            Some(radius) if size > radius => [x * (radius / size), y * (radius / size)],
            _ => [x, y],
        }
    }

    fn sweep(&self, forces: &mut [R]) {
        for block in self.blocks {
            let projected = self.projected(block, forces);
            forces[block.at..block.at + block.axes].copy_from_slice(&projected[..block.axes]);
        }
    }

    /// Newton's method on `forces = projected`.
    fn newton(&self, mut forces: Vec<R>) -> Option<Vec<R>> {
        let count = forces.len();
        let largest = self.rates.iter().fold(R::of(1.0), |largest, rate| largest.max(rate.abs()));
        let tolerance = largest * R::of(1e4 * R::ROUNDING);
        for _ in 0..STEPS {
            let mut matrix = vec![vec![R::zero(); count]; count];
            let mut side = vec![R::zero(); count];
            let mut error = R::zero();
            for block in self.blocks {
                let projected = self.projected(block, &forces);
                for (row, projected) in (block.at..block.at + block.axes).zip(projected) {
                    let gap = projected - forces[row];
                    error = error.max(gap.abs());
                    matrix[row][row] = R::of(1.0);
                    side[row] = gap;
                }
                self.linearize(block, &forces, &mut matrix, &mut side);
            }
            if error <= tolerance {
                return Some(forces);
            }
            for (force, change) in forces.iter_mut().zip(solve(matrix, side)) {
                *force = *force + change;
            }
        }
        None
    }

    /// Replaces a block's equation `change = projected - force`, which holds where the projection is to a fixed point.
    fn linearize(&self, block: &Block<R>, forces: &[R], matrix: &mut [Vec<R>], side: &mut [R]) {
        let (trial, step) = self.trial(block, forces);
        let rows = block.at..block.at + block.axes;
        let size = (trial[0] * trial[0] + trial[1] * trial[1]).sqrt();
        let radius = Self::radius(block.law, forces);
        let is_fixed = match block.law {
            Law::Push => trial[0] <= R::zero(),
            _ => radius.is_some_and(|radius| radius <= R::zero()),
        };
        let is_inside = radius.is_none_or(|radius| size <= radius);
        if is_fixed {
            return;
        }
        if is_inside {
            // The projection changes nothing: the rates must vanish.
            for row in rows {
                matrix[row].clone_from(&self.matrix[row]);
                side[row] = -self.rate(row, forces);
            }
            return;
        }
        let Some(radius) = radius else { return };
        // On the rim, at `radius trial/|trial|`.
        let along = trial.map(|part| part / size);
        for (axis, row) in rows.clone().enumerate() {
            for (other, from) in rows.clone().enumerate() {
                let same = R::of(if axis == other { 1.0 } else { 0.0 });
                let turned = radius / size * (same - along[axis] * along[other]);
                for (column, entry) in self.matrix[from].iter().enumerate() {
                    let own = R::of(if column == from { 1.0 } else { 0.0 });
                    matrix[row][column] = matrix[row][column] - turned * (own - step * *entry);
                }
            }
            if let Law::Grip(Some(friction), push) = block.law {
                matrix[row][push] = matrix[row][push] - friction * along[axis];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reference_engine::DoubleDouble;

    fn of(values: &[f64]) -> Vec<DoubleDouble> {
        values.iter().map(|value| DoubleDouble::of(*value)).collect()
    }

    /// A push of unit response and a friction of response 3.5 across it.
    fn pushed(rates: &[f64], friction: f64) -> Vec<f64> {
        let matrix = [of(&[1.0, 0.0, 0.0]), of(&[0.0, 3.5, 0.0]), of(&[0.0, 0.0, 3.5])];
        let grip = Law::Grip(Some(DoubleDouble::of(friction)), 0);
        let blocks = [Block { at: 0, axes: 1, law: Law::Push }, Block { at: 1, axes: 2, law: grip }];
        let solution = Problem { matrix: &matrix, rates: &of(rates), blocks: &blocks }.solve().unwrap();
        solution.iter().map(|force| force.to_f64()).collect()
    }

    #[test]
    fn what_opens_is_not_pushed_and_not_held() {
        assert_eq!(pushed(&[2.0, 1.0, 1.0], 0.5), [0.0; 3]);
    }

    #[test]
    fn friction_holds_within_its_disk_and_slips_against_the_drive_beyond() {
        let held = pushed(&[-2.0, 0.7, -1.4], 0.5);
        assert!(held.iter().zip([2.0, -0.2, 0.4]).all(|(force, known)| (force - known).abs() < 1e-15), "{held:?}");
        let slips = pushed(&[-2.0, 30.0, -40.0], 0.5);
        assert!(slips.iter().zip([2.0, -0.6, 0.8]).all(|(force, known)| (force - known).abs() < 1e-15), "{slips:?}");
    }
}
