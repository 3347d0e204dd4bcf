//! Three-dimensional vectors of any number type.

use std::ops::{Add, Mul, Neg, Sub};

use glam::DVec3;

use super::Real;

/// A vector. Positions and velocities of balls on the cloth have `z = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<R> {
    /// Along the table's length.
    pub x: R,
    /// Along its width.
    pub y: R,
    /// Upwards.
    pub z: R,
}

impl<R: Real> Vector<R> {
    /// Creates a vector from its components.
    pub fn new(x: R, y: R, z: R) -> Self {
        Self { x, y, z }
    }

    /// Converts a vector, whose `f64` count as exact.
    pub fn of(v: DVec3) -> Self {
        Self::new(R::of(v.x), R::of(v.y), R::of(v.z))
    }

    /// Rounds every component.
    pub fn to_f64(self) -> DVec3 {
        DVec3::new(self.x.to_f64(), self.y.to_f64(), self.z.to_f64())
    }

    /// Returns the zero vector.
    pub fn zero() -> Self {
        Self::new(R::zero(), R::zero(), R::zero())
    }

    /// Returns the upward unit vector.
    pub fn up() -> Self {
        Self::new(R::zero(), R::zero(), R::of(1.0))
    }

    /// Returns the scalar product.
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Returns the vector product.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Returns the length.
    pub fn length(self) -> R {
        self.dot(self).sqrt()
    }

    /// Returns the horizontal part.
    #[must_use]
    pub fn flat(self) -> Self {
        Self::new(self.x, self.y, R::zero())
    }

    /// Combines each component with the same component of another vector.
    #[must_use]
    pub fn with(self, other: Self, combine: impl Fn(R, R) -> R) -> Self {
        Self::new(combine(self.x, other.x), combine(self.y, other.y), combine(self.z, other.z))
    }

    /// Returns the unit vector in this direction, or zero for the zero vector.
    #[must_use]
    pub fn direction(self) -> Self {
        let length = self.length();
        if length > R::zero() { self * (R::of(1.0) / length) } else { Self::zero() }
    }
}

impl<R: Real> Add for Vector<R> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<R: Real> Sub for Vector<R> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<R: Real> Neg for Vector<R> {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<R: Real> Mul<R> for Vector<R> {
    type Output = Self;

    fn mul(self, factor: R) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}
