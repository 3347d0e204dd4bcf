//! Three root finders for the time at which a gap closes: the first time at which a polynomial of degree four becomes negative.

use super::Real;

/// A root finder. Takes the coefficients, lowest first, of a polynomial that is not negative at zero, and the end of the
/// interval. Returns the first falling root in `(0, end]`.
pub type Finder<R> = fn(&[R; 5], R) -> Option<R>;

/// Finds the root between extrema. A polynomial is monotone between its extrema, which are the roots of its derivative and
/// found in the same way, so no root can be missed. Works in any precision.
pub fn by_extrema<R: Real>(gap: &[R; 5], end: R) -> Option<R> {
    let slope = derivative(gap);
    let mut low = R::zero();
    for high in sign_changes(&slope, end).into_iter().chain([end]) {
        if value(gap, high) < R::zero() {
            return Some(bracketed(|t| value(gap, t), |t| value(&slope, t), low, high));
        }
        low = high;
    }
    None
}

/// Returns all roots in `(0, end)` at which the polynomial changes sign, in ascending order.
fn sign_changes<R: Real>(polynomial: &[R], end: R) -> Vec<R> {
    if polynomial.len() < 2 {
        return Vec::new();
    }
    let slope = derivative(polynomial);
    let mut roots = Vec::new();
    let mut low = R::zero();
    for high in sign_changes(&slope, end).into_iter().chain([end]) {
        let (before, behind) = (value(polynomial, low), value(polynomial, high));
        if before > R::zero() && behind < R::zero() {
            roots.push(bracketed(|t| value(polynomial, t), |t| value(&slope, t), low, high));
        } else if before < R::zero() && behind > R::zero() {
            roots.push(bracketed(|t| -value(polynomial, t), |t| -value(&slope, t), low, high));
        }
        low = high;
    }
    roots
}

fn value<R: Real>(polynomial: &[R], t: R) -> R {
    polynomial.iter().rev().fold(R::zero(), |sum, c| sum * t + *c)
}

fn derivative<R: Real>(polynomial: &[R]) -> Vec<R> {
    polynomial.iter().enumerate().skip(1).map(|(power, c)| R::of(power as f64) * *c).collect()
}

/// Returns the root of a function that falls through zero between `low` and `high`: by a Newton step if it stays within the
/// bracket, else by bisection.
pub fn bracketed<R: Real>(value: impl Fn(R) -> R, slope: impl Fn(R) -> R, mut low: R, mut high: R) -> R {
    let half = R::of(0.5);
    let rounding = R::of(R::ROUNDING);
    let mut t = half * (low + high);
    // A bound for functions of the size of rounding; bisection alone would take some 110 iterations in double-double.
    for round in 0..200 {
        let height = value(t);
        if height < R::zero() {
            high = t;
        } else {
            low = t;
        }
        let newton = t - height / slope(t);
        let next = if newton > low && newton < high && round % 8 != 7 { newton } else { half * (low + high) };
        if (next - t).abs() <= rounding * t || high - low <= rounding * high {
            return next;
        }
        t = next;
    }
    t
}

/// Returns where a function without a known derivative falls through zero between `low`, where it is not negative, and `high`,
/// where it is: by false position after Anderson and Björck (1973). The result is on the side of `high`. Every fourth step
/// halves the range, or its decades. The search stops once the value at `high` is not below `-enough`.
pub fn falling_root<R: Real>(value: impl Fn(R) -> R, mut low: R, mut high: R, enough: R) -> R {
    let (zero, half, one) = (R::zero(), R::of(0.5), R::of(1.0));
    let narrow = R::of(4.0 * R::ROUNDING);
    let (mut low_value, mut high_value) = (value(low), value(high));
    let mut behind = high_value;
    for round in 1..200 {
        if high - low <= narrow * high || behind >= -enough {
            break;
        }
        let middle = if round % 4 == 0 || low_value <= zero || high_value >= zero {
            if low * R::of(4.0) < high { (low * high).sqrt().max(high * R::of(1e-4)) } else { half * (low + high) }
        } else {
            low + (high - low) * (low_value / (low_value - high_value))
        };
        if middle <= low || middle >= high {
            break;
        }
        let height = value(middle);
        // The weight of the side that stays is reduced, the more the other side has moved.
        let lessened = |replaced: R| {
            let left = one - height / replaced;
            if left > zero { left } else { half }
        };
        if height < zero {
            low_value = low_value * lessened(high_value);
            (high, high_value, behind) = (middle, height, height);
        } else {
            if low_value > zero {
                high_value = high_value * lessened(low_value);
            }
            (low, low_value) = (middle, height);
        }
    }
    high
}

