//! Comparison with filmed balls: how far the simulation deviates from real balls, and which constants fit them best.
//!
//! The film (`tests/data/filmed`, with its source) contains the positions of the balls at 50 frames a second. `rail_hits`
//! detects impacts on rails. `chains` predicts from rail to rail, `shot_fit` predicts whole shots, `systems` compares with
//! diamond systems. `constants` fits the constants of a table, `laws` weighs the models of the rails.

mod chains;
mod constants;
mod contacts;
mod evaluation;
mod film;
mod laws;
mod motion;
mod picture;
mod rail_hits;
mod replay;
mod report;
mod shot_fit;
mod systems;

pub use constants::fit_constants;
pub use evaluation::evaluate_model;
pub use film::{FilmedShot, SizeMismatch, bundled, check_size};
pub use laws::weigh_models;
pub use picture::paths;
pub use replay::{Replay, ReplayError};
pub use report::{csv, fit_text, models, text};
pub use shot_fit::FITTED_SECONDS;
