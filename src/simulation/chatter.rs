//! Chatter (Zeno behaviour): contacts that close repeatedly, at ever lower speed, under a force that presses.
//!
//! A ball that leaves with the speed `s` and is pulled back with the acceleration `p` bounces for `T = 2s / (p (1 - e))` in total. The
//! bounces are simulated exactly, but reported as one event. Once the remaining bounces are indistinguishable from their limit, the chatter
//! ends with one inelastic impact followed by a resting contact.
//!
//! Both give the same impulse, because both bring the speed to zero, and the same first moment of the impulse, because both bring the gap
//! to zero. Forces that depend on the slip therefore see the same slip on average. The second moments differ by twice the area under the
//! gap, `4 s³ / (3 p² (1 - e³))`. The error in speed, m/s, is half of this, divided by the square of the time in which the direction of
//! friction turns: this error bound is checked.

use super::{Constants, contacts::contacts_where};
use crate::{
    physics::{ActiveSet, BallState, Contact, Contacts, Effort, Scene, involve, slip},
    table::{BALLS, Table},
};

/// Bound on the slip, in units of the bounce speed, that a bounce of two balls or of a ball and a cushion creates.
const MADE_BY_BOUNCES: f64 = 4.0;

/// Bound on the speeds, in units of a bounce's speed, that the bounce causes in coupled contacts and in the slips of the balls.
const COUPLING: f64 = 10.0;

/// Bound on normal forces in units of the cloth's friction on a ball: three balls can press on one contact, and frictions wedge them.
const MAX_PULL: f64 = 8.0;

/// Change of the slip between two balls by the cloth's frictions, in units of the change of a ball's speed.
const GRIPPED_SLIP: f64 = 7.0;

/// Number of slow bounces of one contact that are reported individually; later ones belong to its chatter.
const REPORTED_BOUNCES: u32 = 4;

/// Flights with a larger ratio of successive durations do not indicate a chatter that ends.
const MAX_FLIGHT_RATIO: f64 = 0.99;

/// A pause between two bounces ends a chatter if it exceeds this multiple of the last flight, and [`LONGEST_FLIGHTS`].
const LAST_FLIGHTS: f64 = 8.0;

/// A pause that ends a chatter must also exceed this multiple of both the longest flight and the pause before. If another contact throws
/// a ball back repeatedly, its bounces therefore remain one chatter.
const LONGEST_FLIGHTS: f64 = 2.0;

/// Record of the slow bounces of one contact.
#[derive(Clone, Copy, Debug)]
struct Bounces {
    count: u32,
    last: f64,
    flight: f64,
    /// Longest flight of this chatter, s.
    longest: f64,
    /// Pause between the last bounce before this chatter and its first, s.
    pause: f64,
    /// Ratio of the last flight to the one before; NaN for a first bounce, which has none.
    flight_ratio: f64,
}

impl Bounces {
    const NONE: Self =
        Self { count: 0, last: f64::NEG_INFINITY, flight: f64::INFINITY, longest: 0.0, pause: 0.0, flight_ratio: 0.0 };

    /// Returns the longest pause before the next bounce of the same chatter, s.
    fn longest_pause(&self) -> f64 {
        (LAST_FLIGHTS * self.flight).max(LONGEST_FLIGHTS * self.longest.max(self.pause))
    }
}

/// Records of all slow bounces of a shot, for each contact that has bounced or rested.
#[derive(Clone, Debug, Default)]
pub struct Chatters(Vec<(Contact, Bounces)>);

impl Chatters {
    /// Returns the record of a contact, which is created if there is none.
    fn of(&mut self, contact: &Contact) -> &mut Bounces {
        let known = self.0.iter().position(|(known, _)| known == contact);
        let index = known.unwrap_or_else(|| {
            self.0.push((*contact, Bounces::NONE));
            self.0.len() - 1
        });
        &mut self.0[index].1
    }

