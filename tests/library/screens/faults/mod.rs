//! Faults that somebody met who used the program for the first time: each is played here as it was met.

mod exam;
mod hints;
mod palette_words;
mod placing;
mod saving;
mod session;
mod typing;
