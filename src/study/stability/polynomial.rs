//! Finds the minimum of a polynomial on an interval, with a proof: its Bernstein coefficients are a lower bound.

/// Highest degree: the squared distance of two balls in resting contact, whose courses have degree five.
pub const MAX_DEGREE: usize = 10;

/// Maximum number of halvings of an interval: a shot's longest interval, 100 s, is then divided to 1e-10 s.
const MAX_HALVINGS: u32 = 40;

/// The minimum of a polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Least {
    /// The smallest value found.
    pub value: f64,
    /// Its position, in the polynomial's variable.
    pub at: f64,
}

/// Returns the minimum on `[0, end]` of the polynomial with these coefficients, lowest first.
///
/// A negative minimum is accurate to `precision`, and whether the minimum is below `-precision` is certain. Positive minima are
/// only as good as the first subdivision, because no caller needs them.
pub fn least(coefficients: &[f64], end: f64, precision: f64) -> Least {
    let degree = coefficients.len() - 1;
    let mut bernstein = [0.0; MAX_DEGREE + 1];
    let (mut power, mut binomial) = (1.0, 1.0);
    for (i, c) in coefficients.iter().enumerate() {
        bernstein[i] = c * power / binomial;
        power *= end;
        binomial *= (degree - i) as f64 / (i + 1) as f64;
    }
    for level in 1..=degree {
        for j in (level..=degree).rev() {
            bernstein[j] += bernstein[j - 1];
        }
    }
    let mut found = Least { value: bernstein[0], at: 0.0 };
    divide(&bernstein, degree, (0.0, end), precision, MAX_HALVINGS, &mut found);
    found
}

fn divide(
    bernstein: &[f64; MAX_DEGREE + 1],
    degree: usize,
    (low, high): (f64, f64),
    precision: f64,
    halvings: u32,
    found: &mut Least,
) {
    for (value, at) in [(bernstein[0], low), (bernstein[degree], high)] {
        if value < found.value {
            *found = Least { value, at };
        }
    }
    let bound = bernstein[..=degree].iter().copied().fold(f64::INFINITY, f64::min);
    if bound >= found.value.min(0.0) - precision || halvings == 0 {
        return;
    }
    // De Casteljau's algorithm at the middle gives both halves.
    let (mut left, mut right) = (*bernstein, *bernstein);
    for level in 1..=degree {
        left[level - 1] = right[0];
        for j in 0..=degree - level {
            right[j] = 0.5 * (right[j] + right[j + 1]);
        }
    }
    left[degree] = right[0];
    let middle = 0.5 * (low + high);
    divide(&left, degree, (low, middle), precision, halvings - 1, found);
    divide(&right, degree, (middle, high), precision, halvings - 1, found);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dip_between_the_ends_is_found() {
        // (t - 0.3)² - 1e-6, which is positive at both ends.
        let found = least(&[0.09 - 1e-6, -0.6, 1.0], 1.0, 1e-14);
        assert!((found.value + 1e-6).abs() < 1e-13 && (found.at - 0.3).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn degree_ten_keeps_its_least_value() {
        let mut coefficients = [0.0; MAX_DEGREE + 1];
        (coefficients[0], coefficients[1], coefficients[10]) = (0.0, -1.0, 1.0);
        let at = 0.1_f64.powf(1.0 / 9.0);
        let found = least(&coefficients, 1.0, 1e-13);
        assert!((found.value - (at.powi(10) - at)).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn positive_polynomial_is_detected_at_once() {
        assert!(least(&[1.0, -1.0, 0.5], 1.0, 1e-12).value > 0.0);
    }
}