/// Finds the root by Algorithm 1010 (Orellana and De Michele 2020), from the crate `kurbo`.
pub fn algorithm_1010(gap: &[f64; 5], end: f64) -> Option<f64> {
    let [c0, c1, c2, c3, c4] = *gap;
    first_fall(gap, &kurbo::common::solve_quartic(c0, c1, c2, c3, c4), end)
}

/// Finds the root by Ferrari's closed form as in textbooks, without any measure against cancellation.
pub fn closed_form(gap: &[f64; 5], end: f64) -> Option<f64> {
    let [c0, c1, c2, c3, c4] = *gap;
    if c4 == 0.0 {
        return algorithm_1010(gap, end);
    }
    let (a, b, c, d) = (c3 / c4, c2 / c4, c1 / c4, c0 / c4);
    // With t = y - a/4: y⁴ + p y² + q y + r.
    let p = b - 0.375 * a * a;
    let q = c - 0.5 * a * b + 0.125 * a * a * a;
    let r = d - 0.25 * a * c + 0.0625 * a * a * b - 3.0 / 256.0 * a.powi(4);
    // A positive root m of the resolvent 8m³ + 8pm² + (2p² - 8r)m - q² makes both sides perfect squares.
    let m = largest_cubic_root(p, 0.25 * p * p - r, -0.125 * q * q);
    let mut roots = Vec::with_capacity(4);
    if m > 0.0 {
        let s = (2.0 * m).sqrt();
        for sign in [1.0, -1.0] {
            let inside = -(2.0 * p + 2.0 * m + sign * 2.0 * q / s);
            if inside >= 0.0 {
                roots.extend([1.0, -1.0].map(|side| 0.5 * (sign * s + side * inside.sqrt()) - 0.25 * a));
            }
        }
    } else {
        let inside = 0.25 * p * p - r;
        if inside >= 0.0 {
            for square in [-0.5 * p + inside.sqrt(), -0.5 * p - inside.sqrt()] {
                if square >= 0.0 {
                    roots.extend([square.sqrt() - 0.25 * a, -square.sqrt() - 0.25 * a]);
                }
            }
        }
    }
    first_fall(gap, &roots, end)
}

/// Returns the largest real root of `m³ + a m² + b m + c`, by Cardano's and Viète's formulas.
fn largest_cubic_root(a: f64, b: f64, c: f64) -> f64 {
    let p = b - a * a / 3.0;
    let q = 2.0 / 27.0 * a * a * a - a * b / 3.0 + c;
    let discriminant = 0.25 * q * q + p * p * p / 27.0;
    let root = if discriminant >= 0.0 {
        (-0.5 * q + discriminant.sqrt()).cbrt() + (-0.5 * q - discriminant.sqrt()).cbrt()
    } else {
        let size = 2.0 * (-p / 3.0).sqrt();
        size * ((1.5 * q / p * (-3.0 / p).sqrt()).clamp(-1.0, 1.0).acos() / 3.0).cos()
    };
    root - a / 3.0
}

/// Returns the first of `roots` in `(0, end]` at which the gap decreases.
fn first_fall(gap: &[f64; 5], roots: &[f64], end: f64) -> Option<f64> {
    let slope = derivative(gap);
    roots.iter().copied().filter(|&t| t > 0.0 && t <= end && value(&slope, t) < 0.0).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reference_engine::DoubleDouble;

    /// `(t - 0.3)(t - 0.7)(t + 1)(t + 2)`.
    const QUARTIC: [f64; 5] = [0.42, -1.37, -0.79, 2.0, 1.0];

    #[test]
    fn all_finders_find_the_first_root() {
        for finder in [by_extrema::<f64>, closed_form, algorithm_1010] {
            assert!((finder(&QUARTIC, 5.0).unwrap() - 0.3).abs() < 1e-14);
            assert_eq!(finder(&QUARTIC, 0.29), None);
        }
    }

    #[test]
    fn in_double_double_a_root_has_thirty_digits() {
        let root = by_extrema(&[2.0, 0.0, -1.0, 0.0, 0.0].map(DoubleDouble::of), DoubleDouble::of(9.0)).unwrap();
        assert!((root - DoubleDouble::of(2.0).sqrt()).to_f64().abs() < 1e-30);
    }
}
