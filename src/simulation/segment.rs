//! A segment: the closed-form trajectory of a ball between two events.

use glam::{DVec2, DVec3};

use super::{Constants, hops::Hops};
use crate::physics::{BallState, Motion, SpatialState, decayed_spin, roll_on_slope, slide_on_slope, slip};

/// A slip below this share of the ball's own speeds is a rounding error: the ball rolls.
const SLIP_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A ball's trajectory from `start` until the next event changes it.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Time at which the segment begins, s.
    pub start: f64,
    /// Centre at the start, m.
    pub position: DVec2,
    /// Velocity at the start, m/s.
    pub velocity: DVec2,
    /// Half the acceleration, m/s²: `-k` of thesis equation (38). Constant during the segment, except for [`Motion::Resting`] and
    /// [`Motion::Flying`].
    pub half_acceleration: DVec2,
    /// Angular velocity at the start, rad/s.
    pub spin: DVec3,
    /// The motion phase, which selects the equation of motion.
    pub motion: Motion,
    /// Trajectory data beyond a parabola on the cloth. Boxed, because it is rare and larger than all other fields together.
    pub course: Option<Box<Course>>,
}

/// A trajectory that is more than a parabola on the cloth.
#[derive(Clone, Copy, Debug)]
pub enum Course {
    /// A resting contact.
    Contact(Curve),
    /// A ball in the air.
    Hops(Hops),
}

/// The part of a resting contact's trajectory beyond a parabola: one step of its integration, as polynomials that match the integrated
/// state and its derivatives at both ends.
#[derive(Clone, Copy, Debug)]
pub struct Curve {
    /// Coefficients of `t³`, `t⁴` and `t⁵` in the position, m/s³ and so on.
    pub position: [DVec2; 3],
    /// Coefficients of `t`, `t²` and `t³` in the spin, rad/s² and so on.
    pub spin: [DVec3; 3],
}

/// Whether a free ball slides: its slip exceeds the rounding error of the velocities whose difference it is.
pub fn slides(radius: f64, state: &BallState) -> bool {
    let spin_squared = radius * radius * state.spin.truncate().length_squared();
    slip(radius, state.velocity, state.spin).length_squared()
        > SLIP_ROUNDING * SLIP_ROUNDING * (state.velocity.length_squared() + spin_squared)
}

impl Segment {
    /// Creates the segment of a ball that is at rest from time zero on.
    pub const fn at_rest(position: DVec2) -> Self {
        Self {
            start: 0.0,
            position,
            velocity: DVec2::ZERO,
            half_acceleration: DVec2::ZERO,
            spin: DVec3::ZERO,
            motion: Motion::Stationary,
            course: None,
        }
    }

    /// Returns the free trajectory from `state` at time `start`, and its longest duration, s: until slip or speed is zero (thesis equations
    /// 25 and 26).
    #[inline(always)]
    pub fn free(constants: &Constants, start: f64, state: &BallState) -> (Self, f64) {
        let radius = constants.radius;
        let u = slip(radius, state.velocity, state.spin);
        let slip_squared = u.length_squared();
        let speed_squared = state.velocity.length_squared();
        let mut segment = Self { start, velocity: state.velocity, spin: state.spin, ..Self::at_rest(state.position) };
        let spin_squared = radius * radius * state.spin.truncate().length_squared();
        if slip_squared > SLIP_ROUNDING * SLIP_ROUNDING * (speed_squared + spin_squared) {
            let speed = slip_squared.sqrt();
            segment.motion = Motion::Sliding;
            if constants.level {
                segment.half_acceleration = u * (-0.5 * constants.sliding / speed);
                return (segment, speed * constants.slide_time);
            }
            let slide = slide_on_slope(constants.sliding, constants.tilt, state.velocity, u);
            segment.half_acceleration = slide.half_acceleration;
            (segment, slide.duration)
        } else if speed_squared > 0.0 {
            segment.roll(constants)
        } else {
            (segment, f64::INFINITY)
        }
    }

