//! When a ball will meet a cushion or another ball, if nothing else happens first.
//!
//! It is the duty of this file that nothing is missed and nothing is found twice: a ball that already touches what it
//! has just hit meets it again only when it really comes back.

use glam::DVec2;

use super::{
    Constants, Rail, Segment,
    roots::{MAX_DEGREE, first_crossing, horner},
    savings::Savings,
};
use crate::physics::Motion;

/// Gaps below this are contact, m. Coordinates of up to a few metres are rounded to 4e-16 m, so a gap is known to about
/// 1e-15 m; a real gap of 1e-14 m that is closed at once moves nothing that could be seen at 1e-9 m.
pub const TOUCHING: f64 = 1e-14;

/// Speeds along a contact's normal below this are none, m/s: in ten seconds they move a ball by less than 1e-10 m.
pub const RESTING_SPEED: f64 = 1e-11;

/// Accelerations along a contact's normal below this do not press, m/s²: rounding of g's size is 1e-15.
const PRESSING: f64 = 1e-13;

/// A gap that stays above this, m, is not closed by any rounding: courses within the table are rounded to 1e-14 m.
const SURELY_APART: f64 = 1e-10;

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

/// The first cushion that a free `segment` meets within `horizon` seconds of its start.
#[inline(always)]
pub fn cushion_ahead<S: Savings>(constants: &Constants, segment: &Segment, horizon: f64) -> (Ahead, Rail) {
    let (p, v, k) = (segment.position, segment.velocity, segment.half_acceleration);
    let reach = constants.reach;
    // The course lies within the triangle of these two points and its start.
    let bend = p + 0.5 * horizon * v;
    let end = p + horizon * (v + horizon * k);
    let across = axis_ahead::<S>(reach.x, p.x, v.x, k.x, (bend.x, end.x));
    let along = axis_ahead::<S>(reach.y, p.y, v.y, k.y, (bend.y, end.y));
    let x_rail = if across.upwards { Rail::Right } else { Rail::Left };
    let y_rail = if along.upwards { Rail::Top } else { Rail::Bottom };
    let (time, rail) = if along.time < across.time { (along.time, y_rail) } else { (across.time, x_rail) };
    if time < 0.0 {
        (Ahead::Pressed, rail)
    } else if time < horizon {
        (Ahead::Meeting(time), rail)
    } else {
        (Ahead::Nothing, rail)
    }
}

/// What a course meets on one axis of the table.
struct OnAxis {
    /// When, s; infinity for never, [`PRESSED`] for a resting contact.
    time: f64,
    /// Whether it is the cushion on the positive side.
    upwards: bool,
}

const PRESSED: f64 = -1.0;

/// The first of two opposite cushions, at `±reach`, that a ball meets whose coordinate is `p + v t + k t²`. The control
/// points bound the course.
#[inline(always)]
fn axis_ahead<S: Savings>(reach: f64, p: f64, v: f64, k: f64, (bend, end): (f64, f64)) -> OnAxis {
    let upwards = v > 0.0;
    let sign = if upwards { 1.0 } else { -1.0 };
    let (p, v, k, bend, end) = (sign * p, sign * v, sign * k, sign * bend, sign * end);
    let (highest, lowest) = if bend > end { (bend, end) } else { (end, bend) };
    if !S::CUSHIONS_IN_REACH || reach - highest < SURELY_APART || reach - p < SURELY_APART {
        let time = gap_closes(reach - p, v, k);
        if time < f64::INFINITY {
            // The other side would be met later.
            return OnAxis { time, upwards };
        }
    }
    if !S::CUSHIONS_IN_REACH || reach + lowest < SURELY_APART || reach + p < SURELY_APART {
        return OnAxis { time: gap_closes(reach + p, -v, -k), upwards: !upwards };
    }
    OnAxis { time: f64::INFINITY, upwards }
}

