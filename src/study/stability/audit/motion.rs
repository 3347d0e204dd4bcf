//! All velocities and spins as one vector, half of whose squared length is the energy, and the directions in which forces
//! change it.
//!
//! With `c² = 2/5` a ball's part is `(v, c R w)`. A force per mass `f` along a direction `d` changes the vector by `f d`, and
//! the speed that the force works against is the scalar product with `d`: power, impulse and energy need no masses.

use glam::DVec2;

use super::least_squares::{Column, SIZE, dot};
use crate::{
    physics::BallState,
    simulation::Rail,
    table::{BALLS, PAIRS},
};

/// `√(2/5)`.
const LEVER: f64 = 0.632_455_532_033_675_9;

/// Velocities and spins of all balls as one vector, m/s.
pub fn motion(radius: f64, balls: &[BallState; BALLS]) -> Column {
    let mut vector = [0.0; SIZE];
    for (place, ball) in vector.chunks_exact_mut(5).zip(balls) {
        let spin = LEVER * radius * ball.spin;
        place.copy_from_slice(&[ball.velocity.x, ball.velocity.y, spin.x, spin.y, spin.z]);
    }
    vector
}

/// Energy per mass of a ball, m²/s².
pub fn energy(motion: &Column) -> f64 {
    0.5 * dot(motion, motion)
}

fn add(direction: &mut Column, ball: usize, linear: DVec2, twist: [f64; 3]) {
    let parts = [linear.x, linear.y, twist[0] / LEVER, twist[1] / LEVER, twist[2] / LEVER];
    direction[5 * ball..5 * ball + 5].copy_from_slice(&parts);
}

fn one(ball: usize, linear: DVec2, twist: [f64; 3]) -> Column {
    let mut direction = [0.0; SIZE];
    add(&mut direction, ball, linear, twist);
    direction
}

/// The velocity of a ball's centre along x and y.
pub fn centre(ball: usize) -> [Column; 2] {
    [one(ball, DVec2::X, [0.0; 3]), one(ball, DVec2::Y, [0.0; 3])]
}

/// The slip of a ball on the cloth along x and y (thesis equation 1).
pub fn on_cloth(ball: usize) -> [Column; 2] {
    [one(ball, DVec2::X, [0.0, -1.0, 0.0]), one(ball, DVec2::Y, [1.0, 0.0, 0.0])]
}

/// `R w_z`.
pub fn about_vertical(ball: usize) -> Column {
    one(ball, DVec2::ZERO, [0.0, 0.0, 1.0])
}

/// A ball's contact with a cushion or another ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The ball towards which the normal points.
    pub first: usize,
    /// The other ball, or `None` for a cushion.
    pub second: Option<usize>,
    /// Unit normal towards the first ball.
    pub normal: DVec2,
}

impl Contact {
    /// That of two balls.
    pub fn of_balls(first: usize, second: usize, balls: &[BallState; BALLS]) -> Self {
        let normal = (balls[first].position - balls[second].position).normalize_or(DVec2::X);
        Self { first, second: Some(second), normal }
    }

    /// That of a ball and a cushion.
    pub const fn with_rail(first: usize, rail: Rail) -> Self {
        Self { first, second: None, normal: rail.normal() }
    }

    /// All contacts whose gap is less than `gap`, m.
    pub fn all(radius: f64, reach: DVec2, balls: &[BallState; BALLS], gap: f64) -> Vec<Self> {
        let mut contacts = Vec::new();
        for (ball, state) in balls.iter().enumerate() {
            for rail in Rail::ALL {
                let n = rail.normal();
                if n.abs().dot(reach) + state.position.dot(n) < gap {
                    contacts.push(Self::with_rail(ball, rail));
                }
            }
        }
        for (first, second) in PAIRS {
            if balls[first].position.distance(balls[second].position) - 2.0 * radius < gap {
                contacts.push(Self::of_balls(first, second, balls));
            }
        }
        contacts
    }

    /// The same contact where the balls are now.
    pub fn at(&self, balls: &[BallState; BALLS]) -> Self {
        self.second.map_or(*self, |second| Self::of_balls(self.first, second, balls))
    }

    /// The opening speed, and the slip along `t = z×n` and along z (thesis equation 21).
    pub fn directions(&self) -> [Column; 3] {
        let (n, t) = (self.normal, self.normal.perp());
        let mut all = [
            one(self.first, n, [0.0; 3]),
            one(self.first, t, [0.0, 0.0, -1.0]),
            one(self.first, DVec2::ZERO, [t.x, t.y, 0.0]),
        ];
        if let Some(second) = self.second {
            add(&mut all[0], second, -n, [0.0; 3]);
            add(&mut all[1], second, -t, [0.0, 0.0, -1.0]);
            add(&mut all[2], second, DVec2::ZERO, [t.x, t.y, 0.0]);
        }
        all
    }
}