    /// Converts the segment into a rolling one with its present velocity. Also returns its longest duration, s.
    #[inline(always)]
    fn roll(mut self, constants: &Constants) -> (Self, f64) {
        let speed = self.velocity.length();
        self.spin = (self.velocity.perp() * constants.per_radius).extend(self.spin.z);
        self.motion = Motion::Rolling;
        if constants.has_one_band {
            self.half_acceleration = self.velocity * (-0.5 * constants.rolling.least / speed);
            return (self, speed * constants.roll_time);
        }
        if !constants.level {
            let roll = roll_on_slope(&constants.rolling, constants.tilt, self.velocity);
            self.half_acceleration = roll.half_acceleration;
            return (self, roll.duration);
        }
        let (deceleration, end) = constants.rolling.band(speed);
        self.half_acceleration = self.velocity * (-0.5 * deceleration / speed);
        (self, (speed - end) / deceleration)
    }

    /// Whether a rolling ball comes to rest at the end of this segment, rather than continuing in the next band of deceleration.
    #[inline(always)]
    pub fn rolls_to_rest(&self, constants: &Constants) -> bool {
        if constants.has_one_band {
            return true;
        }
        if constants.level {
            return constants.rolling.is_last(self.velocity.length());
        }
        roll_on_slope(&constants.rolling, constants.tilt, self.velocity).velocity == DVec2::ZERO
    }

    /// Returns the segment that follows after this one's full `duration`, s, and its longest duration.
    #[inline(always)]
    pub fn successor(&self, constants: &Constants, duration: f64) -> (Self, f64) {
        let wz = decayed_spin(self.spin.z, constants.spinning, duration);
        let spin = DVec3::new(0.0, 0.0, wz);
        let start = self.start + duration;
        if self.motion == Motion::Sliding {
            // The velocity after the slip does not depend on the duration, which keeps rounding errors small. A slope adds its part.
            let mut velocity = self.velocity - slip(constants.radius, self.velocity, self.spin) * (2.0 / 7.0);
            if !constants.has_one_band {
                velocity += (5.0 / 7.0 * duration) * constants.tilt;
            }
            let next = Self { start, velocity, spin, ..Self::at_rest(self.position_after(duration)) };
            if velocity == DVec2::ZERO { (next, f64::INFINITY) } else { next.roll(constants) }
        } else if !self.rolls_to_rest(constants) {
            let velocity = if constants.level {
                self.velocity_after(duration)
            } else {
                roll_on_slope(&constants.rolling, constants.tilt, self.velocity).velocity
            };
            Self { start, velocity, spin, ..Self::at_rest(self.position_after(duration)) }.roll(constants)
        } else {
            let position = if constants.level {
                self.position + 0.5 * duration * self.velocity
            } else {
                self.position_after(duration)
            };
            (Self { start, spin, ..Self::at_rest(position) }, f64::INFINITY)
        }
    }

    /// Returns the centre `t` seconds after the start, m.
    #[inline(always)]
    pub fn position_after(&self, t: f64) -> DVec2 {
        match &self.course {
            None => self.position + t * (self.velocity + t * self.half_acceleration),
            Some(course) => self.special_position(course, t),
        }
    }

    /// Returns the velocity `t` seconds after the start, m/s.
    #[inline(always)]
    pub fn velocity_after(&self, t: f64) -> DVec2 {
        match &self.course {
            None => self.velocity + t * (2.0 * self.half_acceleration),
            Some(course) => self.special_velocity(course, t),
        }
    }

    #[inline(never)]
    fn special_position(&self, course: &Course, t: f64) -> DVec2 {
        match course {
            Course::Contact(Curve { position: [c3, c4, c5], .. }) => {
                let bend = self.half_acceleration + t * (c3 + t * (c4 + t * c5));
                self.position + t * (self.velocity + t * bend)
            }
            Course::Hops(hops) => hops.state_after(t).position.truncate(),
        }
    }

    #[inline(never)]
    fn special_velocity(&self, course: &Course, t: f64) -> DVec2 {
        match course {
            Course::Contact(Curve { position: [c3, c4, c5], .. }) => {
                let bend = 2.0 * self.half_acceleration + t * (3.0 * c3 + t * (4.0 * c4 + 5.0 * t * c5));
                self.velocity + t * bend
            }
            Course::Hops(hops) => hops.state_after(t).velocity.truncate(),
        }
    }

    /// Returns the coefficients of the position along the cloth about the start, in ascending powers of `t`, m, m/s and so on. Not valid
    /// for a ball in the air.
    #[inline]
    pub fn coefficients(&self) -> [DVec2; 6] {
        let [c3, c4, c5] = self.curve().map_or([DVec2::ZERO; 3], |curve| curve.position);
        [self.position, self.velocity, self.half_acceleration, c3, c4, c5]
    }

