//! What others wrote, typed or did, against the real program: nothing of it may reach the terminal raw, hang or lose anything.

mod escapes;
mod faults;
mod folders;
mod input;
mod signals;
