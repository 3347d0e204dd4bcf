//! Balls off the cloth: the reaction of the cloth to a ball that is pressed into it or lands on it, and impacts of balls in the
//! air. Every landing is an event, down to hops of the size of rounding.

use super::{
    Ball, Motion, Numbers, Real, Vector,
    contact::{Balls, Contact},
    impact::{coulomb, nose_friction},
    table::normal,
    tolerance::last_hop,
};
use crate::simulation::{EventKind, Rail};

/// The result of an impact in the air.
pub struct ImpactAloft<R> {
    /// The resulting events.
    pub events: Vec<EventKind>,
    /// The dissipated energy per mass.
    pub work: R,
    /// Whether the impact was so slow that similar bounces need not be reported one by one.
    pub is_slow: bool,
}

/// An impulse per mass at a ball's surface, and the resulting change of spin.
struct Change<R> {
    linear: Vector<R>,
    angular: Vector<R>,
}

impl<R: Real> Change<R> {
    /// Applies the change to a ball, and returns the dissipated energy per mass: the impulse times the mean speed of its point
    /// of action.
    fn apply(&self, numbers: &Numbers<R>, ball: &mut Ball<R>) -> R {
        let before = *ball;
        ball.velocity = ball.velocity + self.linear;
        ball.spin = ball.spin + self.angular;
        let inertia = R::of(1.0) / numbers.mass_over_inertia;
        let along = self.linear.dot(before.velocity + ball.velocity);
        R::of(-0.5) * (along + inertia * self.angular.dot(before.spin + ball.spin))
    }
}

/// Applies the cloth's reaction to a ball on it that moves downwards, and returns the dissipated energy per mass.
pub fn press<R: Real>(numbers: &Numbers<R>, ball: &mut Ball<R>) -> R {
    let Some(flight) = numbers.flight.filter(|_| ball.velocity.z < R::zero()) else { return R::zero() };
    let push = (R::of(1.0) + flight.restitution) * -ball.velocity.z;
    let upwards = Change { linear: Vector::up() * push, angular: Vector::zero() }.apply(numbers, ball);
    upwards + apply_cloth_friction(numbers, push, ball)
}

/// Applies the cloth's friction to a ball that is pressed into it by the impulse `push` per mass, and returns the dissipated
/// energy per mass.
fn apply_cloth_friction<R: Real>(numbers: &Numbers<R>, push: R, ball: &mut Ball<R>) -> R {
    let Some(flight) = numbers.flight else { return R::zero() };
    let slip = ball.slip(numbers);
    let linear = slip * -coulomb(Some(flight.friction), push, slip.length(), R::ratio(2.0, 7.0));
    let angular = (Vector::up() * -numbers.radius).cross(linear) * numbers.mass_over_inertia;
    Change { linear, angular }.apply(numbers, ball)
}

/// Chooses the motion of a ball after a stroke or an impact. On the cloth the ball is pressed into it, and stays there if it
/// rebounds no faster than the slowest bounce in the air. Returns the dissipated energy per mass.
pub fn settle<R: Real>(numbers: &Numbers<R>, ball: &mut Ball<R>) -> R {
    let mut work = R::zero();
    if ball.position.z <= R::zero() {
        work = press(numbers, ball);
        if numbers.flight.is_none_or(|flight| ball.velocity.z <= flight.slowest) {
            work = work + stay(ball);
        }
    }
    ball.choose_motion_after_impact(numbers);
    work
}

/// Keeps a ball on the cloth, and returns the dissipated energy per mass.
fn stay<R: Real>(ball: &mut Ball<R>) -> R {
    let work = R::of(0.5) * ball.velocity.z * ball.velocity.z;
    (ball.position.z, ball.velocity.z) = (R::zero(), R::zero());
    work
}

/// Handles a landing: the ball hops again, or stays on the cloth. Returns the events and the dissipated energy per mass.
pub fn land<R: Real>(numbers: &Numbers<R>, index: usize, ball: &mut Ball<R>) -> (Vec<EventKind>, R) {
    // The remaining height is rounding.
    let lowered = numbers.gravity * ball.position.z;
    ball.position.z = R::zero();
    let work = lowered + press(numbers, ball);
    if ball.velocity.z > last_hop() {
        return (Vec::new(), work);
    }
    let work = work + stay(ball);
    ball.choose_motion_after_impact(numbers);
    let mut events = vec![EventKind::Lands(index)];
    match ball.motion {
        Motion::Rolling => events.push(EventKind::SlidingRolling(index)),
        Motion::Stationary => events.push(EventKind::RollingStationary(index)),
        _ => {}
    }
    (events, work)
}

