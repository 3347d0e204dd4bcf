//! A table of the player's own: what short tests at it measure, and the constants that follow.
//!
//! `protocol` has the tests, `entries` what a player has written down of them. `forward` says what a stroke of a test leads
//! to, `estimate` which constants the marks speak for, starting from what `belief` holds of the table, and `posterior` how sure they
//! are then; `rails` tells rails apart that differ; `robust` knows misread marks, `information` which test tells most, `daily` what
//! the weather changes. `calibrate` does it all, `words` says it, and `simulated` measures how far it is to be trusted. `typed`,
//! `kept` and `saved` are what a player types, the file that keeps it and the table's own; `sketch` is a test to be drawn.

mod belief;
mod calibrate;
mod daily;
mod entries;
mod estimate;
mod forward;
mod information;
mod kept;
mod posterior;
mod protocol;
mod rails;
mod robust;
mod saved;
mod simulated;
mod sketch;
mod typed;
mod words;

#[cfg(test)]
mod tests;

pub use calibrate::{Calibration, CalibrationError, Change, Next, Strange, Verdict, calibrate, prior, prospects};
pub use daily::{DAILY, Play, missing_today, overnight};
pub use entries::{Entries, Entry, Oddity, Written};
pub use estimate::{Reading, Trial};
pub use kept::{Edit, KeptError, beside, edit_entries, entries_of, kept_entries, put_aside_unread};
pub use protocol::{Mark, Moment, PROTOCOL, Quantity, Test, Unit};
pub use saved::{SaveError, may_save_table, save_table};
pub use simulated::{Coverage, calibrated, coverage};
pub use sketch::Sketch;
pub use typed::{FAR_END, RAILS, TAPED};
pub use words::NO_BETTER;
