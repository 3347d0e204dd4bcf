//! Calibration of the player's own table: short tests at the table, and the estimation of its constants from their marks.
//!
//! `protocol` defines the tests, `entries` the marks that a player has written down. `forward` simulates a stroke of a test.
//! `estimate` fits the constants to the marks, starting from the prior in `belief`, and `posterior` computes their uncertainty.
//! `rails` detects rails that differ from the others, `robust` handles misread marks, `information` finds the most informative test,
//! and `daily` models the weather. `calibrate` combines all of these, `words` describes the result, and `simulated` measures the
//! coverage of the intervals. `typed` parses input, `kept` stores the entries, `saved` the table; `sketch` contains a drawing of a test.

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
