//! Represents all velocities and spins as one vector, half of whose squared length is the energy, and the directions in which
//! forces change it.
//!
//! With `c² = 2/5`, the components of a ball are `(v, c R w)`. A force per mass `f` along a direction `d` changes the vector by
//! `f d`. The speed that the force works against is the scalar product with `d`: power, impulse and energy need no masses.

use super::least_squares::{Column, SIZE};
use crate::{
    physics::BallState,
    statistics::dot,
    study::reference_engine::{Ball, Contact, Numbers, Row, Vector},
    table::BALLS,
};

/// `√(2/5)`.
const LEVER: f64 = 0.632_455_532_033_675_9;

/// Returns velocities and spins of all balls as one vector, m/s.
pub fn motion(radius: f64, balls: &[BallState; BALLS]) -> Column {
    let mut vector = [0.0; SIZE];
    for (place, ball) in vector.chunks_exact_mut(5).zip(balls) {
        let spin = LEVER * radius * ball.spin;
        place.copy_from_slice(&[ball.velocity.x, ball.velocity.y, spin.x, spin.y, spin.z]);
    }
    vector
}

/// Returns the energy per mass of a ball, m²/s².
pub fn energy(motion: &Column) -> f64 {
    0.5 * dot(motion, motion)
}

/// Converts the balls to those of the reference engine.
pub fn reference_balls(balls: &[BallState; BALLS]) -> [Ball<f64>; BALLS] {
    balls.map(|BallState { position, velocity, spin }| {
        let [position, velocity] = [position, velocity].map(|v| Vector::of(v.extend(0.0)));
        Ball { velocity, spin: Vector::of(spin), ..Ball::at_rest(position) }
    })
}

/// Returns the direction of a row: the effect of a unit of its force.
fn column(numbers: &Numbers<f64>, row: &Row<f64>) -> Column {
    let mut balls = [(Vector::zero(), Vector::zero()); BALLS];
    row.push(numbers, 1.0, &mut balls);
    let lever = LEVER * numbers.radius;
    let mut vector = [0.0; SIZE];
    for (place, (v, w)) in vector.chunks_exact_mut(5).zip(balls) {
        place.copy_from_slice(&[v.x, v.y, lever * w.x, lever * w.y, lever * w.z]);
    }
    vector
}

/// Returns the unit vectors along x and y.
fn axes() -> [Vector<f64>; 2] {
    [Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0)]
}

/// Returns the directions of a ball's velocity along x and y.
pub fn centre(numbers: &Numbers<f64>, ball: usize) -> [Column; 2] {
    axes().map(|axis| column(numbers, &Row::centre(ball, axis)))
}

/// Returns the directions of a ball's slip on the cloth along x and y (thesis equation 1).
pub fn on_cloth(numbers: &Numbers<f64>, ball: usize) -> [Column; 2] {
    axes().map(|axis| column(numbers, &Row::cloth(numbers, ball, axis)))
}

/// Returns the direction of the side spin, `R w_z`.
pub fn about_vertical(numbers: &Numbers<f64>, ball: usize) -> Column {
    column(numbers, &Row::turning(numbers, ball))
}

/// Returns the directions of a contact's opening speed, and of its slip along `t = z×n` and along z (thesis equation 21).
pub fn directions(numbers: &Numbers<f64>, contact: Contact, balls: &[Ball<f64>; BALLS]) -> [Column; 3] {
    let n = contact.normal(balls);
    let slip = |along| Row::slip(numbers, contact, n, along);
    [Row::opening(contact, n), slip(Vector::up().cross(n)), slip(Vector::up())].map(|row| column(numbers, &row))
}

/// Returns all contacts whose gap is less than `gap`, m.
pub fn closed_contacts(numbers: &Numbers<f64>, balls: &[Ball<f64>; BALLS], gap: f64) -> Vec<Contact> {
    Contact::all().filter(|contact| contact.gap(numbers, balls) < gap).collect()
}