/// Takes a ball that leaves the table out of play, and returns its energy per mass.
pub fn leave<R: Real>(numbers: &Numbers<R>, ball: &mut Ball<R>) -> R {
    let work = ball.energy(numbers);
    *ball = Ball { motion: Motion::OffTable, ..Ball::at_rest(ball.position.flat()) };
    work
}

/// Returns the vector from the nose of `rail` to a ball's centre in the plane across the rail, m.
pub fn from_nose<R: Real>(numbers: &Numbers<R>, ball: &Ball<R>, rail: Rail) -> Vector<R> {
    let (sine, cosine, _) = numbers.cushion(rail).nose();
    let n = normal(rail);
    let inwards = numbers.reach(rail) + numbers.radius * cosine + ball.position.dot(n);
    n * inwards + Vector::up() * (ball.position.z - numbers.radius * sine)
}

/// Returns the time at which a ball in the air lands on `rail` behind its nose, s.
pub fn leaves<R: Real>(numbers: &Numbers<R>, ball: &Ball<R>, rail: Rail) -> Option<R> {
    if ball.motion != Motion::Flying {
        return None;
    }
    let (n, way) = (normal(rail), from_nose(numbers, ball, rail));
    let climb = ball.velocity.z;
    let above = climb * climb + R::of(2.0) * numbers.gravity * (way.z - numbers.radius);
    if above < R::zero() {
        return None;
    }
    let time = (climb + above.sqrt()) / numbers.gravity;
    let is_behind = way.dot(n) + ball.velocity.dot(n) * time <= R::zero();
    (time >= R::zero() && is_behind).then_some(time)
}

/// Returns the opening speed of the gap between two bodies, at least one of which is a ball in the air, m/s.
pub fn opening_aloft<R: Real>(numbers: &Numbers<R>, contact: Contact, balls: &Balls<R>) -> R {
    match contact {
        Contact::Rail(ball, rail) => balls[ball].velocity.dot(from_nose(numbers, &balls[ball], rail).direction()),
        Contact::Balls(..) => contact.opening_speed(balls),
    }
}

/// Collides two bodies, at least one of which is a ball in the air.
pub fn collide<R: Real>(numbers: &Numbers<R>, contact: Contact, balls: &mut Balls<R>) -> ImpactAloft<R> {
    let before = *balls;
    let (approach, mut work) = match contact {
        Contact::Rail(ball, rail) => {
            let way = from_nose(numbers, &balls[ball], rail);
            let n = way.direction();
            shift(&mut balls[ball], n * (numbers.radius - way.length()));
            nose_meets(numbers, rail, n, &mut balls[ball])
        }
        Contact::Balls(first, second) => {
            let (mut one, mut other) = (balls[first], balls[second]);
            let gap = contact.normal(balls) * contact.gap(numbers, balls);
            // Only a ball in the air is moved, the upper one of two: the cloth and balls on it stay in place.
            let is_upper = one.position.z > other.position.z;
            if is_upper || (one.motion == Motion::Flying && one.position.z == other.position.z) {
                shift(&mut one, -gap);
            } else {
                shift(&mut other, gap);
            }
            let met = supported_meet(numbers, &mut one, &mut other)
                .unwrap_or_else(|| balls_meet(numbers, &mut one, &mut other));
            (balls[first], balls[second]) = (one, other);
            met
        }
    };
    let mut events = vec![contact.event()];
    let (first, second) = contact.balls();
    for index in [Some(first), second].into_iter().flatten() {
        work = work + settle(numbers, &mut balls[index]);
    }
    events.extend(jumps_and_landings(&before, balls));
    let slow = numbers.flight.map_or(R::zero(), |flight| flight.lifts);
    ImpactAloft { events, work, is_slow: approach <= slow }
}

/// Returns the events of balls that begin to fly or stay on the cloth.
pub fn jumps_and_landings<R: Real>(before: &Balls<R>, after: &Balls<R>) -> Vec<EventKind> {
    let flies = |ball: &Ball<R>| ball.motion == Motion::Flying;
    let event = |(index, (before, after)): (usize, (&Ball<R>, &Ball<R>))| match (flies(before), flies(after)) {
        (false, true) => Some(EventKind::Jumps(index)),
        (true, false) => Some(EventKind::Lands(index)),
        _ => None,
    };
    before.iter().zip(after).enumerate().filter_map(event).collect()
}

