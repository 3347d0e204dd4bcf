//! Shot recommendations: the shot that a player makes most often, its margins of error, and the position that it leaves.

mod advice;
mod aim;
mod candidates;
mod clock;
#[expect(clippy::module_inception, reason = "`coach::Coach` is what a reader expects")]
mod coach;
mod difficulty;
mod doubt;
mod draws;
mod elevated;
mod evidence;
mod first;
mod first_contact;
mod judging;
mod kind;
mod layout_seed;
mod margins;
mod next;
mod pool;
mod refinement;
mod request;
mod risk;
mod scatter;
mod search;
mod self_play;
mod stroke_text;
pub mod systems;
mod technique;
#[cfg(test)]
mod tests;
mod trial;
mod verdict;
mod why;
pub mod words;

pub use advice::{Alternative, Improvement, Recommendation, Source, Suggestion};
pub use aim::{Aim, Hit, RailPoint, aim, first_hit, line_of_aim};
pub use coach::{Coach, make_probability};
pub use difficulty::{DifficultySample, LayoutDifficulty};
pub use doubt::{Doubt, UnknownDoubt};
pub use first_contact::{FirstContact, NO_MATCHING_ATTEMPT, UnknownFirstContact};
pub use judging::judge;
pub use kind::{Kind, Pace, Route};
pub use layout_seed::{layout_number, layout_seed};
pub use margins::{Map, Margin, Outcome, Sensitivity};
pub use request::{Request, Shooter};
pub use risk::{Cause, Risk};
pub use scatter::{Scatter, scatter};
pub use self_play::{Inning, inning};
pub use stroke_text::{StrokeText, StrokeTextError};
pub use technique::{Cushion, PATTERNS, Pattern, Technique};
pub use verdict::{Miss, MissKind, Verdict};
pub use why::{Difference, Kiss, Why, why};
pub use words::{ShotWords, Units, jump_words};

pub use crate::player::{Growth, Input, Skill, SkillError};
