//! Practice: exercises, sessions that keep score, and the estimate of a player's skill from the results.

mod code;
mod compare;
pub mod estimate;
pub mod exam;
mod exercise;
mod file;
mod flaws;
mod library;
mod marked;
pub mod par;
mod play;
mod record;
mod session;
mod shift;
pub mod store;
mod validity;
mod verdict;

pub use code::{CodeError, decode, encode, is_code};
pub use compare::{Advice, advise, chance, difference};
pub use exercise::{Category, Exercise, ExerciseError, LONGEST_POINT, LONGEST_TITLE, Par, bare_tag};
pub use file::{LibraryFile, LibraryFileError};
pub use flaws::{GATHERED, flaws};
pub use library::{Filter, Library, LibraryError};
pub use marked::MarkError;
pub use play::{PlayError, Played, check};
pub use record::Record;
pub use session::{Attempt, Goal, Session, Venue};
pub use shift::shifted;
pub use store::Store;
pub use validity::SessionError;
pub use verdict::changes;
