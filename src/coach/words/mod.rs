//! A shot in players' numbers and words: fullness, side, speed and cushions.

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
pub(crate) use sentence::capitalize;
pub use units::{LengthUnit, PositionUnit, TipUnit, Units, format_trimmed};

use super::{Cushion, Hit, RailPoint, Technique, line_of_aim};
use crate::{
    physics::{CueInputs, least_elevation},
    simulation::{Recording, ShotError},
    table::{Layout, Table},
};

/// A tip of side in ball radii: 3 mm on a carom ball. Systems and books state side in tips and hardly ever define a
/// tip's size. With a tenth of the radius, four to five tips reach the miscue limit (half a radius), which is as far as
/// players count.
pub const TIP: f64 = 0.1;

/// Minimum english that is reported, R w / v.
const MIN_ENGLISH: f64 = 0.1;

/// Elevation up to which a cue is called level, degrees: the rail behind the ball alone requires two or three, and no player sees the
/// difference.
const MAX_LEVEL_ELEVATION: f64 = 3.5;

/// Maximum difference from the least possible elevation for a cue to count as "as level as it can be", rad: half a degree.
const LEVEL_TOLERANCE: f64 = 0.5_f64.to_radians();

/// Elevation from which such a cue is no longer called level, degrees.
const MIN_RAISED_ELEVATION: f64 = 5.0;

/// The effect of side at the first cushion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum English {
    /// It lengthens the rebound.
    Running,
    /// It shortens the rebound.
    Reverse,
}

/// A shot in players' numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShotWords {
    /// The hit on the first object ball; `None` if none is hit.
    pub first: Option<Hit>,
    /// The hit on the other object ball.
    pub second: Option<Hit>,
    /// The object ball that the cue ball flies over before its first contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over: Option<usize>,
    /// Tips of side, positive to the right as seen along the cue.
    pub tips_right: f64,
    /// Tips above the centre; negative is below.
    pub tips_above: f64,
    /// Clock position of the tip on the ball, to half an hour; `None` at the centre.
    pub clock: Option<f64>,
    /// The effect of the side at the first cushion, if it is large enough.
    pub english: Option<English>,
    /// Table lengths that a ball runs on this table when it is struck in its centre at this speed.
    pub table_lengths: f64,
    /// The cue's elevation, degrees.
    pub elevation_deg: f64,
    /// Whether the elevation is the least that rails and balls behind the cue ball allow.
    pub is_level: bool,
    /// Cushions before the first object ball, in order.
    pub before: Vec<Cushion>,
    /// Cushions between the first and the second object ball, in order.
    pub between: Vec<Cushion>,
    /// Number of those cushions before the first ball is hit again, if it is.
    #[serde(skip)]
    rehit_after: Option<usize>,
    /// The point at which the cue is aimed.
    pub ahead: RailPoint,
    /// The point behind the cue ball on the line of aim.
    pub behind: RailPoint,
    /// Direction of the cue, of length 1.
    #[serde(skip)]
    direction: DVec2,
    /// Ball radius, m.
    #[serde(skip)]
    radius: f64,
    /// Length of a diamond, m.
    #[serde(skip)]
    diamond: f64,
}

impl ShotWords {
    /// Simulates a shot and describes it.
    ///
    /// # Errors
    /// Fails if the layout or the stroke is invalid.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        let recording = Recording::new(table, layout, cue)?;
        Ok(Self::of_technique(table, layout, cue, &Technique::of_recorded(table, &recording)))
    }

    /// Describes a shot that is already analysed.
    pub fn of_technique(table: &Table, layout: &Layout, cue: &CueInputs, technique: &Technique) -> Self {
        let [ahead, behind] = line_of_aim(table, layout, cue.phi);
        let (tips_right, tips_above) = (-cue.a / TIP + 0.0, cue.b / TIP);
        let least = least_elevation(table, layout, cue).map_or(0.0, |least| least.theta);
        let first = technique.first;
        let english = match technique.english {
            english if english > MIN_ENGLISH => Some(English::Running),
            english if english < -MIN_ENGLISH => Some(English::Reverse),
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
            // Every stroke that can be played runs some distance.
            table_lengths: table_lengths(table, cue.speed).unwrap_or_default(),
            elevation_deg: cue.theta.to_degrees(),
            is_level: cue.theta - least <= LEVEL_TOLERANCE,
            before: technique.before.clone(),
            between: technique.between.clone(),
            rehit_after: technique.rehit_after,
            ahead,
            behind,
            direction: DVec2::from_angle(cue.phi),
            radius: table.radius,
            diamond: table.diamond(),
        }
    }

    /// Whether players would call the cue level.
    pub fn has_level_cue(&self) -> bool {
        self.elevation_deg < MAX_LEVEL_ELEVATION || self.is_level && self.elevation_deg < MIN_RAISED_ELEVATION
    }
}
