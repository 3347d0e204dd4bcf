//! Rolling resistance that grows with speed, `a = c0 + c1 v`, in bands of constant deceleration.
//!
//! Within a band the course stays a parabola. A band's deceleration stands between the one that keeps the time it takes
//! and the one that keeps its length, and a band ends early enough that a roll from any speed to rest is right in both to
//! five thousandths: far less than what is known of `c0` and `c1`, and every band costs as much as an impact.

use super::rolling_deceleration;
use crate::table::Table;

/// One over a band's share of its first speed `v` is this and this times `c1 v / a`: the relative error of a whole roll's
/// length and of its time is then five thousandths at most.
const SHARE: [f64; 2] = [1.0, 4.3];

/// The last band begins where `c1 v` is this share of the least deceleration.
const LAST: f64 = 0.059;

/// The law of a rolling ball's deceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// Deceleration of a ball about to stop, `5/7 mu_r g` (thesis equation 5), m/s².
    pub least: f64,
    /// Growth with speed, 1/s; zero for the thesis' law, whose only band reaches from any speed to rest.
    pub growth: f64,
}

impl Rolling {
    /// The law on `table`.
    pub fn of(table: &Table) -> Self {
        Self { least: rolling_deceleration(table), growth: table.rolling_growth }
    }

    /// Deceleration for a roll that begins with `speed`, m/s², and the speed at which it changes, zero for rest.
    #[inline]
    pub fn band(&self, speed: f64) -> (f64, f64) {
        let Self { least, growth } = *self;
        if growth == 0.0 {
            return (least, 0.0);
        }
        // Bands that each take the share k of their first speed v make a roll too long, at the right time, by
        // x/6 k²/(3 - 3k + k²) of its length, x = c1 v / a. Half of that is moved over to the time. This k keeps it in bounds.
        let end = if self.is_last(speed) {
            0.0
        } else {
            let fast = least + growth * speed;
            speed - speed * fast / (SHARE[0] * fast + SHARE[1] * growth * speed)
        };
        (self.between(speed, end), end)
    }

    /// Deceleration for a roll that begins with `speed`, m/s², also with none.
    pub fn deceleration(&self, speed: f64) -> f64 {
        if speed > 0.0 { self.band(speed).0 } else { self.least }
    }

    /// The constant deceleration that stands for the law between two speeds, m/s².
    #[inline]
    pub fn between(&self, speed: f64, end: f64) -> f64 {
        let Self { least, growth } = *self;
        let (width, middle) = (speed - end, 0.5 * (speed + end));
        let mean = least + growth * middle;
        // The mean deceleration over the time, to second order in the width, and half of what would keep the length.
        let second = growth * width * width;
        mean + second * (1.0 / (24.0 * middle) - growth / (12.0 * mean))
    }

    /// Whether a roll that begins with `speed` comes to rest in its first band.
    #[inline]
    pub fn is_last(&self, speed: f64) -> bool {
        self.growth * speed <= LAST * self.least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Length and time of a roll to rest: exactly, and band by band.
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
    fn a_roll_from_any_speed_is_right_to_five_thousandths_in_few_bands() {
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
