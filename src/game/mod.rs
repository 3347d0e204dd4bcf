//! The rules of carom, touching balls, and the thesis' rewards.

mod point;
mod reward;
mod rules;
mod touching;

pub use point::Point;
pub use reward::{Reward, UnknownReward};
pub use rules::{Referee, Rule, Tally, UnknownRule, scores};
pub use touching::{Touching, pushes_touching_ball};
