//! Several lines of a run as one: what stays of their values when memory is short.

use super::{NonFinite, Point, Span};
use crate::learning::run::{metrics::Record, quantity::Quantity};

/// What stays of the values of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Summary {
    min: f64,
    /// A running mean, because a sum of large values may overflow.
    mean: f64,
    max: f64,
    finite: u32,
    not_positive: u32,
    nan: u32,
    above: u32,
    below: u32,
}

impl Summary {
    const EMPTY: Self = Self {
        min: f64::INFINITY,
        mean: 0.0,
        max: f64::NEG_INFINITY,
        finite: 0,
        not_positive: 0,
        nan: 0,
        above: 0,
        below: 0,
    };

    /// One value.
    fn of(value: f64) -> Self {
        if value.is_finite() {
            let not_positive = u32::from(value <= 0.0);
            Self { min: value, mean: value, max: value, finite: 1, not_positive, ..Self::EMPTY }
        } else if value.is_nan() {
            Self { nan: 1, ..Self::EMPTY }
        } else if value > 0.0 {
            Self { above: 1, ..Self::EMPTY }
        } else {
            Self { below: 1, ..Self::EMPTY }
        }
    }

    fn absorb(&mut self, other: &Self) {
        let finite = self.finite.saturating_add(other.finite);
        if finite > 0 {
            self.min = self.min.min(other.min);
            self.max = self.max.max(other.max);
            let share = f64::from(other.finite) / f64::from(finite);
            // Rounding must not carry the mean of equal values past them.
            self.mean = (self.mean * (1.0 - share) + other.mean * share).clamp(self.min, self.max);
        }
        self.finite = finite;
        self.not_positive = self.not_positive.saturating_add(other.not_positive);
        self.nan = self.nan.saturating_add(other.nan);
        self.above = self.above.saturating_add(other.above);
        self.below = self.below.saturating_add(other.below);
    }

    /// The values as those between two numbers of shots; `None` where there are none.
    fn point(&self, shots: (u64, u64)) -> Option<Point> {
        let &Self { min, mean, max, .. } = self;
        let finite = (self.finite > 0).then(|| Span { min, mean, max, not_positive: self.not_positive.into() });
        let odd = NonFinite { nan: self.nan.into(), above: self.above.into(), below: self.below.into() };
        (finite.is_some() || odd != NonFinite::default()).then_some(Point { shots, finite, odd })
    }
}

/// Successive lines as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    shots: (u64, u64),
    summaries: [Summary; Quantity::COUNT],
}

impl Stretch {
    /// A stretch of one line, which comes after `last`.
    pub fn of(record: &Record, last: Option<&Record>) -> Self {
        let summary = |quantity: Quantity| quantity.of(record, last).map_or(Summary::EMPTY, Summary::of);
        Self { shots: (record.shots, record.shots), summaries: Quantity::ALL.map(summary) }
    }

    /// Takes in the stretch that follows.
    pub fn absorb(&mut self, next: &Self) {
        self.shots.1 = next.shots.1;
        for (summary, other) in self.summaries.iter_mut().zip(&next.summaries) {
            summary.absorb(other);
        }
    }

    /// What it knows of a quantity; `None` where none of its lines reports it.
    pub fn point(&self, quantity: Quantity) -> Option<Point> {
        self.summaries[quantity as usize].point(self.shots)
    }
}
