//! Ball-ball detection: predicts the next collision of two balls, provided that no other event happens first.

use glam::DVec2;

use super::{
    Constants, Segment,
    aloft::next_collision_in_space,
    predict::{Prediction, lesser, next_collision_on_curve, polynomial_closes},
    roots::{first_crossing, horner},
    savings::Savings,
    tolerance::Tolerance,
};
use crate::physics::Motion;

/// Returns the next collision of two balls within `horizon` seconds of time `now`. If they press on each other and `may_rest`, the result
/// is [`Prediction::Pressed`]. If resting was tried and nothing holds them, they collide as soon as they overlap.
#[inline(always)]
pub fn next_collision<S: Savings>(
    constants: &Constants,
    first: &Segment,
    second: &Segment,
    now: f64,
    horizon: f64,
    may_rest: bool,
) -> Prediction {
    if first.course.is_some() || second.course.is_some() {
        return if first.motion == Motion::Flying || second.motion == Motion::Flying {
            next_collision_in_space::<S>(constants, [first, second], now, horizon).into()
        } else {
            next_collision_on_curve(constants, first, second, now, horizon, may_rest)
        };
    }
    let (t1, t2) = (now - first.start, now - second.start);
    let d = first.position_after(t1) - second.position_after(t2);
    let dv = first.velocity_after(t1) - second.velocity_after(t2);
    let dk = first.half_acceleration - second.half_acceleration;
    let apart = constants.diameter + constants.tolerance.certain_gap;
    if S::SEPARATED_COURSES && Triangle::new(d, dv, dk, horizon).clears(DVec2::ZERO, apart) {
        return Prediction::Nothing;
    }
    // On a slope, the path of a rolling ball is curved.
    let rolls_straight = constants.level
        && matches!(
            (first.motion, second.motion),
            (Motion::Rolling, Motion::Stationary) | (Motion::Stationary, Motion::Rolling)
        );
    approach(constants, [d, dv, dk], horizon, may_rest, rolls_straight)
}

/// As [`next_collision`], for balls that no line was found to separate: their distance vector is `d + t dv + t² dk`.
#[inline(never)]
fn approach(
    constants: &Constants,
    [d, dv, dk]: [DVec2; 3],
    horizon: f64,
    may_rest: bool,
    rolls_straight: bool,
) -> Prediction {
    let (diameter, tolerance) = (constants.diameter, &constants.tolerance);
    let gap = d.length_squared() - diameter * diameter;
    if gap <= 2.0 * diameter * tolerance.touching {
        return next_collision_of_touching(tolerance, d, dv, dk, diameter, horizon, may_rest);
    }
    if rolls_straight {
        return next_straight_collision(d, dv, dk, gap, diameter, horizon).into();
    }
    let c1 = 2.0 * d.dot(dv);
    let c2 = dv.length_squared() + 2.0 * d.dot(dk);
    let c3 = 2.0 * dv.dot(dk);
    let c4 = dk.length_squared();
    let derivative = [c1, 2.0 * c2, 3.0 * c3, 4.0 * c4];
    let value = |t: f64| (d + t * (dv + t * dk)).length_squared() - diameter * diameter;
    let rounding = f64::EPSILON * diameter * diameter;
    first_crossing(value, &derivative, horizon, rounding).into()
}

/// A triangle that contains a part of a trajectory: the control points of a parabola, or the range of positions for all velocities between
/// two.
#[derive(Clone, Copy)]
pub struct Triangle {
    start: DVec2,
    bend: DVec2,
    end: DVec2,
}

impl Triangle {
    /// Returns the triangle around `p + v t + k t²` from zero to `horizon`.
    #[inline(always)]
    pub fn new(p: DVec2, v: DVec2, k: DVec2, horizon: f64) -> Self {
        Self { start: p, bend: p + 0.5 * horizon * v, end: p + horizon * (v + horizon * k) }
    }

    /// Returns the triangle around a trajectory from `p` whose velocity moves along a line from `v` to `last`, for `time` seconds.
    pub fn between(p: DVec2, v: DVec2, last: DVec2, time: f64) -> Self {
        Self { start: p, bend: p + time * v, end: p + time * last }
    }

    /// Whether a line separates the triangle from the disk of radius `distance` around `place`. Two lines are tried: perpendicular to the
    /// direction from the triangle's start to `place`, and along the trajectory.
    #[inline(always)]
    pub fn clears(&self, place: DVec2, distance: f64) -> bool {
        let (start, bend, end) = (self.start - place, self.bend - place, self.end - place);
        let bound = distance * distance;
        // All three points are beyond the first line. Branches for the single comparisons would be mispredicted too often.
        let away = start.length_squared();
        let least = lesser(lesser(start.dot(bend), start.dot(end)), away);
        let leaves = least * least.abs() > bound * away;
        // All three points are on one side of the second line, to which the first and the last point have the same distance.
        let n = (end - start).perp();
        let (ends, middle) = (n.dot(start), n.dot(bend));
        let passes = (ends * middle > 0.0) & (lesser(ends * ends, middle * middle) > bound * n.length_squared());
        leaves | passes
    }
}

