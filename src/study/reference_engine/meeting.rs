//! When two bodies meet, if nothing else happens first.
//!
//! A gap that is closed already opens again or rests; only what closes it afresh is a meeting.

use super::{
    Ball, Finder, Numbers, Real, Vector,
    contact::{Balls, Contact},
    course::Course,
    roots::falls,
    tolerance::{closed, slack, touching},
};

/// When a contact closes within `horizon`, s.
pub fn meets<R: Real>(course: &Course<R>, contact: Contact, horizon: R, finder: Finder<R>) -> Option<R> {
    let Course { numbers, balls, piece } = course;
    let gap = contact.gap(numbers, balls);
    let (first, second) = contact.balls();
    let relative = contact.relative(balls);
    let integrated = |ball: usize| piece.as_ref().is_some_and(|piece| piece.has(ball));
    let is_integrated = integrated(first) || second.is_some_and(integrated);
    // Most bodies are too far apart to meet so soon: to solve for their roots costs most of a shot's time.
    let pull = R::of(if is_integrated { 10.0 } else { 2.0 }) * numbers.slide;
    if gap > horizon * (relative.length() + pull * horizon) {
        return None;
    }
    let opening = contact.opening(balls);
    if gap <= touching() && opening < -closed::<R>() {
        return Some(R::zero());
    }
    if is_integrated {
        return course
            .piece
            .as_ref()
            .and_then(|piece| if piece.presses(contact) { None } else { seen_to_close(course, contact, horizon) });
    }
    let a = &balls[first];
    let time = match second {
        None => {
            let n = contact.normal(balls);
            quadratic_closes(gap, opening, R::of(0.5) * a.acceleration(numbers).dot(n))
        }
        Some(second) => balls_meet(numbers, a, &balls[second], gap, opening, horizon, finder),
    };
    time.filter(|time| *time <= horizon)
}

/// First time at which `gap + speed t + pull t²` falls through zero.
fn quadratic_closes<R: Real>(gap: R, speed: R, pull: R) -> Option<R> {
    let (zero, two) = (R::zero(), R::of(2.0));
    if gap <= touching() {
        return (speed > closed() && pull < zero).then(|| -speed / pull);
    }
    let discriminant = speed * speed - R::of(4.0) * pull * gap;
    if discriminant < zero || (speed >= zero && pull >= zero) {
        return None;
    }
    // Either form of the same root, whichever does not cancel.
    let root = discriminant.sqrt();
    Some(if speed < zero { two * gap / (root - speed) } else { (speed + root) / (-two * pull) })
}

fn balls_meet<R: Real>(
    numbers: &Numbers<R>,
    a: &Ball<R>,
    b: &Ball<R>,
    gap: R,
    opening: R,
    horizon: R,
    finder: Finder<R>,
) -> Option<R> {
    let (zero, two, half) = (R::zero(), R::of(2.0), R::of(0.5));
    let diameter = two * numbers.radius;
    let (d, v): (Vector<R>, Vector<R>) = (a.position - b.position, a.velocity - b.velocity);
    let k = (a.acceleration(numbers) - b.acceleration(numbers)) * half;
    let c = [d.dot(d) - diameter * diameter, two * d.dot(v), v.dot(v) + two * d.dot(k), two * v.dot(k), k.dot(k)];
    if gap > touching() {
        return finder(&c, horizon);
    }
    // The root at zero of balls that touch is the contact that is over: it is divided out. They do not press, so what
    // neither opens nor closes them is rounding.
    if opening > closed() {
        return finder(&[c[1], c[2], c[3], c[4], zero], horizon);
    }
    if c[2] > diameter * slack() { finder(&[c[2], c[3], c[4], zero, zero], horizon) } else { None }
}

/// The same for a gap without closed form, over a time so short that it has at most one extremum.
fn seen_to_close<R: Real>(course: &Course<R>, contact: Contact, horizon: R) -> Option<R> {
    let zero = R::zero();
    let piece = course.piece.as_ref()?;
    let numbers = &course.numbers;
    let end = piece.tau_at(horizon);
    // Gap, rate of opening and time; a gap that is closed at the start is so until it is clearly less.
    let first_gap = contact.gap(numbers, &course.balls);
    let level = if first_gap <= touching() { first_gap - touching() } else { zero };
    let at = |tau: R| {
        let (balls, time) = course.at(piece, tau);
        (contact.gap(numbers, &balls) - level, contact.opening(&balls), time)
    };
    let first_opening = contact.opening(&course.balls);
    let (last_gap, last_opening, _) = at(end);
    let gap_until = |low: R, high: R| {
        let tau = falls(|tau| at(tau).0, low, high, zero);
        at(tau).2
    };
    if level < zero && first_opening > closed() && last_opening < zero {
        // It opens and closes again, perhaps at once: the gap's top lies between.
        let top = falls(|tau| at(tau).1, zero, end, zero);
        let of_contact = |tau: R| at(tau).0 + level - first_gap;
        if of_contact(top) <= touching() {
            // Too low for its height to be seen, and so short that it falls as it rises.
            return Some(R::of(2.0) * at(top).2).filter(|time| *time <= horizon);
        }
        return (of_contact(end) < zero).then(|| at(falls(of_contact, top, end, zero)).2);
    }
    if level < zero && first_opening <= closed() {
        // It rests without pressing: to drift more slowly than what counts as closed is no meeting.
        let closes = R::of(2.0) * closed();
        return (last_opening < -closes).then(|| at(falls(|tau| at(tau).1 + closes, zero, end, zero)).2);
    }
    if last_gap < zero {
        return Some(gap_until(zero, end));
    }
    if first_opening < zero && last_opening > zero {
        let nearest = falls(|tau| -at(tau).1, zero, end, zero);
        return (at(nearest).0 < zero).then(|| gap_until(zero, nearest));
    }
    None
}

/// Moves balls that meet to where their gap is exactly closed.
pub fn touch<R: Real>(numbers: &Numbers<R>, contact: Contact, balls: &mut Balls<R>) {
    let is_rail = matches!(contact, Contact::Rail(..));
    if is_rail || contact.gap(numbers, balls).abs() <= R::of(1e3) * touching() {
        contact.close(numbers, balls);
    }
}
