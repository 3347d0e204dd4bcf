//! Double-double arithmetic: numbers of about 32 digits as the unevaluated sum of two `f64`, by error-free sums and products
//! (Dekker 1971; Hida, Li and Bailey 2001).
//!
//! The relative error of every operation is below 2^-102, as long as no value is near the limits of the `f64` range.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Real;

/// The number `high + low`, where `low` is at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// The circle constant π.
    pub const PI: Self = Self { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

    /// Natural logarithm of two.
    const LN_2: Self = Self { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

    /// Returns the exact sum of two `f64`, if `large` is zero or not the smaller of the two in size.
    fn of_ordered(large: f64, small: f64) -> Self {
        let high = large + small;
        Self { high, low: small - (high - large) }
    }

    /// Returns the exact sum of any two `f64`.
    pub fn of_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        Self { high, low: (a - (high - of_b)) + (b - of_b) }
    }

    /// Returns the exact product of two `f64`, by splitting each into halves of at most 26 bits. A fused multiply-add would
    /// need a single operation, but is a slow function call on machines that the program is not compiled for.
    pub fn of_product(a: f64, b: f64) -> Self {
        let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
        let high = a * b;
        Self { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
    }

    /// Returns sine and cosine of an angle in radians, by power series after reduction by multiples of a right angle.
    pub fn sin_cos(self) -> (Self, Self) {
        let right = Self::PI * Self::of(0.5);
        let turns = (self.high / right.high).round();
        let angle = self - right * Self::of(turns);
        let (mut sine, mut cosine) = (Self::zero(), Self::zero());
        let mut term = Self::of(1.0);
        // The terms fall below 1e-34 for the largest reduced angle, an eighth of a turn.
        for n in 0..32 {
            match n % 4 {
                0 => cosine = cosine + term,
                1 => sine = sine + term,
                2 => cosine = cosine - term,
                _ => sine = sine - term,
            }
            term = term * angle / Self::of(f64::from(n + 1));
        }
        match turns.rem_euclid(4.0) as u8 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }

    /// Returns hyperbolic sine and cosine by power series, for arguments up to one half.
    fn hyperbolic(self) -> (Self, Self) {
        let (mut sine, mut cosine) = (Self::zero(), Self::zero());
        let mut term = Self::of(1.0);
        for n in 0..26 {
            if n % 2 == 0 {
                cosine = cosine + term;
            } else {
                sine = sine + term;
            }
            term = term * self / Self::of(f64::from(n + 1));
        }
        (sine, cosine)
    }
}

fn halves(value: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0;
    let scaled = SPLITTER * value;
    let upper = scaled - (scaled - value);
    (upper, value - upper)
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let high = Self::of_sum(self.high, other.high);
        let low = Self::of_sum(self.low, other.low);
        let sum = Self::of_ordered(high.high, high.low + low.high);
        Self::of_ordered(sum.high, sum.low + low.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = Self::of_product(self.high, other.high);
        Self::of_ordered(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    /// Long division with digits of 53 bits.
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::of(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::of(second);
        let third = rest.high / other.high;
        Self::of_ordered(first, second) + Self::of(third)
    }
}

impl Real for DoubleDouble {
    const ROUNDING: f64 = f64::EPSILON * f64::EPSILON;

    fn of(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    fn to_f64(self) -> f64 {
        self.high
    }

    /// One Newton step from the `f64` root, which doubles the number of digits.
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::zero();
        }
        let root = self.high.sqrt();
        let rest = self - Self::of_product(root, root);
        Self::of_ordered(root, rest.high / (2.0 * root))
    }

    /// Power series after reduction by a power of two.
    fn exp(self) -> Self {
        let powers = (self.high / std::f64::consts::LN_2).round();
        let rest = self - Self::LN_2 * Self::of(powers);
        let (sine, cosine) = rest.hyperbolic();
        (sine + cosine) * Self::of(powers.exp2())
    }

    fn tanh(self) -> Self {
        let one = Self::of(1.0);
        if self.high.abs() < 0.25 {
            let (sine, cosine) = self.hyperbolic();
            return sine / cosine;
        }
        // Beyond 40, the difference from one is below rounding.
        let size = self.abs().min(Self::of(40.0));
        let small = (Self::of(-2.0) * size).exp();
        let tangent = (one - small) / (one + small);
        if self.high < 0.0 { -tangent } else { tangent }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a number from its integer part and groups of 12 decimal digits, which are exact as `f64`.
    fn decimal(leading: f64, groups: [f64; 3]) -> DoubleDouble {
        let scale = DoubleDouble::of(1e12);
        groups.iter().rev().fold(DoubleDouble::zero(), |sum, group| (sum + DoubleDouble::of(*group)) / scale)
            + DoubleDouble::of(leading)
    }

    fn agrees(value: DoubleDouble, known: DoubleDouble) {
        let error = ((value - known) / known).to_f64().abs();
        assert!(error < 1e-30, "{value:?} is off by {error:e}");
    }

    #[test]
    fn known_values_are_accurate_to_thirty_digits() {
        let of = DoubleDouble::of;
        agrees(of(2.0).sqrt(), decimal(1.0, [414_213_562_373.0, 095_048_801_688.0, 724_209_698_079.0]));
        agrees(of(3.0).sqrt(), decimal(1.0, [732_050_807_568.0, 877_293_527_446.0, 341_505_872_367.0]));
        agrees(of(1.0) / of(7.0) + of(1.0), decimal(1.0, [142_857_142_857.0, 142_857_142_857.0, 142_857_142_857.0]));
        agrees(DoubleDouble::PI, decimal(3.0, [141_592_653_589.0, 793_238_462_643.0, 383_279_502_884.0]));
        let pi_squared = decimal(9.0, [869_604_401_089.0, 358_618_834_490.0, 999_876_151_135.0]);
        agrees(DoubleDouble::PI * DoubleDouble::PI, pi_squared);
        agrees(pi_squared / DoubleDouble::PI, DoubleDouble::PI);
        agrees(pi_squared.sqrt(), DoubleDouble::PI);
    }

    #[test]
    fn cancellation_leaves_the_small_term() {
        let tiny = DoubleDouble::of(1e-25);
        let rest = (DoubleDouble::of(1.0) + tiny) - DoubleDouble::of(1.0);
        assert!((rest - tiny).to_f64().abs() < 1e-32);
    }

    #[test]
    fn exponentials_are_accurate_to_thirty_digits() {
        let of = DoubleDouble::of;
        agrees(of(1.0).exp(), decimal(2.0, [718_281_828_459.0, 045_235_360_287.0, 471_352_662_497.0]));
        agrees(of(-3.5).exp(), decimal(0.0, [030_197_383_422.0, 318_500_739_786.0, 292_363_619_845.0]));
        agrees(of(0.125).tanh(), decimal(0.0, [124_353_001_771.0, 596_208_054_647.0, 275_805_892_707.0]));
        agrees(of(-0.75).tanh(), -decimal(0.0, [635_148_952_387.0, 287_319_214_434.0, 357_312_496_495.0]));
        agrees(of(3.0).tanh(), decimal(0.0, [995_054_753_686.0, 730_451_331_880.0, 185_255_488_475.0]));
        assert!((of(1e300).tanh() - of(1.0)).to_f64().abs() < 1e-32);
    }

    #[test]
    fn sines_are_accurate_to_thirty_digits_in_every_quadrant() {
        let (sine, cosine) = DoubleDouble::of(1.0).sin_cos();
        agrees(sine + DoubleDouble::of(1.0), decimal(1.0, [841_470_984_807.0, 896_506_652_502.0, 321_630_298_999.0]));
        agrees(cosine + DoubleDouble::of(1.0), decimal(1.0, [540_302_305_868.0, 139_717_400_936.0, 607_442_976_603.0]));
        for degrees in [30.0, 150.0, 210.0, 330.0, -30.0] {
            let (sine, cosine) = (DoubleDouble::of(degrees) * DoubleDouble::PI / DoubleDouble::of(180.0)).sin_cos();
            agrees(sine.abs(), DoubleDouble::of(0.5));
            agrees(cosine * cosine, DoubleDouble::of(0.75));
            assert_eq!(sine.to_f64() > 0.0, degrees.to_radians().sin() > 0.0);
            assert_eq!(cosine.to_f64() > 0.0, degrees.to_radians().cos() > 0.0);
        }
    }
}
