//! Recommendations: the policy's shot, checked by simulation, then the thesis' variation of it, then a wider search.

mod advisor;
mod search;
mod skill;

pub use advisor::{Coach, Recommendation, Request, Source, Suggestion};
pub use skill::{Skill, UnknownSkill};
