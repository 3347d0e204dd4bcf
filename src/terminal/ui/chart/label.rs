//! Number labels: short, and with a common unit and number of decimals along an axis.

use crate::terminal::{
    ui::chart::step::{Step, power_of_ten},
    words::fixed,
};

/// Magnitudes outside this range are written with an exponent.
const PLAIN: std::ops::Range<f64> = 1e-3..1e15;
/// Powers of ten with a unit letter.
const LETTERS: [(i32, &str); 4] = [(12, "T"), (9, "G"), (6, "M"), (3, "k")];
/// Most decimals of a number without a letter, and of one with a letter.
const DECIMALS: (i32, i32) = (4, 2);

/// Number format that the labels of an axis share.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    power: i32,
    letter: Option<&'static str>,
    decimals: usize,
}

impl Unit {
    /// The unit for values of magnitude up to `largest` that are `step` apart.
    pub fn new(largest: f64, step: Step) -> Self {
        let largest = largest.abs();
        let decimals = |power: i32| (power - step.power()).max(0);
        let unit = |power, letter| Self { power, letter, decimals: decimals(power) as usize };
        if largest > 0.0 && (!PLAIN.contains(&largest) || (largest < 1.0 && decimals(0) > DECIMALS.0)) {
            return unit(Step::at_most(largest).power(), None);
        }
        let fits = |power| largest >= power_of_ten(power) * (1.0 - 1e-9) && decimals(power) <= DECIMALS.1;
        LETTERS
            .into_iter()
            .find(|(power, _)| fits(*power))
            .map_or(unit(0, Some("")), |(power, letter)| unit(power, Some(letter)))
    }

    /// Formats `value` in this unit. Zero has no unit.
    pub fn label(&self, value: f64) -> String {
        if value == 0.0 {
            return "0".to_owned();
        }
        let lead = if self.power < 0 { value * power_of_ten(-self.power) } else { value / power_of_ten(self.power) };
        let number = fixed(lead, self.decimals);
        match self.letter {
            Some(letter) => number + letter,
            None => format!("{number}e{}", self.power),
        }
    }
}

/// Formats a single `value` with three or four digits.
pub fn compact(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if value == 0.0 => "0".to_owned(),
        _ if !value.is_finite() => value.to_string(),
        _ if !PLAIN.contains(&size) => format!("{value:.2e}"),
        _ if size < 9.999_95 => fixed(value, 4),
        _ if size < 99.995 => fixed(value, 2),
        _ if size < 999.95 => fixed(value, 1),
        _ if size < 9_999.5 => fixed(value, 0),
        _ => {
            let rounded = size * (1.0 + 5e-4);
            let (power, letter) =
                LETTERS.into_iter().find(|(power, _)| rounded >= power_of_ten(*power)).unwrap_or((0, ""));
            let lead = value / power_of_ten(power);
            let decimals = match lead.abs() {
                lead if lead < 9.995 => 2,
                lead if lead < 99.95 => 1,
                _ => 0,
            };
            fixed(lead, decimals) + letter
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(step: f64, counts: &[i64]) -> String {
        let step = Step::at_most(step);
        let largest = counts.iter().map(|count| step.times(*count).abs()).fold(0.0, f64::max);
        let unit = Unit::new(largest, step);
        counts.iter().map(|count| unit.label(step.times(*count))).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn labels_of_an_axis_share_unit_and_decimals() {
        insta::assert_snapshot!([
            axis(0.05, &[0, 1, 10]),
            axis(0.2, &[-1, 0, 1, 5]),
            axis(200.0, &[0, 1, 6]),
            axis(2e5, &[0, 1, 5]),
            axis(5e6, &[0, 1]),
            axis(5.0, &[24_680, 24_681]),
            axis(1e-6, &[0, 1, 12]),
            axis(5e-7, &[0, 1, 3]),
            axis(2e-4, &[0, 1, 5]),
            axis(5e29, &[0, 1, 3]),
        ].join("\n"), @r"
        0 0.05 0.50
        -0.2 0 0.2 1.0
        0 0.2k 1.2k
        0 0.2M 1.0M
        0 5M
        123400 123405
        0 0.1e-5 1.2e-5
        0 0.5e-6 1.5e-6
        0 0.0002 0.0010
        0 0.5e30 1.5e30
        ");
    }

    #[test]
    fn a_single_number_is_short_and_never_minus_zero() {
        let words = [
            0.012_34, -0.0, 0.0, -0.25, 9.999_99, 12.345, 123.45, 999.96, 1234.0, 9999.7, 12_345.0, 999_600.0, 1.234e6,
            5e-7, 1e30, -1.5e-30,
        ];
        let words: Vec<_> = words.into_iter().map(compact).collect();
        assert_eq!(
            words.join(" "),
            "0.0123 0 0 -0.2500 10.00 12.35 123.5 1000 1234 10.0k 12.3k 1.00M 1.23M 5.00e-7 1.00e30 -1.50e-30"
        );
    }
}
