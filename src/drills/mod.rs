//! Practice: positions with what they teach, sessions that keep score, and what the score says of a player.

mod exercise;

pub use exercise::{Category, Exercise, ExerciseError, Par};
