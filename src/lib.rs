//! `carom` is a terminal coach for carom billiards: it shows the table, recommends how to strike and plays the shot.
//!
//! The rooms, from the ground up; each may use those above it, never those below: [`platform`] what operating systems do
//! each in its own way, [`printing`] what goes out, [`storage`] files, [`statistics`] shares and fits, [`table`] what is
//! played on, [`physics`] formulas, [`simulation`] when things happen, [`game`] what counts, [`player`] who plays,
//! [`learning`] agents, [`coach`] recommendations, [`calibration`] a table of one's own, [`drills`] practice, [`study`] the
//! program measuring itself, [`terminal`] screens, [`commands`] the command line.

// What may not be used stands in clippy.toml.
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
