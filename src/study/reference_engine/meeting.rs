//! Predicts when two bodies meet if no other event comes first.
//!
//! An already closed gap opens again or stays closed; only a gap that closes again is a meeting.

use super::{
    Ball, Finder, Motion, Numbers, Real, Vector,
    contact::{Balls, Contact},
    course::Course,
    flight::from_nose,
    roots::falling_root,
    table::normal,
    tolerance::{closed, slack, touching},
};
use crate::simulation::Rail;

/// Returns the time at which a contact closes within `horizon`, s.
pub fn meets<R: Real>(course: &Course<R>, contact: Contact, horizon: R, finder: Finder<R>) -> Option<R> {
    let Course { numbers, balls, piece } = course;
    let (first, second) = contact.balls();
    let is_off = |ball: usize| balls[ball].motion == Motion::OffTable;
    if is_off(first) || second.is_some_and(is_off) {
        return None;
    }
    let integrated = |ball: usize| piece.as_ref().is_some_and(|piece| piece.involves(ball));
    let is_integrated = integrated(first) || second.is_some_and(integrated);
    let time = match contact {
        Contact::Rail(ball, rail) if balls[ball].motion == Motion::Flying => {
            nose_meets(numbers, &balls[ball], rail, horizon, finder)
        }
        Contact::Balls(first, second) if !is_integrated => {
            let (a, b) = (&balls[first], &balls[second]);
            let k = (a.acceleration(numbers) - b.acceleration(numbers)) * R::of(0.5);
            let reach = R::of(2.0) * numbers.radius;
            points_meet(reach, [a.position - b.position, a.velocity - b.velocity, k], horizon, finder)
        }
        _ => rail_or_integrated_meets(course, contact, is_integrated, horizon),
    };
    time.filter(|time| *time <= horizon)
}

fn rail_or_integrated_meets<R: Real>(
    course: &Course<R>,
    contact: Contact,
    is_integrated: bool,
    horizon: R,
) -> Option<R> {
    let Course { numbers, balls, piece } = course;
    let gap = contact.gap(numbers, balls);
    let relative = contact.relative_velocity(balls);
    // Most bodies are too far apart to meet within the horizon. This early exit saves most of a shot's computing time.
    let fall = if contact.is_aloft(balls) { numbers.gravity } else { R::zero() };
    let pull = R::of(if is_integrated { 10.0 } else { 2.0 }) * numbers.slide + fall;
    if gap > horizon * (relative.length() + pull * horizon) {
        return None;
    }
    let opening = contact.opening_speed(balls);
    if gap <= touching() && opening < -closed::<R>() {
        return Some(R::zero());
    }
    if is_integrated {
        return if piece.as_ref()?.rest.presses(contact) {
            None
        } else {
            integrated_gap_closes(course, contact, horizon)
        };
    }
    let pull = balls[contact.balls().0].acceleration(numbers).dot(contact.normal(balls));
    quadratic_closes(gap, opening, R::of(0.5) * pull)
}

/// Returns the first time at which `gap + speed t + pull t²` falls through zero.
fn quadratic_closes<R: Real>(gap: R, speed: R, pull: R) -> Option<R> {
    let (zero, two) = (R::zero(), R::of(2.0));
    if gap <= touching() {
        return (speed > closed() && pull < zero).then(|| -speed / pull);
    }
    let discriminant = speed * speed - R::of(4.0) * pull * gap;
    if discriminant < zero || (speed >= zero && pull >= zero) {
        return None;
    }
    // Uses the form of the root that does not cancel.
    let root = discriminant.sqrt();
    Some(if speed < zero { two * gap / (root - speed) } else { (speed + root) / (-two * pull) })
}

/// Returns the time at which a ball in the air meets the nose of `rail` from the table's side.
fn nose_meets<R: Real>(numbers: &Numbers<R>, ball: &Ball<R>, rail: Rail, horizon: R, finder: Finder<R>) -> Option<R> {
    let (n, way) = (normal::<R>(rail), from_nose(numbers, ball, rail));
    let along = n.cross(Vector::up());
    let velocity = ball.velocity - along * ball.velocity.dot(along);
    let fall = ball.acceleration(numbers) * R::of(0.5);
    let time = points_meet(numbers.radius, [way, velocity, fall], horizon, finder)?;
    (way.dot(n) + velocity.dot(n) * time > R::zero()).then_some(time)
}

