//! Ball-cushion detection: predicts the next cushion impact of a free ball, provided that no other event happens first.

use super::{
    Constants, Rail, Segment,
    predict::{Prediction, lesser},
    savings::Savings,
    tolerance::Tolerance,
};
use crate::physics::Motion;

/// Returns the first cushion impact of a free `segment` within `horizon` seconds of its start.
///
/// The processor cannot predict the direction of a ball, so that all four cushions are computed without branches.
#[inline(always)]
pub fn next_cushion_impact<S: Savings>(constants: &Constants, segment: &Segment, horizon: f64) -> (Prediction, Rail) {
    // On a slope, the path of a rolling ball is curved.
    if segment.motion == Motion::Rolling && constants.level {
        return next_cushion_impact_of_rolling::<S>(constants, segment, horizon);
    }
    let (p, v, k) = (segment.position, segment.velocity, segment.half_acceleration);
    let reach = constants.reach;
    if S::CUSHIONS_IN_REACH {
        // The trajectory lies within the triangle of its start and these two points. If they are inside, a ball that touches a cushion at
        // its start moves away from it.
        let bend = (p + 0.5 * horizon * v).abs();
        let end = (p + horizon * (v + horizon * k)).abs();
        let inside = |bend: f64, end: f64, reach: f64| -lesser(-bend, -end) < reach - constants.tolerance.certain_gap;
        if inside(bend.x, end.x, reach.x) & inside(bend.y, end.y, reach.y) {
            return (Prediction::Nothing, Rail::Left);
        }
    }
    let tolerance = &constants.tolerance;
    let (across, right) = next_impact_on_axis(tolerance, reach.x, p.x, v.x, k.x);
    let (along, top) = next_impact_on_axis(tolerance, reach.y, p.y, v.y, k.y);
    let time = lesser(along, across);
    let rail = rail_of(right, top, along < across);
    if time == PRESSED {
        (Prediction::Pressed, rail)
    } else if time < horizon {
        (Prediction::Impact(time), rail)
    } else {
        (Prediction::Nothing, rail)
    }
}

/// Returns the cushion on the given side of the x axis or the y axis.
#[inline(always)]
pub fn rail_of(right: bool, top: bool, on_y: bool) -> Rail {
    let (x, y) = (usize::from(right), 2 + usize::from(top));
    Rail::ALL[x ^ ((x ^ y) * usize::from(on_y))]
}

/// As [`next_cushion_impact`] for a ball that rolls straight: the cushion whose line it would cross first without deceleration, selected by
/// the signs of the velocity.
#[inline(always)]
fn next_cushion_impact_of_rolling<S: Savings>(
    constants: &Constants,
    segment: &Segment,
    horizon: f64,
) -> (Prediction, Rail) {
    let (p, v, reach) = (segment.position, segment.velocity, constants.reach);
    let tolerance = &constants.tolerance;
    let ahead = |reach: f64, p: f64, v: f64| at_full_speed(tolerance, reach - p * 1.0_f64.copysign(v), v.abs());
    let (mut to_x, mut to_y) = (ahead(reach.x, p.x, v.x), ahead(reach.y, p.y, v.y));
    if !S::CUSHIONS_IN_REACH {
        // The cushions behind the ball, from which it moves away.
        to_x = lesser(at_full_speed(tolerance, reach.x + p.x * 1.0_f64.copysign(v.x), -v.x.abs()), to_x);
        to_y = lesser(at_full_speed(tolerance, reach.y + p.y * 1.0_f64.copysign(v.y), -v.y.abs()), to_y);
    }
    let straight = lesser(to_y, to_x);
    let rail = rail_of(v.x > 0.0, v.y > 0.0, to_y < to_x);
    // `straight = t - t² / 2 stop`, where the speed would be zero at `stop`: at the horizon, unless the band ends before.
    let banded = !constants.has_one_band;
    let stop = if banded { -0.5 * v.length_squared() / v.dot(segment.half_acceleration) } else { horizon };
    let share = 1.0 - 2.0 * straight / stop;
    let time = 2.0 * straight / (1.0 + share.sqrt());
    if share > 0.0 && (!banded || time < horizon) {
        (Prediction::Impact(time), rail)
    } else {
        (Prediction::Nothing, rail)
    }
}

