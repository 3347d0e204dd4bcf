//! Practice: exercises, sessions that keep score, and the estimate of a player's skill from the results.

mod code;
mod compare;
pub mod estimate;
pub mod exam;
mod exercise;
mod file;
mod flaws;
mod header;
mod library;
pub mod par;
mod play;
mod record;
mod session;
mod shift;
mod sides;
pub mod store;
mod validity;
mod verdict;

pub use code::{CodeError, decode, encode, is_code};
pub use compare::{Advice, advise, chance, difference};
pub use exercise::{Category, Exercise, ExerciseError, MAX_POINT_BYTES, MAX_TITLE_BYTES, Par, bare_tag};
pub use file::{LibraryFile, LibraryFileError};
pub use flaws::{MAX_GATHERED_DISTANCE, flaws};
pub use header::HeaderError;
pub use library::{Filter, Library, LibraryError};
pub use play::{PlayError, PlayedStroke, check};
pub use record::Record;
pub use session::{Attempt, Goal, Session, Venue};
pub use shift::shifted;
pub use store::Store;
pub use validity::SessionError;
pub use verdict::changes;