    /// Returns the curve of a resting contact.
    pub fn curve(&self) -> Option<&Curve> {
        match self.course.as_deref() {
            Some(Course::Contact(curve)) => Some(curve),
            _ => None,
        }
    }

    /// Returns the flight of a ball in the air.
    pub fn hops(&self) -> Option<&Hops> {
        match self.course.as_deref() {
            Some(Course::Hops(hops)) => Some(hops),
            _ => None,
        }
    }

    /// Returns position, velocity and spin in three dimensions `t` seconds after the start, in the air or on the cloth.
    pub fn spatial_after(&self, constants: &Constants, t: f64) -> SpatialState {
        self.hops().map_or_else(|| self.state_after(constants, t).into(), |hops| hops.state_after(t))
    }

    /// Returns the angular velocity `t` seconds after the start, rad/s.
    #[inline(always)]
    pub fn spin_after(&self, constants: &Constants, t: f64) -> DVec3 {
        match self.course.as_deref() {
            None => {}
            Some(Course::Contact(Curve { spin: [c1, c2, c3], .. })) => {
                return self.spin + t * (c1 + t * (c2 + t * c3));
            }
            Some(Course::Hops(hops)) => return hops.state_after(t).spin,
        }
        // w' = -5/R z×k while sliding (3), z×v'/R while rolling (6).
        let rate = match self.motion {
            Motion::Sliding => -5.0,
            Motion::Rolling => 2.0,
            Motion::Stationary | Motion::Resting | Motion::Flying | Motion::OffTable => 0.0,
        } * constants.per_radius;
        // A slope exerts no torque on a sliding ball.
        let mut turning = self.half_acceleration;
        if !constants.has_one_band && self.motion == Motion::Sliding {
            turning -= 0.5 * constants.tilt;
        }
        let horizontal = self.spin.truncate() + (rate * t) * turning.perp();
        horizontal.extend(decayed_spin(self.spin.z, constants.spinning, t))
    }

    /// Returns position, velocity and spin `t` seconds after the start.
    #[inline(always)]
    pub fn state_after(&self, constants: &Constants, t: f64) -> BallState {
        BallState {
            position: self.position_after(t),
            velocity: self.velocity_after(t),
            spin: self.spin_after(constants, t),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{physics::rolling_spin, table::Table};

    #[test]
    fn sliding_ends_exactly_when_the_slip_is_zero() {
        let constants = Constants::of(&Table::preset("textbook").unwrap());
        let state =
            BallState { position: DVec2::ZERO, velocity: DVec2::new(2.0, -1.0), spin: DVec3::new(30.0, -70.0, 20.0) };
        let (slide, duration) = Segment::free(&constants, 0.0, &state);
        assert_eq!(slide.motion, Motion::Sliding);
        let end = slide.state_after(&constants, duration);
        assert!(slip(constants.radius, end.velocity, end.spin).length() < 1e-14);
        let (roll, _) = slide.successor(&constants, duration);
        assert_eq!(roll.motion, Motion::Rolling);
        assert!(roll.velocity.distance(end.velocity) < 1e-14 && roll.spin.distance(end.spin) < 1e-12);
    }

    #[test]
    fn a_rolling_ball_stops_after_v_squared_over_two_a() {
        let constants = Constants::of(&Table::preset("textbook").unwrap());
        let velocity = DVec2::new(0.3, 0.4);
        let spin = rolling_spin(constants.radius, velocity).extend(0.0);
        let (roll, duration) = Segment::free(&constants, 0.0, &BallState { position: DVec2::ZERO, velocity, spin });
        let (rest, forever) = roll.successor(&constants, duration);
        assert_eq!((rest.motion, forever), (Motion::Stationary, f64::INFINITY));
        assert!((rest.position.length() - 0.25 / (2.0 * constants.rolling.least)).abs() < 1e-14);
    }

    #[test]
    fn spin_about_the_vertical_decays_to_zero_and_stays_there() {
        let constants = Constants::of(&Table::preset("textbook").unwrap());
        let spin = DVec3::new(0.0, 0.0, -1.0);
        let state = BallState { position: DVec2::ZERO, velocity: DVec2::ZERO, spin };
        let (rest, _) = Segment::free(&constants, 0.0, &state);
        assert_eq!(rest.motion, Motion::Stationary);
        assert!(rest.spin_after(&constants, 0.01).z < 0.0);
        assert_eq!(rest.spin_after(&constants, 9.0).z, 0.0);
    }
}
