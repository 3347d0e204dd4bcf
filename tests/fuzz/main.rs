//! Whatever bytes stand in a file or come over a line, the program answers: an error is an answer, a panic is none.
//!
//! The short form runs with all tests. The long one: `PROPTEST_CASES=100000 cargo test --release --test fuzz`, and for what
//! the terminal sends `PROPTEST_CASES=1000000 cargo test --release --lib terminal::input`; see CONTRIBUTING.md.

mod files;
mod lines;
mod monkey;
mod mutation;
#[path = "../pty/session.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod session;
#[path = "../shared.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod shared;
mod text;
