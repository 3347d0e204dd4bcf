//! What an agent can do: where to pass the first ball, how fast, and with which spin; and the cue inputs that do it.

use serde::{Deserialize, Serialize};

use super::dual::{ALONG, Dual};
use crate::table::Table;

/// Most numbers in an action.
pub const ACTIONS: usize = ALONG;

/// An action as a network gives it: aim, speed, tip to the left and up, elevation; each from -1 to 1. All noughts but the
/// first two are the thesis' fixed choice a = b = 0, theta = 10°.
pub type Action = [f32; ACTIONS];

/// Which of the cue inputs an agent chooses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ActionSpace {
    /// The thesis' choice (its 4.1.3): phi and V. The tip meets the ball's centre, the cue is raised by 10°.
    #[default]
    #[serde(rename = "phi-v")]
    PhiV,
    /// All five: a, b, theta, phi and V.
    #[serde(rename = "full")]
    Full,
}

impl ActionSpace {
    /// How many numbers of an [`Action`] it uses; the others stay nought.
    pub const fn actions(self) -> usize {
        match self {
            Self::PhiV => 2,
            Self::Full => ACTIONS,
        }
    }

    /// What its actions mean, for the note in a policy's file: weights fit one meaning only.
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

/// What -1 and 1 stand for in the first action: the cue ball's course passes the first ball's centre on the left at this
/// many ball diameters. 0 is a full hit, 1 a hair's breadth. A little beyond 0, so that a full hit is no edge.
const OFFSETS: [f64; 2] = [-0.1, 1.0];

/// What -1 and 1 stand for in the second action: cue speed, m/s. The upper end is the thesis' (chapter 4.1); below the
/// lower one a ball hardly reaches another.
pub const SPEEDS: [f64; 2] = [0.3, 6.0];

/// What -1 and 1 stand for in the fifth action: elevation of the cue, rad. The middle is the thesis' 10°.
const ELEVATIONS: [f64; 2] = [0.0, 20.0 * std::f64::consts::PI / 180.0];

/// The tip stays within this share of the miscue limit's radius, so that rounding never oversteps it.
const TIP_SHARE: f64 = 0.98;

/// The first action that gives `offset`.
pub fn aim_at(offset: f64) -> f32 {
    (2.0 * (offset - OFFSETS[0]) / (OFFSETS[1] - OFFSETS[0]) - 1.0) as f32
}

/// The second action that gives a cue speed, m/s.
pub fn speed_of(speed: f64) -> f32 {
    (2.0 * (speed - SPEEDS[0]) / (SPEEDS[1] - SPEEDS[0]) - 1.0) as f32
}

/// What an action means on a table, with slopes along its numbers.
#[derive(Clone, Copy, Debug)]
pub struct Meaning {
    /// Ball diameters between the cue ball's course and the first ball's centre.
    pub offset: Dual,
    /// Cue speed, m/s.
    pub speed: Dual,
    /// Tip to the left and up, in units of R; in the observation's frame, which may be a mirror's.
    pub tip: [Dual; 2],
    /// Elevation, rad.
    pub theta: Dual,
}

impl Meaning {
    /// The meaning of `action`. What is not a number becomes the middle, so that a broken network still gives cue inputs.
    pub fn of(table: &Table, action: Action) -> Self {
        let input = |index: usize| {
            let value = if action[index].is_nan() { 0.0 } else { f64::from(action[index].clamp(-1.0, 1.0)) };
            Dual::action(index, value)
        };
        let scaled = |[low, high]: [f64; 2], value: Dual| (value + 1.0) * (0.5 * (high - low)) + low;
        // The square of the two actions is mapped onto the disc of the tip.
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

    /// The stroke with a level cue that gives the cue ball the same speed, roll and side: where a raised cue makes a ball hop,
    /// networks strike level. What the raised cue would have made it swerve is left out, and where the tip would have to be
    /// beyond its limit, so is the rest of the roll. See `physics::level_stroke`.
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
            let action = [aim_at(value), 0.0, 0.0, 0.0, 0.0];
            assert!((Meaning::of(&Table::default(), action).offset.value - value).abs() < 1e-7);
        }
    }

    #[test]
    fn where_balls_fly_a_raised_stroke_becomes_the_level_one_of_the_same_speed_roll_and_side() {
        let frozen = Table { flight: None, ..Table::default() };
        let table = Table::default();
        for action in [[0.2, 0.3, 0.4, 0.5, 0.3], [0.2, -0.3, -0.6, 0.2, 1.0], [0.2, 0.9, 0.0, 0.0, 0.0]] {
            let [raised, level] = [&frozen, &table].map(|table| {
                let Meaning { speed, tip: [a, b], theta, .. } = Meaning::of(table, action);
                let cue = CueInputs { a: a.value, b: b.value, theta: theta.value, phi: 0.0, speed: speed.value };
                cue.validate_tip(table.miscue_limit).unwrap();
                (cue.theta, strike(table, &cue))
            });
            assert!(raised.0 > 0.1 && level.0 == 0.0 && level.1.lift == 0.0);
            let speeds = [raised.1, level.1].map(|impulse| impulse.velocity.length());
            assert!((speeds[0] - speeds[1]).abs() < 1e-12, "{speeds:?}");
            let ways = [raised.1, level.1].map(|impulse| impulse.velocity.normalize());
            let rolls = [raised.1.spin.truncate().dot(ways[0].perp()), level.1.spin.truncate().dot(ways[1].perp())];
            assert!((rolls[0] - rolls[1]).abs() < 1e-9 && (raised.1.spin.z - level.1.spin.z).abs() < 1e-9, "{rolls:?}");
        }
        // Low and raised by 20 degrees, the tip would have to be below where it slips.
        let low = Meaning::of(&table, [0.2, 0.3, 0.0, -1.0, 1.0]);
        assert!((low.tip[1].value + 0.98 * table.miscue_limit.sqrt()).abs() < 1e-12, "{low:?}");
    }
}
