//! What predictions have in common: when something counts as touching, and collisions of balls in a resting contact.
//!
//! It is the duty of this file, `cushions` and `ball_ball` that nothing is missed and nothing is found twice: a ball that
//! already touches what it has just hit meets it again only when it really comes back.

use glam::DVec2;

use super::{
    Constants, Rail, Segment,
    roots::{MAX_DEGREE, first_crossing, horner},
    tolerance::Tolerance,
};

/// What lies ahead of a ball, or of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ahead {
    /// They will not meet within the time asked for.
    Nothing,
    /// They meet after this many seconds.
    Meeting(f64),
    /// They touch, do not move against each other, and are pressed together: a resting contact.
    Pressed,
}

/// The lesser of two numbers; `f64::min` would spend time on what is not a number.
#[inline(always)]
pub fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The first cushion that a ball on a curved course, a polynomial of degree five, meets within `horizon` seconds of the
/// segment's start. The cushions that hold it, as `holds` tells, are part of that course.
pub fn curved_cushion_ahead(
    constants: &Constants,
    segment: &Segment,
    horizon: f64,
    holds: impl Fn(Rail) -> bool,
) -> (Ahead, Rail) {
    let tolerance = &constants.tolerance;
    let mut nearest = (Ahead::Nothing, Rail::Left);
    let mut earliest = horizon;
    let course = segment.coefficients();
    for rail in Rail::ALL.into_iter().filter(|&rail| !holds(rail)) {
        let inward = rail.normal();
        let mut gap = course.map(|c| c.dot(inward));
        gap[0] += inward.abs().dot(constants.reach);
        if gap[0] > tolerance.touching + travel(&gap.map(f64::abs), earliest) {
            continue;
        }
        if let Ahead::Meeting(time) = polynomial_closes(tolerance, &gap, gap[0] <= tolerance.touching, 1.0, earliest) {
            earliest = time;
            nearest = (Ahead::Meeting(time), rail);
        }
    }
    nearest
}

/// Two balls of which one at least is in a resting contact. Whether they rest against each other is known to the
/// contact itself, which then does not ask.
pub fn curved_balls_ahead(constants: &Constants, first: &Segment, second: &Segment, now: f64, horizon: f64) -> Ahead {
    let (c1, c2) = (shifted(first, now), shifted(second, now));
    let mut d = [DVec2::ZERO; 6];
    for power in 0..6 {
        d[power] = c1[power] - c2[power];
    }
    let diameter = 2.0 * constants.radius;
    // Most pairs are too far apart to meet in so short a time.
    let tolerance = &constants.tolerance;
    if d[0].length() - diameter > tolerance.touching + travel(&d.map(DVec2::length), horizon) {
        return Ahead::Nothing;
    }
    let mut gap = [0.0; MAX_DEGREE + 1];
    for i in 0..6 {
        for j in 0..6 {
            gap[i + j] += d[i].dot(d[j]);
        }
    }
    gap[0] -= diameter * diameter;
    let touching = gap[0] <= 2.0 * diameter * tolerance.touching;
    polynomial_closes(tolerance, &gap, touching, 2.0 * diameter, horizon)
}

/// How far a course with coefficients of these sizes can lead within `time`.
pub fn travel(sizes: &[f64; 6], time: f64) -> f64 {
    sizes[1..].iter().rev().fold(0.0, |sum, size| (sum + size) * time)
}

/// When the gap with these coefficients, in units of `scale` times metres, closes. That of balls which touch is divided by
/// the time, whose root at zero is the contact that is already known; where they stay together for now, they meet again
/// when the gap has closed by more than counts as touching.
pub fn polynomial_closes(tolerance: &Tolerance, gap: &[f64], touching: bool, scale: f64, horizon: f64) -> Ahead {
    let mut work = [0.0; MAX_DEGREE + 1];
    let mut count = gap.len();
    work[..count].copy_from_slice(gap);
    if touching {
        let opening = gap[1] / scale;
        if opening < -tolerance.opening {
            return Ahead::Meeting(0.0);
        }
        if opening > tolerance.opening {
            work.copy_within(1.., 0);
            count -= 1;
        } else {
            work[0] = scale * tolerance.touching;
        }
    }
    let work = &work[..count];
    let mut slope = [0.0; MAX_DEGREE];
    for power in 1..count {
        slope[power - 1] = power as f64 * work[power];
    }
    first_crossing(|t| horner(work, t), &slope[..count - 1], horizon).map_or(Ahead::Nothing, Ahead::Meeting)
}

/// A segment's coefficients about the time `now`.
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
    use super::{super::segment::Course, *};
    use crate::physics::Motion;

    #[test]
    fn shifting_a_course_in_time_keeps_its_places() {
        let curve = super::super::segment::Curve {
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
