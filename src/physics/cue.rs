//! The cue strike: from the player's five inputs to the ball's velocity and spin (thesis 2.2.1).

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::table::Table;

/// Fastest cue that is accepted, m/s. The fastest human break shots stay below 20 m/s.
const MAX_SPEED: f64 = 100.0;

/// The five inputs of a stroke (thesis Figures 4 and 5).
///
/// In JSON the angles are in degrees and called `theta_deg` and `phi_deg`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "CueDegrees", into = "CueDegrees")]
pub struct CueInputs {
    /// Horizontal offset of the tip from the ball's centre in units of R. Positive is the side on which the spin
    /// `w_z` comes out negative (thesis equation 16): to the *left* of centre for the player behind the cue.
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

/// The JSON form of [`CueInputs`]: degrees, as people read and write them.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct CueDegrees {
    a: f64,
    b: f64,
    theta_deg: f64,
    phi_deg: f64,
    speed: f64,
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
    /// The tip misses the ball.
    #[error("the tip at a = {a}, b = {b} misses the ball: a² + b² is {offset:.4}, at most {limit} is accepted")]
    Tip {
        /// Horizontal offset in units of R.
        a: f64,
        /// Vertical offset in units of R.
        b: f64,
        /// Their squares' sum.
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

impl CueInputs {
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
        let speed_ok = self.speed > 0.0 && self.speed <= MAX_SPEED;
        range("V", self.speed, speed_ok, "above 0 and at most 100 m/s")
    }

    /// Checks `a² + b² <= limit`; a [`Table`]'s `miscue_limit` is where a real tip begins to slip.
    ///
    /// # Errors
    /// [`CueError::Tip`] where it is larger or not a number.
    pub fn validate_tip(&self, limit: f64) -> Result<(), CueError> {
        let offset = self.tip_offset_squared();
        // Written so that NaN is refused.
        if offset <= limit { Ok(()) } else { Err(CueError::Tip { a: self.a, b: self.b, offset, limit }) }
    }

    /// Whether the tip slips off the ball on this table: no ball is moved then, and no point is made.
    pub fn is_miscue(&self, table: &Table) -> bool {
        self.tip_offset_squared() > table.miscue_limit
    }

    /// `a² + b²`, in units of R².
    pub fn tip_offset_squared(&self) -> f64 {
        self.a * self.a + self.b * self.b
    }

    /// Reads `"a,b,theta,phi,V"`: radii, degrees, m/s. The values are not checked: see [`CueInputs::validate`].
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

/// What a stroke gives the cue ball: the equivalent ball impulse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Impulse {
    /// Initial velocity `V0`, m/s. The vertical part is dropped since z is frozen.
    pub velocity: DVec2,
    /// Initial angular velocity `w0`, rad/s.
    pub spin: DVec3,
}

/// Angle by which the cue ball leaves the cue's direction when it is struck at side `a`, rad, counter-clockwise: a tip on
/// the left sends it off to the right. Zero on a table whose cue has no end mass.
///
/// The end of the cue has to be pushed aside as the ball turns under it (Alciatore, TP A.31).
pub fn squirt(table: &Table, a: f64) -> f64 {
    table.cue_end_mass.map_or(0.0, |end| {
        let rest = 1.0 - a * a;
        let along = 1.0 + table.ball_mass / end + 2.5 * rest;
        -(2.5 * a * rest.max(0.0).sqrt() / along).atan()
    })
}

/// Velocity and spin of the cue ball just after the stroke (thesis equations 9, 15 and 16), along the direction in which
/// the ball squirts.
pub fn strike(table: &Table, cue: &CueInputs) -> Impulse {
    let (a, b) = (cue.a, cue.b);
    let c = (1.0 - cue.tip_offset_squared()).max(0.0).sqrt();
    let (sin_theta, cos_theta) = cue.theta.sin_cos();
    let (sin_phi, cos_phi) = (cue.phi + squirt(table, a)).sin_cos();
    // (9) per ball mass. Its last three terms are the square of b cos - c sin.
    let lever = b * cos_theta - c * sin_theta;
    let force = 2.0 * cue.speed / (1.0 + table.ball_mass / table.cue_mass + 2.5 * (a * a + lever * lever));
    // F R / I with I = 2/5 m R².
    let torque = 2.5 * force / table.radius;
    Impulse {
        velocity: force * cos_theta * DVec2::new(cos_phi, sin_phi),
        spin: torque
            * DVec3::new(
                -lever * sin_phi - a * sin_theta * cos_phi,
                lever * cos_phi - a * sin_theta * sin_phi,
                -a * cos_theta,
            ),
    }
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
        // The inputs are rounded to 5e-4, which moves the spin by up to 0.1 rad/s.
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
    fn half_a_radius_of_side_squirts_by_the_published_angle_to_the_other_side() {
        let table = Table { cue_end_mass: Some(0.005), ball_mass: 0.17, ..Table::default() };
        // TP A.31's formula by hand: atan(1.25 · 0.866 / (1 + 34 + 1.875)).
        let angle = squirt(&table, 0.5);
        assert!((angle + (1.25 * 0.75_f64.sqrt() / 36.875).atan()).abs() < 1e-15);
        let cue = CueInputs { a: 0.5, b: 0.0, theta: 0.0, phi: 1.0, speed: 2.0 };
        assert!((strike(&table, &cue).velocity.to_angle() - (1.0 + angle)).abs() < 1e-14);
        assert_eq!(squirt(&Table::preset("thesis").unwrap(), 0.5), 0.0);
    }

    #[test]
    fn json_speaks_degrees() {
        let json = r#"{"a":0.1,"b":0.2,"theta_deg":10.0,"phi_deg":90.0,"speed":3.0}"#;
        let cue: CueInputs = serde_json::from_str(json).unwrap();
        assert!((cue.phi - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!(serde_json::to_string(&cue).unwrap().contains("\"phi_deg\":90.0"));
    }
}
