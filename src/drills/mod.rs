//! Practice: positions with what they teach, sessions that keep score, and what the score says of a player.

mod compare;
pub mod exam;
mod exercise;
mod play;
mod record;
mod session;

pub use compare::{Advice, advise, chance, difference};
pub use exercise::{Category, Exercise, ExerciseError, Par};
pub use play::{PlayError, Played, check};
pub use record::Record;
pub use session::{Attempt, Goal, Session, Venue};
