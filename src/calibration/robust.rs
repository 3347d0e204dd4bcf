//! The error model of marks that may be misread: a mixture of good marks with their standard error, and a few with a much larger one.

/// Expected share of misread marks: one in fifty.
const SHARE: f64 = 0.02;

/// Factor on the standard error of misread marks.
const WIDTH: f64 = 10.0;

/// Residual, in standard errors, of a mark to which the ball never gets; larger residuals are clamped to it.
pub const UNREACHED_RESIDUAL: f64 = 30.0;

/// Returns the densities of good and of misread marks at a residual `off`, in standard errors, up to a common factor.
fn densities(off: f64) -> [f64; 2] {
    [(1.0 - SHARE) * (-0.5 * off * off).exp(), SHARE / WIDTH * (-0.5 * (off / WIDTH).powi(2)).exp()]
}

/// Returns the number whose square is minus twice the log density of the mixture. For a small residual this is `off` itself; for a large
/// one it grows much more slowly.
pub fn robust_residual(off: f64) -> f64 {
    let off = off.clamp(-UNREACHED_RESIDUAL, UNREACHED_RESIDUAL);
    let [good, bad] = densities(off);
    let [best, worst] = densities(0.0);
    (-2.0 * ((good + bad) / (best + worst)).ln()).max(0.0).sqrt().copysign(off)
}

/// Returns the probability that a mark with the residual `off`, in standard errors, is misread.
pub fn misread_probability(off: f64) -> f64 {
    let [good, bad] = densities(off.clamp(-UNREACHED_RESIDUAL, UNREACHED_RESIDUAL));
    bad / (good + bad)
}

/// Weight of a mark to which no stroke gets: zero, except for what keeps matrices regular.
const MIN_WEIGHT: f64 = 1e-9;

/// Returns the weight of a mark with the residual `off`, relative to a certainly good one. From [`UNREACHED_RESIDUAL`] on it is practically
/// zero, because [`robust_residual`] is flat there: a larger residual does not pull the constants further.
pub fn weight(off: f64) -> f64 {
    if off.abs() >= UNREACHED_RESIDUAL {
        return MIN_WEIGHT;
    }
    let misread = misread_probability(off);
    1.0 - misread + misread / (WIDTH * WIDTH)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_marks_count_fully_and_far_ones_little() {
        assert!((robust_residual(1.0) - 1.0).abs() < 5e-3 && (robust_residual(-2.0) + 2.0).abs() < 3e-2);
        assert!(
            robust_residual(10.0) < 4.0
                && robust_residual(30.0) > robust_residual(10.0)
                && robust_residual(1e9) == robust_residual(UNREACHED_RESIDUAL)
        );
        assert!(misread_probability(2.0) < 0.05 && misread_probability(4.5) > 0.9);
        assert!(weight(1.0) > 0.99 && weight(8.0) < 0.02 && weight(-1e3) < 1e-6);
    }
}
