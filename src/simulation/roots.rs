//! Root finding: the first time at which a gap closes, as a root of a polynomial of small degree, isolated by Descartes' rule or between
//! extrema.

/// Highest degree that [`first_crossing`] accepts: the gap of two balls with trajectories of degree five.
pub const MAX_DEGREE: usize = 10;

/// Capacity for the roots of such a polynomial and the end of the interval.
const MAX_ROOTS: usize = MAX_DEGREE + 1;

/// Relative step at which the search for an extremum ends: the value there differs by less than rounding, because its slope is zero.
const EXTREMUM_STEP: f64 = 1e-9;

/// Returns the first `t` in `(0, end]` at which `value` falls from positive to below zero, given the coefficients of its derivative, lowest
/// first.
///
/// The Bernstein coefficients of `value` often tell that it has no root or a single one. Otherwise the roots of the derivative are found
/// first, by the same method one degree lower. Between them `value` is monotone, so that a sign change is a single root and none can be
/// missed. `rounding` is the rounding error of `value` near its root: the root is as accurate as that allows. An initial value at or below
/// zero is treated as just above it.
pub fn first_crossing(value: impl Fn(f64) -> f64, derivative: &[f64], end: f64, rounding: f64) -> Option<f64> {
    let accuracy = Accuracy { step: 0.5 * f64::EPSILON, value: rounding };
    let root = |bracket, values| bisect_newton(&value, |t| horner(derivative, t), bracket, values, accuracy);
    let (mut low, mut value_at_low) = (0.0, value(0.0));
    match sign_changes(value_at_low, derivative, end, rounding) {
        Some(0) => return None,
        Some(1) => return Some(root([low, end], [value_at_low, value(end)])),
        _ => {}
    }
    let mut turns = [0.0; MAX_ROOTS];
    let count = roots(derivative, end, &mut turns);
    turns[count] = end;
    for &high in &turns[..=count] {
        let value_at_high = value(high);
        if value_at_high < 0.0 {
            return Some(root([low, high], [value_at_low, value_at_high]));
        }
        (low, value_at_low) = (high, value_at_high);
    }
    None
}

/// Returns the number of sign changes in the Bernstein coefficients of a polynomial on `[0, end]`, given its positive value at zero and the
/// coefficients of its derivative. With no change it has no root there, and with one change a single root (Descartes' rule). `None` if
/// rounding decides a sign.
fn sign_changes(start: f64, derivative: &[f64], end: f64, rounding: f64) -> Option<usize> {
    let mut slopes = [0.0; MAX_DEGREE + 1];
    let slopes = bernstein(derivative, end, &mut slopes);
    let share = end / slopes.len() as f64;
    let (mut value, mut size, mut least) = (start, start.abs(), start);
    let (mut changes, mut is_positive) = (0, true);
    for slope in slopes {
        let change = share * slope;
        value += change;
        size += change.abs();
        least = least.min(value.abs());
        changes += usize::from((value > 0.0) != is_positive);
        is_positive = value > 0.0;
    }
    (least > 8.0 * rounding + 16.0 * f64::EPSILON * size).then_some(changes)
}

/// Evaluates a polynomial with coefficients in ascending order of powers.
#[inline]
pub fn horner(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// Returns the coefficients of a polynomial's derivative, which are stored in `slope`.
#[inline]
pub fn derivative<'s>(coefficients: &[f64], slope: &'s mut [f64; MAX_DEGREE]) -> &'s [f64] {
    for power in 1..coefficients.len() {
        slope[power - 1] = power as f64 * coefficients[power];
    }
    &slope[..coefficients.len() - 1]
}

/// Finds all sign changes of the polynomial in the open interval `(0, end)`, in ascending order. Returns their number.
fn roots(coefficients: &[f64], end: f64, found: &mut [f64; MAX_ROOTS]) -> usize {
    let mut degree = coefficients.len().saturating_sub(1);
    while degree > 0 && coefficients[degree] == 0.0 {
        degree -= 1;
    }
    match degree {
        0 => 0,
        1 => keep_inside(&[-coefficients[0] / coefficients[1]], end, found),
        2 => match quadratic(coefficients[2], coefficients[1], coefficients[0]) {
            Some(pair) => keep_inside(&pair, end, found),
            None => 0,
        },
        _ => roots_between_extrema(&coefficients[..=degree], end, found),
    }
}

