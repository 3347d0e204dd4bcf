//! History against a plain count of all lines.

use proptest::prelude::*;
use rand::{RngExt, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::*;

/// A line with `shots`, a reward and a held-out reward.
fn record(shots: u64, reward: f64, held_out: Option<f64>) -> Record {
    Record { shots, rollout_reward: reward, held_out_reward: held_out, ..Record::default() }
}

/// Lines as a run may write them: uneven steps, wild values, a held-out reward every now and then.
fn lines(seed: u64, count: usize) -> Vec<Record> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut shots = 0;
    let mut one = || {
        shots += random.random_range(1..=40);
        let reward = match random.random_range(0..60) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::NEG_INFINITY,
            3 => f64::MAX,
            4 => -f64::MAX,
            _ => random.random_range(-1.0..1.0),
        };
        let held_out = (random.random_range(0..50) == 0).then(|| random.random_range(0.0..1.0));
        record(shots, reward, held_out)
    };
    (0..count).map(|_| one()).collect()
}

fn history_of(records: &[Record]) -> History {
    let mut history = History::default();
    for record in records {
        history.push(record);
    }
    history
}

/// The point that `lines` make, worked out the long way.
fn plain(lines: &[(u64, f64)], shots: (u64, u64)) -> Point {
    let within = lines.iter().filter(|line| (shots.0..=shots.1).contains(&line.0)).map(|line| line.1);
    let values: Vec<f64> = within.collect();
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let min = finite.iter().copied().fold(f64::INFINITY, f64::min);
    let max = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let count = |is: fn(f64) -> bool| values.iter().filter(|value| is(**value)).count() as u64;
    Point {
        shots,
        finite: (!finite.is_empty()).then(|| Span {
            min,
            // Rounding takes a sum of shares of the largest numbers beyond all of them, to infinity.
            mean: finite.iter().map(|value| value / finite.len() as f64).sum::<f64>().clamp(min, max),
            max,
            not_positive: count(|value| value.is_finite() && value <= 0.0),
        }),
        odd: NonFinite {
            nan: count(f64::is_nan),
            above: count(|value| value == f64::INFINITY),
            below: count(|value| value == f64::NEG_INFINITY),
        },
    }
}

fn agree(found: &Point, wanted: &Point) -> bool {
    let close = |one: Span, other: Span| {
        let size = one.min.abs().max(one.max.abs());
        (one.min, one.max, one.not_positive) == (other.min, other.max, other.not_positive)
            && (one.min..=one.max).contains(&one.mean)
            && (one.mean / size - other.mean / size).abs() < 1e-12
    };
    let finite = match (found.finite, wanted.finite) {
        (Some(one), Some(other)) => close(one, other),
        (one, other) => one == other,
    };
    finite && (found.shots, found.odd) == (wanted.shots, wanted.odd)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_line_is_in_exactly_one_point_which_knows_its_peaks(seed: u64, count in 0_usize..12_000) {
        let records = lines(seed, count);
        let history = history_of(&records);
        for quantity in [Quantity::Reward, Quantity::HeldOut] {
            let lines: Vec<_> =
                records.iter().filter_map(|line| Some((line.shots, quantity.of(line, None)?))).collect();
            let points = history.points(quantity, f64::NEG_INFINITY..=f64::INFINITY);
            prop_assert!(points.is_sorted_by(|one, next| one.shots.1 < next.shots.0));
            let mut inside = 0;
            for point in &points {
                let wanted = plain(&lines, point.shots);
                prop_assert!(agree(point, &wanted), "{:?} is not {:?}", point, wanted);
                inside += lines.iter().filter(|line| (point.shots.0..=point.shots.1).contains(&line.0)).count();
            }
            prop_assert_eq!(inside, lines.len());
            let all = plain(&lines, (0, u64::MAX));
            prop_assert_eq!(history.odd(quantity), all.odd);
            if quantity == Quantity::HeldOut {
                prop_assert_eq!(history.best(), all.finite.map(|span| span.max));
            }
        }
    }

    #[test]
    fn a_part_is_what_touches_it_and_one_point_beyond_either_end(seed: u64, ends in (0_u64..150_000, 0_u64..150_000)) {
        let history = history_of(&lines(seed, 6_000));
        let all = history.points(Quantity::HeldOut, f64::NEG_INFINITY..=f64::INFINITY);
        let (start, end) = (ends.0.min(ends.1), ends.0.max(ends.1));
        let first = all.iter().position(|point| point.shots.1 >= start).unwrap_or(all.len());
        let beyond = all.iter().position(|point| point.shots.0 > end).unwrap_or(all.len());
        let wanted = &all[first.saturating_sub(1)..(beyond + 1).min(all.len())];
        prop_assert_eq!(history.points(Quantity::HeldOut, start as f64..=end as f64), wanted);
    }
}

#[test]
fn the_recent_lines_are_exact() {
    let records = lines(7, 9_000);
    let history = history_of(&records);
    let recent = &records[records.len() - RECENT..];
    let points = history.points(Quantity::QValue, recent[0].shots as f64..=f64::INFINITY);
    assert_eq!(points.len(), RECENT + 1);
    for (point, line) in points[1..].iter().zip(recent) {
        assert_eq!(point.shots, (line.shots, line.shots));
    }
    assert_eq!(history.last(), records.last());
}

#[test]
fn a_week_stays_in_bounded_memory_and_keeps_a_peak_of_one_line() {
    let mut history = History::default();
    for line in 0..3_000_000 {
        let reward = if line == 1_234_567 { 9.0 } else { (line % 10) as f64 / 10.0 };
        history.push(&record(100 * line, reward, (line % 50 == 0).then_some(0.5)));
        assert!(history.thinned.stretches().len() <= thinned::CAPACITY && history.recent.len() <= RECENT);
    }
    assert!(history.thinned.stretches().len() >= thinned::CAPACITY / 2);
    assert!(size_of::<Stretch>() * (thinned::CAPACITY + RECENT) < 1_400_000);
    let points = history.points(Quantity::Reward, 0.0..=3e8);
    let peaks: Vec<_> = points.iter().filter(|point| point.finite.is_some_and(|span| span.max == 9.0)).collect();
    assert_eq!(peaks.len(), 1);
    assert!((peaks[0].shots.0..=peaks[0].shots.1).contains(&123_456_700));
}

#[test]
fn a_run_that_went_on_from_earlier_begins_anew() {
    let mut history = History::default();
    for shots in [100, 200, 300, 200, 250] {
        history.push(&record(shots, f64::NAN, Some(shots as f64)));
    }
    assert_eq!((history.best(), history.odd(Quantity::Reward).nan), (Some(250.0), 2));
    let shots: Vec<_> = history.points(Quantity::Reward, 0.0..=1e9).iter().map(|point| point.shots.0).collect();
    assert_eq!(shots, [200, 250]);
}

#[test]
fn quantities_are_numbered_in_the_order_of_their_list() {
    for (n, quantity) in Quantity::ALL.into_iter().enumerate() {
        assert_eq!(quantity as usize, n);
    }
}
