//! `carom train` and `carom evaluate` as a user runs them.

mod basics;
pub mod common;
mod failures;
mod kills;
mod seeds;
mod setting_names;
mod watching;
