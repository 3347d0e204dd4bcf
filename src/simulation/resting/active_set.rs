//! Active set at the start of a step of a resting contact: slips that have ended, contacts that press, frictions that stick.

use glam::DVec2;

use super::{
    super::{Constants, contacts::close_gaps, extrapolation::State, segment::slides},
    Resting,
};
use crate::{
    physics::{
        ActiveSet, BallState, Contact, Contacts, Effort, Friction, MAX_CONTACTS, Resolved, Scene, involve,
        rolling_spin, slip, stop_by_impulses,
    },
    table::{BALLS, Table},
};

/// Number of consecutive restarts after which non-unique forces are sought near the previous ones. A search from zero may find forces at
/// the edge of a law that break it immediately, in every step.
const MAX_RESTARTS: u32 = 8;

impl Resting {
    /// After this step, keeps frictions yielding that yielded before, while their slips are small.
    fn keep_yielding(&self, balls: &State, contacts: &[Contact], set: &mut ActiveSet) {
        let Constants { radius, tolerance, .. } = self.constants;
        let small = |slip: DVec2| slip.length() <= tolerance.yielding;
        for (ball, state) in balls.iter().enumerate() {
            if self.set.cloth[ball] == Friction::Yields && small(slip(radius, state.velocity, state.spin)) {
                set.cloth[ball] = Friction::Yields;
            }
            if self.set.roll[ball] == Friction::Yields && small(state.velocity) {
                set.roll[ball] = Friction::Yields;
            }
        }
        for (index, contact) in contacts.iter().enumerate() {
            let before = self.contacts.iter().position(|before| before == contact);
            if before.is_some_and(|before| self.set.contact[before] == Friction::Yields)
                && small(contact.slip(radius, balls))
            {
                set.contact[index] = Friction::Yields;
            }
        }
    }
}

/// Finds the state without the slips that end here, and the resulting active set. `None` if no contact presses on a moving ball. `balls`
/// become their states if they stay free, and `contacts` those that may rest.
///
/// Unlimited friction has states in which no forces obey all laws (Painlevé's paradox): the force that would prevent the slip of two balls
/// separates them; once they are separated, nothing acts, and they come back. They then begin to bounce, each time higher, and each bounce
/// removes their slip as every impact of such balls does (17).
pub fn find_active_set(
    table: &Table,
    constants: &Constants,
    balls: &mut State,
    contacts: &mut Contacts,
    previous: Option<&Resting>,
    effort: &Effort,
) -> Option<(State, Resolved)> {
    if stand_on_slope(constants, balls, contacts) {
        return None;
    }
    let tolerance = &constants.tolerance;
    let least_push = tolerance.force_error + transient_pressing(constants, balls, contacts);
    // Balls that never slip lose their slip when their contact begins, or when another impact has just made them slip.
    let grips = contacts.iter().filter(|contact| contact.never_slips(table)).any(|contact| {
        previous.is_none_or(|previous| !previous.contacts.contains(contact))
            || contact.slip(table.radius, balls).length() > tolerance.ending_slip
    });
    // The state without the slips that end, the resulting active set, and whether a slip begins again that was treated as ended.
    let stopped = |none: f64, balls: &State, contacts: &[Contact]| {
        let mut begin = *balls;
        if grips {
            stop_slips(table, &mut begin, contacts);
        }
        let mut set = ActiveSet::of(table, &begin, contacts, none);
        if let Some(previous) = previous.filter(|previous| previous.set.yields()) {
            previous.keep_yielding(&begin, contacts, &mut set);
        }
        remove_rounding(table, constants, &mut begin, contacts, &set);
        // Non-unique forces stay near the previous ones after an interruption that has changed no contact, and after many consecutive
        // restarts.
        let same = |previous: &&Resting| {
            previous.restarts > MAX_RESTARTS || previous.interrupted && previous.contacts[..] == *contacts
        };
        let similar = previous.filter(same).map(|previous| previous.last.of_contacts(&previous.contacts, contacts));
        let resolve = |balls: &State, set: &ActiveSet| {
            Scene { table, balls, contacts, set }.resolve(least_push, similar.as_ref(), effort)
        };
        let mut resolved = resolve(&begin, &set)?;
        if !resolved.paradoxes.is_empty() {
            return Some((begin, resolved, false));
        }
        if let Some(sticking) = resolved.sticking {
            set = sticking;
            remove_rounding(table, constants, &mut begin, contacts, &set);
            resolved = resolve(&begin, &set)?;
        }
        let departs = resolved.set != set && {
            let starts = |f: &Friction| matches!(f, Friction::Slips(start) if *start != DVec2::ZERO);
            resolved.set.cloth.iter().chain(&resolved.set.roll).chain(&resolved.set.contact).any(starts)
        };
        Some((begin, resolved, departs))
    };
    let (mut pressing, mut now) = (contacts.clone(), *balls);
    loop {
        if pressing.is_empty() {
            return None;
        }
        let (mut begin, mut resolved, departs) = stopped(tolerance.ending_slip, &now, &pressing)?;
        if departs {
            // A slip that would begin again immediately has not ended.
            (begin, resolved, _) = stopped(tolerance.slip, &now, &pressing)?;
        }
        if !resolved.paradoxes.is_empty() {
            for contact in &resolved.paradoxes {
                separate(&mut now, contact, tolerance.first_bounce);
                separate(balls, contact, tolerance.first_bounce);
            }
            contacts.retain(|contact| !resolved.paradoxes.contains(contact));
            pressing.retain(|contact| !resolved.paradoxes.contains(contact));
            continue;
        }
        // Balls at rest may continue to push each other, held by the cloth; this has no effect.
        let still = |(ball, state): (usize, &BallState)| {
            !involve(&pressing, ball) || (state.velocity == DVec2::ZERO && state.spin == glam::DVec3::ZERO)
        };
        if !departs && begin.iter().enumerate().all(still) {
            return None;
        }
        // A contact that does not push holds nothing: it is not part of the step, and its opening continues.
        if resolved.contacts.len() == pressing.len() {
            return Some((begin, resolved));
        }
        for ball in (0..BALLS).filter(|&ball| involve(&pressing, ball) && !involve(&resolved.contacts, ball)) {
            // The slip has also ended for a ball that nothing holds; if it rolls, it continues to roll.
            let ends = slip(table.radius, now[ball].velocity, now[ball].spin).length() <= tolerance.ending_slip;
            if resolved.set.cloth[ball] == Friction::Sticks && slides(table.radius, &now[ball]) && ends {
                let slid = std::mem::replace(&mut now[ball], begin[ball]);
                if closes(constants, &now, contacts) {
                    now[ball] = slid;
                }
            }
        }
        pressing = resolved.contacts;
    }
}

