//! When a free ball will meet a cushion, if nothing else happens first.

use super::{
    Constants, Rail, Segment,
    predict::{Ahead, PRESSING, RESTING_SPEED, SURELY_APART, TOUCHING, lesser},
    savings::Savings,
};
use crate::physics::Motion;

/// The first cushion that a free `segment` meets within `horizon` seconds of its start.
#[inline(always)]
pub fn cushion_ahead<S: Savings>(constants: &Constants, segment: &Segment, horizon: f64) -> (Ahead, Rail) {
    if segment.motion == Motion::Rolling {
        return cushion_ahead_of_rolling::<S>(constants, segment, horizon);
    }
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
    if time == PRESSED {
        (Ahead::Pressed, rail)
    } else if time < horizon {
        (Ahead::Meeting(time), rail)
    } else {
        (Ahead::Nothing, rail)
    }
}

/// The same for a ball that rolls straight on: the cushion whose line it would cross first without slowing down. Which one
/// that is, its signs tell.
#[inline(always)]
fn cushion_ahead_of_rolling<S: Savings>(constants: &Constants, segment: &Segment, horizon: f64) -> (Ahead, Rail) {
    let (p, v, reach) = (segment.position, segment.velocity, constants.reach);
    let (mut straight, mut rail) = (f64::INFINITY, Rail::Left);
    let mut consider = |side: Rail, gap: f64, speed: f64| {
        let time = at_full_speed(gap, speed);
        if time < straight {
            (straight, rail) = (time, side);
        }
    };
    if S::CUSHIONS_IN_REACH {
        // A ball that does not move along an axis finds no cushion on either side.
        let (x_rail, x) = if v.x > 0.0 { (Rail::Right, p.x) } else { (Rail::Left, -p.x) };
        let (y_rail, y) = if v.y > 0.0 { (Rail::Top, p.y) } else { (Rail::Bottom, -p.y) };
        consider(x_rail, reach.x - x, v.x.abs());
        consider(y_rail, reach.y - y, v.y.abs());
    } else {
        consider(Rail::Left, reach.x + p.x, -v.x);
        consider(Rail::Right, reach.x - p.x, v.x);
        consider(Rail::Bottom, reach.y + p.y, -v.y);
        consider(Rail::Top, reach.y - p.y, v.y);
    }
    // `straight = t - t² / 2 horizon`, since the speed is used up at the horizon.
    let share = 1.0 - 2.0 * straight / horizon;
    if share > 0.0 { (Ahead::Meeting(2.0 * straight / (1.0 + share.sqrt())), rail) } else { (Ahead::Nothing, rail) }
}

/// When a ball of constant speed closes a gap, s; infinity if it touches already without moving against the cushion.
#[inline(always)]
fn at_full_speed(gap: f64, speed: f64) -> f64 {
    let open = if gap > 0.0 { gap } else { 0.0 };
    if speed > RESTING_SPEED || (speed > 0.0 && gap > TOUCHING) { open / speed } else { f64::INFINITY }
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
    let highest = -lesser(-p, lesser(-bend, -end));
    if !S::CUSHIONS_IN_REACH || reach - highest < SURELY_APART {
        let time = gap_closes(reach - p, v, k);
        if time < f64::INFINITY {
            // The other side would be met later.
            return OnAxis { time, upwards };
        }
    }
    let lowest = lesser(p, lesser(bend, end));
    if !S::CUSHIONS_IN_REACH || reach + lowest < SURELY_APART {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_that_leaves_the_cushion_it_touches_does_not_hit_it() {
        assert_eq!(gap_closes(0.0, -1.0, 0.0), f64::INFINITY);
        assert_eq!(gap_closes(0.0, -1.0, 0.5), 2.0);
        assert_eq!(gap_closes(0.0, 0.0, 0.5), PRESSED);
        assert_eq!(gap_closes(-1e-10, 1.0, 0.0), 0.0);
    }
}
