//! A flight and the hops that follow it, in closed form: the motion of a ball from leaving the cloth until it stays on it.
//!
//! A ball that lands with the speed `V` leaves again with `e V`, lands with that, and so on. The hops last `2 V eⁱ / g`, and all of them
//! together `2 V e / g (1 - e)`. At each landing, the cloth's friction impulse is `c eⁱ`, `c = mu (1 + e) V`, against the slip, whose
//! direction is constant until the slip is zero. Positions, velocities and spins are therefore geometric sums.

use glam::{DVec2, DVec3};

use super::Constants;
use crate::physics::{BallState, Cloth, SpatialState, rolling_spin, slip, spin_change_by_cloth};

/// Number of landings up to which powers are multiplied; an exponential costs the same.
const FEW: u32 = 8;

/// Flight from one landing to the next: a parabola.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Start, s since the trajectory's start.
    pub begin: f64,
    /// End, s since the trajectory's start.
    pub end: f64,
    /// Centre at the start, m; `z` is the height above that of a ball on the cloth.
    pub position: DVec3,
    /// Velocity at the start, m/s.
    pub velocity: DVec3,
}

/// Trajectory of a ball that flies, lands, and hops until it stays on the cloth.
#[derive(Clone, Copy, Debug)]
pub struct Hops {
    start: SpatialState,
    /// The cloth on which the ball lands.
    pub cloth: Cloth,
    radius: f64,
    /// Time of the first landing, s since the start, and its vertical speed, m/s.
    first_landing: f64,
    landing_speed: f64,
    /// Direction of the slip at the start, and its magnitude, m/s.
    direction: DVec2,
    slip: f64,
    /// Friction impulse per mass of the first landing, m/s.
    friction_impulse: f64,
    /// Index, from zero, of the landing at which the slip becomes zero; `None` if the ball still slides after the last hop.
    sticks: Option<u32>,
    /// Duration of flight and hops, s.
    pub duration: f64,
    /// Velocity along the cloth after the last hop, m/s. All earlier ones lie between the initial velocity and this one.
    pub last_velocity: DVec2,
}

impl Hops {
    /// Computes the trajectory of a ball in the air, or of one that leaves the cloth.
    pub fn new(constants: &Constants, cloth: &Cloth, start: &SpatialState) -> Self {
        let Cloth { restitution: e, friction, gravity: g } = *cloth;
        let radius = constants.radius;
        let (height, climb) = (start.position.z.max(0.0), start.velocity.z);
        let landing = climb.mul_add(climb, 2.0 * g * height).sqrt();
        // Without cancellation for both signs of the vertical velocity.
        let first = if climb > 0.0 { (climb + landing) / g } else { 2.0 * height / (landing - climb) };
        let u = slip(radius, start.velocity.truncate(), start.spin);
        let size = u.length();
        let friction_impulse = friction * (1.0 + e) * landing;
        let mut hops = Self {
            start: *start,
            cloth: *cloth,
            radius,
            first_landing: if landing > 0.0 { first } else { 0.0 },
            landing_speed: landing,
            direction: if size > 0.0 { u / size } else { DVec2::ZERO },
            slip: size,
            friction_impulse,
            sticks: None,
            duration: 0.0,
            last_velocity: DVec2::ZERO,
        };
        hops.sticks = hops.sticking();
        hops.duration = hops.first_landing + hops.per_speed() * landing * e / (1.0 - e);
        hops.last_velocity = match hops.sticks {
            Some(_) => hops.rolling(),
            None => hops.motion_after_friction(friction_impulse / (1.0 - e)).0,
        };
        hops
    }

    /// Returns `(1 - eⁿ) / (1 - e)`: the sum of the first `n` powers of the restitution.
    fn power_sum(&self, count: u32) -> f64 {
        let e = self.cloth.restitution;
        if count <= FEW {
            (0..count).fold(0.0, |sum, _| sum * e + 1.0)
        } else {
            -libm::expm1(self.log_power(count)) / (1.0 - e)
        }
    }

    /// Returns `ln e`.
    fn log_restitution(&self) -> f64 {
        libm::log1p(self.cloth.restitution - 1.0)
    }

    /// Returns `n ln e`.
    fn log_power(&self, count: u32) -> f64 {
        f64::from(count) * self.log_restitution()
    }

    /// Returns `eⁿ`.
    fn power(&self, count: u32) -> f64 {
        if count <= FEW {
            (0..count).fold(1.0, |power, _| power * self.cloth.restitution)
        } else {
            libm::exp(self.log_power(count))
        }
    }

