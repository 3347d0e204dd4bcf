//! Symmetric positive definite matrices, stored by rows: covariances and their inverses.

/// Returns the lower triangle L of `L Lᵀ` (Cholesky), each row up to the diagonal. Leading zeros of a row stay zero and cost no time.
///
/// # Errors
/// Returns the index of the first row whose remaining diagonal entry is not above `least`: the matrix is not a covariance.
pub fn cholesky(matrix: &[Vec<f64>], least: f64) -> Result<Vec<Vec<f64>>, usize> {
    let mut factor: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
    for (row, entries) in matrix.iter().enumerate() {
        let mut line: Vec<f64> = Vec::with_capacity(row + 1);
        let first = entries[..row].iter().position(|entry| *entry != 0.0).unwrap_or(row);
        line.resize(first, 0.0);
        for (column, above) in factor.iter().enumerate().skip(first) {
            line.push((entries[column] - dot(&line[first..], &above[first..column])) / above[column]);
        }
        let rest = entries[row] - dot(&line, &line);
        if rest.is_nan() || rest <= least {
            return Err(row);
        }
        line.push(rest.sqrt());
        factor.push(line);
    }
    Ok(factor)
}

/// Returns half the logarithm of the determinant, from the Cholesky factor; `None` if the matrix is not positive definite.
pub fn half_log_determinant(matrix: &[Vec<f64>]) -> Option<f64> {
    Some(cholesky(matrix, 0.0).ok()?.iter().filter_map(|line| line.last()).map(|entry| entry.ln()).sum())
}

/// Returns the identity matrix with `size` rows.
pub fn identity(size: usize) -> Vec<Vec<f64>> {
    (0..size).map(|row| (0..size).map(|column| f64::from(u8::from(row == column))).collect()).collect()
}

/// Returns the inverse of a covariance matrix; `None` if the matrix is not positive definite.
pub fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let size = matrix.len();
    let factor = cholesky(matrix, 0.0).ok()?;
    // The rows of the inverse of the Cholesky factor, computed in order.
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(size);
    for (row, line) in factor.iter().enumerate() {
        let mut next = vec![0.0; size];
        next[row] = 1.0;
        for (earlier, entry) in rows.iter().zip(line) {
            next.iter_mut().zip(&earlier[..row]).for_each(|(value, other)| *value -= entry * other);
        }
        for value in &mut next {
            *value /= line[row];
        }
        rows.push(next);
    }
    let entry = |one: usize, other: usize| rows[one.max(other)..].iter().map(|row| row[one] * row[other]).sum();
    Some((0..size).map(|one| (0..size).map(|other| entry(one, other)).collect()).collect())
}

/// Returns `JᵀJ` by rows for the finite columns of J. A parameter that affects few residuals costs time only for those.
pub fn normal_matrix(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let touched = |column: &Vec<f64>| (0..column.len()).filter(|row| column[*row] != 0.0).collect::<Vec<_>>();
    let touched: Vec<Vec<usize>> = columns.iter().map(touched).collect();
    let mut normal = vec![vec![0.0; columns.len()]; columns.len()];
    for one in 0..columns.len() {
        for other in 0..=one {
            let rows = if touched[one].len() < touched[other].len() { &touched[one] } else { &touched[other] };
            let sum = rows.iter().map(|row| columns[one][*row] * columns[other][*row]).sum();
            (normal[one][other], normal[other][one]) = (sum, sum);
        }
    }
    normal
}

/// Solves linear equations with a symmetric positive definite matrix; `None` if it is not definite. The unknowns are eliminated from the
/// last to the first. If the last ones depend on few others and the first ones on all, this takes far less time than the cube of their
/// number.
pub fn solve(matrix: &[Vec<f64>], right: &[f64]) -> Option<Vec<f64>> {
    let turned: Vec<Vec<f64>> = matrix.iter().rev().map(|row| row.iter().rev().copied().collect()).collect();
    let factor = cholesky(&turned, 0.0).ok()?;
    let mut half: Vec<f64> = Vec::with_capacity(right.len());
    for (line, value) in factor.iter().zip(right.iter().rev()) {
        half.push((value - dot(&line[..half.len()], &half)) / line[half.len()]);
    }
    let mut solution = back_substitute(&factor, &half);
    solution.reverse();
    Some(solution)
}

