//! Levenberg and Marquardt's method for a handful of parameters, with derivatives by differences.

/// Best parameters found, their sum of squared residuals, and `JᵀJ` there, rows one after another.
#[derive(Clone, Debug)]
pub struct Fit<const N: usize> {
    /// The parameters.
    pub parameters: [f64; N],
    /// Half the sum of squares is what the method minimizes; this is the whole.
    pub squares: f64,
    /// The normal matrix, whose inverse times the residuals' variance is the parameters' covariance.
    pub normal: [[f64; N]; N],
}

/// Minimizes the sum of squares of what `residuals` fills in, from `start`; `steps` are the differences for derivatives.
pub fn fit<const N: usize>(
    start: [f64; N],
    steps: [f64; N],
    rounds: usize,
    residuals: &mut impl FnMut(&[f64; N], &mut Vec<f64>),
) -> Fit<N> {
    let (mut at, mut other) = (Vec::new(), Vec::new());
    let mut parameters = start;
    residuals(&parameters, &mut at);
    let mut squares = sum(&at);
    let mut damping = 1e-3;
    let mut normal = [[0.0; N]; N];
    for _ in 0..rounds {
        let mut columns: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity(at.len()));
        for (index, column) in columns.iter_mut().enumerate() {
            let mut moved = parameters;
            moved[index] += steps[index];
            residuals(&moved, &mut other);
            column.extend(other.iter().zip(&at).map(|(a, b)| (a - b) / steps[index]));
        }
        let mut slope = [0.0; N];
        for i in 0..N {
            slope[i] = -dot(&columns[i], &at);
            for j in 0..N {
                normal[i][j] = dot(&columns[i], &columns[j]);
            }
        }
        let mut better = None;
        while damping < 1e9 {
            let mut damped = normal;
            for (i, row) in damped.iter_mut().enumerate() {
                row[i] += damping * row[i] + 1e-30;
            }
            let Some(change) = solve(damped, slope) else { break };
            let mut tried = parameters;
            tried.iter_mut().zip(change).for_each(|(value, change)| *value += change);
            residuals(&tried, &mut other);
            let found = sum(&other);
            if found < squares {
                better = Some((tried, found));
                damping *= 0.2;
                break;
            }
            damping *= 5.0;
        }
        let Some((tried, found)) = better else { break };
        let gained = squares - found;
        (parameters, squares) = (tried, found);
        std::mem::swap(&mut at, &mut other);
        if gained < 1e-9 * squares {
            break;
        }
        damping = damping.max(1e-9);
    }
    Fit { parameters, squares, normal }
}

fn sum(residuals: &[f64]) -> f64 {
    residuals.iter().map(|x| x * x).sum()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Solves a system of equations by elimination with the largest pivots; none where it is singular.
pub fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> Option<[f64; N]> {
    for column in 0..N {
        let pivot = (column..N).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        if matrix[pivot][column] == 0.0 || !matrix[pivot][column].is_finite() {
            return None;
        }
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        for row in column + 1..N {
            let factor = matrix[row][column] / matrix[column][column];
            let upper = matrix[column];
            for (value, above) in matrix[row].iter_mut().zip(upper).skip(column) {
                *value -= factor * above;
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decay_is_found_from_its_points() {
        let points: Vec<(f64, f64)> =
            (0..20).map(|i| 0.1 * f64::from(i)).map(|t| (t, 3.0 * (-1.7 * t).exp())).collect();
        let found = fit([1.0, 1.0], [1e-6, 1e-6], 50, &mut |[size, rate], out| {
            out.clear();
            out.extend(points.iter().map(|(t, y)| size * (-rate * t).exp() - y));
        });
        assert!((found.parameters[0] - 3.0).abs() < 1e-8 && (found.parameters[1] - 1.7).abs() < 1e-8);
    }

    #[test]
    fn a_system_without_a_solution_is_none() {
        assert_eq!(solve([[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0]), None);
    }
}
