//! `carom train` and `carom evaluate` as a user runs them.

mod basics;
pub mod common;
mod kills;
mod many;
mod trouble;
mod watching;
