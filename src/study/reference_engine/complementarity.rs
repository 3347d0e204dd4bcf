//! Solves the complementarity problem of resting contact: normal forces complementary to the opening rates, and frictions
//! within their disks complementary to the slips that they would allow to begin.
//!
//! Each law states that its force is the projection of itself minus a multiple of its rate: onto the non-negative numbers, or
//! onto the disk. Newton's method on these equations (Alart and Curnier 1991) converges in a few steps from near the solution;
//! sweeps of the projections lead there.

use super::{Real, linear::solve};

/// Maximum number of successive Newton steps.
const STEPS: usize = 24;

/// Number of series of sweeps between them, each twice as long as the previous.
const ROUNDS: usize = 8;

/// The condition on the forces of one law.
#[derive(Clone, Copy, Debug)]
pub enum Law<R> {
    /// A normal force: neither the force nor the opening rate is negative, and one of the two is zero.
    Push,
    /// A friction that sticks up to this force per mass, m/s².
    Hold(R),
    /// A contact's friction that sticks up to a share of the normal force at this index; without limit if `None`.
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

/// The problem: rates of change are `rates + matrix forces`.
pub struct Problem<'a, R> {
    /// Rates of change per unit of each force.
    pub matrix: &'a [Vec<R>],
    /// Rates of change without any unknown force.
    pub rates: &'a [R],
    /// The laws.
    pub blocks: &'a [Block<R>],
}

impl<R: Real> Problem<'_, R> {
    /// Returns forces that obey all laws; `None` if none are found.
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

    /// Returns a block's forces minus a multiple of their rates, before the projection, and that multiple.
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

    /// Returns the radius of a friction's disk; `None` if there is no disk or no limit.
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

    /// Replaces a block's equation `change = projected - force`, which is right if the projection is a constant.
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
            // The projection is the identity: the rates must vanish.
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

    /// A normal force of unit response and a friction of response 3.5 across it.
    fn pushed(rates: &[f64], friction: f64) -> Vec<f64> {
        let matrix = [of(&[1.0, 0.0, 0.0]), of(&[0.0, 3.5, 0.0]), of(&[0.0, 0.0, 3.5])];
        let grip = Law::Grip(Some(DoubleDouble::of(friction)), 0);
        let blocks = [Block { at: 0, axes: 1, law: Law::Push }, Block { at: 1, axes: 2, law: grip }];
        let solution = Problem { matrix: &matrix, rates: &of(rates), blocks: &blocks }.solve().unwrap();
        solution.iter().map(|force| force.to_f64()).collect()
    }

    #[test]
    fn opening_contact_has_neither_push_nor_friction() {
        assert_eq!(pushed(&[2.0, 1.0, 1.0], 0.5), [0.0; 3]);
    }

    #[test]
    fn friction_sticks_within_its_disk_and_slips_beyond() {
        let held = pushed(&[-2.0, 0.7, -1.4], 0.5);
        assert!(held.iter().zip([2.0, -0.2, 0.4]).all(|(force, known)| (force - known).abs() < 1e-15), "{held:?}");
        let slips = pushed(&[-2.0, 30.0, -40.0], 0.5);
        assert!(slips.iter().zip([2.0, -0.6, 0.8]).all(|(force, known)| (force - known).abs() < 1e-15), "{slips:?}");
    }
}
