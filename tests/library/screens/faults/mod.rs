//! Problems that a first-time user had: each is replayed as it happened.

mod exam;
mod hints;
mod late;
mod palette_words;
mod placing;
mod saving;
mod session;
mod typing;
mod unsaved;