fn keep_inside(candidates: &[f64], end: f64, found: &mut [f64; MAX_ROOTS]) -> usize {
    let mut count = 0;
    for &t in candidates {
        if t > 0.0 && t < end {
            found[count] = t;
            count += 1;
        }
    }
    count
}

fn roots_between_extrema(coefficients: &[f64], end: f64, found: &mut [f64; MAX_ROOTS]) -> usize {
    // A polynomial whose Bernstein coefficients on the interval share one sign has no root in it.
    let mut b = [0.0; MAX_DEGREE + 1];
    let b = bernstein(coefficients, end, &mut b);
    if b.iter().all(|x| *x > 0.0) || b.iter().all(|x| *x < 0.0) {
        return 0;
    }
    let mut slope = [0.0; MAX_DEGREE];
    let slope = derivative(coefficients, &mut slope);
    let mut turns = [0.0; MAX_ROOTS];
    let turn_count = roots(slope, end, &mut turns);
    turns[turn_count] = end;
    let mut count = 0;
    let (mut low, mut low_value) = (0.0, coefficients[0]);
    for &high in &turns[..=turn_count] {
        let high_value = horner(coefficients, high);
        if (low_value < 0.0) != (high_value < 0.0) {
            let sign = if high_value < 0.0 { 1.0 } else { -1.0 };
            let (value, slope) = (|t| sign * horner(coefficients, t), |t| sign * horner(slope, t));
            let accuracy = Accuracy { step: EXTREMUM_STEP, value: 0.0 };
            found[count] = bisect_newton(value, slope, [low, high], [sign * low_value, sign * high_value], accuracy);
            count += 1;
        }
        (low, low_value) = (high, high_value);
    }
    count
}

/// Computes the Bernstein coefficients of a polynomial on `[0, end]`: `b_j = sum_i C(j,i) / C(n,i) c_i end^i`.
#[inline]
fn bernstein<'b>(coefficients: &[f64], end: f64, b: &'b mut [f64; MAX_DEGREE + 1]) -> &'b [f64] {
    let degree = coefficients.len() - 1;
    let mut power = 1.0;
    for ((b, c), share) in b.iter_mut().zip(coefficients).zip(&INVERSE_BINOMIALS[degree]) {
        *b = c * power * share;
        power *= end;
    }
    // Pascal's scheme of sums.
    for level in 1..=degree {
        for j in (level..=degree).rev() {
            b[j] += b[j - 1];
        }
    }
    &b[..=degree]
}

/// `1 / C(n, i)`, for all degrees `n`.
const INVERSE_BINOMIALS: [[f64; MAX_DEGREE + 1]; MAX_DEGREE + 1] = {
    let mut table = [[0.0; MAX_DEGREE + 1]; MAX_DEGREE + 1];
    let mut n = 0;
    while n <= MAX_DEGREE {
        let (mut i, mut binomial) = (0, 1);
        while i <= n {
            table[n][i] = 1.0 / binomial as f64;
            binomial = binomial * (n - i) / (i + 1);
            i += 1;
        }
        n += 1;
    }
    table
};

/// Returns the real roots of `a t² + b t + c` in ascending order, without cancellation.
fn quadratic(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let (first, second) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    Some([first.min(second), first.max(second)])
}

/// Accuracy at which a search ends.
#[derive(Clone, Copy)]
struct Accuracy {
    /// Step relative to the root.
    step: f64,
    /// Value that counts as zero.
    value: f64,
}