/// Returns the time at which two points with the distance vector `d + v t + k t²` come as close as `reach`, m.
fn points_meet<R: Real>(reach: R, [d, v, k]: [Vector<R>; 3], horizon: R, finder: Finder<R>) -> Option<R> {
    let (zero, two) = (R::zero(), R::of(2.0));
    let apart = d.dot(d) - reach * reach;
    let gap = apart / (d.length() + reach);
    // Most are too far apart to meet within the horizon. This early exit saves most of a shot's computing time.
    if gap > horizon * (v.length() + k.length() * horizon) {
        return None;
    }
    let opening = d.dot(v) / d.length();
    if gap <= touching() && opening < -closed::<R>() {
        return Some(zero);
    }
    let c = [apart, two * d.dot(v), v.dot(v) + two * d.dot(k), two * v.dot(k), k.dot(k)];
    if gap > touching() {
        return finder(&c, horizon);
    }
    // The root at zero of touching bodies belongs to the past contact and is divided out. Nothing presses, so openings and
    // closings below the tolerance are rounding.
    if opening > closed() {
        return finder(&[c[1], c[2], c[3], c[4], zero], horizon);
    }
    if c[2] > reach * slack() { finder(&[c[2], c[3], c[4], zero, zero], horizon) } else { None }
}

/// Returns the same for a gap without closed form, over a time so short that the gap has at most one extremum.
fn integrated_gap_closes<R: Real>(course: &Course<R>, contact: Contact, horizon: R) -> Option<R> {
    let zero = R::zero();
    let piece = course.piece.as_ref()?;
    let numbers = &course.numbers;
    let end = piece.tau_at(horizon);
    // Gap, opening speed and time. A gap that is closed at the start stays closed until it is clearly smaller.
    let first_gap = contact.gap(numbers, &course.balls);
    let level = if first_gap <= touching() { first_gap - touching() } else { zero };
    let at = |tau: R| {
        let (balls, time) = course.at(piece, tau);
        (contact.gap(numbers, &balls) - level, contact.opening_speed(&balls), time)
    };
    let first_opening = contact.opening_speed(&course.balls);
    let (last_gap, last_opening, _) = at(end);
    let gap_until = |low: R, high: R| {
        let tau = falling_root(|tau| at(tau).0, low, high, zero);
        at(tau).2
    };
    if level < zero && first_opening > closed() && last_opening < zero {
        // The gap opens and closes again, perhaps at once: its maximum lies between.
        let top = falling_root(|tau| at(tau).1, zero, end, zero);
        let of_contact = |tau: R| at(tau).0 + level - first_gap;
        if of_contact(top) <= touching() {
            // The maximum is too low to resolve, and so brief that the closing takes as long as the opening.
            return Some(R::of(2.0) * at(top).2).filter(|time| *time <= horizon);
        }
        return (of_contact(end) < zero).then(|| at(falling_root(of_contact, top, end, zero)).2);
    }
    if level < zero && first_opening <= closed() {
        // The contact rests without pressing. A drift slower than the tolerance of a closed contact is no meeting.
        let closes = R::of(2.0) * closed();
        return (last_opening < -closes).then(|| at(falling_root(|tau| at(tau).1 + closes, zero, end, zero)).2);
    }
    if last_gap < zero {
        return Some(gap_until(zero, end));
    }
    if first_opening < zero && last_opening > zero {
        let nearest = falling_root(|tau| -at(tau).1, zero, end, zero);
        return (at(nearest).0 < zero).then(|| gap_until(zero, nearest));
    }
    None
}

/// Moves meeting balls so that their gap is exactly closed.
pub fn touch<R: Real>(numbers: &Numbers<R>, contact: Contact, balls: &mut Balls<R>) {
    let is_rail = matches!(contact, Contact::Rail(..));
    if is_rail || contact.gap(numbers, balls).abs() <= R::of(1e3) * touching() {
        contact.close(numbers, balls);
    }
}
