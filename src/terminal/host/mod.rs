//! The program's way to the terminal: the loop, input, signals, and drawing what has changed.

pub mod backend;
mod events;
mod guard;
pub mod input;
mod log;
mod pace;
pub mod runner;
mod sgr;
mod showing;

pub use self::guard::has_terminal;