/// Returns when a ball of constant speed closes a gap, s; infinity if it touches the cushion and does not move towards it. If rounding
/// decides whether it does, it bounces before it is noticeably behind the cushion.
#[inline(always)]
fn at_full_speed(tolerance: &Tolerance, gap: f64, speed: f64) -> f64 {
    let open = if gap > 0.0 { gap } else { 0.0 };
    if speed > tolerance.opening || (speed > 0.0 && gap > tolerance.touching) {
        open / speed
    } else if speed > 0.0 {
        (open + tolerance.coupled_gap) / speed
    } else {
        f64::INFINITY
    }
}

/// Time of the impact of a ball that rests against a cushion.
const PRESSED: f64 = -1.0;

/// Returns the time of the first impact on two opposite cushions, at `±reach`, of a ball with the coordinate `p + v t + k t²`, s; infinity
/// for never. Also returns whether the cushion is on the positive side.
#[inline(always)]
fn next_impact_on_axis(tolerance: &Tolerance, reach: f64, p: f64, v: f64, k: f64) -> (f64, bool) {
    let sign = 1.0_f64.copysign(v);
    let (p, v, k) = (sign * p, v.abs(), sign * k);
    let (forward_gap, backward_gap) = (reach - p, reach + p);
    let (forward, backward) = if v <= tolerance.opening && lesser(forward_gap, backward_gap) <= tolerance.touching {
        (gap_closes(tolerance, forward_gap, v, k), gap_closes(tolerance, backward_gap, -v, -k))
    } else {
        (first_closes(forward_gap, v, k), closes_on_return(backward_gap, v, -k))
    };
    (lesser(forward, backward), (sign > 0.0) == (forward <= backward))
}

/// Returns when `gap - speed t - half_acceleration t²` first falls to zero, for a non-negative speed; infinity if never.
#[inline(always)]
fn first_closes(gap: f64, speed: f64, half_acceleration: f64) -> f64 {
    let gap = -lesser(-gap, 0.0);
    let discriminant = speed * speed + 4.0 * half_acceleration * gap;
    // The root of a negative number is NaN and is never used.
    let time = 2.0 * gap / (speed + discriminant.sqrt());
    if discriminant < 0.0 { f64::INFINITY } else { time }
}

/// Returns when a ball that leaves a cushion with `speed`, at the distance `gap` from it, comes back under `half_pull`; infinity if never.
#[inline(always)]
fn closes_on_return(gap: f64, speed: f64, half_pull: f64) -> f64 {
    let gap = -lesser(-gap, 0.0);
    let discriminant = speed * speed + 4.0 * half_pull * gap;
    let time = (speed + discriminant.sqrt()) / (2.0 * half_pull);
    if half_pull > 0.0 { time } else { f64::INFINITY }
}

