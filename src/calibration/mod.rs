//! Calibration of the player's own table: short tests at the table, and the estimation of its constants from their marks.
//!
//! `protocol` defines the tests, `entries` the marks that a player has written down. `forward` simulates a stroke of a test.
//! `estimate` fits the constants to the marks, starting from the prior in `belief`, and `posterior` computes their uncertainty.
//! `rails` detects rails that differ from the others, `robust` handles misread marks, `information` finds the most informative test,
//! and `daily` models the weather. `calibrate` combines all of these, `words` describes the result, and `simulated` measures the
//! coverage of the intervals. `typed` parses input, `entries_file` stores the entries, `table_file` the table; `sketch` contains a drawing
//! of a test.

mod belief;
mod calibrate;
mod daily;
mod entries;
mod entries_file;
mod estimate;
mod forward;
mod information;
mod posterior;
mod protocol;
mod rails;
mod robust;
mod simulated;
mod sketch;
mod table_file;
mod typed;
mod words;

#[cfg(test)]
mod tests;

pub use calibrate::{
    Calibration, CalibrationError, Change, MarkCheck, NextTest, OutlierStroke, calibrate, prior,
    rank_tests_before_trials,
};
pub use daily::{DAILY_TESTS, TablePlay, missing_daily_tests, next_day_doubt};
pub use entries::{Entries, Entry, EntryProblem, MarkValue};
pub use entries_file::{
    Edit, EntriesFileError, back_up_unreadable, edit_entries, latest_backup_path, load_entries, load_entries_or_empty,
};
pub use estimate::{Reading, Trial};
pub use protocol::{Mark, Moment, PROTOCOL, Quantity, Test, Unit};
pub use simulated::{Coverage, coverage, simulated_calibration};
pub use sketch::Sketch;
pub use table_file::{SaveError, may_save_table, save_table};
pub use typed::{FAR_END, RAILS, TAPE_ERROR_TEXT};
pub use words::NO_BETTER;
