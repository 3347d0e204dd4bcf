//! The value axis: a range with round ends that changes seldom while data arrive, and its ticks.

use crate::terminal::ui::chart::{label::Unit, step::Step};

/// Columns of the labels; a range whose labels do not fit is widened until they do.
pub const LABEL_WIDTH: usize = 6;
/// Largest magnitude that is drawn, so that no range overflows.
const MAX_VALUE: f64 = 1e300;
/// Smaller magnitudes are treated as zero.
const MIN_VALUE: f64 = 1e-300;
/// Smallest distance between two labels, rows, and largest number of labels on an axis.
const LABEL_SPACING: f64 = 1.9;
const MAX_LABELS: f64 = 12.0;
/// Number of decades above which a logarithmic range ends at whole decades.
const FEW_DECADES: f64 = 2.0;
/// Possible distances between two labels of a logarithmic range, decades.
const DECADES: [i32; 8] = [1, 2, 3, 5, 10, 20, 50, 100];

/// A range of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    /// The step that the ends are multiples of; `None` for a logarithmic scale.
    step: Option<Step>,
}

/// A tick with its label.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Position between the bottom (0) and the top (1).
    pub at: f64,
    /// The label, empty if none fits.
    pub label: String,
}

impl Scale {
    /// Creates a linear scale for values from `min` to `max`, both finite. The ends are multiples of a step of 1, 2 or 5 times a power of
    /// ten, and the range is two to five steps long. Growing data change the range seven times per decade.
    pub fn linear(min: f64, max: f64) -> Self {
        let round = |value: f64| if value.abs() < MIN_VALUE { 0.0 } else { value.clamp(-MAX_VALUE, MAX_VALUE) };
        let (mut low, mut high) = (round(min), round(max));
        if high - low <= high.abs().max(low.abs()) * 1e-6 {
            let size = if low == 0.0 { 1.0 } else { low.abs() / 2.0 };
            high += size;
            low -= if low == 0.0 { 0.0 } else { size };
        }
        if low > 0.0 && low <= high / 2.0 {
            low = 0.0;
        } else if high < 0.0 && high >= low / 2.0 {
            high = 0.0;
        }
        let mut step = Step::at_most((high - low) / 2.0);
        loop {
            let ends = [step.times(step.count_down(low)), step.times(step.count_up(high))];
            let unit = Unit::new(ends[0].abs().max(ends[1].abs()), step);
            let narrow = |value: &f64| unit.label(*value).len() <= LABEL_WIDTH;
            // Exponents of three digits after a minus sign never fit; such ends get no label.
            if ends.iter().all(narrow) || step.value() > high.max(-low) {
                return Self { low: ends[0], high: ends[1], step: Some(step) };
            }
            step = step.next();
        }
    }

    /// Creates a logarithmic scale for values from `min` to `max`, both positive. It ends at whole decades, or at 1, 2 or 5 times a power
    /// of ten if the range is short.
    pub fn logarithmic(min: f64, max: f64) -> Self {
        let round = |value: f64| value.clamp(MIN_VALUE, MAX_VALUE);
        let (mut low, mut high) = (Step::at_most(round(min)), Step::at_least(round(max)));
        if low == high {
            (low, high) = (low.previous(), high.next());
        }
        if high.value().log10() - low.value().log10() > FEW_DECADES + 1e-9 {
            low = Step::decade(low.power());
            high = if Step::decade(high.power()) == high { high } else { Step::decade(high.power() + 1) };
        }
        Self { low: low.value(), high: high.value(), step: None }
    }

    /// Position of `value`: 0 is the bottom, 1 the top; `None` if a logarithmic scale cannot show it.
    pub fn fraction(&self, value: f64) -> Option<f64> {
        if self.step.is_some() {
            // Halves, because the difference of the ends may overflow.
            Some((value / 2.0 - self.low / 2.0) / (self.high / 2.0 - self.low / 2.0))
        } else {
            (value > 0.0).then(|| (value.log10() - self.low.log10()) / self.decades())
        }
    }

    /// The ticks of a plot of `rows` rows, from the bottom up.
    pub fn ticks(&self, rows: u16) -> Vec<Tick> {
        match rows {
            0 => Vec::new(),
            1 => self.ends().split_off(1),
            _ => {
                let ticks = match self.step {
                    Some(step) => self.linear_ticks(step, rows),
                    None => self.logarithmic_ticks(rows),
                };
                // Two labelled ends are more useful than one end and a value in between.
                let reach = ticks.last().map_or(0.0, |last| last.at) - ticks.first().map_or(0.0, |first| first.at);
                if ticks.len() < 2 || (ticks.len() == 2 && reach < 0.99) { self.ends() } else { ticks }
            }
        }
    }

