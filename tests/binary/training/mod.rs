//! `carom train` and `carom evaluate` as a user runs them.

mod basics;
mod common;
mod kills;
mod many;
mod trouble;
mod watching;
