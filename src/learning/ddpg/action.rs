//! The agent's actions: offset at the first ball, speed, spin and elevation, and their meaning on a table.

use serde::{Deserialize, Serialize};

use super::dual::{Dual, VARIABLES};
use crate::table::Table;

/// Numbers in an action.
pub const ACTIONS: usize = VARIABLES;

/// An action as a network outputs it: aim, speed, tip to the left and up, elevation; each from -1 to 1. Zeros from the third number on
/// are the thesis' fixed choice a = b = 0, theta = 10°.
pub type Action = [f32; ACTIONS];

/// The cue inputs that an agent chooses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ActionSpace {
    /// The thesis' choice (its 4.1.3): phi and V. The tip hits the ball's centre; the elevation is 10°.
    #[default]
    #[serde(rename = "phi-v")]
    PhiV,
    /// All five: a, b, theta, phi and V.
    #[serde(rename = "full")]
    Full,
}

impl ActionSpace {
    /// Number of leading entries of an [`Action`] that are in use; the others stay zero.
    pub const fn actions(self) -> usize {
        match self {
            Self::PhiV => 2,
            Self::Full => ACTIONS,
        }
    }

    /// Returns the meaning of the actions, for the note in a policy's file: weights are valid for one meaning only.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::PhiV => "phi from offset -0.1 to 1 diameters, V 0.3 to 6 m/s, a = b = 0, theta = 10 degrees",
            Self::Full => {
                "phi from offset -0.1 to 1 diameters, swerve allowed for, V 0.3 to 6 m/s, a and b to 0.98 of the miscue \
                 limit, theta 0 to 20 degrees"
            }
        }
    }
}

/// Range of the first action's offset, in ball diameters: distance at which the cue ball's course passes the first ball's centre on the
/// left. 0 is a full hit, 1 the thinnest one. The range starts below 0, so that a full hit is not at its edge.
const OFFSETS: [f64; 2] = [-0.1, 1.0];

/// Range of the second action's cue speed, m/s. The upper end is the thesis' (chapter 4.1); below the lower end a ball hardly reaches
/// another.
pub const SPEEDS: [f64; 2] = [0.3, 6.0];

/// Range of the fifth action's elevation of the cue, rad. The middle is the thesis' 10°.
const ELEVATIONS: [f64; 2] = [0.0, 20.0 * std::f64::consts::PI / 180.0];

/// Largest tip offset as a share of the miscue limit's radius; below 1, so that rounding never exceeds the limit.
const TIP_SHARE: f64 = 0.98;

/// Returns the first action for an `offset`.
pub fn action_for_offset(offset: f64) -> f32 {
    (2.0 * (offset - OFFSETS[0]) / (OFFSETS[1] - OFFSETS[0]) - 1.0) as f32
}

/// Returns the second action for a cue speed, m/s.
pub fn action_for_speed(speed: f64) -> f32 {
    (2.0 * (speed - SPEEDS[0]) / (SPEEDS[1] - SPEEDS[0]) - 1.0) as f32
}

/// The physical meaning of an action on a table, with its slopes along the action's numbers.
#[derive(Clone, Copy, Debug)]
pub struct DecodedAction {
    /// Ball diameters between the cue ball's course and the first ball's centre.
    pub offset: Dual,
    /// Cue speed, m/s.
    pub speed: Dual,
    /// Tip to the left and up, in units of R; in the observation's frame, which may be mirrored.
    pub tip: [Dual; 2],
    /// Elevation, rad.
    pub theta: Dual,
}

