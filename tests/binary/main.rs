//! Tests of the real binary: the command line, training runs, practice, failures, and the screen in a pseudo-terminal.

mod accuracy;
mod accuracy_input;
mod bench;
mod calibrate;
mod club;
mod cluster;
mod command_faults;
mod commands;
mod cue_room;
mod doctor;
mod documents;
mod drills;
mod evaluate;
mod exit_codes;
mod fuzz;
mod hostile;
mod locale;
mod names;
mod program;
mod pty;
mod refusals;
mod reproduce;
mod terminal;
mod training;
