//! The active set at the start of a step of a resting contact: which slips have ended, which contacts press, which
//! frictions stick.

use glam::DVec2;

use super::{Constants, contacts::close_gaps, extrapolation::State, segment::slides, tolerance::Tolerance};
use crate::{
    physics::{
        ActiveSet, BallState, Contact, Contacts, Effort, Forces, Friction, MAX_CONTACTS, Resolved, Scene, rolling_spin,
        slip, stop_by_impulses,
    },
    table::{BALLS, Table},
};

/// The step that has just ended.
#[derive(Clone, Copy)]
pub struct Ended<'a> {
    /// The contacts that pressed.
    pub contacts: &'a Contacts,
    /// What its frictions did.
    pub set: &'a ActiveSet,
    /// The forces at the end.
    pub forces: &'a Forces,
    /// Whether something else has ended the step.
    pub interrupted: bool,
    /// Whether many steps in a row have begun anew.
    pub repeats: bool,
}

impl Ended<'_> {
    /// Frictions that have yielded go on so while their slips are small.
    fn goes_on_yielding(
        &self,
        radius: f64,
        tolerance: &Tolerance,
        balls: &State,
        contacts: &[Contact],
        set: &mut ActiveSet,
    ) {
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

/// Balls without the slips that end, and what holds then.
struct Stopped {
    begin: State,
    resolved: Resolved,
    /// Whether a slip begins again that has been taken to end.
    departs: bool,
}

/// The state without the slips that end here, and the active set that holds then; none where no contact presses a ball that
/// moves. `balls` become what they are where they stay free, and `contacts` what may rest.
///
/// Friction without limit leaves states in which no forces obey all laws (Painlevé's paradox): what would hold the slip of two
/// balls parts them, and once they have parted, and nothing holds, they come back. They begin to bounce then, each time
/// higher, and each bounce takes their slip as every impact of theirs does (17).
pub fn find_active_set(
    table: &Table,
    constants: &Constants,
    balls: &mut State,
    contacts: &mut Contacts,
    least_push: f64,
    previous: Option<Ended<'_>>,
    effort: &Effort,
) -> Option<(State, Resolved)> {
    if stand_on_slope(constants, balls, contacts) {
        return None;
    }
    let tolerance = &constants.tolerance;
    let grips = contacts.iter().any(|contact| has_to_grip(table, constants, balls, contact, previous));
    let stopped = |none: f64, balls: &State, contacts: &[Contact]| {
        let mut begin = *balls;
        if grips {
            stop_slips(table, &mut begin, contacts);
        }
        let mut set = ActiveSet::of(table, &begin, contacts, none);
        if let Some(previous) = previous.filter(|previous| previous.set.yields()) {
            previous.goes_on_yielding(table.radius, tolerance, &begin, contacts, &mut set);
        }
        remove_rounding(table, constants, &mut begin, contacts, &set);
        // Where forces are not unique, those near to the ones before are taken: after an interruption that has changed no contact, and after
        // many steps in a row that have begun anew.
        let same =
            |previous: &Ended<'_>| previous.repeats || previous.interrupted && previous.contacts[..] == *contacts;
        let of_these = |previous: Ended<'_>| previous.forces.of_contacts(previous.contacts, contacts);
        let similar = previous.filter(same).map(of_these);
        let resolve = |balls: &State, set: &ActiveSet| {
            Scene { table, balls, contacts, set }.resolve(least_push, similar.as_ref(), effort)
        };
        let mut resolved = resolve(&begin, &set)?;
        if resolved.is_paradox() {
            return Some(Stopped { begin, resolved, departs: false });
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
        Some(Stopped { begin, resolved, departs })
    };
    let (mut pressing, mut now) = (*contacts, *balls);
    loop {
        if pressing.is_empty() {
            return None;
        }
        let ended = stopped(tolerance.ending_slip, &now, &pressing)?;
        if ended.resolved.is_paradox() {
            let part = |index: usize, contact: &Contact, balls: &mut State| {
                if ended.resolved.paradox[index] {
                    part(balls, contact, tolerance.first_bounce);
                }
            };
            for (index, contact) in pressing.iter().enumerate() {
                part(index, contact, &mut now);
                part(index, contact, balls);
            }
            contacts.retain(|_, contact| {
                let index = pressing.iter().position(|pressing| pressing == contact);
                index.is_none_or(|index| !ended.resolved.paradox[index])
            });
            pressing.retain(|index, _| !ended.resolved.paradox[index]);
            continue;
        }
        // Balls that lie still may go on pushing each other, held by the cloth; nothing comes of it.
        let still = |(ball, state): (usize, &BallState)| {
            !pressing.hold(ball) || (state.velocity == DVec2::ZERO && state.spin == glam::DVec3::ZERO)
        };
        if !ended.departs && ended.begin.iter().enumerate().all(still) {
            return None;
        }
        // What would begin to slip again at once has not ended.
        let Stopped { begin, resolved, .. } =
            if ended.departs { stopped(tolerance.slip, &now, &pressing)? } else { ended };
        // A contact that does not push holds nothing: it is no part of the step, and its opening goes on.
        if resolved.contacts.len() == pressing.len() {
            return Some((begin, resolved));
        }
        for ball in (0..BALLS).filter(|&ball| pressing.hold(ball) && !resolved.contacts.hold(ball)) {
            // A slip that has ended has done so for a ball that nothing holds, too; one that rolls rolls on.
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

/// Lets two balls part at some speed, m/s.
fn part(balls: &mut State, contact: &Contact, speed: f64) {
    let Some(second) = contact.second else { return };
    let missing = 0.5 * (speed - contact.opening_speed(balls)) * contact.normal(balls);
    balls[contact.first].velocity += missing;
    balls[second].velocity -= missing;
}

/// Whether balls that never slip have to stop slipping: their contact begins, or an impact of another has just made them slip.
fn has_to_grip(
    table: &Table,
    constants: &Constants,
    balls: &State,
    contact: &Contact,
    previous: Option<Ended<'_>>,
) -> bool {
    contact.never_slips(table)
        && (previous.is_none_or(|previous| !previous.contacts.contains(contact))
            || contact.slip(table.radius, balls).length() > constants.tolerance.ending_slip)
}

/// Balls that never slip stop slipping as soon as they press, however little: as in a collision of theirs (17), where the
/// cloth has no time to take part.
fn stop_slips(table: &Table, balls: &mut State, contacts: &[Contact]) {
    let sticks = |contact: Option<&Contact>| match contact {
        Some(contact) if contact.second.is_some() => Friction::Sticks,
        _ => Friction::Slips(DVec2::ZERO),
    };
    let contact = std::array::from_fn(|index| sticks(contacts.get(index)));
    stop_by_impulses(table, balls, contacts, &ActiveSet { contact, ..ActiveSet::SLIPPING }, &[0.0; MAX_CONTACTS]);
}

/// Pressing that cannot matter before the slips end that make it, m/s²: it moves nothing by as much as a speed that counts
/// for none, or is no more than the rounding of the slips' directions, which are the less known the smaller a slip is beside
/// the speeds that it is the difference of.
pub fn transient_pressing(constants: &Constants, balls: &State, contacts: &Contacts) -> f64 {
    let idle = |ball: &BallState| {
        let slip = slip(constants.radius, ball.velocity, ball.spin).length();
        if slip <= constants.tolerance.ending_slip {
            return 0.0;
        }
        let speeds = ball.velocity.length() + constants.radius * ball.spin.truncate().length();
        let rounding = 32.0 * f64::EPSILON * speeds / slip * constants.sliding;
        rounding.max(constants.tolerance.opening / (slip * constants.slide_time))
    };
    let members = balls.iter().enumerate().filter(|(ball, _)| contacts.hold(*ball));
    members.map(|(_, ball)| idle(ball)).fold(0.0, f64::max)
}

/// Whether the balls of contacts stand still on a table that is not level: what lies below goes on pressing them, but they are at rest.
fn stand_on_slope(constants: &Constants, balls: &State, contacts: &Contacts) -> bool {
    let none = constants.tolerance.still;
    let stands = |ball: &BallState| {
        ball.velocity.length() < none && constants.radius * ball.spin.truncate().length() < none && ball.spin.z == 0.0
    };
    !constants.level && (0..BALLS).all(|ball| !contacts.hold(ball) || stands(&balls[ball]))
}

/// The balls of contacts that do not press, without slips on the cloth that end at once: what a resting contact would count
/// as rolling must not slide when it is free.
pub fn without_ending_slips(table: &Table, constants: &Constants, balls: &State, contacts: &Contacts) -> State {
    let set = ActiveSet::of(table, balls, contacts, constants.tolerance.ending_slip);
    let ends = |(ball, state): (usize, &BallState)| {
        contacts.hold(ball) && set.cloth[ball] == Friction::Sticks && slides(table.radius, state)
    };
    let mut ended = *balls;
    if balls.iter().enumerate().any(ends) {
        remove_rounding(table, constants, &mut ended, contacts, &set);
    }
    ended
}

/// Whether a contact closes by as much as, together with what rounding does, would be a bounce: a ball that another drives on does not
/// stand still.
fn closes(constants: &Constants, balls: &State, contacts: &Contacts) -> bool {
    contacts.iter().any(|contact| contact.opening_speed(balls) < -0.1 * constants.tolerance.opening)
}

/// Takes the rounding out of the state: contacts are closed and do not open, and what has stopped slipping, moving or
/// spinning by `set` has stopped exactly.
pub fn remove_rounding(table: &Table, constants: &Constants, balls: &mut State, contacts: &[Contact], set: &ActiveSet) {
    close_gaps(constants, balls, contacts);
    stop_by_impulses(table, balls, contacts, set, &[0.0; MAX_CONTACTS]);
    for (ball, state) in balls.iter_mut().enumerate() {
        if !contacts.iter().any(|contact| contact.has(ball)) {
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