/// As [`first_closes`] for any speed, if rounding decides whether a ball touches; infinity if never, [`PRESSED`] for a resting contact.
#[cold]
fn gap_closes(tolerance: &Tolerance, gap: f64, speed: f64, half_acceleration: f64) -> f64 {
    if gap <= tolerance.touching {
        return if speed > tolerance.opening {
            0.0
        } else if 2.0 * half_acceleration <= tolerance.pressing {
            // A ball that creeps into the cushion bounces before it is noticeably behind it.
            if speed > 0.0 {
                first_closes(gap + tolerance.coupled_gap, speed, half_acceleration)
            } else {
                f64::INFINITY
            }
        } else if speed >= -tolerance.opening {
            PRESSED
        } else {
            -speed / half_acceleration
        };
    }
    if speed > 0.0 {
        first_closes(gap, speed, half_acceleration)
    } else {
        closes_on_return(gap, -speed, half_acceleration)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::{super::savings::AllSavings, *};
    use crate::{physics::BallState, table::Table};

    /// Returns the first cushion impact of a ball with this velocity and spin, and the ball's position then.
    fn first_cushion(position: DVec2, velocity: DVec2, spin: DVec3) -> (Prediction, Rail, DVec2) {
        let constants = Constants::of(&Table::default());
        let (segment, duration) = Segment::free(&constants, 0.0, &BallState { position, velocity, spin });
        let (ahead, rail) = next_cushion_impact::<AllSavings>(&constants, &segment, duration);
        let at = if let Prediction::Impact(time) = ahead { segment.position_after(time) } else { position };
        (ahead, rail, at)
    }

    #[test]
    fn rolling_ball_hits_the_first_cushion_on_its_line() {
        let constants = Constants::of(&Table::default());
        for (velocity, expected) in [
            (DVec2::new(1.0, 0.1), Rail::Right),
            (DVec2::new(-1.0, 0.1), Rail::Left),
            (DVec2::new(0.1, 1.0), Rail::Top),
            (DVec2::new(0.1, -1.0), Rail::Bottom),
            (DVec2::new(0.0, -1.0), Rail::Bottom),
        ] {
            let spin = crate::physics::rolling_spin(constants.radius, velocity).extend(0.0);
            let (_, rail, at) = first_cushion(DVec2::new(0.2, -0.1), velocity, spin);
            assert_eq!(rail, expected);
            let gap = rail.gap(constants.reach, at);
            assert!(gap.abs() < 1e-15, "{gap}");
        }
    }

    #[test]
    fn ball_that_creeps_into_a_cushion_bounces_before_it_is_behind_it() {
        let constants = Constants::of(&Table::default());
        let creeps = DVec2::new(0.5, 1e-11);
        let rolls = crate::physics::rolling_spin(constants.radius, creeps).extend(0.0);
        for spin in [rolls, DVec3::new(0.0, -400.0, 0.0)] {
            let (ahead, rail, at) = first_cushion(DVec2::new(-0.5, constants.reach.y), creeps, spin);
            assert!(matches!(ahead, Prediction::Impact(time) if time > 0.1) && rail == Rail::Top, "{ahead:?} {rail:?}");
            assert!(at.y - constants.reach.y < 1.1 * constants.tolerance.coupled_gap, "{at}");
        }
    }

    #[test]
    fn drawn_ball_returns_to_the_cushion_it_left() {
        let reach = Constants::of(&Table::default()).reach;
        let from = DVec2::new(reach.x, 0.0);
        let (ahead, rail, at) = first_cushion(from, DVec2::new(-0.1, 0.0), DVec3::new(0.0, 30.0, 0.0));
        assert!(matches!(ahead, Prediction::Impact(time) if time > 0.05), "{ahead:?}");
        assert_eq!(rail, Rail::Right);
        assert!((at.x - reach.x).abs() < 1e-15);
    }

    #[test]
    fn ball_that_stops_short_hits_no_cushion() {
        let (ahead, ..) = first_cushion(DVec2::ZERO, DVec2::new(0.1, 0.1), DVec3::ZERO);
        assert_eq!(ahead, Prediction::Nothing);
    }

    #[test]
    fn ball_leaving_a_touching_cushion_does_not_hit_it() {
        let tolerance = Constants::of(&Table::default()).tolerance;
        assert_eq!(gap_closes(&tolerance, 0.0, -1.0, 0.0), f64::INFINITY);
        assert_eq!(gap_closes(&tolerance, 0.0, -1.0, 0.5), 2.0);
        assert_eq!(gap_closes(&tolerance, 0.0, 0.0, 0.5), PRESSED);
        assert_eq!(gap_closes(&tolerance, -1e-10, 1.0, 0.0), 0.0);
    }
}
