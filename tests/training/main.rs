//! `carom train` and `carom evaluate` as a user runs them.

#[path = "../shared.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod shared;

mod basics;
mod common;
mod kills;
mod many;
mod trouble;
mod watching;
