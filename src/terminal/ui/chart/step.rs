//! Round numbers, 1, 2 and 5 times powers of ten, as steps of axes and labels.

/// 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    digit: u8,
    power: i32,
}

/// Relative tolerance for rounding errors of round numbers.
const ROUNDING: f64 = 1e-9;

impl Step {
    /// The largest step not above `value`, which must be positive and finite.
    pub fn at_most(value: f64) -> Self {
        let mut power = value.log10().floor() as i32;
        let mut lead = value / power_of_ten(power);
        if lead < 1.0 - ROUNDING {
            power -= 1;
            lead *= 10.0;
        } else if lead > 10.0 * (1.0 - ROUNDING) {
            power += 1;
            lead /= 10.0;
        }
        let digit = [5, 2].into_iter().find(|digit| lead >= f64::from(*digit) * (1.0 - ROUNDING)).unwrap_or(1);
        Self { digit, power }
    }

    /// The smallest step not below `value`, which must be positive and finite.
    pub fn at_least(value: f64) -> Self {
        let below = Self::at_most(value);
        if below.value() >= value * (1.0 - ROUNDING) { below } else { below.next() }
    }

    /// The step 10^`power`.
    pub const fn decade(power: i32) -> Self {
        Self { digit: 1, power }
    }

    /// The next larger step.
    #[must_use]
    pub const fn next(self) -> Self {
        match self.digit {
            1 => Self { digit: 2, ..self },
            2 => Self { digit: 5, ..self },
            _ => Self::decade(self.power + 1),
        }
    }

    /// The next smaller step.
    #[must_use]
    pub const fn previous(self) -> Self {
        match self.digit {
            5 => Self { digit: 2, ..self },
            2 => Self { digit: 1, ..self },
            _ => Self { digit: 5, power: self.power - 1 },
        }
    }

    /// The value of the step.
    pub fn value(self) -> f64 {
        self.times(1)
    }

    /// `count` times the step.
    pub fn times(self, count: i64) -> f64 {
        let whole = (count * i64::from(self.digit)) as f64;
        // Dividing rounds once, multiplying by a tenth would round twice: 3 / 10 is 0.3.
        if self.power < 0 { whole / power_of_ten(-self.power) } else { whole * power_of_ten(self.power) }
    }

    /// `value` in steps, rounded down; saturates far above what a label could show.
    pub fn count_down(self, value: f64) -> i64 {
        (value / self.value() + ROUNDING).floor() as i64
    }

    /// `value` in steps, rounded up.
    pub fn count_up(self, value: f64) -> i64 {
        (value / self.value() - ROUNDING).ceil() as i64
    }

    /// The power of ten of the step.
    pub const fn power(self) -> i32 {
        self.power
    }
}

/// 10^`power`.
pub fn power_of_ten(power: i32) -> f64 {
    if power < 0 { 1.0 / 10_f64.powi(-power) } else { 10_f64.powi(power) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_enclose_every_number_and_are_their_own_bounds() {
        for value in [1e-300, 3e-30, 0.001, 0.999_999, 1.0, 1.9, 2.0, 4.99, 7.0, 10.0, 12_345.0, 1e30, 9e299] {
            let (below, above) = (Step::at_most(value), Step::at_least(value));
            assert!(below.value() <= value * 1.000_001 && value < below.next().value(), "{value}: {below:?}");
            assert!(above.value() >= value * 0.999_999 && value > above.previous().value(), "{value}: {above:?}");
        }
        for power in -300..300 {
            for step in [Step::decade(power), Step::decade(power).next(), Step::decade(power).previous()] {
                assert_eq!((Step::at_most(step.value()), Step::at_least(step.value())), (step, step));
            }
        }
    }

    #[test]
    fn multiples_are_the_decimal_numbers_themselves() {
        assert_eq!(Step::decade(-1).times(3), 0.3);
        assert_eq!(Step::at_most(0.2).times(3), 0.6);
        assert_eq!((Step::at_most(0.2).count_down(0.6), Step::at_most(0.2).count_up(0.6)), (3, 3));
    }
}