/// Prediction for two touching balls, whose gap is divided by the time: its root at zero is the present contact.
fn next_collision_of_touching(
    tolerance: &Tolerance,
    d: DVec2,
    dv: DVec2,
    dk: DVec2,
    diameter: f64,
    horizon: f64,
    may_rest: bool,
) -> Prediction {
    let c1 = 2.0 * d.dot(dv);
    let c2 = dv.length_squared() + 2.0 * d.dot(dk);
    let separation = c1 / (2.0 * diameter);
    if separation < -tolerance.opening {
        return Prediction::Impact(0.0);
    }
    if may_rest && separation <= tolerance.opening && c2 / diameter < -tolerance.pressing {
        return Prediction::Pressed;
    }
    // Coefficients at rounding level would open and close the gap without end.
    let clean = |c: f64| if c.abs() < tolerance.pressing { 0.0 } else { c };
    let (c2, c3, c4) = (clean(c2), clean(2.0 * dv.dot(dk)), dk.length_squared());
    let gap = [0.0, c1, c2, c3, c4];
    let falls = polynomial_closes(tolerance, &gap, 2.0 * diameter, horizon);
    if separation > tolerance.opening {
        return falls.into();
    }
    // Pressing balls collide as soon as they close at a significant speed: until a gap at rounding level closes, their slips would change
    // too much.
    let speed = [c1 + 4.0 * diameter * tolerance.opening, 2.0 * c2, 3.0 * c3, 4.0 * c4];
    let horizon = falls.unwrap_or(horizon);
    let steepness = [speed[1], 2.0 * speed[2], 3.0 * speed[3]];
    let rounding = f64::EPSILON * speed[0].abs();
    match first_crossing(|t| horner(&speed, t), &steepness, horizon, rounding) {
        Some(time) if horner(&gap, time) <= 2.0 * diameter * tolerance.touching => Prediction::Impact(time),
        _ => falls.into(),
    }
}

/// Prediction for a ball that rolls straight towards one at rest: where the line enters the circle of radius `diameter`, and when.
fn next_straight_collision(d: DVec2, dv: DVec2, dk: DVec2, gap: f64, diameter: f64, horizon: f64) -> Option<f64> {
    let speed = dv.length();
    let direction = dv / speed;
    let along = -d.dot(direction);
    let beside = d.perp_dot(direction);
    let half_chord_squared = diameter * diameter - beside * beside;
    if along <= 0.0 || half_chord_squared < 0.0 {
        return None;
    }
    // The nearer of the two crossings, computed as the product of both divided by the farther one, without cancellation.
    let distance = gap / (along + half_chord_squared.sqrt());
    let half_deceleration = -dk.dot(direction);
    let discriminant = speed * speed - 4.0 * half_deceleration * distance;
    if discriminant < 0.0 {
        return None;
    }
    let time = 2.0 * distance / (speed + discriminant.sqrt());
    (time <= horizon).then_some(time)
}

#[cfg(test)]
mod tests {
    use super::{super::savings::AllSavings, *};
    use crate::{physics::BallState, table::Table};

    #[test]
    fn triangle_clears_a_bending_course_but_not_a_grazing_one() {
        let (v, k) = (DVec2::new(1.0, 0.0), DVec2::new(0.0, 0.5));
        let triangle = Triangle::new(DVec2::ZERO, v, k, 1.0);
        // The trajectory ends at (1, 0.5) and passes (0.5, 0.125).
        assert!(triangle.clears(DVec2::new(0.5, -0.1), 0.06));
        assert!(triangle.clears(DVec2::new(-0.1, 0.0), 0.06));
        assert!(triangle.clears(DVec2::new(1.1, 0.6), 0.06));
        assert!(!triangle.clears(DVec2::new(0.5, 0.07), 0.06));
        assert!(!triangle.clears(DVec2::new(1.0, 0.55), 0.06));
    }

    #[test]
    fn straight_collision_time_follows_constant_deceleration() {
        let constants = Constants::of(&Table::default());
        let velocity = DVec2::new(0.5, 0.0);
        let spin = crate::physics::rolling_spin(constants.radius, velocity).extend(0.0);
        let (roll, _) = Segment::free(&constants, 0.0, &BallState { position: DVec2::ZERO, velocity, spin });
        let rest = Segment::at_rest(DVec2::new(0.5, 0.0));
        let Prediction::Impact(time) = next_collision::<AllSavings>(&constants, &roll, &rest, 0.0, 10.0, true) else {
            panic!("no meeting")
        };
        let position = roll.position_after(time);
        assert!((position.x - (0.5 - 2.0 * constants.radius)).abs() < 1e-15);
    }

    /// Two balls side by side, one of which begins to press: until a gap at rounding level closes, 1e-7 s pass, in which the slip of balls
    /// that never slip grows beyond its zero tolerance.
    #[test]
    fn touching_balls_collide_once_their_closing_speed_is_significant() {
        let constants = Constants::of(&Table::preset("thesis").unwrap());
        let (tolerance, diameter) = (&constants.tolerance, constants.diameter);
        let meets = |dv: DVec2, dk: DVec2| {
            next_collision_of_touching(tolerance, DVec2::new(diameter, 0.0), dv, dk, diameter, 1.0, false)
        };
        let Prediction::Impact(time) = meets(DVec2::ZERO, DVec2::new(-0.9, 0.0)) else { panic!("no meeting") };
        assert!((time * 1.8 - 2.0 * tolerance.opening).abs() < 1e-3 * tolerance.opening, "{time}");
        // Separating balls do not collide.
        let parting = DVec2::new(0.5 * tolerance.opening, 0.0);
        assert_eq!(meets(parting, DVec2::new(0.9, 0.0)), Prediction::Nothing);
    }
}
