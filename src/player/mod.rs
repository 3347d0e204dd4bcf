//! Models of a player: execution errors in the five cue inputs, and inaccurate reports of ball positions.

pub mod errors;
mod input;
mod sight;
mod skill;

pub use input::Input;
pub use sight::{perturbed_layout, re_aimed};
pub use skill::{Growth, Skill, SkillError};
