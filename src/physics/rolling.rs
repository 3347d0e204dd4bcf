//! Rolling resistance that grows with speed, `a = c0 + c1 v`, approximated by bands of constant deceleration.
//!
//! Within a band the trajectory is a parabola. The deceleration of a band lies between the value that gives the exact duration and the one
//! that gives the exact length. The bands are narrow enough that length and time of a roll from any speed to rest are correct to 0.5 %.
//! This error is far below the uncertainty of `c0` and `c1`, and every additional band costs as much as an impact.

use crate::table::Table;

/// Coefficients of the band width: a band that starts at the speed `v` spans the share `1 / (1 + 4.3 x)` of it, with `x = c1 v / a`. The
/// relative errors of a whole roll's length and time are then at most 0.005.
const BAND_WIDTH: [f64; 2] = [1.0, 4.3];

/// In the last band, `c1 v` is at most this share of the least deceleration.
const LAST_BAND: f64 = 0.059;

/// Deceleration law of a rolling ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// Deceleration of a ball about to stop, `5/7 mu_r g` (thesis equation 5), m/s².
    pub least: f64,
    /// Growth with speed, 1/s; zero for the thesis' law, which has a single band from any speed to rest.
    pub growth: f64,
}

impl Rolling {
    /// Returns the law of `table`.
    pub fn of(table: &Table) -> Self {
        Self { least: 5.0 / 7.0 * table.rolling_friction * table.gravity, growth: table.rolling_growth }
    }

    /// Returns the deceleration of the band that starts at `speed`, m/s², and the speed at its end, m/s (zero for rest).
    #[inline]
    pub fn band(&self, speed: f64) -> (f64, f64) {
        let Self { least, growth } = *self;
        if growth == 0.0 {
            return (least, 0.0);
        }
        // Bands that span the share k of their initial speed v and have the exact duration make a roll too long by x/6 k²/(3 - 3k + k²) of
        // its length, x = c1 v / a. Half of this error is shifted to the time. This k keeps both errors within their bound.
        let end = if self.is_last(speed) {
            0.0
        } else {
            let fast = least + growth * speed;
            speed - speed * fast / (BAND_WIDTH[0] * fast + BAND_WIDTH[1] * growth * speed)
        };
        (self.mean_deceleration(speed, end), end)
    }

    /// Returns the deceleration of a roll that starts at `speed`, m/s²; zero speed is accepted, too.
    pub fn deceleration(&self, speed: f64) -> f64 {
        if speed > 0.0 { self.band(speed).0 } else { self.least }
    }

    /// Returns the constant deceleration that approximates the law between two speeds, m/s².
    #[inline]
    pub fn mean_deceleration(&self, speed: f64, end: f64) -> f64 {
        let Self { least, growth } = *self;
        let (width, middle) = (speed - end, 0.5 * (speed + end));
        let mean = least + growth * middle;
        // Mean deceleration over time, to second order in the width, with half the correction that would give the exact length.
        let second = growth * width * width;
        mean + second * (1.0 / (24.0 * middle) - growth / (12.0 * mean))
    }

    /// Whether a roll that starts at `speed` comes to rest in its first band.
    #[inline]
    pub fn is_last(&self, speed: f64) -> bool {
        self.growth * speed <= LAST_BAND * self.least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Length and time of a roll to rest: exact values, and sums over the bands.
    fn roll(rolling: &Rolling, speed: f64) -> ([f64; 2], [f64; 2], usize) {
        let Rolling { least, growth } = *rolling;
        let time = libm::log(1.0 + growth * speed / least) / growth;
        let exact = [(speed - least * time) / growth, time];
        let (mut bands, mut v, mut count) = ([0.0; 2], speed, 0);
        while v > 0.0 {
            let (deceleration, end) = rolling.band(v);
            let lasts = (v - end) / deceleration;
            bands[0] += 0.5 * (v + end) * lasts;
            bands[1] += lasts;
            (v, count) = (end, count + 1);
        }
        (exact, bands, count)
    }

    #[test]
    fn few_bands_give_any_roll_to_half_a_percent() {
        for (least, growth) in [(0.040, 0.016), (0.05, 0.03), (0.07, 0.002)] {
            for step in 1..200 {
                let speed = 0.04 * f64::from(step);
                let rolling = Rolling { least, growth };
                let (exact, bands, count) = roll(&rolling, speed);
                for (exact, bands) in exact.into_iter().zip(bands) {
                    assert!((bands / exact - 1.0).abs() < 5e-3, "{least} + {growth} v from {speed}: {bands}, {exact}");
                }
                assert!(count <= 12, "{count} bands from {speed} m/s");
            }
        }
    }

    #[test]
    fn without_growth_there_is_one_band() {
        assert_eq!(Rolling { least: 0.07, growth: 0.0 }.band(3.0), (0.07, 0.0));
    }
}