/// When `gap - speed t - half_acceleration t²` first falls to zero: infinity if never, [`PRESSED`] for a resting contact.
#[inline(always)]
fn gap_closes(gap: f64, speed: f64, half_acceleration: f64) -> f64 {
    if gap <= TOUCHING {
        return if speed > RESTING_SPEED {
            0.0
        } else if 2.0 * half_acceleration <= PRESSING {
            f64::INFINITY
        } else if speed >= -RESTING_SPEED {
            PRESSED
        } else {
            -speed / half_acceleration
        };
    }
    if speed <= 0.0 && half_acceleration <= 0.0 {
        return f64::INFINITY;
    }
    let discriminant = speed * speed + 4.0 * half_acceleration * gap;
    if discriminant < 0.0 {
        f64::INFINITY
    } else if speed > 0.0 {
        2.0 * gap / (speed + discriminant.sqrt())
    } else {
        // Without cancellation, since speed is not positive.
        (discriminant.sqrt() - speed) / (2.0 * half_acceleration)
    }
}

/// The same for a ball in a resting contact, whose course is a polynomial of degree five. The cushions that hold it, as
/// `holds` tells, are part of that course.
pub fn curved_cushion_ahead(
    constants: &Constants,
    segment: &Segment,
    horizon: f64,
    holds: impl Fn(Rail) -> bool,
) -> (Ahead, Rail) {
    let mut nearest = (Ahead::Nothing, Rail::Left);
    let mut earliest = horizon;
    let course = coefficients(segment);
    for rail in Rail::ALL.into_iter().filter(|&rail| !holds(rail)) {
        let inward = rail.normal();
        let mut gap = course.map(|c| c.dot(inward));
        gap[0] += inward.abs().dot(constants.reach);
        if gap[0] > TOUCHING + travel(&gap.map(f64::abs), earliest) {
            continue;
        }
        if let Ahead::Meeting(time) = polynomial_closes(&gap, gap[0] <= TOUCHING, 1.0, earliest) {
            earliest = time;
            nearest = (Ahead::Meeting(time), rail);
        }
    }
    nearest
}

fn coefficients(segment: &Segment) -> [DVec2; 6] {
    let [c3, c4, c5] = segment.curve.as_ref().map_or([DVec2::ZERO; 3], |curve| curve.position);
    [segment.position, segment.velocity, segment.half_acceleration, c3, c4, c5]
}

/// When two balls meet within `horizon` seconds of time `now`. If they `may_rest` against each other, [`Ahead::Pressed`]
/// says so; if that has been tried and nothing holds them, they meet again as soon as they overlap.
#[inline]
pub fn balls_ahead<S: Savings>(
    constants: &Constants,
    first: &Segment,
    second: &Segment,
    now: f64,
    horizon: f64,
    may_rest: bool,
) -> Ahead {
    if first.curve.is_some() || second.curve.is_some() {
        return curved_balls_ahead(constants, first, second, now, horizon);
    }
    let (t1, t2) = (now - first.start, now - second.start);
    let d = first.position_after(t1) - second.position_after(t2);
    let dv = first.velocity_after(t1) - second.velocity_after(t2);
    let dk = first.half_acceleration - second.half_acceleration;
    let diameter = 2.0 * constants.radius;
    if S::COURSES_APART && courses_apart(d, dv, dk, diameter, horizon) {
        return Ahead::Nothing;
    }
    let gap = d.length_squared() - diameter * diameter;
    if gap <= 2.0 * diameter * TOUCHING {
        return touching_balls_ahead(d, dv, dk, diameter, horizon, may_rest);
    }
    if matches!(
        (first.motion, second.motion),
        (Motion::Rolling, Motion::Stationary) | (Motion::Stationary, Motion::Rolling)
    ) {
        return straight_ahead(d, dv, dk, gap, diameter, horizon);
    }
    let c1 = 2.0 * d.dot(dv);
    let c2 = dv.length_squared() + 2.0 * d.dot(dk);
    let c3 = 2.0 * dv.dot(dk);
    let c4 = dk.length_squared();
    let derivative = [c1, 2.0 * c2, 3.0 * c3, 4.0 * c4];
    let value = |t: f64| (d + t * (dv + t * dk)).length_squared() - diameter * diameter;
    first_crossing(value, &derivative, horizon).map_or(Ahead::Nothing, Ahead::Meeting)
}