/// Removes the remaining gap, which is rounding, from the position of a ball in the air, without landing it. A ball that is
/// just being lifted stays at the height of the cloth.
fn shift<R: Real>(ball: &mut Ball<R>, by: Vector<R>) {
    let height = ball.position.z.max(R::zero());
    ball.position = ball.position + by;
    if height == R::zero() || ball.position.z <= R::zero() {
        ball.position.z = height;
    }
}

/// Returns the relative velocity after an impact with restitution. Before the impact it was `across - approach n`; friction has
/// already changed the part across. No impact in the air opens more slowly than `slowest`: an impact that approaches no faster
/// loses nothing, and the missing energy comes from the part across.
fn opened<R: Real>(slowest: R, n: Vector<R>, opening: R, across: Vector<R>) -> Vector<R> {
    let missing = slowest * slowest - opening * opening;
    if missing <= R::zero() {
        return across + n * opening;
    }
    let had = across.dot(across);
    if had <= missing {
        return n * (had + opening * opening).sqrt();
    }
    across * ((had - missing) / had).sqrt() + n * slowest
}

/// Returns the opening speed of an impact in the air, before the correction by [`opened`], and the slowest bounce.
pub(super) fn opening<R: Real>(numbers: &Numbers<R>, restitution: R, approach: R) -> (R, R) {
    let slowest = numbers.flight.map_or(R::zero(), |flight| flight.slowest);
    ((restitution * approach).max(approach.min(slowest)), slowest)
}

/// Collides two balls in space. Returns the approach speed and the dissipated energy per mass.
fn balls_meet<R: Real>(numbers: &Numbers<R>, first: &mut Ball<R>, second: &mut Ball<R>) -> (R, R) {
    let (half, two) = (R::of(0.5), R::of(2.0));
    let mut n = (first.position - second.position).direction();
    if n.flat() == Vector::zero() {
        // The direction in which a ball leaves the top of another is undetermined: the convention is that of the simulator.
        n.x = R::of(f64::EPSILON);
    }
    let relative = first.velocity - second.velocity;
    let approach = -relative.dot(n);
    let across = relative + n * approach;
    let (opening, slowest) = opening(numbers, numbers.ball_restitution_at(approach), approach);
    let push = (approach + opening) * half;
    let slip = across + n.cross(first.spin + second.spin) * numbers.radius;
    let size = slip.length();
    let rub = slip * -coulomb(numbers.ball_friction_at(size), push, size, R::ratio(1.0, 7.0));
    let after = opened(slowest, n, opening, across + rub * two);
    let linear = (after - relative) * half;
    let angular = (n * -numbers.radius).cross(rub) * numbers.mass_over_inertia;
    let one = Change { linear, angular }.apply(numbers, first);
    let other = Change { linear: -linear, angular }.apply(numbers, second);
    (approach, one + other)
}

/// Largest number of corrections of the normal impulse of such a collision.
const MAX_CORRECTIONS: u32 = 120;