    /// Returns the first landing at which friction would remove the remaining slip.
    fn sticking(&self) -> Option<u32> {
        let least = self.slip / (3.5 * self.friction_impulse);
        let e = self.cloth.restitution;
        // NaN if there is neither slip nor friction.
        if least.is_nan() || least <= 1.0 {
            return Some(0);
        }
        let left = (1.0 - e).mul_add(-least, 1.0);
        if left <= 0.0 {
            return None;
        }
        // The rounded logarithm may be off by one.
        let near = (libm::log(left) / self.log_restitution()).ceil().min(1e6) as u32;
        (near.saturating_sub(2)..=near + 1).find(|&landing| self.power_sum(landing + 1) >= least)
    }

    /// Returns the duration of a hop per m/s of its initial vertical speed, s²/m.
    fn per_speed(&self) -> f64 {
        2.0 / self.cloth.gravity
    }

    /// Returns the velocity along the cloth when the slip is zero, m/s.
    fn rolling(&self) -> DVec2 {
        self.start.velocity.truncate() - (2.0 / 7.0 * self.slip) * self.direction
    }

    /// Returns velocity along the cloth and spin after `landings` landings.
    fn motion(&self, landings: u32) -> (DVec2, DVec3) {
        if self.sticks.is_some_and(|last| landings > last) {
            return self.rolls();
        }
        self.motion_after_friction(self.friction_impulse * self.power_sum(landings))
    }

    fn rolls(&self) -> (DVec2, DVec3) {
        let velocity = self.rolling();
        (velocity, rolling_spin(self.radius, velocity).extend(self.start.spin.z))
    }

    /// Returns velocity along the cloth and spin after a total friction impulse per mass of `friction`, m/s.
    fn motion_after_friction(&self, friction: f64) -> (DVec2, DVec3) {
        let impulse = -friction * self.direction;
        (
            self.start.velocity.truncate() + impulse,
            self.start.spin + spin_change_by_cloth(self.radius, impulse).extend(0.0),
        )
    }

    /// Returns the centre at the landing with this index, m.
    fn landing_position(&self, landing: u32) -> DVec2 {
        let e = self.cloth.restitution;
        let velocity = self.start.velocity.truncate();
        let slides = self.sticks.map_or(landing, |last| last.min(landing));
        let sum = self.power_sum(slides);
        let friction = self.friction_impulse * sum * self.power_sum(slides + 1) / (1.0 + e);
        let mut displacement = e * (sum * velocity - friction * self.direction);
        if landing > slides {
            displacement += self.power(slides + 1) * self.power_sum(landing - slides) * self.rolling();
        }
        self.touchdown() + self.per_speed() * self.landing_speed * displacement
    }

    /// Returns the position of the first landing, m.
    fn touchdown(&self) -> DVec2 {
        self.start.position.truncate() + self.first_landing * self.start.velocity.truncate()
    }

    /// Returns the state of the ball on the cloth after the last hop.
    pub fn end(&self) -> BallState {
        let e = self.cloth.restitution;
        let (position, (velocity, spin)) = if let Some(last) = self.sticks {
            let rest = self.power(last + 1) / (1.0 - e);
            (self.landing_position(last) + self.per_speed() * self.landing_speed * rest * self.rolling(), self.rolls())
        } else {
            let sum = 1.0 / (1.0 - e);
            let displacement =
                e * sum * (self.start.velocity.truncate() - self.friction_impulse * sum / (1.0 + e) * self.direction);
            (
                self.touchdown() + self.per_speed() * self.landing_speed * displacement,
                self.motion_after_friction(self.friction_impulse * sum),
            )
        };
        BallState { position, velocity, spin }
    }

    /// Returns the flight after `landings` landings.
    pub fn arc(&self, landings: u32) -> Arc {
        if landings == 0 {
            let SpatialState { position, velocity, .. } = self.start;
            return Arc { begin: 0.0, end: self.first_landing, position, velocity };
        }
        let climb = self.landing_speed * self.power(landings);
        let begin = self.first_landing
            + self.per_speed() * self.landing_speed * self.cloth.restitution * self.power_sum(landings - 1);
        Arc {
            begin,
            end: begin + self.per_speed() * climb,
            position: self.landing_position(landings - 1).extend(0.0),
            velocity: self.motion(landings).0.extend(climb),
        }
    }

    /// Returns the number of landings `t` seconds after the start.
    pub fn landings(&self, t: f64) -> u32 {
        let e = self.cloth.restitution;
        if t < self.first_landing || e == 0.0 {
            return 0;
        }
        let since = (t - self.first_landing) / (self.per_speed() * self.landing_speed * e);
        let left = (1.0 - e).mul_add(-since, 1.0);
        if left <= 0.0 {
            u32::MAX
        } else {
            1 + (libm::log(left) / self.log_restitution()).floor().clamp(0.0, 1e9) as u32
        }
    }

    /// Returns position, velocity and spin `t` seconds after the start.
    pub fn state_after(&self, t: f64) -> SpatialState {
        let landings = self.landings(t);
        if landings == u32::MAX || t >= self.duration {
            return self.end().into();
        }
        let arc = self.arc(landings);
        let (_, spin) = self.motion(landings);
        let after = t - arc.begin;
        let fallen = self.cloth.gravity * after;
        let mut position = arc.position + after * arc.velocity;
        position.z = (position.z - 0.5 * fallen * after).max(0.0);
        SpatialState { position, velocity: arc.velocity - fallen * DVec3::Z, spin }
    }

