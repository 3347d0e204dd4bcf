//! Whatever bytes a file or a line contains, the program answers: an error is an answer, a panic is not.
//!
//! The short form runs with all tests. For the long form, use `PROPTEST_CASES=100000 cargo test --profile quick --test binary fuzz::`, and
//! for terminal input `PROPTEST_CASES=1000000 cargo test --profile quick --lib terminal::host::input`; see docs/reliability.md.

mod files;
mod lines;
mod monkey;
mod mutation;
mod text;
