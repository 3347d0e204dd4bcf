//! Sliding and rolling on a table that is not level, as parabolas that are correct to first order in the slope.
//!
//! Friction is opposite to the motion and turns with it. While a ball decelerates from `v0` to `v` at the rate `a`, a transverse pull `p`
//! gives it the transverse velocity `p/a v ln(v0/v)`. This is less than `p t`: friction removes a part of it, and in the end all.

use glam::DVec2;

use super::Rolling;

/// Largest share of the speed that a band on a slope may span. Within such a band the trajectory deviates from a parabola by up to 1/5000
/// of `p v²/a²`, some tenths of a millimetre for the fastest rolls.
const MAX_BAND_SHARE: f64 = 0.2;

/// Largest accepted deviation of a last band to rest from a parabola, m.
const MAX_DEVIATION: f64 = 1e-5;

/// A stretch of constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Half the acceleration, m/s².
    pub half_acceleration: DVec2,
    /// Duration, s.
    pub duration: f64,
    /// Initial velocity of the next stretch, m/s; zero for rest. The transverse acceleration is not constant, so that the parabola itself
    /// ends with a slightly larger velocity.
    pub velocity: DVec2,
}

/// Returns the speed at the end of a band that starts at `speed` under the pull on a rolling ball, m/s; zero for rest.
fn end_on_slope(rolling: &Rolling, pull: DVec2, speed: f64) -> f64 {
    let (_, end) = rolling.band(speed);
    let is_wide = 0.04 * pull.length() * speed * speed > MAX_DEVIATION * rolling.least * rolling.least;
    if is_wide { end.max((1.0 - MAX_BAND_SHARE) * speed) } else { end }
}

/// Returns the next stretch of a ball that rolls with `velocity` on a table whose slope accelerates free bodies by `tilt`.
pub fn roll_on_slope(rolling: &Rolling, tilt: DVec2, velocity: DVec2) -> Stretch {
    // A rolling ball has five sevenths of the acceleration of a free body.
    let pull = 5.0 / 7.0 * tilt;
    let speed = velocity.length();
    let direction = velocity / speed;
    let end = end_on_slope(rolling, pull, speed);
    let deceleration = rolling.mean_deceleration(speed, end);
    let along = pull.dot(direction);
    let across = pull - along * direction;
    let (left, lost) = (end / speed, 1.0 - end / speed);
    // Mean shares of the transverse pull that friction leaves over the band: for the displacement and for the final velocity.
    let (for_way, for_speed) = if end > 0.0 {
        let fall = libm::log(left);
        (2.0 * (0.25 - 0.25 * left * left + 0.5 * left * left * fall) / (lost * lost), -left * fall / lost)
    } else {
        (0.5, 0.0)
    };
    let braked = deceleration - along;
    let duration = (speed - end) / braked;
    Stretch {
        half_acceleration: 0.5 * (for_way * across - braked * direction),
        duration,
        velocity: end * direction + (for_speed * duration) * across,
    }
}

