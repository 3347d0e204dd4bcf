//! What a run has reported, in bounded memory: the recent lines exactly, all of it thinned without losing peaks.

use super::{metrics::Record, quantity::Quantity};

/// Lines that are kept as they are.
pub const RECENT: usize = 1000;

/// One quantity over a stretch of a run: a line of metrics, or several that were thinned to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Shots played at the first and the last line of the stretch.
    pub shots: (u64, u64),
    /// Smallest, mean and largest finite value; `None` where there is no finite value.
    pub finite: Option<Span>,
    /// What else there was.
    pub odd: Odd,
}

/// Finite values of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The smallest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub max: f64,
}

/// How many values were not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Odd {
    /// Not numbers.
    pub nan: u64,
    /// Above all numbers.
    pub above: u64,
    /// Below all numbers.
    pub below: u64,
}

/// A run's lines.
#[derive(Clone, Debug, Default)]
pub struct History {}

impl History {
    /// Adds a line.
    pub fn push(&mut self, record: &Record) {
        let _ = record;
    }

    /// The last line.
    pub fn last(&self) -> Option<&Record> {
        None
    }

    /// Lines added.
    pub fn lines(&self) -> u64 {
        0
    }

    /// The largest held-out reward so far.
    pub fn best(&self) -> Option<f64> {
        None
    }

    /// The points of a quantity between two numbers of shots, in order: exact where the lines are recent. Stretches that
    /// do not report it are left out.
    pub fn points(&self, quantity: Quantity, shots: std::ops::RangeInclusive<f64>) -> Vec<Point> {
        let _ = (quantity, shots);
        Vec::new()
    }

    /// All values of a quantity that were not finite.
    pub fn odd(&self, quantity: Quantity) -> Odd {
        let _ = quantity;
        Odd::default()
    }
}