/// Makes two balls separate at a given speed, m/s.
fn separate(balls: &mut State, contact: &Contact, speed: f64) {
    let Some(second) = contact.second() else { return };
    let missing = 0.5 * (speed - contact.opening_speed(balls)) * contact.normal(balls);
    balls[contact.first].velocity += missing;
    balls[second].velocity -= missing;
}

/// Stops the slip of balls that never slip as soon as they press, however weakly: as in their collisions (17), which are too short for the
/// cloth to act.
fn stop_slips(table: &Table, balls: &mut State, contacts: &[Contact]) {
    let sticks = |contact: Option<&Contact>| match contact {
        Some(contact) if contact.second().is_some() => Friction::Sticks,
        _ => Friction::Slips(DVec2::ZERO),
    };
    let contact = std::array::from_fn(|index| sticks(contacts.get(index)));
    stop_by_impulses(table, balls, contacts, &ActiveSet { contact, ..ActiveSet::SLIPPING }, &[0.0; MAX_CONTACTS]);
}

/// Returns the pressing acceleration that is negligible until the slips that cause it end, m/s². It changes no speed by more than its zero
/// tolerance, or it is within the rounding of the slip directions. A direction is less accurate the smaller the slip is compared with the
/// speeds whose difference it is.
fn transient_pressing(constants: &Constants, balls: &State, contacts: &[Contact]) -> f64 {
    let idle = |ball: &BallState| {
        let slip = slip(constants.radius, ball.velocity, ball.spin).length();
        if slip <= constants.tolerance.ending_slip {
            return 0.0;
        }
        let speeds = ball.velocity.length() + constants.radius * ball.spin.truncate().length();
        let rounding = 32.0 * f64::EPSILON * speeds / slip * constants.sliding;
        rounding.max(constants.tolerance.opening / (slip * constants.slide_time))
    };
    let members = balls.iter().enumerate().filter(|(ball, _)| involve(contacts, *ball));
    members.map(|(_, ball)| idle(ball)).fold(0.0, f64::max)
}

/// Whether the balls of contacts are at rest on a table that is not level: the slope presses the upper ball on the lower one, but nothing
/// moves.
fn stand_on_slope(constants: &Constants, balls: &State, contacts: &[Contact]) -> bool {
    let none = constants.tolerance.still;
    let stands = |ball: &BallState| {
        ball.velocity.length() < none && constants.radius * ball.spin.truncate().length() < none && ball.spin.z == 0.0
    };
    !constants.level && (0..BALLS).all(|ball| !involve(contacts, ball) || stands(&balls[ball]))
}

/// Returns the balls of contacts that do not press, without slips on the cloth that end at once: a ball that counts as rolling in a resting
/// contact must not slide when it is free.
pub fn without_ending_slips(table: &Table, constants: &Constants, balls: &State, contacts: &[Contact]) -> State {
    let set = ActiveSet::of(table, balls, contacts, constants.tolerance.ending_slip);
    let ends = |(ball, state): (usize, &BallState)| {
        involve(contacts, ball) && set.cloth[ball] == Friction::Sticks && slides(table.radius, state)
    };
    let mut ended = *balls;
    if balls.iter().enumerate().any(ends) {
        remove_rounding(table, constants, &mut ended, contacts, &set);
    }
    ended
}

/// Whether a contact closes at a speed that, together with rounding, would be a bounce: a ball that is driven by another is not at rest.
fn closes(constants: &Constants, balls: &State, contacts: &[Contact]) -> bool {
    contacts.iter().any(|contact| contact.opening_speed(balls) < -0.1 * constants.tolerance.opening)
}

/// Removes rounding errors from the state: contacts are closed and do not open, and slips, velocities and spins that have ended by `set`
/// become exactly zero.
pub fn remove_rounding(table: &Table, constants: &Constants, balls: &mut State, contacts: &[Contact], set: &ActiveSet) {
    close_gaps(constants, balls, contacts);
    stop_by_impulses(table, balls, contacts, set, &[0.0; MAX_CONTACTS]);
    for (ball, state) in balls.iter_mut().enumerate() {
        if !involve(contacts, ball) {
            continue;
        }
        if set.spin[ball] == Friction::Sticks {
            state.spin.z = 0.0;
        }
        if set.cloth[ball] == Friction::Sticks {
            if set.roll[ball] == Friction::Sticks {
                state.velocity = DVec2::ZERO;
            }
            state.spin = rolling_spin(table.radius, state.velocity).extend(state.spin.z);
        }
    }
}