    /// Records a slow bounce. Returns whether it is part of a chatter.
    pub fn bounce(&mut self, contact: &Contact, now: f64) -> bool {
        let bounces = self.of(contact);
        let flight = now - bounces.last;
        if flight <= bounces.longest_pause() {
            let known = if flight.is_finite() { flight } else { 0.0 };
            (bounces.count, bounces.longest) = (bounces.count + 1, bounces.longest.max(known));
        } else {
            (bounces.count, bounces.longest, bounces.pause) = (0, 0.0, flight);
        }
        bounces.flight_ratio = flight / bounces.flight;
        (bounces.last, bounces.flight) = (now, flight);
        bounces.count > REPORTED_BOUNCES
    }

    /// Records that a contact begins to rest; after a pause, this counts as a bounce.
    pub fn begin_rest(&mut self, contact: &Contact, now: f64) {
        if now > self.of(contact).last {
            self.bounce(contact, now);
        }
    }

    /// Records that a contact has rested until now: its chatter continues from here.
    pub fn rest(&mut self, contact: &Contact, now: f64) {
        self.of(contact).last = now;
    }

    /// Returns the ratio of a contact's last flight to the one before; NaN after its first bounce, zero without any.
    pub fn flight_ratio(&self, contact: &Contact) -> f64 {
        self.0.iter().find(|(known, _)| known == contact).map_or(0.0, |(_, bounces)| bounces.flight_ratio)
    }

    /// Returns when each chatter of a ball ends, s, if it does not bounce again, with the index of the other ball, or the ball's own index for
    /// chatters with cushions. Any bounce, reported or not, may be followed by others within `pause`, s.
    pub fn ends(&self, ball: usize, pause: f64) -> impl Iterator<Item = (usize, f64)> {
        self.0.iter().filter(move |(contact, _)| contact.involves(ball)).map(move |(contact, bounces)| {
            let other = contact.second().map_or(ball, |second| contact.first + second - ball);
            let pause = if bounces.count > REPORTED_BOUNCES { pause.max(bounces.longest_pause()) } else { pause };
            (other, bounces.last + pause)
        })
    }
}