impl DecodedAction {
    /// Returns the meaning of `action`. NaN becomes the middle of the range, so that a broken network still yields cue inputs.
    pub fn of(table: &Table, action: Action) -> Self {
        let input = |index: usize| {
            let value = if action[index].is_nan() { 0.0 } else { f64::from(action[index].clamp(-1.0, 1.0)) };
            Dual::action(index, value)
        };
        let scaled = |[low, high]: [f64; 2], value: Dual| (value + 1.0) * (0.5 * (high - low)) + low;
        // Maps the square of the two actions onto the disc of tip positions.
        let (left, up) = (input(2), input(3));
        let radius = TIP_SHARE * table.miscue_limit.sqrt();
        let tip = [left * (-(up * up) * 0.5 + 1.0).sqrt() * radius, up * (-(left * left) * 0.5 + 1.0).sqrt() * radius];
        let meaning = Self {
            offset: scaled(OFFSETS, input(0)),
            speed: scaled(SPEEDS, input(1)),
            tip,
            theta: scaled(ELEVATIONS, input(4)),
        };
        if table.flight.is_some() { meaning.levelled(table) } else { meaning }
    }

    /// Returns the stroke with a level cue that gives the cue ball the same speed, roll and side. Networks strike level on tables on
    /// which a raised cue makes a ball hop. The swerve of the raised cue is lost, and so is the part of the roll for which the tip would
    /// exceed its limit. See `physics::level_stroke`.
    fn levelled(self, table: &Table) -> Self {
        let [a, b] = self.tip;
        let (sin, cos) = self.theta.sin_cos();
        let lever = b * cos - (-(a * a) - b * b + 1.0).at_least(1e-6).sqrt() * sin;
        let limit = TIP_SHARE * TIP_SHARE * table.miscue_limit;
        let most = (-(a * a) + limit).at_least(1e-12).sqrt();
        let up = -((-(lever * cos.recip())).min(most));
        let up = up.min(most);
        let mass = |lever: Dual| (a * a + lever * lever) * 2.5 + (1.0 + table.ball_mass / table.cue_mass);
        let speed = self.speed * cos * mass(up) * mass(lever).recip();
        Self { speed, tip: [a, up], theta: Dual::constant(0.0), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::{CueInputs, strike};

    #[test]
    fn offsets_and_actions_are_inverse() {
        for value in [-0.1, 0.0, 0.5, 1.0] {
            let action = [action_for_offset(value), 0.0, 0.0, 0.0, 0.0];
            assert!((DecodedAction::of(&Table::default(), action).offset.value - value).abs() < 1e-7);
        }
    }

    #[test]
    fn raised_strokes_are_levelled_on_tables_with_flight() {
        let frozen = Table { flight: None, ..Table::default() };
        let table = Table::default();
        for action in [[0.2, 0.3, 0.4, 0.5, 0.3], [0.2, -0.3, -0.6, 0.2, 1.0], [0.2, 0.9, 0.0, 0.0, 0.0]] {
            let [raised, level] = [&frozen, &table].map(|table| {
                let DecodedAction { speed, tip: [a, b], theta, .. } = DecodedAction::of(table, action);
                let cue = CueInputs { a: a.value, b: b.value, theta: theta.value, phi: 0.0, speed: speed.value };
                cue.validate_tip(table.miscue_limit).unwrap();
                (cue.theta, strike(table, &cue))
            });
            assert!(raised.0 > 0.1 && level.0 == 0.0 && level.1.lift == 0.0);
            let speeds = [raised.1, level.1].map(|impulse| impulse.velocity.length());
            assert!((speeds[0] - speeds[1]).abs() < 1e-12, "{speeds:?}");
            let directions = [raised.1, level.1].map(|impulse| impulse.velocity.normalize());
            let rolls =
                [raised.1.spin.truncate().dot(directions[0].perp()), level.1.spin.truncate().dot(directions[1].perp())];
            assert!((rolls[0] - rolls[1]).abs() < 1e-9 && (raised.1.spin.z - level.1.spin.z).abs() < 1e-9, "{rolls:?}");
        }
        // For a low stroke raised by 20 degrees, the level tip would be below the miscue limit.
        let low = DecodedAction::of(&table, [0.2, 0.3, 0.0, -1.0, 1.0]);
        assert!((low.tip[1].value + 0.98 * table.miscue_limit.sqrt()).abs() < 1e-12, "{low:?}");
    }
}
