//! The history of a run's metrics, quantity by quantity, and its reduction to the points of a chart.
//!
//! A line of metrics takes 112 bytes here, and up to twice as much while a vector grows. A run has 2,500 lines by default, and
//! the longest of `models/train.sh` 5,200: 0.6 megabytes. With one line per second a week has 600,000: 70 megabytes, a third of the
//! size of the metrics file, and 10 ms to compute the points of four charts.

use std::ops::RangeInclusive;

use super::{metrics::Record, quantity::Quantity};

/// Largest number of points for a chart, several times the number of columns of a screen. More lines are grouped into points.
const MAX_POINTS: usize = 4096;

/// One quantity over one or several successive lines of metrics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Shots played at the first and the last of the lines.
    pub shots: (u64, u64),
    /// Smallest, mean and largest finite value; `None` if there is no finite value.
    pub finite: Option<Span>,
    /// Numbers of values that are not finite.
    pub non_finite: NonFinite,
}

/// Range and mean of the finite values of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The smallest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub max: f64,
    /// Number of values that are not above zero, so that a logarithmic scale cannot show them.
    pub not_positive: u64,
}

/// Numbers of values that were not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NonFinite {
    /// Values that are NaN.
    pub nan: u64,
    /// Values that are positive infinity.
    pub above: u64,
    /// Values that are negative infinity.
    pub below: u64,
}

/// The shots played at a line, and the line's value.
type Line = (u64, f64);

impl Point {
    /// Combines successive lines, at least one, to one point.
    fn of(lines: &[Line]) -> Self {
        let mut span = Span { min: f64::INFINITY, mean: 0.0, max: f64::NEG_INFINITY, not_positive: 0 };
        let (mut non_finite, mut finite) = (NonFinite::default(), 0.0);
        // Sums up shares of the values, because the sum of large values would overflow.
        let share = 1.0 / lines.len() as f64;
        for &(_, value) in lines {
            if value.is_finite() {
                finite += 1.0;
                (span.min, span.max) = (span.min.min(value), span.max.max(value));
                span.mean += value * share;
                span.not_positive += u64::from(value <= 0.0);
            } else {
                non_finite.count(value);
            }
        }
        let span = (finite > 0.0).then(|| {
            // The mean of equal values must not differ from them by rounding.
            let mean = (span.mean / (finite * share)).clamp(span.min, span.max);
            Span { mean, ..span }
        });
        Self { shots: (lines[0].0, lines[lines.len() - 1].0), finite: span, non_finite }
    }
}

impl NonFinite {
    /// Counts a value that is not finite.
    fn count(&mut self, value: f64) {
        let number = match value {
            value if value.is_nan() => &mut self.nan,
            value if value > 0.0 => &mut self.above,
            _ => &mut self.below,
        };
        *number += 1;
    }
}

/// The lines of metrics of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// For each quantity, the lines that contain it.
    lines: [Vec<Line>; Quantity::COUNT],
    last: Option<Record>,
}

impl History {
    /// Adds a line. A line with fewer shots than the last one restarts the history, because the run was resumed from an earlier
    /// checkpoint.
    pub fn push(&mut self, record: &Record) {
        if self.last.as_ref().is_some_and(|last| record.shots < last.shots) {
            *self = Self::default();
        }
        for (lines, quantity) in self.lines.iter_mut().zip(Quantity::ALL) {
            lines.extend(quantity.of(record, self.last.as_ref()).map(|value| (record.shots, value)));
        }
        self.last = Some(record.clone());
    }

    /// Returns the last line.
    pub fn last(&self) -> Option<&Record> {
        self.last.as_ref()
    }

    /// Returns the largest held-out reward so far.
    pub fn best(&self) -> Option<f64> {
        self.finite(Quantity::HeldOut).reduce(f64::max)
    }

    /// Returns the last finite value of a quantity.
    pub fn last_of(&self, quantity: Quantity) -> Option<f64> {
        self.finite(quantity).next_back()
    }

    /// Returns the points of a quantity in a range of shots, plus the next line beyond either end, in order. Each point is one line, or
    /// several if there are too many lines to draw.
    pub fn points(&self, quantity: Quantity, shots: RangeInclusive<f64>) -> Vec<Point> {
        let lines = self.of(quantity);
        let first = lines.partition_point(|(at, _)| (*at as f64) < *shots.start());
        let beyond = lines.partition_point(|(at, _)| *at as f64 <= *shots.end()).max(first);
        let lines = &lines[first.saturating_sub(1)..(beyond + 1).min(lines.len())];
        lines.chunks(lines.len().div_ceil(MAX_POINTS).max(1)).map(Point::of).collect()
    }

