//! A shot as the studies keep it: with the very numbers that a person would write, so that a failure can be repeated.

use serde::{Deserialize, Serialize};

use crate::{physics::CueInputs, table::Layout};

/// A layout and a stroke. The stroke's angles stay in degrees: turning radians back into degrees would lose the last bit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shot {
    /// Where the balls lie.
    pub layout: Layout,
    /// How the cue ball is struck.
    pub cue: Stroke,
}

/// The five inputs of a stroke, as [`CueInputs`] but in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stroke {
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

impl Stroke {
    /// A level stroke through the ball's centre.
    pub const fn centre(phi_deg: f64, speed: f64) -> Self {
        Self { a: 0.0, b: 0.0, theta_deg: 0.0, phi_deg, speed }
    }

    /// The same stroke as the physics takes it, by the conversion that reads it from JSON.
    pub fn inputs(&self) -> CueInputs {
        CueInputs {
            a: self.a,
            b: self.b,
            theta: self.theta_deg.to_radians(),
            phi: self.phi_deg.to_radians(),
            speed: self.speed,
        }
    }
}
