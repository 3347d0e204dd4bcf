//! The cue strike: computes the ball's velocity and spin from the player's five inputs (thesis 2.2.1).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::{Cloth, SpatialState};
use crate::table::{Table, is_default};

/// Fastest accepted ball, m/s: a light ball leaves the fastest cue at twice the cue's speed.
const MAX_BALL_SPEED: f64 = 2.0 * CueInputs::MAX_SPEED;

/// Fastest accepted spin, rad/s: approximately that of a 30 mm ball that is struck at its edge and leaves at that speed.
const MAX_SPIN: f64 = 20_000.0;

/// The five inputs of a stroke (thesis Figures 4 and 5).
///
/// In JSON the angles are in degrees and called `theta_deg` and `phi_deg`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "CueDegrees", into = "CueDegrees")]
pub struct CueInputs {
    /// Horizontal offset of the tip from the ball's centre in units of R. For positive `a` the spin `w_z` is negative (thesis equation 16):
    /// the tip is to the *left* of the centre for the player behind the cue.
    pub a: f64,
    /// Vertical offset of the tip in units of R, positive above the centre.
    pub b: f64,
    /// Elevation of the cue above the cloth, rad.
    pub theta: f64,
    /// Direction of the stroke, counter-clockwise from the x axis, rad.
    pub phi: f64,
    /// Speed `V` of the cue just before impact, m/s.
    pub speed: f64,
}

/// The five inputs of [`CueInputs`] with the angles in degrees, as people read and write them. Converting radians back to degrees would
/// lose the last bit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CueDegrees {
    /// Horizontal offset of the tip in units of R.
    pub a: f64,
    /// Vertical offset of the tip in units of R.
    pub b: f64,
    /// Elevation of the cue, degrees.
    pub theta_deg: f64,
    /// Direction of the stroke, degrees.
    pub phi_deg: f64,
    /// Speed of the cue, m/s.
    pub speed: f64,
}

impl CueDegrees {
    /// A level stroke through the ball's centre.
    pub const fn centre(phi_deg: f64, speed: f64) -> Self {
        Self { a: 0.0, b: 0.0, theta_deg: 0.0, phi_deg, speed }
    }
}

impl From<CueDegrees> for CueInputs {
    fn from(cue: CueDegrees) -> Self {
        Self { a: cue.a, b: cue.b, theta: cue.theta_deg.to_radians(), phi: cue.phi_deg.to_radians(), speed: cue.speed }
    }
}

impl From<CueInputs> for CueDegrees {
    fn from(cue: CueInputs) -> Self {
        Self { a: cue.a, b: cue.b, theta_deg: cue.theta.to_degrees(), phi_deg: cue.phi.to_degrees(), speed: cue.speed }
    }
}

/// Why a stroke is refused.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum CueError {
    /// The tip misses the ball or slips off it.
    #[error(
        "the tip at a = {a}, b = {b} {} the ball: a² + b² is {offset:.4}, at most {limit} is accepted",
        if *offset <= 1.0 { "slips off" } else { "misses" }
    )]
    Tip {
        /// Horizontal offset in units of R.
        a: f64,
        /// Vertical offset in units of R.
        b: f64,
        /// The sum of their squares.
        offset: f64,
        /// The largest accepted sum.
        limit: f64,
    },
    /// An input is outside its range.
    #[error("{name} = {value} is outside its range; accepted is {accepted}")]
    Range {
        /// Name of the input.
        name: &'static str,
        /// Its value, angles in degrees.
        value: f64,
        /// What would be accepted.
        accepted: &'static str,
    },
    /// The text is not a stroke.
    #[error("\"{0}\" is not a shot; write \"a,b,theta,phi,V\" like \"0,0.2,5,12.5,3\" (radii, degrees, m/s)")]
    Text(String),
}

