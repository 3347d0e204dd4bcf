//! Chatters: contacts that close again and again, ever more softly, under a force that presses.
//!
//! A ball that leaves with speed `s` and is pulled back with acceleration `p` bounces for `T = 2s / (p (1 - e))` in all. The
//! bounces are played exactly, but told as one event; and once it cannot be told apart, the chatter ends at once with one
//! inelastic impact followed by a resting contact. Both give the same impulse, since both bring the speed to zero, and the
//! same first moment of it, since both bring the gap to zero; so the forces that follow the slip see the same slip on
//! average. The second moments differ by twice the area under the gap, `4 s³ / (3 p² (1 - e³))`, and what is left of the
//! chatter is half of that over the square of the time in which the friction's direction turns: that is the error bound
//! which is checked.

use super::{
    Constants,
    contacts::{PAIRS_OF, contacts_where},
};
use crate::{
    physics::{ActiveSet, BallState, Contact, Contacts, Effort, Scene, slip},
    table::{BALLS, PAIRS, Table},
};

/// A bounce of two balls makes a slip of this many times its speed at most, and so does one against a cushion.
const MADE_BY_BOUNCES: f64 = 4.0;

/// The bounces of one contact move others that are coupled to it, and the slips of the balls, by this many times their
/// speed at most.
const COUPLING: f64 = 10.0;

/// Normal forces are at most so many times what the cloth's friction gives a ball: three balls press one contact, and frictions
/// wedge them.
const MOST_PULL: f64 = 8.0;

/// The cloth's frictions on two balls change the slip between them by so many times what they change a ball's speed.
const GRIPPED_SLIP: f64 = 7.0;

/// Slow bounces of one contact that are told one by one; those that follow belong to its chatter.
const TOLD: u32 = 4;

/// Flights that shrink more slowly are no sign of a chatter that ends.
const SLOWEST_SHRINKING: f64 = 0.99;

/// A pause between two bounces is the end of a chatter if it is as long as so many of the last flights, and as so many of the longest
/// one or of the pause before: where another contact throws a ball back again and again, its chatters are one.
const LAST_FLIGHTS: f64 = 8.0;
const LONGEST_FLIGHTS: f64 = 2.0;

/// Pairs of balls, and balls with cushions.
const PLACES: usize = PAIRS.len() + 4 * BALLS;

/// The slow bounces of one contact.
#[derive(Clone, Copy, Debug)]
struct Bounces {
    count: u32,
    last: f64,
    flight: f64,
    /// The longest flight of this chatter.
    longest: f64,
    /// How long before this chatter the last bounce was, s.
    pause: f64,
    /// The last flight over the one before; of a first bounce, which has none, not a number.
    shrinking: f64,
}

impl Bounces {
    /// Longest pause before the next bounce of the same chatter, s.
    fn longest_pause(&self) -> f64 {
        (LAST_FLIGHTS * self.flight).max(LONGEST_FLIGHTS * self.longest.max(self.pause))
    }
}

/// The slow bounces of a shot.
#[derive(Clone, Debug)]
pub struct Chatters([Bounces; PLACES]);

impl Chatters {
    /// No bounces yet.
    pub const fn new() -> Self {
        Self(
            [Bounces {
                count: 0,
                last: f64::NEG_INFINITY,
                flight: f64::INFINITY,
                longest: 0.0,
                pause: 0.0,
                shrinking: 0.0,
            }; PLACES],
        )
    }

    fn place(contact: &Contact) -> usize {
        if let Some(second) = contact.second {
            return contact.first + second - 1;
        }
        let n = contact.cushion_normal;
        let rail = if n.x == 0.0 { 2 + usize::from(n.y > 0.0) } else { usize::from(n.x > 0.0) };
        PAIRS.len() + 4 * contact.first + rail
    }

