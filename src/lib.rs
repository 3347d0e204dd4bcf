//! `carom` is a terminal coach for carom billiards: it shows the table, recommends how to strike and plays the shot.
//!
//! The modules, from the lowest layer to the highest. A module may use those before it, never those after it:
//!
//! - [`platform`] – operating-system services
//! - [`printing`] – text output
//! - [`storage`] – files
//! - [`statistics`] – success rates and fits
//! - [`table`] – the table and the positions of the balls
//! - [`physics`] – formulas
//! - [`simulation`] – detection and order of events
//! - [`game`] – rules and rewards
//! - [`player`] – skills and execution errors
//! - [`learning`] – agents
//! - [`coach`] – recommendations
//! - [`calibration`] – the constants of a real table
//! - [`drills`] – practice
//! - [`study`] – measurements of the program itself
//! - [`terminal`] – screens
//! - [`commands`] – the command line

// The disallowed macros and methods are listed in clippy.toml.
#![cfg_attr(not(test), warn(clippy::disallowed_macros, clippy::disallowed_methods))]

pub mod calibration;
pub mod coach;
pub mod commands;
pub mod drills;
pub mod game;
pub mod learning;
pub mod physics;
pub mod platform;
pub mod player;
pub mod printing;
pub mod simulation;
pub mod statistics;
pub mod storage;
pub mod study;
pub mod table;
pub mod terminal;