/// Collides a ball in the air with one on the cloth so softly that the lower ball stays there. The cloth supports the lower
/// ball, so that it yields only horizontally, and the upper ball gets the rebound of both the balls and the cloth. Returns the
/// same as [`balls_meet`]; `None` if the lower ball is thrown up, or if the two separate anyway.
fn supported_meet<R: Real>(numbers: &Numbers<R>, one: &mut Ball<R>, other: &mut Ball<R>) -> Option<(R, R)> {
    let flight = numbers.flight?;
    let (mut first, mut second) = (*one, *other);
    let (approach, _) = balls_meet(numbers, &mut first, &mut second);
    settle(numbers, &mut first);
    settle(numbers, &mut second);
    let (upper, lower, after) = match (one.motion == Motion::Flying, other.motion == Motion::Flying) {
        (true, false) => (one, other, [first, second]),
        (false, true) => (other, one, [second, first]),
        _ => return None,
    };
    if upper.position.z <= R::zero() {
        return None;
    }
    let mut n = (upper.position - lower.position).direction();
    let parts = (after[0].velocity - after[1].velocity).dot(n);
    let is_thrown_up = after[1].motion == Motion::Flying;
    if approach < R::zero() || is_thrown_up || (approach > flight.slowest && parts >= flight.slowest) {
        return None;
    }
    if n.flat() == Vector::zero() {
        n.x = R::of(f64::EPSILON);
    }
    let still = Vector::zero();
    let given_back = numbers.ball_restitution_at(approach) * flight.restitution;
    let opens = (given_back * approach).max(approach.min(flight.slowest));
    let parts = R::of(1.0) + n.flat().dot(n.flat());
    let before = [*upper, *lower];
    let pushed = |push: R| {
        let [mut upper, mut lower] = before;
        let mut work = Change { linear: n * push, angular: still }.apply(numbers, &mut upper)
            + Change { linear: n.flat() * -push, angular: still }.apply(numbers, &mut lower);
        let relative = upper.velocity - lower.velocity;
        let slip = relative - n * relative.dot(n) + n.cross(upper.spin + lower.spin) * numbers.radius;
        let rub = slip * -coulomb(numbers.ball_friction_at(slip.length()), push, slip.length(), R::ratio(1.0, 7.0));
        let angular = (n * -numbers.radius).cross(rub) * numbers.mass_over_inertia;
        work = work
            + Change { linear: rub, angular }.apply(numbers, &mut upper)
            + Change { linear: -rub.flat(), angular }.apply(numbers, &mut lower)
            + apply_cloth_friction(numbers, (push * n.z + rub.z).max(R::zero()), &mut lower);
        ([upper, lower], work)
    };
    // The push makes up for the opening speed that friction takes by moving the lower ball along the table.
    let missing = |[upper, lower]: &[Ball<R>; 2]| opens - (upper.velocity - lower.velocity).dot(n);
    let alone = pushed((approach + opens) / parts);
    let (mut push, mut after) = ((approach + opens) / parts, alone);
    for _ in 0..MAX_CORRECTIONS {
        let short = missing(&after.0);
        if short <= R::zero() {
            break;
        }
        push = push + short / parts;
        after = pushed(push);
    }
    // The work is what is dissipated.
    let is_solved = missing(&after.0) <= opens * R::of(1e-12) && after.1 >= R::zero();
    let ([above, below], work) = if is_solved { after } else { alone };
    (*upper, *lower) = (above, below);
    let work = work + separate_slowly(flight.slowest, numbers, n, upper, lower);
    Some((approach, work))
}

/// Separates two balls, the lower one supported by the cloth, along `n` with at least the speed `slowest`. The energy comes
/// from their sliding along each other, which neither opens nor closes the gap. Returns the dissipated energy per mass.
fn separate_slowly<R: Real>(
    slowest: R,
    numbers: &Numbers<R>,
    n: Vector<R>,
    upper: &mut Ball<R>,
    lower: &mut Ball<R>,
) -> R {
    let relative = upper.velocity - lower.velocity;
    let opening = relative.dot(n);
    let across = relative - n * opening;
    let across = across - n * across.dot(n);
    if opening >= R::of(0.5) * slowest || across.dot(across) <= R::zero() {
        return R::zero();
    }
    let along = across.direction();
    // Inverse effective masses against separation and against sliding.
    let parts = R::of(1.0) + n.flat().dot(n.flat());
    let shared = n.z * along.z / parts;
    let (one, other) = (along + n * shared, along.flat() + n.flat() * shared);
    let slides = one.dot(one) + other.dot(other);
    let sliding = upper.velocity.dot(one) - lower.velocity.dot(other);
    let available = sliding * sliding * parts / slides;
    let needed = (slowest * slowest - opening * opening).min(available);
    let push = ((opening * opening + needed).sqrt() - opening) / parts;
    let kept = ((available - needed).max(R::zero()) * slides / parts).sqrt();
    let brake = (sliding.abs() - kept) / slides;
    let brake = if sliding < R::zero() { -brake } else { brake };
    let on_upper = Change { linear: n * push - one * brake, angular: Vector::zero() };
    let on_lower = Change { linear: other * brake - n.flat() * push, angular: Vector::zero() };
    on_upper.apply(numbers, upper) + on_lower.apply(numbers, lower)
}

/// Collides a ball with a nose, from which `n` points to its centre. Returns the approach speed and the dissipated energy per
/// mass.
fn nose_meets<R: Real>(numbers: &Numbers<R>, rail: Rail, n: Vector<R>, ball: &mut Ball<R>) -> (R, R) {
    let cushion = numbers.cushion(rail);
    let approach = -ball.velocity.dot(n);
    let across = ball.velocity + n * approach;
    let (opening, slowest) = opening(numbers, cushion.restitution_at(approach), approach);
    let slip = across + n.cross(ball.spin) * numbers.radius;
    let push = cushion.friction * (approach + opening);
    let rub = slip * -nose_friction(cushion.nose().2, push, slip.length());
    let linear = opened(slowest, n, opening, across + rub) - ball.velocity;
    let angular = (n * -numbers.radius).cross(rub) * numbers.mass_over_inertia;
    (approach, Change { linear, angular }.apply(numbers, ball))
}
