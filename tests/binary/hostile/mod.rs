//! Hostile input of others against the real program: none may reach the terminal raw, block the program or lose data.

mod escapes;
mod faults;
mod folders;
mod input;
mod signals;
