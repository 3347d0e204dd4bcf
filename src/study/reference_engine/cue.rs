//! The cue strike (thesis 2.2.1) in any precision; the caller provides sines and cosines of the angles.

use super::{Ball, Numbers, Real, Vector, flight::press};

/// A stroke with its angles as sines and cosines.
#[derive(Clone, Copy, Debug)]
pub struct Stroke<R> {
    /// Offset of the tip to the side, in ball radii.
    pub a: R,
    /// Offset of the tip upwards, in ball radii.
    pub b: R,
    /// Sine and cosine of the elevation.
    pub theta: (R, R),
    /// Sine and cosine of the direction.
    pub phi: (R, R),
    /// Speed of the cue, m/s.
    pub speed: R,
}

/// Returns sine and cosine of the ball's direction with squirt: it deviates away from the tip's side by an angle with the
/// tangent `5/2 a √(1-a²) / (1 + m/m_e + 5/2 (1-a²))` (Alciatore, TP A.31).
fn squirted<R: Real>(numbers: &Numbers<R>, a: R, (sine, cosine): (R, R)) -> (R, R) {
    let Some(ratio) = numbers.end_ratio else { return (sine, cosine) };
    let (one, rest) = (R::of(1.0), (R::of(1.0) - a * a).max(R::zero()));
    let tangent = R::of(2.5) * a * rest.sqrt() / (one + ratio + R::of(2.5) * rest);
    let (turned_sine, turned_cosine) = (sine - tangent * cosine, cosine + tangent * sine);
    let length = (one + tangent * tangent).sqrt();
    (turned_sine / length, turned_cosine / length)
}

/// Returns velocity and spin just after the stroke, by thesis equations (9), (15) and (16) divided by the ball's mass, in the
/// direction with squirt. If balls can leave the cloth, its reaction is included.
pub fn strike<R: Real>(numbers: &Numbers<R>, stroke: &Stroke<R>) -> (Vector<R>, Vector<R>) {
    let Stroke { a, b, theta: (sin_theta, cos_theta), phi, speed } = *stroke;
    let (sin_phi, cos_phi) = squirted(numbers, a, phi);
    let c = (R::of(1.0) - a * a - b * b).max(R::zero()).sqrt();
    let offset = a * a + b * b * cos_theta * cos_theta + c * c * sin_theta * sin_theta
        - R::of(2.0) * b * c * cos_theta * sin_theta;
    let force = R::of(2.0) * speed / (R::of(1.0) + numbers.mass_ratio + R::of(2.5) * offset);
    let along = force * cos_theta;
    let pressed = if numbers.flight.is_some() { -force * sin_theta } else { R::zero() };
    let velocity = Vector::new(along * cos_phi, along * sin_phi, pressed);
    // In the cue's frame (16): across, along and up.
    let across = c * sin_theta - b * cos_theta;
    let (along, up) = (a * sin_theta, -a * cos_theta);
    let turning = Vector::new(across * sin_phi - along * cos_phi, -across * cos_phi - along * sin_phi, up);
    let spin = turning * (R::of(2.5) * force / numbers.radius);
    let mut ball = Ball { velocity, spin, ..Ball::at_rest(Vector::zero()) };
    press(numbers, &mut ball);
    (ball.velocity, ball.spin)
}
