//! What others wrote, typed or did, against the real program: nothing of it may reach the terminal raw, hang or lose anything.

mod escapes;
mod faults;
mod folders;
mod input;
#[path = "../drills/common.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod program;
#[path = "../pty/session.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod session;
mod signals;
