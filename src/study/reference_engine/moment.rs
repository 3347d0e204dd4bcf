//! Processes all changes at one time: impacts, the end of a chatter, and the beginning and end of resting contacts.

use super::{
    Motion, Numbers, Real, Unjudged,
    contact::{Balls, Contact},
    rest::{Rest, creep, rest},
    rounds::collide,
    tolerance::{chatter, closed, settled},
};
use crate::{simulation::EventKind, table::BALLS};

/// The result of the changes at one time.
#[derive(Clone, Debug)]
pub struct Moment<R> {
    /// The resulting events.
    pub events: Vec<EventKind>,
    /// The pressing contacts from this time on.
    pub rest: Option<Rest<R>>,
    /// The dissipated energy per mass.
    pub work: R,
}

/// Processes `balls`, of which those in `resting` were in resting contact before; `creeping` allows slow slips to creep.
///
/// Bounces that shrink in geometric progression end in a resting contact. The last impact of such a chatter has no restitution.
/// This is tried once the rebound is slow enough, and accepted if the contact then presses.
///
/// # Errors
/// [`Unjudged::Unsolved`] if no forces are found that obey all laws.
pub fn process_moment<R: Real>(
    numbers: &Numbers<R>,
    balls: &mut Balls<R>,
    resting: [bool; BALLS],
    creeping: bool,
) -> Result<Moment<R>, Unjudged> {
    let before = *balls;
    let (mut ending, mut going_on): (Vec<Contact>, Vec<Contact>) = (Vec::new(), Vec::new());
    loop {
        *balls = before;
        let (met, taken) = collide(numbers, balls, &ending)?;
        for (index, ball) in balls.iter_mut().enumerate() {
            if met.iter().any(|contact| contact.involves(index)) {
                ball.choose_motion_after_impact(numbers);
            }
        }
        let is_slow = |contact: &&Contact| {
            let known = ending.contains(contact) || going_on.contains(contact);
            !known && contact.opening_speed(balls) > closed() && contact.opening_speed(balls) <= chatter()
        };
        let slow: Vec<Contact> = met.iter().filter(is_slow).copied().collect();
        if !slow.is_empty() {
            ending.extend(slow);
            continue;
        }
        let crept = if creeping && met.is_empty() { creep(numbers, balls) } else { None };
        let crept = crept.and_then(|(rest, creeps)| creeps.then_some(rest));
        let (rest, lost) = if crept.is_some() { (crept, R::zero()) } else { rest(numbers, balls)? };
        let presses = |contact: &Contact| rest.as_ref().is_some_and(|rest| rest.presses(*contact));
        if !ending.iter().all(presses) {
            going_on.extend(ending.iter().filter(|contact| !presses(contact)));
            ending.retain(presses);
            continue;
        }
        let mut events: Vec<EventKind> = met.iter().map(|contact| contact.event()).collect();
        let has_climbed =
            |index: &usize| balls[*index].motion == Motion::Flying && before[*index].motion != Motion::Flying;
        events.extend((0..BALLS).filter(has_climbed).map(EventKind::Jumps));
        for (index, ball) in balls.iter_mut().enumerate().filter(|(index, _)| resting[*index]) {
            if rest.as_ref().is_none_or(|rest| rest.laws.cloth[index].is_none()) && before[index].motion == ball.motion
            {
                ball.choose_motion(numbers, settled());
            }
            match (before[index].motion, ball.motion) {
                _ if !met.is_empty() => {}
                (Motion::Sliding, Motion::Rolling | Motion::Stationary) => {
                    events.push(EventKind::SlidingRolling(index));
                }
                (Motion::Rolling, Motion::Stationary) => events.push(EventKind::RollingStationary(index)),
                _ => {}
            }
        }
        return Ok(Moment { events, rest, work: taken + lost });
    }
}