    fn linear_ticks(&self, step: Step, rows: u16) -> Vec<Tick> {
        let share = |step: Step| step.value() / (self.high - self.low);
        let largest = self.high.abs().max(self.low.abs());
        let fits = |step: Step| {
            let unit = Unit::new(largest, step);
            let narrow = |value| unit.label(value).len() <= LABEL_WIDTH;
            f64::from(rows - 1) * share(step) >= spacing(rows) && narrow(self.low) && narrow(self.high)
        };
        // Large plots have room for finer steps than that of the ends.
        let mut step = step.previous().previous();
        while !fits(step) && share(step) < 1.0 {
            step = step.next();
        }
        let unit = Unit::new(largest, step);
        let counts = step.count_up(self.low)..=step.count_down(self.high);
        counts.filter_map(|count| self.tick(step.times(count), unit)).collect()
    }

    fn logarithmic_ticks(&self, rows: u16) -> Vec<Tick> {
        let rows_each = f64::from(rows - 1) / self.decades();
        let fine = rows_each * 2_f64.log10() >= spacing(rows);
        let apart = DECADES.into_iter().find(|count| rows_each * f64::from(*count) >= spacing(rows)).unwrap_or(1000);
        let mut ticks = Vec::new();
        let mut step = Step::at_least(self.low);
        while step.value() <= self.high * (1.0 + 1e-9) {
            let is_decade = Step::decade(step.power()) == step;
            if fine || (is_decade && step.power().rem_euclid(apart) == 0) {
                ticks.extend(self.tick(step.value(), Unit::new(step.value(), step)));
            }
            step = step.next();
        }
        ticks
    }

    /// Length of a logarithmic range in decades; a difference of logarithms, because the quotient of the ends may overflow.
    fn decades(&self) -> f64 {
        self.high.log10() - self.low.log10()
    }

    fn ends(&self) -> Vec<Tick> {
        let largest = self.high.abs().max(self.low.abs());
        let own = |value: f64| Unit::new(value, Step::at_most(value.abs().max(MIN_VALUE)));
        let unit = |value: f64| self.step.map_or_else(|| own(value), |step| Unit::new(largest, step));
        [self.low, self.high].into_iter().filter_map(|value| self.tick(value, unit(value))).collect()
    }

    fn tick(&self, value: f64, unit: Unit) -> Option<Tick> {
        let label = Some(unit.label(value)).filter(|label| label.len() <= LABEL_WIDTH).unwrap_or_default();
        Some(Tick { at: self.fraction(value)?, label })
    }
}

/// Smallest distance between two labels in a plot of `rows` rows.
fn spacing(rows: u16) -> f64 {
    LABEL_SPACING.max(f64::from(rows) / MAX_LABELS)
}