    /// Takes note of a slow bounce; tells whether it is part of a chatter.
    pub fn bounce(&mut self, contact: &Contact, now: f64) -> bool {
        let bounces = &mut self.0[Self::place(contact)];
        let flight = now - bounces.last;
        if flight <= bounces.longest_pause() {
            let known = if flight.is_finite() { flight } else { 0.0 };
            (bounces.count, bounces.longest) = (bounces.count + 1, bounces.longest.max(known));
        } else {
            (bounces.count, bounces.longest, bounces.pause) = (0, 0.0, flight);
        }
        bounces.shrinking = flight / bounces.flight;
        (bounces.last, bounces.flight) = (now, flight);
        bounces.count > TOLD
    }

    /// Takes note that a contact begins to rest: after a pause, that is like a bounce.
    pub fn begin_rest(&mut self, contact: &Contact, now: f64) {
        if now > self.0[Self::place(contact)].last {
            self.bounce(contact, now);
        }
    }

    /// Takes note that a contact has rested until now: its chatter goes on from here.
    pub fn rest(&mut self, contact: &Contact, now: f64) {
        self.0[Self::place(contact)].last = now;
    }

    /// The last flight of a contact over the one before; not a number behind its first bounce, of whose flights nothing is known.
    pub fn shrinking(&self, contact: &Contact) -> f64 {
        self.0[Self::place(contact)].shrinking
    }

    /// When each chatter of a ball is over, s, if it bounces no more: those with the other balls, by their index, and at its own
    /// index those with cushions. Any bounce, told or not, may be followed by others within a `pause`, s.
    pub fn ends(&self, ball: usize, pause: f64) -> [f64; BALLS] {
        let mut ends = [f64::NEG_INFINITY; BALLS];
        let cushions = (0..4).map(|rail| (ball, PAIRS.len() + 4 * ball + rail));
        for (other, place) in cushions.chain(PAIRS_OF[ball].map(|(pair, other)| (other, pair))) {
            let bounces = self.0[place];
            ends[other] = ends[other].max(bounces.last + pause);
            if bounces.count > TOLD {
                ends[other] = ends[other].max(bounces.last + bounces.longest_pause());
            }
        }
        ends
    }
}

/// A contact that bounces with some speed, and all others that its bounces are coupled to.
fn coupled(
    constants: &Constants,
    balls: &[BallState; BALLS],
    on_cloth: [bool; BALLS],
    contact: &Contact,
    speed: f64,
) -> Contacts {
    let slow = COUPLING * speed.abs();
    let high =
        (0.5 * slow * slow / constants.sliding).clamp(constants.tolerance.touching, constants.tolerance.coupled_gap);
    let is_coupled = |gap: f64, other: &Contact| gap <= high && other.opening_speed(balls).abs() <= slow;
    let mut contacts = contacts_where(constants, balls, on_cloth, is_coupled);
    // It has met, whatever rounding says of its gap.
    contacts.retain(|_, other| other != contact);
    contacts.push(*contact);
    contacts
}

/// The end of a chatter.
pub struct ChatterEnd {
    /// The contacts that rest from now on.
    pub contacts: Contacts,
    /// How long the bounces that are left out would have gone on, s; none where they are too slow to be missed.
    pub lasts: f64,
}

