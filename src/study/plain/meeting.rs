//! When a ball meets a cushion or another ball, if nothing else happens first.
//!
//! A gap that is closed already opens again or presses; only what closes it afresh is a meeting.

use super::{Finder, Motion, Numbers, Real, course::Course, roots::bracketed, table::normal};
use crate::simulation::Rail;

/// What lies ahead of two balls.
pub enum Meeting<R> {
    /// They do not meet.
    Never,
    /// They meet after this time, s.
    After(R),
    /// They touch and are pressed together.
    Pressed,
}

/// When a ball meets a cushion within `horizon`, s.
pub fn rail_met<R: Real>(numbers: &Numbers<R>, course: &Course<R>, rail: Rail, horizon: R) -> Option<R> {
    let n = normal(rail);
    let reach = numbers.reach(rail);
    let ball = &course.ball;
    let gap = reach + ball.position.dot(n);
    if let Some(press) = &course.press {
        if ball.motion == Motion::Pressed(rail) {
            return None;
        }
        let at = |time| {
            let ball = press.after(time).0;
            (reach + ball.position.dot(n), ball.velocity.dot(n))
        };
        return seen_to_close(at, R::of(1.0), horizon);
    }
    let (speed, pull) = (ball.velocity.dot(n), R::of(0.5) * ball.acceleration(numbers).dot(n));
    let time = quadratic_closes(gap, speed, pull)?;
    (time <= horizon).then_some(time)
}

/// First time at which `gap + speed t + pull t²` falls through zero.
fn quadratic_closes<R: Real>(gap: R, speed: R, pull: R) -> Option<R> {
    let (zero, two) = (R::zero(), R::of(2.0));
    if gap <= Numbers::touching() {
        if speed < -Numbers::<R>::settled() {
            return Some(zero);
        }
        return (speed > zero && pull < zero).then(|| -speed / pull);
    }
    let discriminant = speed * speed - R::of(4.0) * pull * gap;
    if discriminant < zero || (speed >= zero && pull >= zero) {
        return None;
    }
    // Either form of the same root, whichever does not cancel.
    let root = discriminant.sqrt();
    Some(if speed < zero { two * gap / (root - speed) } else { (speed + root) / (-two * pull) })
}

/// When two balls meet within `horizon`, s.
pub fn balls_meet<R: Real>(
    numbers: &Numbers<R>,
    first: &Course<R>,
    second: &Course<R>,
    horizon: R,
    finder: Finder<R>,
) -> Meeting<R> {
    let (a, b) = (&first.ball, &second.ball);
    if a.motion == Motion::Stationary && b.motion == Motion::Stationary {
        return Meeting::Never;
    }
    let (two, half) = (R::of(2.0), R::of(0.5));
    let diameter = two * numbers.radius;
    let (d, v) = (a.position - b.position, a.velocity - b.velocity);
    let k = (a.acceleration(numbers) - b.acceleration(numbers)) * half;
    let gap = d.dot(d) - diameter * diameter;
    let opening = d.dot(v) / diameter;
    let touching = gap <= diameter * Numbers::touching();
    // Most pairs are too far apart to meet so soon: to solve for their roots costs most of a shot's time.
    let pull = if first.press.is_some() || second.press.is_some() { R::of(10.0) * numbers.slide } else { k.length() };
    if d.length() - diameter > horizon * (v.length() + pull * horizon) {
        return Meeting::Never;
    }
    if touching && opening < -Numbers::<R>::settled() {
        return Meeting::After(R::zero());
    }
    if first.press.is_some() || second.press.is_some() {
        let at = |time| {
            let (a, b) = (first.after(numbers, time).0, second.after(numbers, time).0);
            let d = a.position - b.position;
            (d.dot(d) - diameter * diameter, two * d.dot(a.velocity - b.velocity))
        };
        if touching && opening <= Numbers::settled() && at(horizon).0 < R::zero() {
            return Meeting::Pressed;
        }
        return seen_to_close(at, diameter, horizon).map_or(Meeting::Never, Meeting::After);
    }
    let c = [gap, two * d.dot(v), v.dot(v) + two * d.dot(k), two * v.dot(k), k.dot(k)];
    if touching && opening <= Numbers::settled() && c[2] < R::zero() {
        return Meeting::Pressed;
    }
    // The root at zero of balls that touch is the contact that is over: it is divided out.
    let c = if touching { [c[1], c[2], c[3], c[4], R::zero()] } else { c };
    finder(&c, horizon).map_or(Meeting::Never, Meeting::After)
}

/// The same for a gap without closed form, over a time so short that it has at most one minimum. `at` gives the gap, in
/// units of `scale` times metres, and its rate.
fn seen_to_close<R: Real>(at: impl Fn(R) -> (R, R), scale: R, horizon: R) -> Option<R> {
    let zero = R::zero();
    let ((gap, rate), (last_gap, last_rate)) = (at(zero), at(horizon));
    if gap <= scale * Numbers::touching() && rate < -scale * Numbers::<R>::settled() {
        return Some(zero);
    }
    let gap_until = |end| bracketed(|t| at(t).0, |t| at(t).1, zero, end);
    if last_gap < zero {
        return Some(gap_until(horizon));
    }
    if rate < zero && last_rate > zero {
        let nearest = bracketed(|t| -at(t).1, |_| zero, zero, horizon);
        return (at(nearest).0 < zero).then(|| gap_until(nearest));
    }
    None
}