/// The ticks for shots between the ends of `shots` in a plot of `width` columns, far enough apart for their labels.
pub fn shot_ticks(shots: (f64, f64), width: u16) -> Vec<Tick> {
    /// Smallest gap between two labels, columns.
    const GAP: usize = 3;
    let range = shots.1 - shots.0;
    let mut step = Step::at_least((range / f64::from(width.max(1))).max(1.0));
    loop {
        let unit = Unit::new(shots.1.abs().max(shots.0.abs()), step);
        let ends = [step.count_up(shots.0), step.count_down(shots.1)];
        let widest = ends.into_iter().map(|count| unit.label(step.times(count)).len()).max().unwrap_or(0);
        let columns = f64::from(width.saturating_sub(1)) * (step.value() / range);
        if columns >= ((widest + GAP) as f64).max(f64::from(width) / MAX_LABELS) || step.value() > range {
            let tick = |count| {
                let value = step.times(count);
                Tick { at: (value - shots.0) / range, label: unit.label(value) }
            };
            return (ends[0]..=ends[1]).map(tick).collect();
        }
        step = step.next();
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn words(ticks: &[Tick]) -> String {
        ticks.iter().map(|tick| tick.label.as_str()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn ranges_end_at_round_numbers_and_include_a_near_zero() {
        let cases: [(f64, f64); 14] = [
            (0.1, 0.38),
            (0.81, 0.93),
            (-0.2, 1.4),
            (-0.9, -0.1),
            (0.5, 0.5),
            (0.0, 0.0),
            (-3.0, -3.0),
            (900.0, 1234.0),
            (12_345.1, 12_345.3),
            (-1.7e30, 1.7e30),
            (0.0, 3e-30),
            (-f64::MAX, f64::MAX),
            (2e-310, 3e-310),
            (1_234_500.0, 1_234_600.0),
        ];
        let lines = cases.map(|(min, max)| format!("{min:e} {max:e}: {}", words(&Scale::linear(min, max).ticks(9))));
        insta::assert_snapshot!(lines.join("\n"), @r"
        1e-1 3.8e-1: 0 0.1 0.2 0.3 0.4
        8.1e-1 9.3e-1: 0.80 0.85 0.90 0.95
        -2e-1 1.4e0: -0.5 0 0.5 1.0 1.5
        -9e-1 -1e-1: -1.0 -0.5 0
        5e-1 5e-1: 0 0.2 0.4 0.6 0.8
        0e0 0e0: 0 0.5 1.0
        -3e0 -3e0: -6 -4 -2 0
        9e2 1.234e3: 0.9k 1.0k 1.1k 1.2k 1.3k
        1.23451e4 1.23453e4: 12345 12346
        -1.7e30 1.7e30: -2e30 -1e30 0 1e30 2e30
        0e0 3e-30: 0 1e-30 2e-30 3e-30
        -1.7976931348623157e308 1.7976931348623157e308: -1e300 0 1e300
        2e-310 3e-310: 0 0.5 1.0
        1.2345e6 1.2346e6: 1234k 1235k
        ");
    }

    #[test]
    fn logarithmic_ranges_are_decades_or_a_few_round_numbers() {
        let cases = [(0.3, 0.9), (0.011, 0.8), (1e-6, 400.0), (5.0, 5.0), (1e-30, 1e30), (5e-324, f64::MAX)];
        let lines =
            cases.map(|(min, max)| format!("{min:e} {max:e}: {}", words(&Scale::logarithmic(min, max).ticks(9))));
        insta::assert_snapshot!(lines.join("\n"), @r"
        3e-1 9e-1: 0.2 0.5 1
        1.1e-2 8e-1: 0.01 0.1 1
        1e-6 4e2: 1e-6 0.001 1 1k
        5e0 5e0: 2 5 10
        1e-30 1e30: 1e-20 1 1e20
        5e-324 1.7976931348623157e308: 1e-300 1e300
        ");
    }

    #[test]
    fn growing_values_change_the_range_seven_times_per_decade() {
        let mut tops = Vec::new();
        for max in (1..=10_000).map(|n| 1e-3 * f64::from(n)) {
            let top = Scale::linear(0.0, max).high;
            assert!((max * 0.999_999..=max * 1.500_001).contains(&top), "{top} for {max}");
            tops.push(top);
        }
        tops.dedup();
        assert!(tops.len() <= 4 * 7 + 1, "{tops:?}");
    }

    #[test]
    fn shot_labels_do_not_overlap_and_share_a_unit() {
        let words = |shots, width| words(&shot_ticks(shots, width));
        assert_eq!(words((0.0, 1e6), 53), "0 0.2M 0.4M 0.6M 0.8M 1.0M");
        assert_eq!(words((0.0, 5e5), 53), "0 100k 200k 300k 400k 500k");
        assert_eq!(words((0.0, 2e6), 19), "0 1M 2M");
        assert_eq!(words((123_400.0, 124_600.0), 40), "123.5k 124.0k 124.5k");
        assert_eq!(words((5.2, 5.9), 40), "");
    }

    proptest! {
        #[test]
        fn every_value_lies_in_the_range_and_every_label_fits(
            one in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
            other in proptest::num::f64::NORMAL,
            near in -3.0..3.0,
            rows in 1_u16..60,
            log: bool,
        ) {
            // In half of the cases both ends have similar magnitudes, which gives long labels.
            let other = if rows % 2 == 0 { other } else { one * (1.0 + near * 1e-3) };
            let (one, other) = if log { (one.abs().max(1e-320), other.abs().max(1e-320)) } else { (one, other) };
            let (min, max) = (one.min(other).max(-f64::MAX), one.max(other).min(f64::MAX));
            let scale = if log { Scale::logarithmic(min, max) } else { Scale::linear(min, max) };
            let sound = |value: f64| value.abs() < 1e300 && (value == 0.0 || value.abs() > 1e-300);
            for value in [min, max] {
                let place = scale.fraction(value).unwrap();
                prop_assert!(place.is_finite());
                prop_assert!(!sound(value) || (-1e-6..=1.0 + 1e-6).contains(&place), "{} in {:?}", place, scale);
            }
            let ticks = scale.ticks(rows);
            prop_assert!(!ticks.is_empty() && ticks.len() <= MAX_LABELS as usize + 1, "{:?}", ticks);
            let differ = |one: &Tick, next: &Tick| one.label != next.label || one.label.is_empty();
            prop_assert!(ticks.is_sorted_by(|one, next| one.at < next.at && differ(one, next)), "{:?}", ticks);
            for tick in &ticks {
                prop_assert!((-1e-6..=1.0 + 1e-6).contains(&tick.at) && tick.label.len() <= LABEL_WIDTH, "{:?}", ticks);
            }
        }
    }
}
