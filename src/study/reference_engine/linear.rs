//! Solves systems of linear equations that may be rank deficient.

use super::Real;

/// Solves `matrix x = side` by Gaussian elimination with full pivoting. Undetermined unknowns are zero. The caller has to check
/// whether the equations contradict each other.
pub fn solve<R: Real>(mut matrix: Vec<Vec<R>>, mut side: Vec<R>) -> Vec<R> {
    let count = side.len();
    let mut order: Vec<usize> = (0..count).collect();
    let size = matrix.iter().flatten().fold(R::zero(), |largest, entry| largest.max(entry.abs()));
    let none = size * R::of(R::ROUNDING.sqrt());
    let mut rank = 0;
    while rank < count {
        let (mut row, mut column, mut pivot) = (rank, rank, R::zero());
        for (i, entries) in matrix.iter().enumerate().skip(rank) {
            for (j, entry) in entries.iter().enumerate().skip(rank) {
                if entry.abs() > pivot {
                    (row, column, pivot) = (i, j, entry.abs());
                }
            }
        }
        if pivot <= none {
            break;
        }
        matrix.swap(rank, row);
        side.swap(rank, row);
        for entries in &mut matrix {
            entries.swap(rank, column);
        }
        order.swap(rank, column);
        let (above, below) = matrix.split_at_mut(rank + 1);
        let top = &above[rank];
        for (offset, entries) in below.iter_mut().enumerate() {
            let factor = entries[rank] / top[rank];
            for (entry, of_top) in entries.iter_mut().zip(top).skip(rank) {
                *entry = *entry - factor * *of_top;
            }
            side[rank + 1 + offset] = side[rank + 1 + offset] - factor * side[rank];
        }
        rank += 1;
    }
    let mut solution = vec![R::zero(); count];
    for row in (0..rank).rev() {
        let known = (row + 1..rank).fold(side[row], |sum, j| sum - matrix[row][j] * solution[order[j]]);
        solution[order[row]] = known / matrix[row][row];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_are_solved_in_any_order_of_pivots() {
        let x = solve(vec![vec![0.0, 2.0, 1.0], vec![1.0, 0.0, 0.0], vec![3.0, 1.0, -1.0]], vec![7.0, 1.0, 2.0]);
        assert!(x.iter().zip([1.0, 2.0, 3.0]).all(|(x, known)| (x - known).abs() < 1e-14), "{x:?}");
    }

    #[test]
    fn redundant_equations_are_consistent() {
        let x = solve(vec![vec![1.0, 1.0], vec![2.0, 2.0]], vec![3.0, 6.0]);
        assert!((x[0] + x[1] - 3.0).abs() < 1e-15);
    }
}