/// Why an initial motion of the cue ball is refused.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum ImpulseError {
    /// The velocity along the cloth, m/s, is not a number or is too large.
    #[error("velocity = {0} m/s is not accepted; accepted are finite numbers and at most {MAX_BALL_SPEED} m/s")]
    Velocity(DVec2),
    /// The upward velocity, m/s, is not a number, negative or too large.
    #[error("velocity has {0} m/s upwards; accepted are 0 to {MAX_BALL_SPEED} m/s")]
    Lift(f64),
    /// The spin, rad/s, is not a number or is too large.
    #[error("spin = {0} rad/s is not accepted; accepted are finite numbers and at most {MAX_SPIN} rad/s")]
    Spin(DVec3),
}

/// Returns the angle from one direction to another, rad, between -π and π: whole turns are removed.
pub fn signed_angle(from: f64, to: f64) -> f64 {
    let turn = to - from;
    turn - TAU * (turn / TAU).round()
}

impl CueInputs {
    /// Fastest accepted cue, m/s. The fastest human break shots stay below 20 m/s.
    pub const MAX_SPEED: f64 = 100.0;

    /// Checks that the tip meets the ball (thesis equation 46) and that every input is in its range.
    ///
    /// # Errors
    /// The first problem found.
    pub fn validate(&self) -> Result<(), CueError> {
        self.validate_tip(1.0)?;
        let range = |name, value, accept: bool, accepted| {
            if accept { Ok(()) } else { Err(CueError::Range { name, value, accepted }) }
        };
        let theta = self.theta.to_degrees();
        range("theta", theta, (0.0..90.0).contains(&theta), "0 to below 90 degrees")?;
        let phi = self.phi.to_degrees();
        range("phi", phi, phi.abs() <= 36_000.0, "-36000 to 36000 degrees")?;
        let speed_ok = self.speed > 0.0 && self.speed <= Self::MAX_SPEED;
        range("V", self.speed, speed_ok, "above 0 and at most 100 m/s")
    }

    /// Checks that the tip does not slip: either the squared tip offset `a² + b²` or the squared distance of the cue's line from the
    /// centre, [`Self::offset_across_squared`], both in units of R², must be at most `limit`. [`Table::miscue_limit`] is the value at
    /// which a real tip starts to slip.
    /// For a level cue both measures are equal. The second one lets a steep cue hit the ball further up; the first one keeps a low tip
    /// accepted if the cue is slightly raised.
    ///
    /// # Errors
    /// [`CueError::Tip`] if both are larger or not a number.
    pub fn validate_tip(&self, limit: f64) -> Result<(), CueError> {
        let offset = self.tip_offset_squared();
        // The comparisons are written so that NaN is refused.
        let holds = offset <= limit || offset <= 1.0 && self.offset_across_squared() <= limit;
        if holds { Ok(()) } else { Err(CueError::Tip { a: self.a, b: self.b, offset, limit }) }
    }

    /// Whether the tip slips off the ball on this table. The shot then moves no ball and scores no point.
    pub fn is_miscue(&self, table: &Table) -> bool {
        self.validate_tip(table.miscue_limit).is_err()
    }

    /// Returns the squared distance of the cue's line from the ball's centre in units of R²: `a² + (b cos theta - c sin theta)²`, as in
    /// thesis equation 9. For a level cue it is `a² + b²`. A point on the far side, which the cue could only reach through the ball, has
    /// the maximum, 1.
    pub fn offset_across_squared(&self) -> f64 {
        let (sin, cos) = libm::sincos(self.theta);
        let c = (1.0 - self.tip_offset_squared()).max(0.0).sqrt();
        let lever = self.b * cos - c * sin;
        let faces_cue = c * cos + self.b * sin > 0.0;
        if faces_cue { self.a * self.a + lever * lever } else { 1.0 }
    }

    /// Returns `a² + b²`, in units of R².
    pub fn tip_offset_squared(&self) -> f64 {
        self.a * self.a + self.b * self.b
    }

    /// Formats the direction in degrees in the range 0 to below 360, with `decimals` decimals. Strokes accept and use any number of whole
    /// turns.
    pub fn phi_text(&self, decimals: usize) -> String {
        let text = |degrees: f64| format!("{degrees:.decimals$}");
        // Adding zero turns minus zero into zero.
        let degrees = text(self.phi.to_degrees().rem_euclid(360.0) + 0.0);
        // A value that rounds to 360 is displayed as 0.
        if degrees == text(360.0) { text(0.0) } else { degrees }
    }

