//! The kind of a shot: shots of one kind are variations of each other, shots of different kinds are alternatives.

use std::fmt;

use serde::Serialize;

use super::{
    candidates::MAX_ELEVATION,
    words::{LengthUnit, format_trimmed},
};
use crate::{
    game::Tally,
    physics::CueInputs,
    table::{BALL_NAMES, BALLS},
};

/// Speed from which on a stroke counts as hard, m/s. A ball struck at this speed in its centre runs 7.3 to 8.4 m along
/// a `match` table, between two and a half and three lengths.
const HARD: f64 = 2.5;

/// Number of cushions from which on the cue ball goes around the table.
const AROUND: u32 = 3;

/// How the cue ball reaches the second object ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Route {
    /// With no cushion.
    Direct,
    /// Off one or two cushions.
    OffCushion,
    /// Off three cushions or more.
    AroundTheTable,
}

/// How hard the stroke is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pace {
    /// Below 2.5 m/s.
    Soft,
    /// From 2.5 m/s on.
    Hard,
}

/// The kind of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Kind {
    /// The object ball that is hit first, 1 or 2; 0 if none is hit.
    pub first_ball: usize,
    /// Whether the cue ball hits a cushion before it.
    pub cushion_first: bool,
    /// How the cue ball reaches the second object ball.
    #[serde(rename = "way")]
    pub route: Route,
    /// How hard the stroke is.
    pub pace: Pace,
    /// Whether the cue is raised by more than 30 degrees, for a jump or a massé.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub raised: bool,
}

impl Kind {
    /// Returns the kind of a shot with this tally.
    pub fn of(tally: &Tally, cue: &CueInputs) -> Self {
        let route = match tally.cushions_before_second {
            0 => Route::Direct,
            cushions if cushions < AROUND => Route::OffCushion,
            _ => Route::AroundTheTable,
        };
        Self {
            first_ball: tally.first_ball().unwrap_or(0),
            cushion_first: tally.cushions_before_first > 0,
            route,
            pace: if cue.speed < HARD { Pace::Soft } else { Pace::Hard },
            raised: cue.theta > MAX_ELEVATION,
        }
    }

    /// Describes the kind for a player with the white ball, with speeds in the system of `unit`.
    pub fn words(self, unit: LengthUnit) -> String {
        let Self { first_ball, cushion_first, route, pace, raised } = self;
        let pace = pace.words(unit) + if raised { ", raised" } else { "" };
        let start = if cushion_first { "cushion first to" } else { "first" };
        match first_ball {
            0 => format!("hits no ball, {pace}"),
            _ => format!("{start} {}, {route}, {pace}", BALL_NAMES[first_ball.min(BALLS - 1)]),
        }
    }
}

/// Avoids the players' terms, because their names of patterns and speeds are more specific than a kind.
impl fmt::Display for Route {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Direct => "direct",
            Self::OffCushion => "off one or two cushions",
            Self::AroundTheTable => "off three cushions or more",
        })
    }
}

impl Pace {
    /// Describes the pace, with speeds in the system of `unit`.
    pub fn words(self, unit: LengthUnit) -> String {
        let (in_it, symbol) = unit.speed();
        let speed = format_trimmed(in_it * HARD, 1);
        match self {
            Self::Soft => format!("below {speed} {symbol}"),
            Self::Hard => format!("{speed} {symbol} and more"),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(&self.words(LengthUnit::Metres))
    }
}