/// Whether a line separates the relative course `d + dv t + dk t²` from all places nearer than `diameter`, so that the
/// balls cannot meet within `horizon`. The course lies within the triangle of its control points; the lines that are
/// tried stand across the way to the other ball, and along the course.
#[inline(always)]
fn courses_apart(d: DVec2, dv: DVec2, dk: DVec2, diameter: f64, horizon: f64) -> bool {
    let bend = d + 0.5 * horizon * dv;
    let end = d + horizon * (dv + horizon * dk);
    let closest = diameter + SURELY_APART;
    let bound = closest * closest;
    // All three points beyond the line across the way to the other ball, which the first one is by itself. Branches on
    // the single comparisons would be guessed wrong too often.
    let away = d.length_squared();
    let least = lesser(lesser(d.dot(bend), d.dot(end)), away);
    let leaves = least * least.abs() > bound * away;
    // All three on one side of the line along the course, which the first and the last are equally far from.
    let n = (end - d).perp();
    let (ends, middle) = (n.dot(d), n.dot(bend));
    let passes = (ends * middle > 0.0) & (lesser(ends * ends, middle * middle) > bound * n.length_squared());
    leaves | passes
}

/// The lesser of two numbers; `f64::min` would spend time on what is not a number.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The gap of two balls that touch, divided by the time: its root at zero is the contact that is already known.
fn touching_balls_ahead(d: DVec2, dv: DVec2, dk: DVec2, diameter: f64, horizon: f64, may_rest: bool) -> Ahead {
    let c1 = 2.0 * d.dot(dv);
    let c2 = dv.length_squared() + 2.0 * d.dot(dk);
    let separation = c1 / (2.0 * diameter);
    if separation < -RESTING_SPEED {
        return Ahead::Meeting(0.0);
    }
    if may_rest && separation <= RESTING_SPEED && c2 / diameter < -PRESSING {
        return Ahead::Pressed;
    }
    // Coefficients of rounding's size would close and open the gap without end.
    let clean = |c: f64| if c.abs() < PRESSING { 0.0 } else { c };
    polynomial_closes(
        &[0.0, c1, clean(c2), clean(2.0 * dv.dot(dk)), dk.length_squared()],
        true,
        2.0 * diameter,
        horizon,
    )
}

/// A ball that rolls straight towards one at rest: where the line enters the circle of radius `diameter`, and when.
fn straight_ahead(d: DVec2, dv: DVec2, dk: DVec2, gap: f64, diameter: f64, horizon: f64) -> Ahead {
    let speed = dv.length();
    let direction = dv / speed;
    let along = -d.dot(direction);
    let beside = d.perp_dot(direction);
    let half_chord_squared = diameter * diameter - beside * beside;
    if along <= 0.0 || half_chord_squared < 0.0 {
        return Ahead::Nothing;
    }
    // The nearer of the two crossings, written as the product of both over the farther one.
    let distance = gap / (along + half_chord_squared.sqrt());
    let half_deceleration = -dk.dot(direction);
    let discriminant = speed * speed - 4.0 * half_deceleration * distance;
    if discriminant < 0.0 {
        return Ahead::Nothing;
    }
    let time = 2.0 * distance / (speed + discriminant.sqrt());
    if time <= horizon { Ahead::Meeting(time) } else { Ahead::Nothing }
}

