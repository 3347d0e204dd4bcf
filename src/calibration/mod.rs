//! A table of the player's own: what short tests at it measure, and the constants that follow.
//!
//! `protocol` has the tests, `entries` what a player has written down of them. `forward` says what a stroke of a test leads
//! to, `estimate` which constants the marks speak for, starting from what `belief` holds of the table; `robust` knows
//! misread marks, `information` which test tells most, `daily` what the weather changes. `calibrate` does it all, and
//! `simulated` measures how far it is to be trusted.

mod belief;
mod calibrate;
mod daily;
mod entries;
mod estimate;
mod forward;
mod information;
mod protocol;
mod robust;
mod simulated;

#[cfg(test)]
mod tests;

pub use calibrate::{Calibration, CalibrationError, Change, Next, Strange, Verdict, calibrate};
pub use daily::{DAILY, Play, overnight};
pub use entries::{Entries, EntriesError, Entry, Oddity, Written};
pub use estimate::{Reading, Trial};
pub use protocol::{Mark, Moment, PROTOCOL, Quantity, Test, Unit};
pub use simulated::{Coverage, calibrated, coverage};
