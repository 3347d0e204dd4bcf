//! The number types of the reference engine: the required operations, and their implementations for `f32` and `f64`.

use std::{
    fmt::Debug,
    ops::{Add, Div, Mul, Neg, Sub},
};

/// A real number of some precision. The engine needs the four operations, the square root, comparisons and, for the friction of
/// some tables, the exponential and the hyperbolic tangent.
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
    /// Relative rounding error of one operation.
    const ROUNDING: f64;

    /// Returns the nearest number to `value`.
    fn of(value: f64) -> Self;

    /// Returns the nearest `f64`.
    fn to_f64(self) -> f64;

    /// Returns the square root of a non-negative number.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Returns `e` to this power.
    #[must_use]
    fn exp(self) -> Self;

    /// Returns the hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;

    /// Returns zero.
    fn zero() -> Self {
        Self::of(0.0)
    }

    /// Returns the absolute value.
    #[must_use]
    fn abs(self) -> Self {
        if self < Self::zero() { -self } else { self }
    }

    /// Returns the smaller of two numbers.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// Returns the larger of two numbers.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// Returns a quotient of two exact numbers.
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
