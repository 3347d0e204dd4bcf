//! Linear least squares with few unknowns, by the Gram-Schmidt method with column pivoting: returns the solution, or that it is
//! not unique.

use crate::{statistics::dot, table::BALLS};

/// Length of a column: velocity and spin of every ball.
pub const SIZE: usize = 5 * BALLS;

/// A column, or the right-hand side.
pub type Column = [f64; SIZE];

/// If the independent part of a column is shorter than this share of the longest column, the factors are not determined; the
/// part that the columns explain is used all the same.
const DEPENDENT: f64 = 1e-9;

/// If the independent part is shorter than this share, the column explains nothing: on a table of ten metres this is the
/// uncertainty of the normal of two balls, the rounding of their positions over their distance. With a larger value, the
/// transverse forces of balls almost in a row have no cause. With a smaller value, rounding explains them.
const NONE: f64 = 2e-14;

/// The best approximation of a right-hand side by columns.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Factor of each column, in their order; `None` if the solution is not unique.
    pub factors: Option<Vec<f64>>,
    /// The part that the columns do not explain.
    pub residual: Column,
    /// Length of the shortest independent part of a column: the accuracy of the factors is the rounding of the right-hand side
    /// over this.
    pub shortest: f64,
}

/// Finds the factors for which the sum of `columns` is closest to `target`.
pub fn fit(columns: &[Column], target: &Column) -> Fit {
    let count = columns.len();
    let mut rest: Vec<Column> = columns.to_vec();
    let mut order: Vec<usize> = (0..count).collect();
    // Row `i` of the triangle belongs to the `i`th column in `order`.
    let mut triangle = vec![vec![0.0; count]; count];
    let mut residual = *target;
    let mut shares = Vec::with_capacity(count);
    let longest = columns.iter().map(|column| dot(column, column)).fold(0.0, f64::max).sqrt();
    let mut shortest = longest;
    for rank in 0..count {
        let size = |place: &usize| dot(&rest[order[*place]], &rest[order[*place]]);
        let Some(pivot) = (rank..count).max_by(|a, b| size(a).total_cmp(&size(b))) else { break };
        order.swap(rank, pivot);
        let column = rest[order[rank]];
        let length = dot(&column, &column).sqrt();
        if length <= NONE * longest {
            shortest = 0.0;
            break;
        }
        shortest = length;
        let unit = column.map(|x| x / length);
        triangle[rank][order[rank]] = length;
        for &later in &order[rank + 1..] {
            triangle[rank][later] = project_out(&unit, &mut rest[later]);
        }
        shares.push(project_out(&unit, &mut residual));
    }
    if shares.len() < count || shortest <= DEPENDENT * longest {
        return Fit { factors: None, residual, shortest };
    }
    let mut factors = vec![0.0; count];
    for rank in (0..count).rev() {
        let known: f64 = order[rank + 1..].iter().map(|&later| triangle[rank][later] * factors[later]).sum();
        factors[order[rank]] = (shares[rank] - known) / triangle[rank][order[rank]];
    }
    Fit { factors: Some(factors), residual, shortest }
}

/// Removes the component along a unit vector from another vector and returns it. Done twice, so that only rounding remains.
fn project_out(unit: &Column, from: &mut Column) -> f64 {
    let mut sum = 0.0;
    for _ in 0..2 {
        let share = dot(unit, from);
        from.iter_mut().zip(unit).for_each(|(from, unit)| *from -= share * unit);
        sum += share;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(start: &[f64]) -> Column {
        std::array::from_fn(|place| start.get(place).copied().unwrap_or(0.0))
    }

    #[test]
    fn fit_recovers_the_factors_and_leaves_the_residual() {
        let columns = [column(&[1.0, 2.0]), column(&[0.0, 1.0, 1.0]), column(&[3.0, 0.0, 1.0])];
        let target = column(&[1.0 + 6.0, 2.0 - 1.0, -1.0 + 2.0, 5.0]);
        let found = fit(&columns, &target);
        let factors = found.factors.unwrap();
        assert!(factors.iter().zip([1.0, -1.0, 2.0]).all(|(found, meant)| (found - meant).abs() < 1e-14));
        assert!((found.residual[3] - 5.0).abs() < 1e-14 && found.residual[0].abs() < 1e-14);
    }

    /// The case of balls almost in a row that push each other.
    #[test]
    fn nearly_equal_columns_explain_their_difference() {
        let apart = |angle: f64| fit(&[column(&[1.0, 0.0]), column(&[1.0, angle])], &column(&[1.0, 0.5e-10]));
        let left = |found: &Fit| dot(&found.residual, &found.residual).sqrt();
        assert!(apart(1e-10).factors.is_none() && left(&apart(1e-10)) < 1e-24);
        assert!(left(&apart(1e-15)) > 0.4e-10);
        assert!(apart(1e-8).factors.is_some());
    }

    #[test]
    fn equal_columns_have_no_unique_factors() {
        let found = fit(&[column(&[1.0, 1.0]), column(&[2.0, 2.0])], &column(&[3.0, 3.0]));
        assert!(found.factors.is_none() && dot(&found.residual, &found.residual) < 1e-28);
    }
}
