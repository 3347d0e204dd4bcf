//! A shot in the numbers and words of a player: how full, how much side, how hard, and which cushions.

mod difference;
mod flight;
mod numbers;
mod pace;
mod sentence;
#[cfg(test)]
mod tests;
mod units;

use glam::DVec2;
use serde::Serialize;

pub use flight::{height_words, jump_words, no_jump_words};
use numbers::clock;
pub use numbers::fullness_word;
pub(super) use numbers::{NUMBERS, SIXTEENTHS, number_word};
pub(super) use pace::PACES;
pub use pace::{lengths_words, pace_word, table_lengths};
pub(crate) use sentence::capital;
pub use units::{LengthUnit, PlaceUnit, TipUnit, Units, short};

use super::{Cushion, Hit, RailPoint, Technique, line_of_aim};
use crate::{
    physics::{CueInputs, least_elevation},
    simulation::{Recording, ShotError},
    table::{Layout, Table},
};

/// A tip of side in ball radii, 3 mm of a carom ball. Systems and books give side in tips and hardly ever say how long one is;
/// four to five of a tenth of the radius are as far as a tip holds (half a radius), which is how far players count.
pub const TIP: f64 = 0.1;

/// Least english that is told, R w / v.
const TOLD: f64 = 0.1;

/// Elevation below which a cue is called level, degrees: no player tells it from one that is.
const LEVEL: f64 = 2.0;

/// How near the least elevation a cue counts as level as it can be, rad: half a degree.
const LEAST: f64 = 0.5_f64.to_radians();

/// Elevation from which such a cue is no longer called level, degrees: the rail behind the ball alone asks for two or three.
const RAISED: f64 = 5.0;

/// What side does at the first cushion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum English {
    /// The rebound is longer for it.
    Running,
    /// It is shorter.
    Reverse,
}

/// A shot in the numbers of a player.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShotWords {
    /// How the object ball is met that comes first; `None` where none is.
    pub first: Option<Hit>,
    /// How the other one is met.
    pub second: Option<Hit>,
    /// The object ball over which the cue ball flies before it meets anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over: Option<usize>,
    /// Tips of side, to the right for one who looks along the cue; less is left.
    pub tips_right: f64,
    /// Tips above the centre; less is below.
    pub tips_above: f64,
    /// The hour of the clock at which the tip meets the ball, to half an hour; `None` in the middle.
    pub clock: Option<f64>,
    /// What the side does at the first cushion, if it does much.
    pub english: Option<English>,
    /// Table lengths that a ball runs on this table which is struck so in the middle.
    pub table_lengths: f64,
    /// The cue's elevation, degrees.
    pub elevation_deg: f64,
    /// Whether it is the least that rails and balls behind the cue ball allow.
    pub is_level: bool,
    /// Cushions before the first ball, in order.
    pub before: Vec<Cushion>,
    /// Cushions from there to the second ball, in order.
    pub between: Vec<Cushion>,
    /// After how many of those the first ball is met again, if it is.
    #[serde(skip)]
    again: Option<usize>,
    /// Where the cue points.
    pub ahead: RailPoint,
    /// Where it comes from.
    pub behind: RailPoint,
    /// The way that the cue points, of length 1.
    #[serde(skip)]
    direction: DVec2,
    /// Ball radius, m.
    #[serde(skip)]
    radius: f64,
    /// A diamond, m.
    #[serde(skip)]
    diamond: f64,
}

impl ShotWords {
    /// What a player calls this shot.
    ///
    /// # Errors
    /// What is wrong with the layout or the stroke.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        let recording = Recording::new(table, layout, cue)?;
        Ok(Self::of_technique(table, layout, cue, &Technique::of_recorded(table, &recording)))
    }

    /// The same of a shot that has been looked at.
    pub fn of_technique(table: &Table, layout: &Layout, cue: &CueInputs, technique: &Technique) -> Self {
        let [ahead, behind] = line_of_aim(table, layout, cue.phi);
        let (tips_right, tips_above) = (-cue.a / TIP + 0.0, cue.b / TIP);
        let least = least_elevation(table, layout, cue).map_or(0.0, |least| least.theta);
        let first = technique.first;
        let english = match technique.english {
            english if english > TOLD => Some(English::Running),
            english if english < -TOLD => Some(English::Reverse),
            _ => None,
        };
        Self {
            first,
            second: technique.second,
            over: technique.over,
            tips_right,
            tips_above,
            clock: clock(tips_right, tips_above),
            english,
            // Every stroke that can be played runs some way.
            table_lengths: table_lengths(table, cue.speed).unwrap_or_default(),
            elevation_deg: cue.theta.to_degrees(),
            is_level: cue.theta - least <= LEAST,
            before: technique.before.clone(),
            between: technique.between.clone(),
            again: technique.again,
            ahead,
            behind,
            direction: DVec2::from_angle(cue.phi),
            radius: table.radius,
            diamond: table.diamond(),
        }
    }

    /// Whether players call the cue level.
    pub fn has_level_cue(&self) -> bool {
        self.elevation_deg < LEVEL || self.is_level && self.elevation_deg < RAISED
    }
}
