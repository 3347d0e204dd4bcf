//! Connects the program to the terminal: event loop, input, signals, and drawing of changes.

pub mod backend;
mod events;
mod guard;
pub mod input;
mod log;
mod pace;
pub mod runner;
mod sgr;
mod table_sharing;

pub use self::guard::has_terminal;