/// Returns the stretch of a ball that slides with `velocity` and `slip` under the friction `sliding`, m/s², until it rolls.
pub fn slide_on_slope(sliding: f64, tilt: DVec2, velocity: DVec2, slip: DVec2) -> Stretch {
    let speed = slip.length();
    let direction = slip / speed;
    let along = tilt.dot(direction);
    let across = tilt - along * direction;
    // The slip decreases by 7/2 of the friction, less the slope's contribution.
    let duration = speed / (3.5 * sliding - along);
    Stretch {
        // Transverse to its slip, the ball moves 6/7 as far as the slope alone would take it and ends with 5/7 of that velocity. A parabola
        // can match only one of them: it matches the velocity, so that the velocity has no jump. The position error is 1-2 mm at the
        // steepest slope and 4 µm at a usual one.
        half_acceleration: 0.5 * (tilt - sliding * direction - 2.0 / 7.0 * across),
        duration,
        // Exact, whatever the direction of the friction is during the slide.
        velocity: velocity - 2.0 / 7.0 * slip + (5.0 / 7.0 * duration) * tilt,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIDING: f64 = 2.0;

    /// Integrates the exact equations for position, velocity and slip by the Runge-Kutta method until rest. Returns the trajectory as
    /// `(time, position)`. A slip of zero means rolling.
    fn integrated(rolling: &Rolling, tilt: DVec2, start: [DVec2; 3]) -> Vec<(f64, DVec2)> {
        let rates = |[_, velocity, slip]: [DVec2; 3]| {
            if slip == DVec2::ZERO {
                let braked = (rolling.least + rolling.growth * velocity.length()) * velocity.normalize_or_zero();
                [velocity, 5.0 / 7.0 * tilt - braked, DVec2::ZERO]
            } else {
                let friction = -SLIDING * slip.normalize();
                [velocity, friction + tilt, 3.5 * friction + tilt]
            }
        };
        let mut state = start;
        let mut way = vec![(0.0, state[0])];
        loop {
            let [_, velocity, slip] = state;
            let (speed, rate) =
                if slip == DVec2::ZERO { (velocity.length(), rolling.least) } else { (slip.length(), 3.5 * SLIDING) };
            if slip == DVec2::ZERO && speed < 2e-6 {
                return way;
            }
            // Shorter steps towards the end, where the directions turn ever faster.
            let step = (0.2 * speed / rate).min(1e-4);
            let moved = |rates: [DVec2; 3], time: f64| std::array::from_fn(|i| state[i] + time * rates[i]);
            let first = rates(state);
            let second = rates(moved(first, 0.5 * step));
            let third = rates(moved(second, 0.5 * step));
            let fourth = rates(moved(third, step));
            let mean = std::array::from_fn(|i| (first[i] + 2.0 * second[i] + 2.0 * third[i] + fourth[i]) / 6.0);
            state = moved(mean, step);
            if state[2].length() < 1e-9 {
                state[2] = DVec2::ZERO;
            }
            way.push((way[way.len() - 1].0 + step, state[0]));
        }
    }

    /// The same trajectory as a chain of stretches: start time, position, velocity and half the acceleration of each, then the end.
    fn chained(rolling: &Rolling, tilt: DVec2, [place, velocity, slip]: [DVec2; 3]) -> Vec<(f64, DVec2, DVec2, DVec2)> {
        let mut stretch = slide_on_slope(SLIDING, tilt, velocity, slip);
        if slip == DVec2::ZERO {
            stretch = roll_on_slope(rolling, tilt, velocity);
        }
        let mut chain = vec![(0.0, place, velocity, stretch.half_acceleration)];
        loop {
            let (start, place, velocity, half) = chain[chain.len() - 1];
            let time = stretch.duration;
            let end = place + time * (velocity + time * half);
            if stretch.velocity == DVec2::ZERO {
                chain.push((start + time, end, DVec2::ZERO, DVec2::ZERO));
                return chain;
            }
            let velocity = stretch.velocity;
            stretch = roll_on_slope(rolling, tilt, velocity);
            chain.push((start + time, end, velocity, stretch.half_acceleration));
        }
    }

    /// Largest distance between the chain and the exact trajectory: at the end, and along the way, m.
    fn off(rolling: &Rolling, tilt: DVec2, start: [DVec2; 3]) -> [f64; 2] {
        let (exact, chain) = (integrated(rolling, tilt, start), chained(rolling, tilt, start));
        let at = |time: f64| {
            let &(start, place, velocity, half) = chain.iter().rfind(|stretch| stretch.0 <= time).unwrap();
            place + (time - start) * (velocity + (time - start) * half)
        };
        let on_the_way = exact.iter().step_by(7).map(|&(time, place)| at(time).distance(place)).fold(0.0, f64::max);
        [chain[chain.len() - 1].1.distance(exact[exact.len() - 1].1), on_the_way]
    }

    const SPEEDS: [f64; 4] = [0.05, 0.3, 1.0, 2.0];

    /// Compares trajectories on slopes in eight directions with integrated ones. For a speed, `most` returns the largest accepted error at
    /// the end and along the way, m; `slip` is that of a ball at 1 m/s.
    fn keeps_to_the_integrated_course(
        rolling: Rolling,
        tilt: f64,
        speeds: &[f64],
        slip: DVec2,
        most: impl Fn(f64) -> [f64; 2],
    ) {
        for angle in 0..8 {
            let tilt = tilt * DVec2::from_angle(0.4 * f64::from(angle));
            for &speed in speeds {
                let found = off(&rolling, tilt, [DVec2::ZERO, DVec2::new(speed, 0.0), speed * slip]);
                let most = most(speed);
                assert!(found[0] < most[0] && found[1] < most[1], "{speed}, {angle}: {found:?} of {most:?}");
            }
        }
    }

    #[test]
    fn course_on_a_slope_matches_integration() {
        for slip in [DVec2::ZERO, DVec2::new(0.5, -1.2)] {
            // Such a slope moves these balls by up to 0.3 m. Measured errors: 2.2e-4 m at rest and 2.5e-4 m along the way.
            keeps_to_the_integrated_course(Rolling { least: 0.05, growth: 0.0 }, 1e-3, &SPEEDS, slip, |_| [3e-4; 2]);
        }
    }

    #[test]
    fn course_with_growing_resistance_is_accurate_to_one_thousandth() {
        let rolling = Rolling { least: 0.036, growth: 0.0155 };
        keeps_to_the_integrated_course(rolling, 1e-3, &SPEEDS[..3], DVec2::ZERO, |speed| {
            // The bands alone cause an error of a thousandth of the length.
            [1.05e-3, 1.5e-3].map(|share| share * speed * speed / (2.0 * 0.036))
        });
    }

    #[test]
    fn course_on_the_steepest_slope_is_accurate_to_two_thousandths() {
        for (least, growth) in [(0.036, 0.0155), (0.07, 0.0)] {
            let (rolling, steepest) = (Rolling { least, growth }, 0.2 * 1.4 * least);
            keeps_to_the_integrated_course(rolling, steepest, &SPEEDS, DVec2::ZERO, |speed| {
                [2e-3 * speed * speed / (2.0 * (least + 0.65 * growth * speed)); 2]
            });
        }
    }

    #[test]
    fn slope_along_the_path_only_changes_the_deceleration() {
        let rolling = Rolling { least: 0.05, growth: 0.0 };
        let chain = chained(&rolling, DVec2::new(7e-3, 0.0), [DVec2::ZERO, DVec2::X, DVec2::ZERO]);
        let end = chain[chain.len() - 1];
        assert!((end.1.x - 1.0 / (2.0 * 0.045)).abs() < 1e-12 && end.1.y == 0.0, "{end:?}");
        assert!((end.0 - 1.0 / 0.045).abs() < 1e-12);
    }
}
