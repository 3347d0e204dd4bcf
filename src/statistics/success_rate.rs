//! Success rates with confidence intervals.

use serde::Serialize;

/// A success rate with the 95 % confidence interval of the true rate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SuccessRate {
    /// Number of trials: layouts for a policy, or attempts of a player at one shot.
    #[serde(rename = "layouts")]
    pub trials: usize,
    /// Number of successful trials.
    pub successes: usize,
    /// Share of successful trials.
    pub rate: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// Standard errors on either side of a 95 % confidence interval.
const Z: f64 = 1.959_963_984_540_054;

impl SuccessRate {
    /// Computes the rate with Wilson's score interval: unlike the textbook interval, it stays within 0 to 1 and remains valid near both
    /// ends.
    pub fn new(successes: usize, trials: usize) -> Self {
        Self::of_clustered(successes, trials, 1.0)
    }

    /// Like [`SuccessRate::new`], for trials that depend on each other, of which `per_independent` are worth one independent trial (Kish's
    /// design effect).
    pub fn of_clustered(successes: usize, trials: usize, per_independent: f64) -> Self {
        if trials == 0 {
            return Self { trials, successes, rate: 0.0, low: 0.0, high: 1.0 };
        }
        let (n, rate) = (trials as f64 / per_independent, successes as f64 / trials as f64);
        let centre = rate + Z * Z / (2.0 * n);
        let spread = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        let bound = |value: f64| (value / scale).clamp(0.0, 1.0);
        // Exact at the ends, where rounding would give almost 0 or 1.
        let low = if successes == 0 { 0.0 } else { bound(centre - spread) };
        let high = if successes == trials { 1.0 } else { bound(centre + spread) };
        Self { trials, successes, rate, low, high }
    }

    /// Whether the difference from a lower rate is significant: the 95 % interval of the difference for independent trials, combined
    /// from the two score intervals, is above zero (Newcombe 1998b, method 10). A rate of 0 or 1 is thus uncertain too.
    pub fn is_significantly_above(&self, lower: &Self) -> bool {
        self.rate - lower.rate > (self.rate - self.low).hypot(lower.high - lower.rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_intervals_match_published_values_within_zero_to_one() {
        // Newcombe 1998, table I: 81 of 263 gives 0.2553 to 0.3662, 0 of 20 gives 0 to 0.1611.
        let rate = SuccessRate::new(81, 263);
        assert!((rate.low - 0.2553).abs() < 5e-5 && (rate.high - 0.3662).abs() < 5e-5, "{rate:?}");
        let none = SuccessRate::new(0, 20);
        assert!(none.low == 0.0 && (none.high - 0.1611).abs() < 5e-5, "{none:?}");
        // 50 and 56 % of 1000 differ although their intervals overlap; 50 and 54 % do not.
        let [half, more, most] = [500, 540, 560].map(|made| SuccessRate::new(made, 1000));
        assert!(most.is_significantly_above(&half) && most.low < half.high && !more.is_significantly_above(&half));
        // Four trials that always succeed or fail together are one.
        let (clustered, alone) = (SuccessRate::of_clustered(100, 400, 4.0), SuccessRate::new(25, 100));
        assert_eq!([clustered.rate, clustered.low, clustered.high], [alone.rate, alone.low, alone.high]);
        // Few trials prove little, even if all succeed.
        let [few, many] = [(13, 13), (130, 130)].map(|(made, tried)| SuccessRate::new(made, tried));
        let nine_tenths = SuccessRate::new(900, 1000);
        assert!(!few.is_significantly_above(&nine_tenths) && many.is_significantly_above(&nine_tenths));
        assert_eq!((SuccessRate::new(0, 0).low, SuccessRate::new(0, 0).high), (0.0, 1.0));
    }
}