    /// Returns the greatest speed along the cloth from that arc on, m/s.
    pub fn fastest(&self, arc: &Arc) -> f64 {
        // The velocities lie on a line segment, so that the largest is at one of its ends.
        arc.velocity.truncate().length_squared().max(self.last_velocity.length_squared()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::table::Table;

    fn constants() -> Constants {
        Constants::of(&Table::preset("textbook").unwrap())
    }

    /// Reference: simulates the landings one by one until hops are too low to matter.
    fn one_by_one(constants: &Constants, cloth: &Cloth, start: &SpatialState) -> (f64, SpatialState) {
        let (mut ball, mut time) = (*start, 0.0);
        for _ in 0..20_000 {
            let speed = (ball.velocity.z.powi(2) + 2.0 * cloth.gravity * ball.position.z).sqrt();
            if speed < 1e-15 {
                break;
            }
            let flight = (ball.velocity.z + speed) / cloth.gravity;
            ball.position += (flight * ball.velocity.truncate()).extend(-ball.position.z);
            ball.velocity.z = -speed;
            cloth.resolve(constants.radius, &mut ball);
            time += flight;
        }
        (time, ball)
    }

    fn started(height: f64, velocity: [f64; 3], spin: [f64; 3]) -> SpatialState {
        SpatialState {
            position: DVec3::new(0.1, -0.2, height),
            velocity: DVec3::from_array(velocity),
            spin: DVec3::from_array(spin),
        }
    }

    proptest! {
        #[test]
        fn closed_form_sums_equal_stepwise_landings(
            height in prop_oneof![Just(0.0), 0.0..0.3f64],
            velocity in [-5.0..5.0f64, -5.0..5.0, -3.0..4.0],
            spin in [-150.0..150.0f64, -150.0..150.0, -99.0..99.0],
            restitution in prop_oneof![Just(0.0), Just(0.5), Just(0.99), 0.0..0.95f64],
            friction in 0.02..0.6f64,
        ) {
            let constants = constants();
            let cloth = Cloth { restitution, friction, gravity: 9.81 };
            let mut start = started(height, velocity, spin);
            if height == 0.0 {
                start.velocity.z = start.velocity.z.abs();
            }
            let hops = Hops::new(&constants, &cloth, &start);
            let (time, ball) = one_by_one(&constants, &cloth, &start);
            let end = hops.end();
            prop_assert!((time - hops.duration).abs() < 1e-11, "{time} {}", hops.duration);
            prop_assert!(end.position.distance(ball.position.truncate()) < 1e-10);
            prop_assert!(end.velocity.distance(ball.velocity.truncate()) < 1e-12);
            prop_assert!(end.spin.distance(ball.spin) < 1e-9);
        }

        #[test]
        fn arcs_are_contiguous_and_contain_the_state(
            velocity in [-5.0..5.0f64, -5.0..5.0, 0.1..4.0],
            spin in [-150.0..150.0f64, -150.0..150.0, -99.0..99.0],
            restitution in prop_oneof![Just(0.5), Just(0.99), 0.1..0.95f64],
        ) {
            let constants = constants();
            let cloth = Cloth { restitution, friction: 0.2, gravity: 9.81 };
            let hops = Hops::new(&constants, &cloth, &started(0.01, velocity, spin));
            for landings in 0..12 {
                let (arc, next) = (hops.arc(landings), hops.arc(landings + 1));
                prop_assert!((arc.end - next.begin).abs() < 1e-13);
                let displacement = arc.position.truncate() + (arc.end - arc.begin) * arc.velocity.truncate();
                prop_assert!(displacement.distance(next.position.truncate()) < 1e-12);
                let middle = 0.5 * (arc.begin + arc.end);
                prop_assert_eq!(hops.landings(middle), landings);
                let state = hops.state_after(middle);
                prop_assert!(state.position.z > 0.0 && state.velocity.truncate() == arc.velocity.truncate());
            }
        }
    }

    #[test]
    fn ball_dropped_without_slip_lands_in_place() {
        let constants = constants();
        let cloth = Cloth { restitution: 0.5, friction: 0.2, gravity: 9.81 };
        let hops = Hops::new(&constants, &cloth, &started(0.05, [0.0; 3], [0.0, 0.0, 20.0]));
        let fall = (2.0 * 0.05 / 9.81_f64).sqrt();
        assert!((hops.duration - 3.0 * fall).abs() < 1e-15, "once down, and twice as long up and down in all");
        assert_eq!(hops.end().position, DVec2::new(0.1, -0.2));
        assert_eq!(hops.end().spin, DVec3::new(0.0, 0.0, 20.0));
    }
}
