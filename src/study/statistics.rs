//! Median, 99th percentile and maximum of an error: a mean alone would hide the tail.

use serde::Serialize;

use crate::statistics::SuccessRate;

/// Distribution of an error over the shots.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The 99th percentile.
    pub p99: f64,
    /// The maximum.
    pub worst: f64,
}

impl Spread {
    /// Computes the spread of `values`; `None` if there are none. NaN counts as infinity.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> =
            values.into_iter().map(|value| if value.is_nan() { f64::INFINITY } else { value }).collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        // Nearest rank: the smallest value that at least this share of the values does not exceed.
        let rank = |share: f64| values[((share * values.len() as f64).ceil() as usize).saturating_sub(1).min(last)];
        Some(Self { median: rank(0.5), p99: rank(0.99), worst: values[last] })
    }
}

/// A share of the shots and its 95 % confidence interval (Wilson's).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Proportion {
    /// Number of shots that count.
    pub count: usize,
    /// Number of all shots.
    #[serde(rename = "of")]
    pub total: usize,
    /// Lower bound of the interval.
    pub low: f64,
    /// Upper bound of the interval.
    pub high: f64,
}

impl Proportion {
    /// Computes the share of `true` values.
    pub fn of(holds: impl IntoIterator<Item = bool>) -> Self {
        let (mut count, mut total) = (0, 0);
        for one in holds {
            count += usize::from(one);
            total += 1;
        }
        let SuccessRate { low, high, .. } = SuccessRate::new(count, total);
        Self { count, total, low, high }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_uses_nearest_rank_and_nan_counts_as_worst() {
        let spread = Spread::of((1..=200).map(f64::from)).unwrap();
        assert_eq!((spread.median, spread.p99, spread.worst), (100.0, 198.0, 200.0));
        assert_eq!(Spread::of([1.0, f64::NAN]).unwrap().worst, f64::INFINITY);
        assert_eq!(Spread::of([]), None);
    }

    #[test]
    fn proportion_of_zero_has_an_upper_bound() {
        let share = Proportion::of([false; 100]);
        assert_eq!((share.count, share.total, share.low), (0, 100, 0.0));
        assert!(share.high > 0.03 && share.high < 0.04);
    }
}