/// The contacts that come to rest together with one that has just bounced, and opens in the state `balls`: forces press them
/// once their bounces have ended, and what is left of those can no longer be told. None if it goes on. Its bounces have a `restitution`, and
/// `shrinking` is the last flight over the one before.
pub fn chatter_end(
    table: &Table,
    constants: &Constants,
    contact: &Contact,
    balls: &[BallState; BALLS],
    on_cloth: [bool; BALLS],
    (restitution, shrinking): (f64, f64),
    effort: &Effort,
) -> Option<ChatterEnd> {
    let tolerance = &constants.tolerance;
    let speed = contact.opening_speed(balls);
    // Bounces that lose nothing never fade.
    let slowest = if restitution < 1.0 { tolerance.slowest_bounce } else { tolerance.slowest_lossless_bounce };
    if speed <= slowest {
        let mut alone = Contacts::NONE;
        alone.push(*contact);
        return Some(ChatterEnd { contacts: alone, lasts: 0.0 });
    }
    // What the bounces open holds on average, and slips that they make are none.
    let mut contacts = coupled(constants, balls, on_cloth, contact, speed);
    // What is in flight does not press, and to stop it its contact would have to pull.
    let flies = |other: &Contact| other != contact && other.opening_speed(balls) > tolerance.slowest_bounce;
    contacts.retain(|_, other| other.shares_a_ball(contact) && !flies(other));
    let none = tolerance.ending_slip.max(MADE_BY_BOUNCES * speed);
    // The friction that turns soonest: that of the ball whose slip ends first.
    let slips = balls
        .iter()
        .enumerate()
        .filter(|(ball, _)| contacts.hold(*ball))
        .map(|(_, state)| slip(table.radius, state.velocity, state.spin).length());
    let (mut slide, mut made) = (f64::INFINITY, false);
    for slip in slips {
        if slip > none {
            slide = slide.min(slip * constants.slide_time);
        } else if slip > tolerance.ending_slip {
            made = true;
        }
    }
    // A slip that the bounces make turns with each of them: what they do is of their own size.
    let alone = contacts.len() == 1;
    if made && speed > if alone { tolerance.slowest_bounce } else { tolerance.slowest_coupled_bounce } {
        return None;
    }
    // Behind a first bounce the shrinking is not a number, and counts as the slowest: `min` returns the other operand.
    let restitution = restitution.max(shrinking.min(SLOWEST_SHRINKING));
    let cube = |x: f64| x * x * x;
    // Coupled contacts need not bounce ever more softly: all that is known is how softly they do.
    let negligible = if alone { tolerance.negligible } else { tolerance.negligible_coupled };
    let ends = |pull: f64| {
        let chatter = 2.0 * speed / (pull * (1.0 - restitution));
        let moment = 4.0 * cube(speed) / (3.0 * pull * pull * (1.0 - cube(restitution)));
        chatter <= slide && 0.5 * moment <= negligible * slide * slide
    };
    // Most bounces are too fast for any pull that the cloth can give.
    let bodies = if contact.second.is_some() { 2.0 } else { 1.0 };
    if !ends(MOST_PULL * bodies * (constants.sliding + constants.tilt.length())) {
        return None;
    }
    let set = ActiveSet::of(table, balls, &contacts, none);
    let resolved = Scene { table, balls, contacts: &contacts, set: &set }.resolve(tolerance.slack, None, effort)?;
    let index = resolved.contacts.iter().position(|pressing| pressing == contact)?;
    let pull = bodies * resolved.forces.normal[index];
    // Balls that never slip lose with each impact the slip that their flight has made, which the other contacts feel as a
    // bounce.
    let kick = 2.0 * speed / pull * GRIPPED_SLIP * constants.sliding;
    let grips = !alone && contacts.iter().any(|other| other.never_slips(table));
    if grips && kick > tolerance.slowest_coupled_bounce {
        return None;
    }
    if !ends(pull) {
        return None;
    }
    let is_missed = speed > tolerance.slowest_coupled_bounce;
    let lasts = if is_missed { 2.0 * speed / (pull * (1.0 - restitution)) } else { 0.0 };
    let is_cut_short = is_missed && meets_another(constants, balls, on_cloth, &resolved.contacts, lasts);
    (!is_cut_short).then_some(ChatterEnd { contacts: resolved.contacts, lasts })
}

