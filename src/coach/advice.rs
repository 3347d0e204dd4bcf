//! What the coach answers.

use std::{fmt, time::Duration};

use serde::Serialize;

use super::{Kind, Risk};
use crate::{physics::CueInputs, statistics::SuccessRate};

/// Where a shot comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// The policy's own shot.
    Policy,
    /// Near a shot of the policy: its direction and speed with another tip position and elevation (thesis 5.1), or a
    /// refinement of it. In JSON a search too.
    #[serde(rename = "search")]
    Variation,
    /// The wider search.
    Search,
    /// A former answer to the same question, or near a shot of it. In JSON a search too.
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

/// A shot and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suggestion {
    /// The stroke.
    pub cue: CueInputs,
    /// Who thought of it.
    pub source: Source,
}

/// Another shot that makes the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alternative {
    /// The stroke.
    pub cue: CueInputs,
    /// Who thought of it.
    pub source: Source,
    /// What sort of shot it is.
    pub kind: Kind,
    /// How often the player makes it; `None` where time ran out before a single attempt.
    pub make_probability: Option<SuccessRate>,
    /// Probability of the point after this one, where that was asked for.
    pub next_probability: Option<f64>,
}

/// The best shot so far, while the search goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Improvement {
    /// The stroke.
    pub cue: CueInputs,
    /// What sort of shot it is.
    pub kind: Kind,
    /// The share of points in the errors that it was chosen by, which flatters it a little; the answer has the honest one.
    pub make_probability: SuccessRate,
    /// Shots simulated so far.
    pub simulations: u64,
    /// Time since the question.
    pub elapsed: Duration,
}

/// The coach's answer.
#[derive(Clone, Debug)]
pub struct Recommendation {
    /// The stroke: it makes the point if `solved`, else it is the best attempt.
    pub cue: CueInputs,
    /// Whether it makes the point when it is played as meant, by simulation.
    pub solved: bool,
    /// Where it comes from.
    pub source: Source,
    /// What sort of shot it is, if it makes the point.
    pub kind: Option<Kind>,
    /// How often the player makes it, from independent attempts that took no part in the choice; `None` where there is no
    /// such shot or time ran out before a single attempt. A perfect player always makes what makes the point.
    pub make_probability: Option<SuccessRate>,
    /// The first attempt behind `make_probability`, as [`judge`](super::judge) counts them: above 0 where earlier attempts took part in the
    /// choice.
    pub judged_from: usize,
    /// What would miss it by itself, where anything is in doubt and time did not run out.
    pub risk: Option<Risk>,
    /// Probability of the point after this one, an estimate, where that was asked for and the table is the one that the
    /// estimate was fitted on.
    pub next_probability: Option<f64>,
    /// Whether the shots are ranked by this point and the next, so that one may lead that is made less often than another.
    pub is_planned: bool,
    /// Other strokes that make the point, the best of each kind, the best first; none that is made less than half as often
    /// as the recommended one.
    pub alternatives: Vec<Alternative>,
    /// Shots simulated.
    pub simulations: u64,
    /// Time taken.
    pub elapsed: Duration,
}
