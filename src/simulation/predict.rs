//! Common parts of all predictions: contact tolerances, and collisions of balls in a resting contact.
//!
//! It is the duty of this file, `cushions` and `ball_ball` that no impact is missed and none is found twice: a ball that touches what it
//! has just hit hits it again only if it really comes back.

use glam::DVec2;

use super::{
    Constants, Rail, Segment,
    roots::{MAX_DEGREE, derivative, first_crossing, horner},
    tolerance::Tolerance,
};

/// Predicted event of a ball, or of two balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prediction {
    /// No impact within the given time.
    Nothing,
    /// An impact after this many seconds.
    Impact(f64),
    /// They touch without relative normal velocity and are pressed together: a resting contact.
    Pressed,
}

impl From<Option<f64>> for Prediction {
    fn from(impact: Option<f64>) -> Self {
        impact.map_or(Self::Nothing, Self::Impact)
    }
}

/// Returns the lesser of two numbers; `f64::min` would spend time on NaN.
#[inline(always)]
pub fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns the first cushion impact of a ball on a curved trajectory, a polynomial of degree five, within `horizon` seconds of the
/// segment's start. Cushions for which `holds` returns true are part of the resting contact and are skipped.
pub fn next_cushion_impact_on_curve(
    constants: &Constants,
    segment: &Segment,
    horizon: f64,
    holds: impl Fn(Rail) -> bool,
) -> (Prediction, Rail) {
    let tolerance = &constants.tolerance;
    let mut nearest = (Prediction::Nothing, Rail::Left);
    let mut earliest = horizon;
    let course = segment.coefficients();
    for rail in Rail::ALL.into_iter().filter(|&rail| !holds(rail)) {
        let inward = rail.normal();
        let mut gap = course.map(|c| c.dot(inward));
        gap[0] += inward.abs().dot(constants.reach);
        if gap[0] > tolerance.touching + travel(&gap.map(f64::abs), earliest) {
            continue;
        }
        if let Some(time) = polynomial_closes(tolerance, &gap, 1.0, earliest) {
            earliest = time;
            nearest = (Prediction::Impact(time), rail);
        }
    }
    nearest
}

/// Returns the next collision of two balls, at least one of which is in a resting contact, or that they press on each other, if they
/// `may_rest`. Pairs that rest against each other are handled by the contact itself and are not passed to this function.
pub fn next_collision_on_curve(
    constants: &Constants,
    first: &Segment,
    second: &Segment,
    now: f64,
    horizon: f64,
    may_rest: bool,
) -> Prediction {
    let (c1, c2) = (shifted(first, now), shifted(second, now));
    let d: [DVec2; 6] = std::array::from_fn(|power| c1[power] - c2[power]);
    let diameter = constants.diameter;
    // Most pairs are too far apart to collide in such a short time.
    let tolerance = &constants.tolerance;
    if d[0].length() - diameter > tolerance.touching + travel(&d.map(DVec2::length), horizon) {
        return Prediction::Nothing;
    }
    let gap = squared_gap(&d, DVec2::dot, diameter);
    let stays = gap[0] <= 2.0 * diameter * tolerance.touching && gap[1].abs() <= 2.0 * diameter * tolerance.opening;
    if may_rest && stays && gap[2] < -diameter * tolerance.pressing {
        return Prediction::Pressed;
    }
    polynomial_closes(tolerance, &gap, 2.0 * diameter, horizon).into()
}

/// Returns the coefficients of the squared distance of two balls less that of touching ones, for a distance vector `d[0] + t d[1] + …`.
pub fn squared_gap<V: Copy>(d: &[V; 6], dot: impl Fn(V, V) -> f64, diameter: f64) -> [f64; MAX_DEGREE + 1] {
    let mut gap = [0.0; MAX_DEGREE + 1];
    for i in 0..6 {
        for j in 0..6 {
            gap[i + j] += dot(d[i], d[j]);
        }
    }
    gap[0] -= diameter * diameter;
    gap
}

/// Returns an upper bound of the distance along a trajectory with coefficients of these magnitudes within `time`.
pub fn travel(sizes: &[f64; 6], time: f64) -> f64 {
    sizes[1..].iter().rev().fold(0.0, |sum, size| (sum + size) * time)
}