/// Returns the row vector whose product with the lower triangle `factor` is `product` (back substitution).
pub fn back_substitute(factor: &[Vec<f64>], product: &[f64]) -> Vec<f64> {
    let mut row = vec![0.0; product.len()];
    for column in (0..product.len()).rev() {
        let later: f64 = (column + 1..product.len()).map(|k| row[k] * factor[k][column]).sum();
        row[column] = (product[column] - later) / factor[column][column];
    }
    row
}

/// Returns the dot product; extra elements of the longer slice are ignored.
pub fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn back_substitution_and_inverse_undo_the_matrix_product() {
        let matrix = vec![vec![4.0, 1.2, -0.6], vec![1.2, 2.0, 0.3], vec![-0.6, 0.3, 1.0]];
        let factor = cholesky(&matrix, 0.0).unwrap();
        let entry = |row: usize, column: usize| factor[row].get(column).copied().unwrap_or(0.0);
        let inverse = inverse(&matrix).unwrap();
        let product = [0.3, -2.0, 0.7];
        let row = back_substitute(&factor, &product);
        for column in 0..3 {
            let again: f64 = (0..3).map(|k| row[k] * entry(k, column)).sum();
            assert!((again - product[column]).abs() < 1e-12);
            for line in 0..3 {
                let back: f64 = (0..3).map(|k| entry(line, k) * entry(column, k)).sum();
                assert!((back - matrix[line][column]).abs() < 1e-12);
                let unit: f64 = (0..3).map(|k| inverse[line][k] * matrix[k][column]).sum();
                assert!((unit - f64::from(u8::from(line == column))).abs() < 1e-12);
            }
        }
        assert_eq!(cholesky(&[vec![1.0, 2.0], vec![2.0, 1.0]], 0.0), Err(1));
        assert_eq!(super::inverse(&[vec![f64::NAN]]), None);
        let determinant: f64 = 4.0 * (2.0 - 0.09) - 1.2 * (1.2 + 0.18) - 0.6 * (0.36 + 1.2);
        assert!((2.0 * half_log_determinant(&matrix).unwrap() - determinant.ln()).abs() < 1e-12);
        assert_eq!(half_log_determinant(&identity(4)), Some(0.0));
        assert_eq!(half_log_determinant(&[vec![1.0, 2.0], vec![2.0, 1.0]]), None);
    }

    #[test]
    fn equations_are_solved_for_any_dependency_pattern() {
        // First, all unknowns depend on the first one only; then each depends on every other.
        for filled in [0.0, 0.1] {
            let entry = |row: usize, column: usize| match (row, column) {
                _ if row == column => 3.0 + row as f64,
                (0, _) | (_, 0) => 0.5,
                _ => filled,
            };
            let matrix: Vec<Vec<f64>> = (0..6).map(|row| (0..6).map(|column| entry(row, column)).collect()).collect();
            let wanted = [1.0, -2.0, 0.5, 4.0, 0.0, -1.0];
            let right: Vec<f64> = matrix.iter().map(|row| dot(row, &wanted)).collect();
            let found = solve(&matrix, &right).unwrap();
            assert!(found.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 1e-12), "{found:?}");
        }
        assert_eq!(solve(&[vec![1.0, 2.0], vec![2.0, 4.0]], &[1.0, 1.0]), None);
        let columns = [vec![1.0, 0.0, 2.0, 0.5], vec![0.0, 3.0, 0.0, -1.0]];
        assert_eq!(normal_matrix(&columns), [[5.25, -0.5], [-0.5, 10.0]]);
    }
}