/// Two balls of which one at least is in a resting contact. Whether they rest against each other is known to the
/// contact itself, which then does not ask.
fn curved_balls_ahead(constants: &Constants, first: &Segment, second: &Segment, now: f64, horizon: f64) -> Ahead {
    let (c1, c2) = (shifted(first, now), shifted(second, now));
    let mut d = [DVec2::ZERO; 6];
    for power in 0..6 {
        d[power] = c1[power] - c2[power];
    }
    let diameter = 2.0 * constants.radius;
    // Most pairs are too far apart to meet in so short a time.
    if d[0].length() - diameter > TOUCHING + travel(&d.map(DVec2::length), horizon) {
        return Ahead::Nothing;
    }
    let mut gap = [0.0; MAX_DEGREE + 1];
    for i in 0..6 {
        for j in 0..6 {
            gap[i + j] += d[i].dot(d[j]);
        }
    }
    gap[0] -= diameter * diameter;
    let touching = gap[0] <= 2.0 * diameter * TOUCHING;
    polynomial_closes(&gap, touching, 2.0 * diameter, horizon)
}

/// How far a course with coefficients of these sizes can lead within `time`.
fn travel(sizes: &[f64; 6], time: f64) -> f64 {
    sizes[1..].iter().rev().fold(0.0, |sum, size| (sum + size) * time)
}

/// When the gap with these coefficients, in units of `scale` times metres, closes. That of balls which touch is divided by
/// the time, whose root at zero is the contact that is already known; where they stay together for now, they meet again
/// when the gap has closed by more than counts as touching.
fn polynomial_closes(gap: &[f64], touching: bool, scale: f64, horizon: f64) -> Ahead {
    let mut work = [0.0; MAX_DEGREE + 1];
    let mut count = gap.len();
    work[..count].copy_from_slice(gap);
    if touching {
        let opening = gap[1] / scale;
        if opening < -RESTING_SPEED {
            return Ahead::Meeting(0.0);
        }
        if opening > RESTING_SPEED {
            work.copy_within(1.., 0);
            count -= 1;
        } else {
            work[0] = scale * TOUCHING;
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
fn shifted(segment: &Segment, now: f64) -> [DVec2; 6] {
    let mut c = coefficients(segment);
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
    use super::{super::savings::All, *};
    use crate::{physics::BallState, table::Table};

    #[test]
    fn a_ball_that_leaves_the_cushion_it_touches_does_not_hit_it() {
        assert_eq!(gap_closes(0.0, -1.0, 0.0), f64::INFINITY);
        assert_eq!(gap_closes(0.0, -1.0, 0.5), 2.0);
        assert_eq!(gap_closes(0.0, 0.0, 0.5), PRESSED);
        assert_eq!(gap_closes(-1e-10, 1.0, 0.0), 0.0);
    }

    #[test]
    fn a_straight_meeting_takes_the_time_of_the_constant_deceleration() {
        let constants = Constants::of(&Table::default());
        let velocity = DVec2::new(0.5, 0.0);
        let spin = crate::physics::rolling_spin(constants.radius, velocity).extend(0.0);
        let (roll, _) = Segment::free(&constants, 0.0, &BallState { position: DVec2::ZERO, velocity, spin });
        let rest = Segment::at_rest(DVec2::new(0.5, 0.0));
        let Ahead::Meeting(time) = balls_ahead::<All>(&constants, &roll, &rest, 0.0, 10.0, true) else {
            panic!("no meeting")
        };
        let position = roll.position_after(time);
        assert!((position.x - (0.5 - 2.0 * constants.radius)).abs() < 1e-15);
    }

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
            curve: Some(Box::new(curve)),
            ..Segment::at_rest(DVec2::new(0.1, 0.2))
        };
        let c = shifted(&segment, 1.25);
        let at = c.iter().rev().fold(DVec2::ZERO, |sum, c| sum * 0.5 + *c);
        assert!(at.distance(segment.position_after(0.75)) < 1e-15);
    }
}
