//! Marks that may be misread: a mixture of those that are as good as they say, and a few that are far off.

/// The share of marks that are expected to be misread: one in fifty.
const SHARE: f64 = 0.02;

/// How many times as far off as the others those are.
const WIDTH: f64 = 10.0;

/// What counts for a mark that a stroke does not even come to, in deviations.
pub const NEVER: f64 = 30.0;

/// The densities of good and of misread marks at so many deviations, up to a common factor.
fn densities(off: f64) -> [f64; 2] {
    [(1.0 - SHARE) * (-0.5 * off * off).exp(), SHARE / WIDTH * (-0.5 * (off / WIDTH).powi(2)).exp()]
}

/// The number whose square is minus twice the logarithm of the mixture: that of a good mark is `off` itself, and far off
/// it grows ever more slowly.
pub fn soften(off: f64) -> f64 {
    let off = off.clamp(-NEVER, NEVER);
    let [good, bad] = densities(off);
    let [best, worst] = densities(0.0);
    (-2.0 * ((good + bad) / (best + worst)).ln()).max(0.0).sqrt().copysign(off)
}

/// How likely a mark that is off by so many deviations is misread.
pub fn misread(off: f64) -> f64 {
    let [good, bad] = densities(off.clamp(-NEVER, NEVER));
    bad / (good + bad)
}

/// How much a mark counts that no stroke comes near: nothing, up to what keeps matrices regular.
const NOTHING: f64 = 1e-9;

/// How much such a mark counts, against one that is certainly good. From [`NEVER`] on it counts nothing, for [`soften`] is flat there:
/// however far off it is, it draws the constants no farther.
pub fn weight(off: f64) -> f64 {
    if off.abs() >= NEVER {
        return NOTHING;
    }
    let misread = misread(off);
    1.0 - misread + misread / (WIDTH * WIDTH)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_marks_count_fully_and_far_ones_little() {
        assert!((soften(1.0) - 1.0).abs() < 5e-3 && (soften(-2.0) + 2.0).abs() < 3e-2);
        assert!(soften(10.0) < 4.0 && soften(30.0) > soften(10.0) && soften(1e9) == soften(NEVER));
        assert!(misread(2.0) < 0.05 && misread(4.5) > 0.9);
        assert!(weight(1.0) > 0.99 && weight(8.0) < 0.02 && weight(-1e3) < 1e-6);
    }
}