/// Returns when the gap with these coefficients, in units of `scale` times metres, closes within `horizon` seconds. The gap of touching
/// balls is divided by the time, because its root at zero is the present contact. If they stay together for now, they collide when the gap
/// has closed by more than the touching tolerance, or by more than the coupled gap if it closes too slowly for an impact.
pub fn polynomial_closes(tolerance: &Tolerance, gap: &[f64], scale: f64, horizon: f64) -> Option<f64> {
    let mut work = [0.0; MAX_DEGREE + 1];
    let mut count = gap.len();
    work[..count].copy_from_slice(gap);
    let mut stays = false;
    if gap[0] <= scale * tolerance.touching {
        let opening = gap[1] / scale;
        if opening < -tolerance.opening {
            return Some(0.0);
        }
        if opening > tolerance.opening {
            work.copy_within(1.., 0);
            count -= 1;
        } else {
            (work[0], stays) = (scale * tolerance.touching, true);
        }
    }
    let work = &mut work[..count];
    let mut slope = [0.0; MAX_DEGREE];
    let slope = derivative(work, &mut slope);
    let closes = |work: &[f64]| first_crossing(|t| horner(work, t), slope, horizon, f64::EPSILON * work[0].abs());
    let mut time = closes(work);
    if stays && time.is_some_and(|time| horner(slope, time) > -scale * tolerance.opening) {
        work[0] = scale * tolerance.coupled_gap;
        time = closes(work);
    }
    time
}

/// Returns a segment's coefficients about the time `now`.
pub fn shifted(segment: &Segment, now: f64) -> [DVec2; 6] {
    let mut c = segment.coefficients();
    let shift = now - segment.start;
    if shift != 0.0 {
        // Repeated synthetic division.
        for low in 0..5 {
            for power in (low..5).rev() {
                let above = c[power + 1];
                c[power] += shift * above;
            }
        }
    }
    c
}

#[cfg(test)]
mod tests {
    use super::{
        super::segment::{Course, Curve},
        *,
    };
    use crate::{physics::Motion, table::Table};

    /// Two touching balls move at the same speed, the second one ahead; it rolls out while the first one, in a resting contact, does not.
    #[test]
    fn balls_that_begin_to_press_without_an_impact_rest_together() {
        let constants = Constants::of(&Table::preset("thesis").unwrap());
        let curve = Curve { position: [DVec2::ZERO; 3], spin: [glam::DVec3::ZERO; 3] };
        let velocity = DVec2::new(0.1, 0.0);
        let pushes = Segment {
            velocity,
            motion: Motion::Resting,
            course: Some(Box::new(Course::Contact(curve))),
            ..Segment::at_rest(DVec2::ZERO)
        };
        let ahead = |deceleration: f64| Segment {
            velocity,
            half_acceleration: DVec2::new(-0.5 * deceleration, 0.0),
            motion: Motion::Rolling,
            ..Segment::at_rest(DVec2::new(constants.diameter, 0.0))
        };
        let next = |deceleration, may_rest| {
            next_collision_on_curve(&constants, &pushes, &ahead(deceleration), 0.0, 1.0, may_rest)
        };
        assert_eq!(next(0.1, true), Prediction::Pressed);
        // Nothing holds them: they collide as soon as they overlap.
        assert!(matches!(next(0.1, false), Prediction::Impact(time) if time < 1e-6));
        assert_eq!(next(-0.1, true), Prediction::Nothing);
    }

    /// At 1e-14 m/s² a ball needs seconds to close a gap of the touching tolerance, and is then slower than any impact.
    #[test]
    fn gap_that_hardly_closes_may_become_a_coupled_gap() {
        let tolerance = Tolerance::of(&Table::preset("thesis").unwrap());
        let gap_at_impact = |acceleration: f64| {
            let time = polynomial_closes(&tolerance, &[0.0, 0.0, -0.5 * acceleration], 1.0, 1e3).expect("an impact");
            0.5 * acceleration * time * time
        };
        assert!((gap_at_impact(1e-14) / tolerance.coupled_gap - 1.0).abs() < 1e-9);
        assert!((gap_at_impact(1.0) / tolerance.touching - 1.0).abs() < 1e-9);
    }

    #[test]
    fn shifting_a_course_in_time_keeps_its_positions() {
        let curve = Curve {
            position: [DVec2::new(0.3, -0.2), DVec2::new(-0.1, 0.4), DVec2::new(0.05, 0.01)],
            spin: [glam::DVec3::ZERO; 3],
        };
        let segment = Segment {
            start: 1.0,
            velocity: DVec2::new(1.0, 2.0),
            half_acceleration: DVec2::new(-0.5, 0.1),
            motion: Motion::Resting,
            course: Some(Box::new(Course::Contact(curve))),
            ..Segment::at_rest(DVec2::new(0.1, 0.2))
        };
        let c = shifted(&segment, 1.25);
        let at = c.iter().rev().fold(DVec2::ZERO, |sum, c| sum * 0.5 + *c);
        assert!(at.distance(segment.position_after(0.75)) < 1e-15);
    }
}
