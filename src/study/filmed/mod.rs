//! Filmed balls: how far the simulation is from what real balls did, and which constants come nearest.
//!
//! The film (`tests/data/filmed`, with its source) shows the balls' places at 50 pictures a second. `rail_hits` finds
//! where balls met rails; `chains` predicts from rail to rail, `whole` whole shots, `systems` what players count on;
//! `constants` fits a table, `laws` says how far each law of the rails is to be believed.

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
