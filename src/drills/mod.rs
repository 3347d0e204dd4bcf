//! Practice: positions with what they teach, sessions that keep score, and what the score says of a player.

mod code;
mod exercise;
mod file;
mod library;
pub mod par;
mod shift;
mod technique;

pub use code::{CodeError, decode, encode};
pub use exercise::{Category, Exercise, ExerciseError, Par};
pub use file::{LibraryFile, LibraryFileError};
pub use library::{Filter, Library, LibraryError};
pub use shift::shifted;
pub use technique::{GATHERED, PATTERNS, Pattern, Technique, flaws};
