//! Who plays: the errors of a hand in the five cue inputs, and balls that lie not quite where they are said to lie.

pub mod errors;
mod input;
mod sight;
mod skill;

pub use input::Input;
pub use sight::{aimed, misplaced};
pub use skill::{Growth, Skill, SkillError};