/// Returns the root of a function that falls from positive to negative between two points with these values: Newton's method, with bisection
/// if a step leaves the bracket or shrinks too slowly. It starts from the root of the parabola that has both values and the slope at the
/// first point.
fn bisect_newton(
    value: impl Fn(f64) -> f64,
    slope: impl Fn(f64) -> f64,
    [mut low, mut high]: [f64; 2],
    [value_at_low, value_at_high]: [f64; 2],
    accuracy: Accuracy,
) -> f64 {
    let (value_at_low, slope_at_low, width) = (value_at_low.max(0.0), slope(low), high - low);
    let bend = (value_at_high - value_at_low - slope_at_low * width) / (width * width);
    let discriminant = slope_at_low * slope_at_low - 4.0 * bend * value_at_low;
    let ahead = 2.0 * value_at_low / (discriminant.sqrt() - slope_at_low);
    let mut t = if ahead > 0.0 && ahead < width { low + ahead } else { low + 0.5 * width };
    let mut last_step = width;
    loop {
        let f = value(t);
        if f.abs() <= accuracy.value {
            return t;
        }
        if f > 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - f / slope(t);
        let step = newton - t;
        let next = if newton > low && newton < high && step.abs() < 0.5 * last_step.abs() {
            newton
        } else {
            0.5 * (low + high)
        };
        last_step = next - t;
        // Adjacent numbers, or a step below the last bit: no further progress is possible.
        if next <= low || next >= high || last_step.abs() <= accuracy.step * t {
            return next.clamp(low, high);
        }
        t = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn derivative(coefficients: &[f64]) -> Vec<f64> {
        super::derivative(coefficients, &mut [0.0; MAX_DEGREE]).to_vec()
    }

    fn from_roots(roots: &[f64]) -> Vec<f64> {
        let mut polynomial = vec![1.0];
        for root in roots {
            let mut next = vec![0.0; polynomial.len() + 1];
            for (i, c) in polynomial.iter().enumerate() {
                next[i + 1] += c;
                next[i] -= root * c;
            }
            polynomial = next;
        }
        polynomial
    }

    #[test]
    fn two_roots_a_ten_millionth_apart_are_distinguished_from_none() {
        let touch = from_roots(&[0.5, 0.5 + 1e-7, -1.0, -2.0]);
        let value = |t: f64| (t - 0.5) * (t - 0.5 - 1e-7) * (t + 1.0) * (t + 2.0);
        let t = first_crossing(value, &derivative(&touch), 1.0, 0.0);
        assert!((t.unwrap() - 0.5).abs() < 1e-12);
        let miss = |t: f64| (t - 0.5) * (t - 0.5) + 1e-12;
        assert_eq!(first_crossing(miss, &[-1.0, 2.0], 1.0, 0.0), None);
    }

    #[test]
    fn root_at_the_interval_end_counts_and_later_ones_do_not() {
        let line = |t: f64| 1.0 - t;
        assert_eq!(first_crossing(line, &[-1.0], 1.0 - 1e-9, 0.0), None);
        assert!((first_crossing(line, &[-1.0], 1.0 + 1e-9, 0.0).unwrap() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn sign_changes_count_the_roots_unless_rounding_decides() {
        let changes = |polynomial: &[f64], end| sign_changes(polynomial[0], &derivative(polynomial), end, 0.0);
        let two = from_roots(&[0.5, 0.9, -1.0, -2.0]);
        assert_eq!([0.1, 0.7, 1.0].map(|end| changes(&two, end)), [Some(0), Some(1), Some(2)]);
        assert_eq!(changes(&[0.5, -1.0], 0.5), None);
    }

    /// Near its root the rounded value of a slow approach changes its sign many times: bisection would halve its bracket fifty times.
    #[test]
    fn a_search_ends_at_the_rounding_error_of_its_value() {
        let evaluations = std::cell::Cell::new(0);
        let (distance, speed) = (0.061, 1e-4);
        let value = |t: f64| {
            evaluations.set(evaluations.get() + 1);
            let left = distance + 1e-5 - speed * t;
            left * left - distance * distance
        };
        let derivative = [-2.0 * speed * (distance + 1e-5), 2.0 * speed * speed];
        let t = first_crossing(value, &derivative, 0.4, f64::EPSILON * distance * distance);
        assert!((t.unwrap() - 0.1).abs() < 1e-11, "{t:?}");
        assert!(evaluations.get() < 10, "{}", evaluations.get());
    }

    proptest! {
        #[test]
        fn the_smallest_of_any_roots_is_found(mut roots in prop::collection::vec(0.01..3.0f64, 4)) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|w| w[1] - w[0] > 1e-4));
            let polynomial = from_roots(&roots);
            let t = first_crossing(|t| horner(&polynomial, t), &derivative(&polynomial), 4.0, 0.0).unwrap();
            prop_assert!((t - roots[0]).abs() < 1e-8, "{t} {roots:?}");
        }

        #[test]
        fn high_degrees_lose_no_root(gaps in prop::collection::vec(0.05..0.15f64, 9)) {
            let mut roots: Vec<f64> =
                gaps.iter().scan(0.0, |sum, gap| { *sum += gap; Some(*sum) }).collect();
            roots.push(-1.0);
            let polynomial: Vec<f64> = from_roots(&roots).iter().map(|c| -c).collect();
            let t = first_crossing(|t| horner(&polynomial, t), &derivative(&polynomial), 2.0, 0.0).unwrap();
            prop_assert!((t - roots[0]).abs() < 1e-5, "{t} {roots:?}");
        }
    }
}