    /// Parses `"a,b,theta,phi,V"`: radii, degrees, m/s. The values are not checked: see [`CueInputs::validate`].
    ///
    /// # Errors
    /// [`CueError::Text`].
    pub fn parse(text: &str) -> Result<Self, CueError> {
        let refuse = || CueError::Text(text.to_owned());
        let numbers: Vec<f64> =
            text.split(',').map(|part| part.trim().parse()).collect::<Result<_, _>>().map_err(|_| refuse())?;
        let [a, b, theta_deg, phi_deg, speed] = numbers[..] else { return Err(refuse()) };
        Ok(CueDegrees { a, b, theta_deg, phi_deg, speed }.into())
    }
}

/// Motion of the cue ball just after the stroke: the equivalent ball impulse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Impulse {
    /// Initial velocity `V0` along the cloth, m/s.
    pub velocity: DVec2,
    /// Initial angular velocity `w0`, rad/s.
    pub spin: DVec3,
    /// Upward velocity after the impulse of the cloth, m/s: zero on a table that keeps its balls on the cloth.
    #[serde(skip_serializing_if = "is_default")]
    pub lift: f64,
}

impl Impulse {
    /// Creates a motion along the cloth.
    pub const fn on_cloth(velocity: DVec2, spin: DVec3) -> Self {
        Self { velocity, spin, lift: 0.0 }
    }

    /// Checks that velocity, spin and lift are finite and within their limits. A ball at rest is accepted: it stays where it is,
    /// unless it spins about a horizontal axis.
    ///
    /// # Errors
    /// The first problem found.
    pub fn validate(&self) -> Result<(), ImpulseError> {
        let Self { velocity, spin, lift } = *self;
        let is_within = |length: f64, most: f64| (0.0..=most).contains(&length);
        if !is_within(velocity.length(), MAX_BALL_SPEED) {
            return Err(ImpulseError::Velocity(velocity));
        }
        if !is_within(lift, MAX_BALL_SPEED) {
            return Err(ImpulseError::Lift(lift));
        }
        if !is_within(spin.length(), MAX_SPIN) {
            return Err(ImpulseError::Spin(spin));
        }
        Ok(())
    }
}

/// Returns the squirt angle for a side offset `a`, rad, counter-clockwise from the cue's direction: a tip on the left deflects the ball to
/// the right. Zero on a table without an end mass of the cue.
///
/// Squirt occurs because the ball's rotation pushes the end of the cue aside (Alciatore, TP A.31).
pub fn squirt(table: &Table, a: f64) -> f64 {
    table.cue_end_mass.map_or(0.0, |end| {
        let rest = 1.0 - a * a;
        let along = 1.0 + table.ball_mass / end + 2.5 * rest;
        -libm::atan(2.5 * a * rest.max(0.0).sqrt() / along)
    })
}

/// Returns velocity and spin of the cue ball just after the stroke (thesis equations 9, 15 and 16), in the direction of squirt. If balls
/// can leave the cloth, the downward part of (15) presses the ball into the cloth, which responds at the same moment with friction and
/// restitution.
pub fn strike(table: &Table, cue: &CueInputs) -> Impulse {
    let (a, b) = (cue.a, cue.b);
    let c = (1.0 - cue.tip_offset_squared()).max(0.0).sqrt();
    let (sin_theta, cos_theta) = libm::sincos(cue.theta);
    let (sin_phi, cos_phi) = libm::sincos(cue.phi + squirt(table, a));
    // (9) per ball mass. The last three terms of (9) are the square of b cos - c sin.
    let lever = b * cos_theta - c * sin_theta;
    let force = 2.0 * cue.speed / (1.0 + table.ball_mass / table.cue_mass + 2.5 * (a * a + lever * lever));
    // F R / I with I = 2/5 m R².
    let torque = 2.5 * force / table.radius;
    let velocity = force * cos_theta * DVec2::new(cos_phi, sin_phi);
    let spin = torque
        * DVec3::new(
            -lever * sin_phi - a * sin_theta * cos_phi,
            lever * cos_phi - a * sin_theta * sin_phi,
            -a * cos_theta,
        );
    match Cloth::of(table) {
        Some(cloth) if sin_theta > 0.0 => {
            let pressed = velocity.extend(-force * sin_theta);
            let mut ball = SpatialState { position: DVec3::ZERO, velocity: pressed, spin };
            cloth.resolve(table.radius, &mut ball);
            Impulse { velocity: ball.velocity.truncate(), spin: ball.spin, lift: ball.velocity.z }
        }
        _ => Impulse::on_cloth(velocity, spin),
    }
}

