//! Small dense linear systems, solved by Gaussian elimination, with partial pivoting if necessary. All functions work in place: these
//! systems are solved so often that moving them would cost more than solving them.

/// Regularization added to the diagonal of a force system, whose entries are 1 to 10, if the forces are not unique because balls are
/// over-constrained. It selects the forces nearest to the previous ones; iterative refinement then removes its effect.
pub const PROXIMITY: f64 = 1e-7;

/// A pivot above this is large enough for elimination without row exchanges: the entries of a force system are 1 to 10.
const LARGE_PIVOT: f64 = 0.05;

/// Solves a system whose diagonal pivots are all large, without row exchanges, so that the compiler can unroll it if it knows the size.
/// `side` becomes the solution. Returns false if a pivot is small; `entries` and `side` are then invalid.
#[inline(always)]
pub fn eliminate(entries: &mut [f64], side: &mut [f64]) -> bool {
    let size = side.len();
    let mut inverse = [0.0; 3 * super::MAX_CONTACTS];
    for column in 0..size {
        let pivot = entries[column * (size + 1)];
        if pivot.abs() <= LARGE_PIVOT || pivot.is_nan() {
            return false;
        }
        inverse[column] = 1.0 / pivot;
        for row in column + 1..size {
            let factor = entries[row * size + column] * inverse[column];
            for other in column + 1..size {
                entries[row * size + other] -= factor * entries[column * size + other];
            }
            side[row] -= factor * side[column];
        }
    }
    for column in (0..size).rev() {
        side[column] *= inverse[column];
        for row in 0..column {
            side[row] -= entries[row * size + column] * side[column];
        }
    }
    true
}

/// Computes the LU factorization of a square matrix, stored row by row: `L` below the diagonal, `U` on and above it. `pivots` receives the
/// row that was exchanged in each elimination step. Returns the magnitude of the smallest pivot. Zero means an exactly singular matrix,
/// whose factors cannot be used.
#[inline(always)]
pub fn factorize(entries: &mut [f64], pivots: &mut [usize]) -> f64 {
    let size = pivots.len();
    let mut least = f64::INFINITY;
    for column in 0..size {
        let size_at = |row: usize| entries[row * size + column].abs();
        let pivot = (column..size).fold(column, |best, row| if size_at(row) > size_at(best) { row } else { best });
        least = least.min(size_at(pivot));
        if least == 0.0 {
            return 0.0;
        }
        pivots[column] = pivot;
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
    least
}

/// Replaces the right-hand side by the solution of a factorized system.
#[inline(always)]
pub fn substitute(entries: &[f64], pivots: &[usize], side: &mut [f64]) {
    let size = pivots.len();
    let row = |index: usize| &entries[index * size..(index + 1) * size];
    for (place, &pivot) in pivots.iter().enumerate() {
        side.swap(place, pivot);
    }
    for index in 1..size {
        let known: f64 = row(index)[..index].iter().zip(&*side).map(|(l, x)| l * x).sum();
        side[index] -= known;
    }
    for index in (0..size).rev() {
        let known: f64 = (index + 1..size).map(|other| row(index)[other] * side[other]).sum();
        side[index] = (side[index] - known) / row(index)[index];
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
            let (mut factors, mut pivots) = (rows.clone(), [0; 5]);
            prop_assume!(factorize(&mut factors, &mut pivots) > 1e-9);
            substitute(&factors, &pivots, &mut solution);
            let scale = solution.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
            for (row, wanted) in rows.chunks_exact(5).zip(&side) {
                let product: f64 = row.iter().zip(&solution).map(|(a, x)| a * x).sum();
                prop_assert!((product - wanted).abs() < 1e-13 * scale);
            }
        }
    }

    proptest! {
        #[test]
        fn elimination_without_pivoting_gives_the_same_solution(rows in prop::collection::vec(-0.6..0.6f64, 16), side in prop::collection::vec(-1.0..1.0f64, 4)) {
            let mut entries = rows;
            (0..4).for_each(|index| entries[5 * index] += 2.0);
            let (mut factors, mut pivots, mut expected, mut solution) = (entries.clone(), [0; 4], side.clone(), side);
            factorize(&mut factors, &mut pivots);
            substitute(&factors, &pivots, &mut expected);
            prop_assume!(eliminate(&mut entries, &mut solution));
            for (found, expected) in solution.iter().zip(&expected) {
                prop_assert!((found - expected).abs() < 1e-11 * expected.abs().max(1.0));
            }
        }
    }

    #[test]
    fn a_small_pivot_is_not_eliminated() {
        assert!(!eliminate(&mut [1.0, 1.0, 1.0, 1.04], &mut [1.0, 1.0]));
        assert!(!eliminate(&mut [f64::NAN], &mut [1.0]));
    }

    #[test]
    fn a_row_of_zeros_has_no_solution() {
        assert_eq!(factorize(&mut [1.0, 2.0, 0.0, 0.0], &mut [0; 2]), 0.0);
    }
}
