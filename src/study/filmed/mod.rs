//! Comparison with filmed balls: how far the simulation deviates from real balls, and which constants fit them best.
//!
//! The film (`tests/data/filmed`, with its source) contains the positions of the balls at 50 frames a second. `rail_hits`
//! detects impacts on rails. `chains` predicts from rail to rail, `whole` predicts whole shots, `systems` compares with diamond
//! systems. `constants` fits the constants of a table, `laws` weighs the models of the rails.

mod chains;
mod constants;
mod contacts;
mod film;
mod judged;
mod laws;
mod motion;
mod picture;
mod rail_hits;
mod replay;
mod report;
mod systems;
mod whole;

pub use constants::{Constant, Fitted, fit_constants};
pub use film::{FilmedShot, NotFilmed, Sample, bundled, check_size};
pub use judged::{Judged, judge};
pub use laws::{Weighed, weigh};
pub use motion::Motion;
pub use picture::paths;
pub use replay::{Replay, ReplayError};
pub use report::{csv, fit_text, models, text};
pub use systems::Natural;
pub use whole::{FITTED, Whole, play};
