//! Levenberg–Marquardt least squares, with derivatives by finite differences or from the caller.

use super::{dot, normal_matrix, solve};

/// A least-squares problem: half the sum of squares of the residuals is minimized.
pub trait LeastSquaresProblem {
    /// Fills `out` with the residuals at `parameters`.
    fn residuals(&mut self, parameters: &[f64], out: &mut Vec<f64>);

    /// Returns the derivatives of the residuals, one column for each parameter; `residuals` are those at `parameters`.
    fn derivatives(&mut self, parameters: &[f64], residuals: &[f64]) -> Vec<Vec<f64>>;
}

/// The minimum that was found.
#[derive(Clone, Debug)]
pub struct Minimum {
    /// The parameters.
    pub parameters: Vec<f64>,
    /// The sum of squares of the residuals; the method minimizes half of it.
    pub squares: f64,
    /// The normal matrix `JᵀJ` by rows, before the last step, which is small. Its inverse times the variance of the residuals is the
    /// covariance of the parameters.
    pub normal: Vec<Vec<f64>>,
}

/// Minimizes from `start` in at most `rounds` iterations.
pub fn minimize(start: &[f64], rounds: usize, problem: &mut impl LeastSquaresProblem) -> Minimum {
    let (mut at, mut other) = (Vec::new(), Vec::new());
    let mut parameters = start.to_vec();
    problem.residuals(&parameters, &mut at);
    let mut squares = sum(&at);
    let mut damping = 1e-3;
    let count = start.len();
    let mut normal = vec![vec![0.0; count]; count];
    for _ in 0..rounds {
        let columns = problem.derivatives(&parameters, &at);
        let slope: Vec<f64> = columns.iter().map(|column| -dot(column, &at)).collect();
        normal = normal_matrix(&columns);
        let mut better = None;
        while damping < 1e9 {
            let mut damped = normal.clone();
            for (i, row) in damped.iter_mut().enumerate() {
                row[i] += damping * row[i] + 1e-30;
            }
            // The damping grows for the next attempt, unless this one succeeds.
            let used = damping;
            damping *= 5.0;
            let Some(change) = solve(&damped, &slope) else { continue };
            let mut tried = parameters.clone();
            tried.iter_mut().zip(change).for_each(|(value, change)| *value += change);
            problem.residuals(&tried, &mut other);
            let found = sum(&other);
            if found < squares {
                better = Some((tried, found));
                damping = 0.2 * used;
                break;
            }
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
    Minimum { parameters, squares, normal }
}

/// A [`Minimum`] of a problem with a fixed number of parameters.
#[derive(Clone, Debug)]
pub struct Fit<const N: usize> {
    /// The parameters.
    pub parameters: [f64; N],
    /// The sum of squares.
    pub squares: f64,
    /// The normal matrix by rows.
    pub normal: Vec<Vec<f64>>,
}

/// Minimizes the sum of squares of the values that `residuals` fills in, from `start`, in at most `rounds` iterations. `steps` are the
/// steps of the finite differences.
pub fn fit<const N: usize>(
    start: [f64; N],
    steps: [f64; N],
    rounds: usize,
    residuals: &mut impl FnMut(&[f64; N], &mut Vec<f64>),
) -> Fit<N> {
    let mut problem = FiniteDifferences { residuals, steps, other: Vec::new() };
    let Minimum { parameters, squares, normal } = minimize(&start, rounds, &mut problem);
    Fit { parameters: std::array::from_fn(|index| parameters[index]), squares, normal }
}

/// A problem whose derivatives are finite differences.
struct FiniteDifferences<'a, F, const N: usize> {
    residuals: &'a mut F,
    steps: [f64; N],
    other: Vec<f64>,
}

impl<F: FnMut(&[f64; N], &mut Vec<f64>), const N: usize> LeastSquaresProblem for FiniteDifferences<'_, F, N> {
    fn residuals(&mut self, parameters: &[f64], out: &mut Vec<f64>) {
        (self.residuals)(&std::array::from_fn(|index| parameters[index]), out);
    }

    fn derivatives(&mut self, parameters: &[f64], residuals: &[f64]) -> Vec<Vec<f64>> {
        let column = |index: usize| {
            let mut moved: [f64; N] = std::array::from_fn(|index| parameters[index]);
            moved[index] += self.steps[index];
            (self.residuals)(&moved, &mut self.other);
            self.other.iter().zip(residuals).map(|(a, b)| (a - b) / self.steps[index]).collect()
        };
        (0..N).map(column).collect()
    }
}

fn sum(residuals: &[f64]) -> f64 {
    residuals.iter().map(|x| x * x).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponential_decay_is_fitted() {
        let points: Vec<(f64, f64)> =
            (0..20).map(|i| 0.1 * f64::from(i)).map(|t| (t, 3.0 * (-1.7 * t).exp())).collect();
        let found = fit([1.0, 1.0], [1e-6, 1e-6], 50, &mut |[size, rate], out| {
            out.clear();
            out.extend(points.iter().map(|(t, y)| size * (-rate * t).exp() - y));
        });
        assert!((found.parameters[0] - 3.0).abs() < 1e-8 && (found.parameters[1] - 1.7).abs() < 1e-8);
    }
}
