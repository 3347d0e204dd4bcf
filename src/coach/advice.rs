//! The output of a recommendation.

use std::{fmt, time::Duration};

use serde::Serialize;

use super::{Kind, Risk};
use crate::{physics::CueInputs, statistics::SuccessRate};

/// The origin of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// The policy's own shot.
    Policy,
    /// Near a shot of the policy: its direction and speed with another tip position and elevation (thesis 5.1), or a
    /// refinement of it. Written as `search` in JSON.
    #[serde(rename = "search")]
    Variation,
    /// The wider search.
    Search,
    /// An earlier answer to the same question, or a shot near one. Written as `search` in JSON.
    #[serde(rename = "search")]
    Former,
}

impl fmt::Display for Source {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Policy => "networks",
            Self::Variation => "variation",
            Self::Search | Self::Former => "search",
        })
    }
}

/// A shot and its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suggestion {
    /// The stroke.
    pub cue: CueInputs,
    /// The origin of the shot.
    pub source: Source,
}

/// Another shot that makes the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alternative {
    /// The stroke.
    pub cue: CueInputs,
    /// The origin of the shot.
    pub source: Source,
    /// The kind of the shot.
    pub kind: Kind,
    /// How often the player makes it; `None` if time ran out before the first attempt.
    pub make_probability: Option<SuccessRate>,
    /// Index of the first attempt behind `make_probability`, as in [`Recommendation`].
    pub judged_from: usize,
    /// As in [`Recommendation`].
    pub effort_penalty: f64,
    /// Probability of the point after this one, if the request asked for it.
    pub next_probability: Option<f64>,
}

/// The best shot so far, reported during the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Improvement {
    /// The stroke.
    pub cue: CueInputs,
    /// Share of points under the errors by which the shot was chosen. This flatters it a little; the final answer has
    /// an unbiased rate.
    pub make_probability: SuccessRate,
}

/// The coach's answer.
#[derive(Clone, Debug)]
pub struct Recommendation {
    /// The stroke: it makes the point if `solved`, else it is the best attempt.
    pub cue: CueInputs,
    /// Whether the simulated stroke makes the point when it is played as intended.
    pub solved: bool,
    /// The origin of the shot.
    pub source: Source,
    /// The kind of the shot, if it makes the point.
    pub kind: Option<Kind>,
    /// How often the player makes it, from independent attempts that took no part in the choice, unless time ran out before the fresh
    /// ones were complete, or they showed that another shot is better. `None` if there is no such shot, or time ran out before the first
    /// attempt. A perfect player makes every shot that makes the point.
    pub make_probability: Option<SuccessRate>,
    /// Index of the first attempt behind `make_probability`, as [`judge`](super::judge) counts them: above 0 if earlier
    /// attempts took part in the choice.
    pub judged_from: usize,
    /// What the search takes off the make probability of a stroke that is hard to play or that hits the first ball twice.
    pub effort_penalty: f64,
    /// How often each cause alone would miss the shot, if anything is in doubt and time did not run out.
    pub risk: Option<Risk>,
    /// Estimated probability of the point after this one, if the request asked for it and the table is the one that the
    /// estimate was fitted on.
    pub next_probability: Option<f64>,
    /// Other strokes that make the point: the best of each kind, best first, each made at least half as often as the
    /// recommended one.
    pub alternatives: Vec<Alternative>,
    /// Number of simulated shots.
    pub simulations: u64,
    /// Time taken.
    pub elapsed: Duration,
}