/// Returns the contacts that come to rest together with `contact`, which has just bounced and opens in the state `balls`. Forces must press
/// them once their bounces have ended, and the remaining bounces must be negligible. Also returns the remaining duration of the omitted
/// bounces, s, which is zero if they are negligibly slow. `None` if the chatter continues. `restitution` is that of its bounces;
/// `flight_ratio` is the ratio of the last flight to the one before.
pub fn chatter_end(
    table: &Table,
    constants: &Constants,
    contact: &Contact,
    balls: &[BallState; BALLS],
    on_cloth: [bool; BALLS],
    (restitution, flight_ratio): (f64, f64),
    effort: &Effort,
) -> Option<(Contacts, f64)> {
    let tolerance = &constants.tolerance;
    let speed = contact.opening_speed(balls);
    // Bounces without loss never fade.
    let slowest = if restitution < 1.0 { tolerance.slowest_bounce } else { tolerance.slowest_lossless_bounce };
    if speed <= slowest {
        return Some((Contacts::from_iter([*contact]), 0.0));
    }
    // While a contact chatters, the contacts that are coupled to it count as closed, and slips as small as its bounces cause count as zero.
    // A contact in flight does not press, and could only be stopped by pulling.
    let slow = COUPLING * speed;
    let high = (0.5 * slow * slow / constants.sliding).clamp(tolerance.touching, tolerance.coupled_gap);
    let is_coupled = |gap: f64, other: &Contact| {
        let opening = other.opening_speed(balls);
        let is_slow = opening.abs() <= slow && opening <= tolerance.slowest_bounce;
        gap <= high && is_slow && other != contact && other.shares_a_ball(contact)
    };
    let mut contacts = contacts_where(constants, balls, on_cloth, is_coupled);
    // The contact is closed, whatever its rounded gap is.
    contacts.push(*contact);
    let none = tolerance.ending_slip.max(MADE_BY_BOUNCES * speed);
    // The friction whose direction turns soonest: that of the ball whose slip ends first.
    let slips = balls
        .iter()
        .enumerate()
        .filter(|(ball, _)| involve(&contacts, *ball))
        .map(|(_, state)| slip(table.radius, state.velocity, state.spin).length());
    let (mut slide, mut made) = (f64::INFINITY, false);
    for slip in slips {
        if slip > none {
            slide = slide.min(slip * constants.slide_time);
        } else if slip > tolerance.ending_slip {
            made = true;
        }
    }
    // A slip that the bounces create turns with each of them: its effect is as large as their own.
    let alone = contacts.len() == 1;
    if made && speed > if alone { tolerance.slowest_bounce } else { tolerance.slowest_coupled_bounce } {
        return None;
    }
    // After a first bounce, `flight_ratio` is NaN and counts as the slowest: `min` returns the other operand.
    let restitution = restitution.max(flight_ratio.min(MAX_FLIGHT_RATIO));
    let cube = |x: f64| x * x * x;
    // Coupled contacts do not necessarily bounce more and more softly: only their present speed is known.
    let negligible = if alone { tolerance.negligible } else { tolerance.negligible_coupled };
    let ends = |pull: f64| {
        let chatter = 2.0 * speed / (pull * (1.0 - restitution));
        let moment = 4.0 * cube(speed) / (3.0 * pull * pull * (1.0 - cube(restitution)));
        chatter <= slide && 0.5 * moment <= negligible * slide * slide
    };
    // Most bounces are too fast for any acceleration that the cloth can cause.
    let bodies = if contact.second().is_some() { 2.0 } else { 1.0 };
    if !ends(MAX_PULL * bodies * (constants.sliding + constants.tilt.length())) {
        return None;
    }
    let set = ActiveSet::of(table, balls, &contacts, none);
    let resolved =
        Scene { table, balls, contacts: &contacts, set: &set }.resolve(tolerance.force_error, None, effort)?;
    let index = resolved.contacts.iter().position(|pressing| pressing == contact)?;
    let pull = bodies * resolved.forces.normal[index];
    // In each impact, balls that never slip lose the slip that arose in flight, which the other contacts feel as a bounce.
    let kick = 2.0 * speed / pull * GRIPPED_SLIP * constants.sliding;
    let grips = !alone && contacts.iter().any(|other| other.never_slips(table));
    if grips && kick > tolerance.slowest_coupled_bounce {
        return None;
    }
    if !ends(pull) {
        return None;
    }
    let is_missed = speed > tolerance.slowest_coupled_bounce;
    let duration = if is_missed { 2.0 * speed / (pull * (1.0 - restitution)) } else { 0.0 };
    let is_cut_short = is_missed && meets_another(constants, balls, on_cloth, &resolved.contacts, duration);
    (!is_cut_short).then_some((resolved.contacts, duration))
}

