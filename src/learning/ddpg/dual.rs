//! Dual numbers: values with their slopes along the numbers of an action (forward-mode differentiation).

use std::ops::{Add, Mul, Neg, Sub};

use glam::DVec2;

/// Variables with respect to which slopes are computed: as many as an action has numbers.
pub const VARIABLES: usize = 5;

/// A value and its partial derivatives with respect to the numbers of an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    pub value: f64,
    /// Partial derivative with respect to each number of the action.
    pub slope: [f64; VARIABLES],
}

impl Dual {
    /// Creates a number that does not depend on the action.
    pub const fn constant(value: f64) -> Self {
        Self { value, slope: [0.0; VARIABLES] }
    }

    /// Creates the action's number `index`, whose slope along itself is 1.
    pub fn action(index: usize, value: f64) -> Self {
        Self { value, slope: std::array::from_fn(|other| f64::from(u8::from(other == index))) }
    }

    /// Applies a function by the chain rule, given its value and derivative at this number.
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: self.slope.map(|slope| derivative * slope) }
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }

    pub fn recip(self) -> Self {
        let inverse = self.value.recip();
        self.chain(inverse, -inverse * inverse)
    }

    /// Returns the cosine for this sine, limited away from zero, where its slope would be infinite.
    pub fn cosine(self) -> Self {
        (-(self * self).at_most(0.998) + 1.0).sqrt()
    }

    pub fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    pub fn at_most(self, limit: f64) -> Self {
        if self.value > limit { Self::constant(limit) } else { self }
    }

    pub fn at_least(self, limit: f64) -> Self {
        if self.value < limit { Self::constant(limit) } else { self }
    }

    pub fn min(self, other: Self) -> Self {
        if other.value < self.value { other } else { self }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: std::array::from_fn(|action| self.slope[action] + other.slope[action]),
        }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        // The product rule.
        Self { value, slope: (self.chain(0.0, other.value) + other.chain(0.0, self.value)).slope }
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

/// A plane vector of dual numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DualVector {
    pub x: Dual,
    pub y: Dual,
}

impl DualVector {
    /// Creates a vector that does not depend on the action.
    pub const fn constant(vector: DVec2) -> Self {
        Self { x: Dual::constant(vector.x), y: Dual::constant(vector.y) }
    }

    /// Returns this vector rotated by the angle of the unit vector `by`.
    pub fn rotated(self, by: DVec2) -> Self {
        Self { x: self.x * by.x - self.y * by.y, y: self.x * by.y + self.y * by.x }
    }

    /// Returns the unit vector of the same direction.
    pub fn normalised(self) -> Self {
        let inverse = self.dot(self).sqrt().recip();
        Self { x: self.x * inverse, y: self.y * inverse }
    }

    pub fn dot(self, other: Self) -> Dual {
        self.x * other.x + self.y * other.y
    }

    /// Returns the component of `other` to the left of this vector, times this vector's length.
    pub fn perp_dot(self, other: Self) -> Dual {
        self.x * other.y - self.y * other.x
    }
}

impl Sub for DualVector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

impl Mul<f64> for DualVector {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Self { x: self.x * other, y: self.y * other }
    }
}
