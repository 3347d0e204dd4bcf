//! Collisions (thesis 2.2.2 and 2.2.3). Each returns the energy over mass that it takes, worked out from the impulses.

use super::{Ball, Numbers, Real, Vector};

/// Two balls collide, with the given restitution (the table's, or zero at the end of a chatter).
pub fn balls_collide<R: Real>(numbers: &Numbers<R>, restitution: R, first: &mut Ball<R>, second: &mut Ball<R>) -> R {
    let one = R::of(1.0);
    let n = (first.position - second.position).direction();
    let relative = first.velocity - second.velocity;
    let approach = -relative.dot(n);
    let push = R::of(0.5) * (one + restitution) * approach;
    let slip = relative + n * approach + n.cross(first.spin + second.spin) * numbers.radius;
    let share = coulomb(numbers.ball_friction, push, slip.length(), R::ratio(1.0, 7.0));
    let change = n * push - slip.flat() * share;
    first.velocity = first.velocity + change;
    second.velocity = second.velocity - change;
    let turn = n.cross(slip) * (R::of(2.5) * share / numbers.radius);
    first.spin = first.spin + turn;
    second.spin = second.spin + turn;
    R::of(0.25) * (one - restitution * restitution) * approach * approach + rubbed(slip, share, R::of(0.5))
}

/// A ball hits the cushion with normal `n`, with the given restitution.
pub fn rail_collides<R: Real>(numbers: &Numbers<R>, restitution: R, n: Vector<R>, ball: &mut Ball<R>) -> R {
    let one = R::of(1.0);
    let approach = -ball.velocity.dot(n);
    let push = (one + restitution) * approach;
    let slip = ball.velocity + n * approach + n.cross(ball.spin) * numbers.radius;
    let share = coulomb(Some(numbers.rail_friction), push, slip.length(), R::ratio(2.0, 7.0));
    ball.velocity = ball.velocity + n * push - slip.flat() * share;
    ball.spin = ball.spin + n.cross(slip) * (R::of(2.5) * share / numbers.radius);
    R::of(0.5) * (one - restitution * restitution) * approach * approach + rubbed(slip, share, R::of(0.25))
}

/// Tangential impulse over slip: Coulomb's, or what stops the slip if that is less.
pub fn coulomb<R: Real>(friction: Option<R>, push: R, slip: R, stops: R) -> R {
    match friction {
        Some(friction) if friction * push < stops * slip => friction * push / slip,
        _ => stops,
    }
}

/// Work of the friction: impulse times the mean slip, which falls by 7 (two balls: half that for one) times the impulse
/// along the table, by 5 upwards since no ball leaves the cloth.
fn rubbed<R: Real>(slip: Vector<R>, share: R, bodies: R) -> R {
    let along = slip.flat().dot(slip.flat()) * (R::of(1.0) - R::of(7.0) * bodies * share);
    let upwards = slip.z * slip.z * (R::of(1.0) - R::of(5.0) * bodies * share);
    share * (along + upwards)
}
