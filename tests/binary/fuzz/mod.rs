//! Whatever bytes stand in a file or come over a line, the program answers: an error is an answer, a panic is none.
//!
//! The short form runs with all tests. The long one: `PROPTEST_CASES=100000 cargo test --profile quick --test binary fuzz::`, and for what
//! the terminal sends `PROPTEST_CASES=1000000 cargo test --profile quick --lib terminal::host::input`; see docs/reliability.md.

mod files;
mod lines;
mod monkey;
mod mutation;
mod text;