/// Whether a ball of the contacts meets anything else within a `time`, s, in which the bounces that are left out are not over: it would
/// have the speed of one of them still.
fn meets_another(
    constants: &Constants,
    balls: &[BallState; BALLS],
    on_cloth: [bool; BALLS],
    contacts: &Contacts,
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

    /// How many bounces with these flights behind them are told, and when the last flight is over, s.
    fn told(chatters: &mut Chatters, contact: &Contact, flights: impl Iterator<Item = f64>) -> (u32, f64) {
        flights.fold((0, 0.0), |(told, now), flight| (told + u32::from(!chatters.bounce(contact, now)), now + flight))
    }

    #[test]
    fn bounces_are_told_until_they_are_a_chatter() {
        let mut chatters = Chatters::new();
        let flights = (1..=40).map(|bounce| 0.1 * 0.9_f64.powi(bounce));
        let (told, now) = told(&mut chatters, &Contact::of_balls(0, 1), flights);
        assert_eq!(told, TOLD);
        assert!(chatters.ends(1, 0.0)[0] > now && chatters.ends(2, 0.0)[0] < now);
        assert!(chatters.ends(0, 0.0)[1] < now + 1.0);
    }

    /// Bounces between a ball and a cushion: each time when the cushion throws the ball back they begin anew, and shorter.
    #[test]
    fn a_ball_that_another_contact_throws_back_goes_on_with_its_chatter() {
        let mut chatters = Chatters::new();
        let flights = (0..20).flat_map(|round| {
            let longest = 0.1 * 0.95_f64.powi(round);
            let pause = move |bounce: i32| if bounce == 11 { 0.9 * longest } else { 0.0 };
            (0..12).map(move |bounce| longest * 0.3_f64.powi(bounce) + pause(bounce))
        });
        let (told, now) = told(&mut chatters, &Contact::of_balls(0, 1), flights);
        assert_eq!(told, TOLD);
        assert!(chatters.ends(0, 0.0)[1] > now && chatters.ends(0, 0.0)[1] < now + 0.2);
    }

    /// Two contacts in turn throw a ball back, each with two bounces, after pauses that grow shorter.
    #[test]
    fn bounces_that_come_back_after_ever_shorter_pauses_are_one_chatter() {
        let flights = (1..=50).flat_map(|round| [0.0, 0.0, 6e-3 * 0.9_f64.powi(round)]);
        let (told, _) = told(&mut Chatters::new(), &Contact::of_balls(0, 2), flights);
        assert!(told <= 4 * TOLD, "{told} of 150 bounces are told");
    }

    /// A ball spins against a cushion, and another one comes from behind: at this speed its bounces are over in some microseconds.
    #[test]
    fn a_chatter_goes_on_that_another_ball_would_cut_short() {
        let table = Table::preset("thesis").unwrap();
        let constants = Constants::of(&table);
        let contact = Contact::with_cushion(0, glam::DVec2::NEG_X);
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

    /// A ball that is pressed into a corner and bounces on both cushions: one bounce has just ended, the other is in flight.
    #[test]
    fn a_chatter_ends_without_the_contact_that_is_in_flight() {
        let table = Table::preset("thesis").unwrap();
        let constants = Constants::of(&table);
        let contact = Contact::with_cushion(0, glam::DVec2::NEG_X);
        let ends = |up: f64| {
            let mut balls =
                [glam::DVec2::ZERO, glam::DVec2::new(0.0, 0.3), glam::DVec2::new(0.0, -0.3)].map(BallState::at_rest);
            // Spins that press it to both.
            balls[0] = BallState {
                position: table.reach(),
                velocity: glam::DVec2::new(-1e-9, -up),
                spin: glam::DVec3::new(-100.0, 100.0, 0.0),
            };
            let bounces = (table.rail_restitution, 0.3);
            chatter_end(&table, &constants, &contact, &balls, [true; BALLS], bounces, &Effort::default())
                .expect("the chatter ends")
                .contacts
                .to_vec()
        };
        let other = Contact::with_cushion(0, glam::DVec2::NEG_Y);
        assert_eq!(ends(3e-9), [contact]);
        assert!(ends(0.0).contains(&contact) && ends(0.0).contains(&other));
    }
}