    /// Counts all values of a quantity that were not finite.
    pub fn non_finite(&self, quantity: Quantity) -> NonFinite {
        let mut non_finite = NonFinite::default();
        let values = self.of(quantity).iter().map(|(_, value)| *value);
        values.filter(|value| !value.is_finite()).for_each(|value| non_finite.count(value));
        non_finite
    }

    fn of(&self, quantity: Quantity) -> &[Line] {
        &self.lines[quantity as usize]
    }

    fn finite(&self, quantity: Quantity) -> impl DoubleEndedIterator<Item = f64> {
        self.of(quantity).iter().map(|(_, value)| *value).filter(|value| value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line with `shots`, a reward and a held-out reward.
    fn record(shots: u64, reward: f64, held_out: Option<f64>) -> Record {
        Record { shots, rollout_reward: reward, held_out_reward: held_out, ..Record::default() }
    }

    fn history_of(records: impl IntoIterator<Item = Record>) -> History {
        let mut history = History::default();
        records.into_iter().for_each(|record| history.push(&record));
        history
    }

    const ALL: RangeInclusive<f64> = f64::NEG_INFINITY..=f64::INFINITY;

    #[test]
    fn a_range_includes_one_point_beyond_each_end() {
        let history = history_of((1..=4000).map(|n| record(100 * n, n as f64, (n % 50 == 0).then_some(0.5))));
        let all = history.points(Quantity::HeldOut, ALL);
        assert_eq!((all.len(), all[0].shots), (80, (5000, 5000)));
        for (range, shots) in [
            (9_000.0..=16_000.0, vec![5000, 10_000, 15_000, 20_000]),
            (10_000.0..=15_000.0, vec![5000, 10_000, 15_000, 20_000]),
            (11_000.0..=12_000.0, vec![10_000, 15_000]),
            (0.0..=1.0, vec![5000]),
            (500_000.0..=600_000.0, vec![400_000]),
        ] {
            let points = history.points(Quantity::HeldOut, range);
            assert_eq!(points.iter().map(|point| point.shots.0).collect::<Vec<_>>(), shots);
        }
        assert!(History::default().points(Quantity::Reward, ALL).is_empty());
    }

    #[test]
    fn reduced_points_keep_single_line_peaks() {
        let reward = |n: u64| match n {
            123_456 => 9.0,
            7 => f64::NAN,
            8 => f64::INFINITY,
            9 => f64::NEG_INFINITY,
            _ => (n % 10) as f64 / 10.0,
        };
        let history = history_of((0..600_000).map(|n| record(100 * n, reward(n), None)));
        let points = history.points(Quantity::Reward, ALL);
        assert!(points.len() <= MAX_POINTS && points.is_sorted_by(|one, next| one.shots.1 < next.shots.0));
        let non_finite = NonFinite { nan: 1, above: 1, below: 1 };
        assert_eq!((history.non_finite(Quantity::Reward), points[0].non_finite), (non_finite, non_finite));
        let peaks: Vec<_> = points.iter().filter(|point| point.finite.is_some_and(|span| span.max == 9.0)).collect();
        assert!(peaks.len() == 1 && (peaks[0].shots.0..=peaks[0].shots.1).contains(&12_345_600));
        // In a shorter range each line is a point again.
        assert_eq!(history.points(Quantity::Reward, 1e6..=1.2e6).len(), 2003);
    }

    #[test]
    fn means_of_the_largest_numbers_stay_finite() {
        let span = |values: &[f64]| {
            let lines: Vec<Line> = (0..).zip(values.iter().copied()).collect();
            Point::of(&lines).finite
        };
        let max = f64::MAX;
        assert_eq!(span(&[max; 3]), Some(Span { min: max, mean: max, max, not_positive: 0 }));
        assert_eq!(span(&[0.0, f64::NAN, 1.0]), Some(Span { min: 0.0, mean: 0.5, max: 1.0, not_positive: 1 }));
        assert_eq!(span(&[f64::NAN]), None);
    }

    #[test]
    fn an_earlier_checkpoint_restarts_the_history() {
        let history = history_of([100, 200, 300, 200, 250].map(|shots| record(shots, f64::NAN, Some(shots as f64))));
        assert_eq!((history.best(), history.non_finite(Quantity::Reward).nan), (Some(250.0), 2));
        let shots: Vec<_> = history.points(Quantity::Reward, ALL).iter().map(|point| point.shots.0).collect();
        assert_eq!(shots, [200, 250]);
        assert_eq!((history.last_of(Quantity::HeldOut), history.last_of(Quantity::Reward)), (Some(250.0), None));
    }

    #[test]
    fn quantity_numbers_match_their_list() {
        for (n, quantity) in Quantity::ALL.into_iter().enumerate() {
            assert_eq!(quantity as usize, n);
        }
    }
}
