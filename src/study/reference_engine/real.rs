//! The numbers that the reference engine computes with: what it needs of them, for `f32` and `f64`.

use std::{
    fmt::Debug,
    ops::{Add, Div, Mul, Neg, Sub},
};

/// A real number to some precision. The engine needs no more than the four operations, the root, a comparison and, for the
/// frictions of some tables, the exponential.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Relative error of one operation.
    const ROUNDING: f64;

    /// The nearest number to `value`.
    fn of(value: f64) -> Self;

    /// The nearest `f64`.
    fn to_f64(self) -> f64;

    /// The square root of a number that is not negative.
    #[must_use]
    fn sqrt(self) -> Self;

    /// `e` to this power.
    #[must_use]
    fn exp(self) -> Self;

    /// The hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;

    /// Zero.
    fn zero() -> Self {
        Self::of(0.0)
    }

    /// The size without the sign.
    #[must_use]
    fn abs(self) -> Self {
        if self < Self::zero() { -self } else { self }
    }

    /// The smaller of two.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// The larger of two.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// A fraction whose numerator and denominator are exact.
    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::of(numerator) / Self::of(denominator)
    }
}

impl Real for f64 {
    const ROUNDING: f64 = f64::EPSILON / 2.0;

    fn of(value: f64) -> Self {
        value
    }

    fn to_f64(self) -> f64 {
        self
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn exp(self) -> Self {
        self.exp()
    }

    fn tanh(self) -> Self {
        self.tanh()
    }
}

impl Real for f32 {
    const ROUNDING: f64 = f32::EPSILON as f64 / 2.0;

    fn of(value: f64) -> Self {
        value as f32
    }

    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn exp(self) -> Self {
        self.exp()
    }

    fn tanh(self) -> Self {
        self.tanh()
    }
}