/// Whether a ball of the contacts collides with anything else within `time`, s, before the omitted bounces are over: it would still have
/// the speed of one of them.
fn meets_another(
    constants: &Constants,
    balls: &[BallState; BALLS],
    on_cloth: [bool; BALLS],
    contacts: &[Contact],
    time: f64,
) -> bool {
    let meets = |gap: f64, other: &Contact| {
        let closing = -other.opening_speed(balls);
        closing > constants.tolerance.opening
            && gap <= time * (closing + constants.sliding * time)
            && !contacts.contains(other)
            && contacts.iter().any(|contact| contact.shares_a_ball(other))
    };
    !contacts_where(constants, balls, on_cloth, meets).is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Rail;

    /// Returns the end of the chatters of a ball with another one, s.
    fn end_time(chatters: &Chatters, ball: usize, other: usize) -> f64 {
        let ends = chatters.ends(ball, 0.0).filter(|(with, _)| *with == other);
        ends.map(|(_, end)| end).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns how many bounces with these flights after them are reported, and when the last flight is over, s.
    fn reported(chatters: &mut Chatters, contact: &Contact, flights: impl Iterator<Item = f64>) -> (u32, f64) {
        flights.fold((0, 0.0), |(reported, now), flight| {
            (reported + u32::from(!chatters.bounce(contact, now)), now + flight)
        })
    }

    #[test]
    fn bounces_are_reported_until_they_are_a_chatter() {
        let mut chatters = Chatters::default();
        let flights = (1..=40).map(|bounce| 0.1 * 0.9_f64.powi(bounce));
        let (reported, now) = reported(&mut chatters, &Contact::of_balls(0, 1), flights);
        assert_eq!(reported, REPORTED_BOUNCES);
        assert!(end_time(&chatters, 1, 0) > now && end_time(&chatters, 2, 0) < now);
        assert!(end_time(&chatters, 0, 1) < now + 1.0);
    }

    /// Bounces between a ball and a cushion: each time the cushion throws the ball back, they start again, with shorter flights.
    #[test]
    fn ball_thrown_back_by_another_contact_continues_its_chatter() {
        let mut chatters = Chatters::default();
        let flights = (0..20).flat_map(|round| {
            let longest = 0.1 * 0.95_f64.powi(round);
            let pause = move |bounce: i32| if bounce == 11 { 0.9 * longest } else { 0.0 };
            (0..12).map(move |bounce| longest * 0.3_f64.powi(bounce) + pause(bounce))
        });
        let (reported, now) = reported(&mut chatters, &Contact::of_balls(0, 1), flights);
        assert_eq!(reported, REPORTED_BOUNCES);
        assert!(end_time(&chatters, 0, 1) > now && end_time(&chatters, 0, 1) < now + 0.2);
    }

    /// Two contacts alternately throw a ball back, each with two bounces, after ever shorter pauses.
    #[test]
    fn bounces_with_shrinking_pauses_are_one_chatter() {
        let flights = (1..=50).flat_map(|round| [0.0, 0.0, 6e-3 * 0.9_f64.powi(round)]);
        let (reported, _) = reported(&mut Chatters::default(), &Contact::of_balls(0, 2), flights);
        assert!(reported <= 4 * REPORTED_BOUNCES, "{reported} of 150 bounces are reported");
    }

    /// A ball spins against a cushion, and another one approaches from behind: at this speed the bounces end within some microseconds.
    #[test]
    fn chatter_continues_if_another_ball_would_interrupt_its_end() {
        let table = Table::preset("thesis").unwrap();
        let constants = Constants::of(&table);
        let contact = Contact::with_cushion(0, Rail::Right);
        let ends = |gap: f64| {
            let place = glam::DVec2::new(table.reach().x, 0.0);
            let behind = place - glam::DVec2::new(2.0 * table.radius + gap, 0.0);
            let mut balls = [place, behind, -place].map(BallState::at_rest);
            balls[0].velocity.x = -1e-6;
            balls[0].spin.y = 100.0;
            balls[1].velocity.x = 0.1;
            let bounces = (table.rail_restitution, 0.3);
            chatter_end(&table, &constants, &contact, &balls, [true; BALLS], bounces, &Effort::default()).is_some()
        };
        assert!(ends(1e-6) && !ends(1e-8));
    }

    /// A ball that is pressed into a corner and bounces on both cushions: one bounce has just ended, the other contact is in flight.
    #[test]
    fn end_of_a_chatter_excludes_contacts_in_flight() {
        let table = Table::preset("thesis").unwrap();
        let constants = Constants::of(&table);
        let contact = Contact::with_cushion(0, Rail::Right);
        let ends = |up: f64| {
            let mut balls =
                [glam::DVec2::ZERO, glam::DVec2::new(0.0, 0.3), glam::DVec2::new(0.0, -0.3)].map(BallState::at_rest);
            // Spins that press the ball against both cushions.
            balls[0] = BallState {
                position: table.reach(),
                velocity: glam::DVec2::new(-1e-9, -up),
                spin: glam::DVec3::new(-100.0, 100.0, 0.0),
            };
            let bounces = (table.rail_restitution, 0.3);
            chatter_end(&table, &constants, &contact, &balls, [true; BALLS], bounces, &Effort::default())
                .expect("the chatter ends")
                .0
        };
        let other = Contact::with_cushion(0, Rail::Top);
        assert_eq!(ends(3e-9)[..], [contact]);
        assert!(ends(0.0).contains(&contact) && ends(0.0).contains(&other));
    }
}
