//! What a run has reported, in bounded memory: the recent lines exactly, all before them thinned without losing peaks.

mod stretch;
mod thinned;

use std::collections::VecDeque;

use self::{stretch::Summary, thinned::Thinned};
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
    /// How many of them are not above zero, so that a logarithmic scale cannot show them.
    pub not_positive: u64,
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

/// A run's lines, at most a megabyte and a quarter of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// The lines before the recent ones: a line is in one of both, never in both.
    thinned: Thinned,
    recent: VecDeque<Line>,
    last: Option<Record>,
    best: Option<f64>,
    odd: [Odd; Quantity::COUNT],
}

/// A line's values in the order of [`Quantity::ALL`]; `None` is what it does not report.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    shots: u64,
    values: [Option<f64>; Quantity::COUNT],
}

impl History {
    /// Adds a line, in constant time on average. A line with fewer shots than the last one begins the history anew: the
    /// run has gone on from an earlier checkpoint, and what was thinned cannot be taken apart again.
    pub fn push(&mut self, record: &Record) {
        if self.last.as_ref().is_some_and(|last| record.shots < last.shots) {
            *self = Self::default();
        }
        let values = Quantity::ALL.map(|quantity| quantity.of(record, self.last.as_ref()));
        for (total, value) in self.odd.iter_mut().zip(values) {
            let odd = value.map_or(Odd::default(), |value| Summary::of(value).odd());
            total.nan += odd.nan;
            total.above += odd.above;
            total.below += odd.below;
        }
        if let Some(value) = record.held_out_reward.filter(|value| value.is_finite()) {
            self.best = Some(self.best.map_or(value, |best| best.max(value)));
        }
        if self.recent.len() == RECENT
            && let Some(oldest) = self.recent.pop_front()
        {
            self.thinned.push(&oldest);
        }
        self.recent.push_back(Line { shots: record.shots, values });
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
        let recent = self.recent.iter().rev().filter_map(|line| line.point(quantity));
        let before = self.thinned.stretches().iter().rev().filter_map(|stretch| stretch.point(quantity));
        recent.chain(before).find_map(|point| point.finite).map(|span| span.mean)
    }

    /// The points of a quantity between two numbers of shots and the next one beyond either end, in order: exact where
    /// the lines are recent. Stretches that do not report it are left out.
    pub fn points(&self, quantity: Quantity, shots: std::ops::RangeInclusive<f64>) -> Vec<Point> {
        let recent = self.recent.iter().filter_map(|line| line.point(quantity));
        let all = self.thinned.stretches().iter().filter_map(|stretch| stretch.point(quantity)).chain(recent);
        let (mut points, mut before) = (Vec::new(), None);
        for point in all {
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
    pub fn odd(&self, quantity: Quantity) -> Odd {
        self.odd[quantity as usize]
    }
}

impl Line {
    fn point(&self, quantity: Quantity) -> Option<Point> {
        Summary::of(self.values[quantity as usize]?).point((self.shots, self.shots))
    }
}

#[cfg(test)]
mod tests;
