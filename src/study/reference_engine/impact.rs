//! Collisions (thesis 2.2.2 and 2.2.3, and cushions with contact at the height of the nose). Each function returns the
//! dissipated energy per mass, computed from the impulses.

use super::{
    Ball, Numbers, Real, Vector,
    rails::{Cushion, RailLaw},
};

/// Maximum number of immediately repeated impacts on a nose, and the remaining share of the approach speed at which they end.
const MAX_REPEATS: u32 = 400;
const END_OF_APPROACH: f64 = 1e-28;

/// Collides two balls.
pub fn balls_collide<R: Real>(numbers: &Numbers<R>, first: &mut Ball<R>, second: &mut Ball<R>) -> R {
    let one = R::of(1.0);
    let n = (first.position - second.position).direction();
    let relative = first.velocity - second.velocity;
    let approach = -relative.dot(n);
    let restitution = numbers.ball_restitution_at(approach);
    let push = R::of(0.5) * (one + restitution) * approach;
    let slip = relative + n * approach + n.cross(first.spin + second.spin) * numbers.radius;
    let share = coulomb(numbers.ball_friction_at(slip.length()), push, slip.length(), R::ratio(1.0, 7.0));
    let change = n * push - slip.flat() * share;
    first.velocity = first.velocity + change;
    second.velocity = second.velocity - change;
    let turn = n.cross(slip) * (R::of(2.5) * share / numbers.radius);
    first.spin = first.spin + turn;
    second.spin = second.spin + turn;
    R::of(0.25) * (one - restitution * restitution) * approach * approach + friction_work(slip, share, R::of(0.5))
}

/// Collides a ball with a cushion whose normal into the table is `n`.
pub fn rail_collides<R: Real>(numbers: &Numbers<R>, cushion: &Cushion<R>, n: Vector<R>, ball: &mut Ball<R>) -> R {
    let one = R::of(1.0);
    let approach = -ball.velocity.dot(n);
    let restitution = cushion.restitution_at(approach);
    if let RailLaw::Nose { sine, cosine, most } = cushion.law {
        let meet = |restitution: R, ball: &mut Ball<R>| {
            nose_collides(numbers, cushion.friction, restitution, n, [sine, cosine], most, ball)
        };
        let (mut taken, mut climb) = meet(restitution, ball);
        // While the cloth holds down a ball that the nose has not thrown back, the impact repeats immediately.
        for _ in 0..MAX_REPEATS {
            let left = -ball.velocity.dot(n);
            if left <= approach * R::of(END_OF_APPROACH) || climb > R::zero() {
                break;
            }
            let (more, up) = meet(cushion.restitution_at(left), ball);
            (taken, climb) = (taken + more, climb + up);
        }
        return taken;
    }
    let push = (one + restitution) * approach;
    let slip = ball.velocity + n * approach + n.cross(ball.spin) * numbers.radius;
    let share = coulomb(Some(cushion.friction), push, slip.length(), R::ratio(2.0, 7.0));
    ball.velocity = ball.velocity + n * push - slip.flat() * share;
    ball.spin = ball.spin + n.cross(slip) * (R::of(2.5) * share / numbers.radius);
    R::of(0.5) * (one - restitution * restitution) * approach * approach + friction_work(slip, share, R::of(0.25))
}

/// Collides a ball with a nose. The normal impulse acts along the line from the nose to the ball's centre, and friction across
/// it. The cloth absorbs a downward impulse. An upward impulse lifts the ball if it is fast enough and balls can leave the
/// cloth. Also returns the upward impulse.
fn nose_collides<R: Real>(
    numbers: &Numbers<R>,
    friction: R,
    restitution: R,
    n: Vector<R>,
    [sine, cosine]: [R; 2],
    most: Option<R>,
    ball: &mut Ball<R>,
) -> (R, R) {
    let before = *ball;
    let to_nose = Vector::up() * sine - n * cosine;
    let push = (R::of(1.0) + restitution) * ball.velocity.dot(to_nose);
    let surface = ball.velocity + ball.spin.cross(to_nose) * numbers.radius;
    let slip = surface - to_nose * surface.dot(to_nose);
    let size = slip.length();
    let rub = slip * -nose_friction(most, friction * push, size);
    let impulse = rub - to_nose * push;
    let climbs = numbers.flight.is_some_and(|flight| impulse.z > flight.lifts);
    let up = impulse.z;
    let impulse = if climbs { impulse } else { impulse.flat() };
    ball.velocity = ball.velocity + impulse;
    let turn = to_nose.cross(rub);
    ball.spin = ball.spin + turn * (R::of(2.5) / numbers.radius);
    // Impulses times the mean speeds of their points of action.
    let mean = R::of(-0.5);
    let taken =
        mean * (impulse.dot(before.velocity + ball.velocity) + numbers.radius * turn.dot(before.spin + ball.spin));
    (taken, up)
}

/// Returns the tangential impulse over the slip on a nose, given `μP/m`: Coulomb's law, or a law with a smooth transition to
/// sticking.
pub fn nose_friction<R: Real>(most: Option<R>, push: R, slip: R) -> R {
    match most {
        None => coulomb(Some(R::of(1.0)), push, slip, R::ratio(2.0, 7.0)),
        Some(most) if slip > R::zero() => most * (push / (most * slip)).tanh(),
        Some(_) => R::zero(),
    }
}

/// Returns the tangential impulse over the slip: Coulomb's, or the share that stops the slip if that is less.
pub fn coulomb<R: Real>(friction: Option<R>, push: R, slip: R, stops: R) -> R {
    match friction {
        Some(friction) if friction * push < stops * slip => friction * push / slip,
        _ => stops,
    }
}

/// Returns the work of friction: impulse times mean slip. Along the table the slip decreases by 7 times the impulse (two balls:
/// half of that for one), upwards by 5 times, because no ball leaves the cloth.
fn friction_work<R: Real>(slip: Vector<R>, share: R, bodies: R) -> R {
    let along = slip.flat().dot(slip.flat()) * (R::of(1.0) - R::of(7.0) * bodies * share);
    let upwards = slip.z * slip.z * (R::of(1.0) - R::of(5.0) * bodies * share);
    share * (along + upwards)
}