/// Returns the stroke with a level cue that gives the cue ball this motion, the inverse of [`strike`]. `None` if there is no such stroke:
/// the ball does not move, or the tip would have to be outside the ball's outline. Spin about the direction of motion is ignored, because a
/// level cue does not create it.
pub fn level_stroke(table: &Table, impulse: &Impulse) -> Option<CueInputs> {
    let Impulse { velocity, spin, .. } = *impulse;
    let speed = velocity.length();
    let ahead = velocity.try_normalize()?;
    // (15) and (16) at theta = 0: `w R` is 5/2 of the speed times the tip offset.
    let tip = table.radius / (2.5 * speed);
    let (a, b) = (-tip * spin.z, tip * spin.truncate().dot(ahead.perp()));
    let offset = a * a + b * b;
    let cue_speed = 0.5 * speed * (1.0 + table.ball_mass / table.cue_mass + 2.5 * offset);
    let phi = libm::atan2(velocity.y, velocity.x) - squirt(table, a);
    (offset <= 1.0).then_some(CueInputs { a, b, theta: 0.0, phi, speed: cue_speed })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thesis_figure_35_is_reproduced_to_its_own_rounding() {
        let table = Table::preset("thesis").unwrap();
        let cue = CueInputs::parse("-0.204,-0.440,24.379,-1.020,3.977").unwrap();
        let impulse = strike(&table, &cue);
        assert!(impulse.velocity.abs_diff_eq(DVec2::new(2.461, -0.044), 5.1e-4), "{impulse:?}");
        // The inputs are rounded to 5e-4, which changes the spin by up to 0.1 rad/s.
        assert!(impulse.spin.abs_diff_eq(DVec3::new(15.628, -169.046, 41.122), 0.15), "{impulse:?}");
    }

    #[test]
    fn a_tip_beyond_the_ball_and_not_a_number_are_refused() {
        let cue = |text| CueInputs::parse(text).unwrap().validate().unwrap_err().to_string();
        assert!(cue("0.8,0.8,0,0,1").contains("1.2800"));
        assert!(cue("NaN,0,0,0,1").contains("NaN"));
        assert!(cue("0,0,90,0,1").contains("theta = 90"));
        assert!(cue("0,0,0,inf,1").contains("phi"));
        assert!(cue("0,0,0,0,0").contains("V = 0"));
        assert!(CueInputs::parse("1,2,3").unwrap_err().to_string().contains("1,2,3"));
    }

    #[test]
    fn level_stroke_is_recovered_from_its_motion() {
        for table in [Table::default(), Table::preset("thesis").unwrap()] {
            for stroke in ["0,0,0,0,1", "0.3,-0.2,0,140,3", "-0.4,0.4,0,-80,0.2"] {
                let cue = CueInputs::parse(stroke).unwrap();
                let found = level_stroke(&table, &strike(&table, &cue)).unwrap();
                let [wanted, found] = [cue, found].map(|cue| [cue.a, cue.b, cue.theta, cue.phi, cue.speed]);
                assert!(wanted.iter().zip(found).all(|(one, other)| (one - other).abs() < 1e-12), "{found:?}");
            }
        }
        let motion = |speed: f64, side| Impulse::on_cloth(DVec2::X * speed, DVec3::Z * side);
        assert_eq!(level_stroke(&Table::default(), &motion(0.0, 10.0)), None);
        assert_eq!(level_stroke(&Table::default(), &motion(0.1, 10.0)), None, "a = -1.2");
    }

    #[test]
    fn impossible_motion_is_refused_with_its_values() {
        let impulse = Impulse::on_cloth;
        let still = impulse(DVec2::ZERO, DVec3::ZERO);
        assert_eq!(still.validate(), Ok(()));
        let refused = |impulse: Impulse| impulse.validate().unwrap_err().to_string();
        assert!(refused(Impulse { velocity: DVec2::new(f64::NAN, 1.0), ..still }).contains("velocity = [NaN, 1]"));
        assert!(refused(Impulse { velocity: DVec2::new(0.0, 200.1), ..still }).contains("at most 200 m/s"));
        assert!(refused(Impulse { spin: DVec3::new(0.0, f64::INFINITY, 0.0), ..still }).contains("spin = [0, inf, 0]"));
        // The fastest stroke with the tip at the ball's edge is accepted.
        let hardest = CueInputs { a: 1.0, b: 0.0, theta: 0.0, phi: 0.0, speed: CueInputs::MAX_SPEED };
        assert_eq!(strike(&Table::default(), &hardest).validate(), Ok(()));
    }

    #[test]
    fn squirt_of_half_a_radius_matches_the_published_angle() {
        let table = Table { cue_end_mass: Some(0.005), ball_mass: 0.17, ..Table::default() };
        // TP A.31's formula by hand: atan(1.25 · 0.866 / (1 + 34 + 1.875)).
        let angle = squirt(&table, 0.5);
        assert!((angle + (1.25 * 0.75_f64.sqrt() / 36.875).atan()).abs() < 1e-15);
        let cue = CueInputs { a: 0.5, b: 0.0, theta: 0.0, phi: 1.0, speed: 2.0 };
        assert!((strike(&table, &cue).velocity.to_angle() - (1.0 + angle)).abs() < 1e-14);
        assert_eq!(squirt(&Table::preset("thesis").unwrap(), 0.5), 0.0);
    }

    #[test]
    fn directions_are_formatted_from_0_to_below_360_degrees() {
        let formatted = |degrees: f64| {
            CueInputs { phi: degrees.to_radians(), ..CueInputs::parse("0,0,0,0,1").unwrap() }.phi_text(2)
        };
        let directions = [-27.0, 333.0, 0.0, -0.001, 359.999, 720.5, -0.0].map(formatted);
        assert_eq!(directions, ["333.00", "333.00", "0.00", "0.00", "0.00", "0.50", "0.00"]);
    }

    #[test]
    fn json_uses_degrees() {
        let json = r#"{"a":0.1,"b":0.2,"theta_deg":10.0,"phi_deg":90.0,"speed":3.0}"#;
        let cue: CueInputs = serde_json::from_str(json).unwrap();
        assert!((cue.phi - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!(serde_json::to_string(&cue).unwrap().contains("\"phi_deg\":90.0"));
    }

    #[test]
    fn steep_cue_can_strike_near_the_top_and_level_cue_cannot() {
        let table = Table::preset("textbook").unwrap();
        let cue = |theta: &str| CueInputs::parse(&format!("0.2,0.9,{theta},0,2")).unwrap();
        let (level, steep) = (cue("5"), cue("75"));
        assert!(level.is_miscue(&table) && !steep.is_miscue(&table));
        // The cue's line passes the centre at less than half a radius.
        assert!(steep.offset_across_squared() < 0.25, "{}", steep.offset_across_squared());
        let flat = CueInputs { theta: 0.0, ..level };
        assert!((flat.offset_across_squared() - flat.tip_offset_squared()).abs() < 1e-15);
        // A steep cue does not reach the ball's lower half, and an offset beyond the ball's outline misses it.
        let below = CueInputs { b: -0.9, ..steep };
        assert!(below.is_miscue(&table));
        let beside = CueInputs { a: 0.6, b: 0.9, ..steep };
        assert!(beside.is_miscue(&table) && beside.validate_tip(1.0).is_err());
    }
}
