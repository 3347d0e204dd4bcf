//! A small dense linear system, solved by elimination with partial pivoting.

/// A square matrix, factorized once and used for several right-hand sides.
pub struct Factorized {
    size: usize,
    /// Rows one after another; `L` below the diagonal, `U` on and above it.
    entries: Vec<f64>,
    /// The row that stood in each place when it was eliminated.
    pivots: Vec<usize>,
}

impl Factorized {
    /// Factorizes the matrix with these rows; `None` where it is singular to the last bit.
    pub fn new(size: usize, mut entries: Vec<f64>) -> Option<Self> {
        let mut pivots = Vec::with_capacity(size);
        for column in 0..size {
            let size_at = |row: usize| entries[row * size + column].abs();
            let pivot = (column..size).fold(column, |best, row| if size_at(row) > size_at(best) { row } else { best });
            if size_at(pivot) == 0.0 {
                return None;
            }
            pivots.push(pivot);
            if pivot != column {
                for other in 0..size {
                    entries.swap(column * size + other, pivot * size + other);
                }
            }
            let (above, below) = entries.split_at_mut((column + 1) * size);
            let upper = &above[column * size..];
            for row in below.chunks_exact_mut(size) {
                let factor = row[column] / upper[column];
                row[column] = factor;
                for other in column + 1..size {
                    row[other] -= factor * upper[other];
                }
            }
        }
        Some(Self { size, entries, pivots })
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, side: &mut [f64]) {
        let row = |index: usize| &self.entries[index * self.size..(index + 1) * self.size];
        for (place, &pivot) in self.pivots.iter().enumerate() {
            side.swap(place, pivot);
        }
        for index in 1..self.size {
            let known: f64 = row(index)[..index].iter().zip(&*side).map(|(l, x)| l * x).sum();
            side[index] -= known;
        }
        for index in (0..self.size).rev() {
            let known: f64 = (index + 1..self.size).map(|other| row(index)[other] * side[other]).sum();
            side[index] = (side[index] - known) / row(index)[index];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_solution_solves_the_system(rows in prop::collection::vec(-1.0..1.0f64, 25), side in prop::collection::vec(-1.0..1.0f64, 5)) {
            let mut solution = side.clone();
            let Some(factors) = Factorized::new(5, rows.clone()) else { return Ok(()) };
            factors.solve(&mut solution);
            let scale = solution.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
            for (row, wanted) in rows.chunks_exact(5).zip(&side) {
                let product: f64 = row.iter().zip(&solution).map(|(a, x)| a * x).sum();
                prop_assert!((product - wanted).abs() < 1e-13 * scale);
            }
        }
    }

    #[test]
    fn a_row_of_zeros_has_no_solution() {
        assert!(Factorized::new(2, vec![1.0, 2.0, 0.0, 0.0]).is_none());
    }
}
