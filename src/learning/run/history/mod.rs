//! What a run has reported, in bounded memory: the recent lines exactly, all before them thinned without losing peaks.

mod stretch;
mod thinned;

use std::collections::VecDeque;

use self::{stretch::Stretch, thinned::Thinned};
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
    pub odd: NonFinite,
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
    /// How many of them are not above zero, so that a logarithmic scale cannot show them.
    pub not_positive: u64,
}

/// How many values were not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NonFinite {
    /// Not numbers.
    pub nan: u64,
    /// Above all numbers.
    pub above: u64,
    /// Below all numbers.
    pub below: u64,
}

/// A run's lines, at most 1.4 megabytes of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// The lines before the recent ones: a line is in one of both, never in both.
    thinned: Thinned,
    /// Stretches of one line.
    recent: VecDeque<Stretch>,
    last: Option<Record>,
    best: Option<f64>,
}

impl History {
    /// Adds a line, in constant time on average. A line with fewer shots than the last one begins the history anew: the
    /// run has gone on from an earlier checkpoint, and what was thinned cannot be taken apart again.
    pub fn push(&mut self, record: &Record) {
        if self.last.as_ref().is_some_and(|last| record.shots < last.shots) {
            *self = Self::default();
        }
        if let Some(value) = record.held_out_reward.filter(|value| value.is_finite()) {
            self.best = Some(self.best.map_or(value, |best| best.max(value)));
        }
        if self.recent.len() == RECENT
            && let Some(oldest) = self.recent.pop_front()
        {
            self.thinned.push(oldest);
        }
        self.recent.push_back(Stretch::of(record, self.last.as_ref()));
        self.last = Some(record.clone());
    }

    /// The last line.
    pub fn last(&self) -> Option<&Record> {
        self.last.as_ref()
    }

    /// The largest held-out reward so far.
    pub fn best(&self) -> Option<f64> {
        self.best
    }

    /// The last finite value of a quantity, or the mean of those that it was thinned to.
    pub fn last_of(&self, quantity: Quantity) -> Option<f64> {
        self.all(quantity).rev().find_map(|point| point.finite).map(|span| span.mean)
    }

    /// The points of a quantity between two numbers of shots and the next one beyond either end, in order: exact where
    /// the lines are recent. Stretches that do not report it are left out.
    pub fn points(&self, quantity: Quantity, shots: std::ops::RangeInclusive<f64>) -> Vec<Point> {
        let (mut points, mut before) = (Vec::new(), None);
        for point in self.all(quantity) {
            if (point.shots.1 as f64) < *shots.start() {
                before = Some(point);
                continue;
            }
            points.extend(before.take());
            points.push(point);
            if point.shots.0 as f64 > *shots.end() {
                break;
            }
        }
        points.extend(before);
        points
    }

    /// All values of a quantity that were not finite.
    pub fn odd(&self, quantity: Quantity) -> NonFinite {
        let add = |total: NonFinite, NonFinite { nan, above, below }| NonFinite {
            nan: total.nan + nan,
            above: total.above + above,
            below: total.below + below,
        };
        self.all(quantity).map(|point| point.odd).fold(NonFinite::default(), add)
    }

    /// All points of a quantity, in order.
    fn all(&self, quantity: Quantity) -> impl DoubleEndedIterator<Item = Point> {
        self.thinned.stretches().iter().chain(&self.recent).filter_map(move |stretch| stretch.point(quantity))
    }
}

#[cfg(test)]
mod tests;
