//! What changes at one moment: impacts, ends of slips, resting contacts that begin and end.

use super::{
    doubt::{RESTING_SPEED, STOPPED_SPEED},
    laws::impact_loss,
    least_squares::{Column, dot, fit},
    motion::{directions, energy, motion, on_cloth, plain},
};
use crate::{
    physics::{BallState, slip},
    study::reference_engine::{Contact, Numbers},
    table::{BALLS, Table},
};

/// The balls just before and just after a moment.
pub struct Moment<'a> {
    pub table: &'a Table,
    pub numbers: &'a Numbers<f64>,
    pub before: [BallState; BALLS],
    pub after: [BallState; BALLS],
    /// Whether each ball was in resting contact, and whether it is.
    pub rested: [bool; BALLS],
    pub rests: [bool; BALLS],
    /// The impacts that are told, in order.
    pub impacts: Vec<Contact>,
    /// The contacts that are closed.
    pub closed: Vec<Contact>,
}

/// What a moment takes that no law does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Taken {
    /// Energy that is lost beyond what the laws take, m²/s²; negative where too little is lost.
    pub unexplained: f64,
    /// Energy of the bounces that a resting contact replaces from now on.
    pub bounces: Option<Bounces>,
}

/// A chatter that is told as one resting contact: its remaining bounces take their energy little by little.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounces {
    /// The ball that bounces.
    pub ball: usize,
    /// Energy of the first bounce that is left out, m²/s².
    pub energy: f64,
    /// How long the bounces go on at least, s.
    pub lasts: f64,
}

impl Bounces {
    /// Those of a `ball` that meets something at a `speed`, m/s, with restitution `e`; the energy is that per mass of what bounces.
    pub fn of(table: &Table, ball: usize, speed: f64, e: f64) -> Self {
        // No more than the cloth under all balls presses them together.
        let pull = BALLS as f64 * table.sliding_friction * table.gravity;
        let speed = e * speed.max(0.0);
        Self { ball, energy: 0.5 * speed * speed, lasts: 2.0 * speed / (pull * (1.0 - e)) }
    }
}

/// So many roundings of the fastest velocity are in the states before and after a moment; each impact adds one. Smaller: impulses that
/// such velocities tell badly seem to pull, or to rub more than Coulomb allows. Larger: some of those that do are missed.
const ROUNDINGS: f64 = 4.0;

/// Bounces slower than this may be the last of a chatter, m/s: they take and leave as little as a resting contact.
const LAST_BOUNCE: f64 = 1e-7;

/// Bounces slower than this lose nothing in a shot that has taken too much work for anything to rest, m/s.
pub fn fastest_micro_collision(table: &Table) -> f64 {
    1e-3 * (table.gravity * table.radius).sqrt()
}

impl Moment<'_> {
    /// Whether a group's impact is so slow that it may end a chatter.
    pub fn ends_a_chatter(&self, group: [bool; BALLS]) -> bool {
        let mut inside = self.impacts.iter().filter(|contact| group[contact.balls().0]);
        inside.any(|contact| self.closing_speed(*contact).abs() < LAST_BOUNCE)
    }

    /// Whether a contact in a group is closed without an impact: the engine asks whether it rests, and stops what it closes by.
    pub fn touches_without_impact(&self, group: [bool; BALLS]) -> bool {
        self.closed.iter().any(|contact| contact.is_among(group) && !self.impacts.contains(contact))
    }

    /// The balls that are joined to `ball` by impacts or closed contacts, itself among them.
    pub fn group(&self, ball: usize, changed: [bool; BALLS]) -> [bool; BALLS] {
        let mut group: [bool; BALLS] = std::array::from_fn(|other| other == ball);
        // Three balls are reached in two rounds.
        for _ in 1..BALLS {
            for contact in self.impacts.iter().chain(&self.closed) {
                if let Contact::Balls(first, second) = *contact
                    && contact.is_among(changed)
                    && (group[first] || group[second])
                {
                    (group[first], group[second]) = (true, true);
                }
            }
        }
        group
    }

    /// What is lost by the balls of a group beyond what its impacts take.
    pub fn taken(&self, group: [bool; BALLS]) -> Taken {
        let of_group = |balls: &[BallState; BALLS]| {
            let mut all = motion(self.table.radius, balls);
            for (place, member) in all.chunks_exact_mut(5).zip(group) {
                if !member {
                    place.fill(0.0);
                }
            }
            all
        };
        let (before, after) = (of_group(&self.before), of_group(&self.after));
        let lost = energy(&before) - energy(&after);
        let impacts: Vec<Contact> = self.impacts.iter().copied().filter(|contact| group[contact.balls().0]).collect();
        let was_free = (0..BALLS).all(|ball| !(group[ball] && self.rested[ball]));
        let several = || Taken { unexplained: self.several(group, &impacts, &before, &after), bounces: None };
        let nearer =
            |one: Taken, other: Taken| if other.unexplained.abs() < one.unexplained.abs() { other } else { one };
        match impacts[..] {
            [] if !self.begins_to_grip(group) => {
                let nothing = Taken { unexplained: lost, bounces: None };
                nearer(nothing, if self.stops_softly(group) { several() } else { nothing })
            }
            [contact] if was_free && !self.grips(contact) && !self.joins_others(contact, group) => {
                let alone = self.one_impact(contact, &before, lost);
                let speed = self.closing_speed(contact);
                // A slip on the cloth that ends with it presses, too.
                let ends_a_slip = self.creeps(contact.balls().0) && speed < STOPPED_SPEED;
                // Such an impact may lose nothing along the normal.
                let may_be_micro = speed < fastest_micro_collision(self.table);
                nearer(alone, if ends_a_slip || may_be_micro { several() } else { alone })
            }
            _ => several(),
        }
    }

    /// Whether something in a closed contact closes so softly that it is stopped untold: an impulse does that, and rubs.
    fn stops_softly(&self, group: [bool; BALLS]) -> bool {
        let inside = || self.closed.iter().filter(|contact| contact.is_among(group));
        inside().any(|contact| self.closing_speed(*contact) > 0.0)
            && inside().all(|contact| self.closing_speed(*contact) < STOPPED_SPEED)
    }

    /// Whether a ball slips so little on the cloth that it may be stopped at once.
    fn creeps(&self, ball: usize) -> bool {
        let BallState { velocity, spin, .. } = self.before[ball];
        slip(self.table.radius, velocity, spin).length() < STOPPED_SPEED
    }

    /// Speed at which a contact closes before the moment, m/s.
    fn closing_speed(&self, contact: Contact) -> f64 {
        -contact.relative(&plain(&self.before)).dot(contact.normal(&plain(&self.after)))
    }

    /// The directions of a contact, where the balls are after the moment.
    fn directions(&self, contact: Contact) -> [Column; 3] {
        directions(self.numbers, contact, &plain(&self.after))
    }

    /// Whether balls that never slip where they touch begin to rest against each other: what is left of their slip ends at
    /// once, as in an impact.
    fn begins_to_grip(&self, group: [bool; BALLS]) -> bool {
        self.closed.iter().any(|contact| {
            let gripped = || contact.is_among(self.rested) && !self.slipped(*contact);
            self.grips(*contact) && contact.is_among(group) && !gripped()
        })
    }

    /// Whether there was a slip in a contact before the moment.
    fn slipped(&self, contact: Contact) -> bool {
        let before = motion(self.table.radius, &self.before);
        let [_, along, up] = self.directions(contact).map(|direction| dot(&direction, &before));
        along.hypot(up) > RESTING_SPEED
    }

    /// Whether two balls rest against each other that never slip where they touch: what an impact has left of their slip
    /// ends at once, too.
    fn grips(&self, contact: Contact) -> bool {
        contact.is_among(self.rests) && contact.friction(self.numbers).is_none()
    }

    /// Whether other contacts take part in an impact: those of a third ball that changes with it, and those in which balls begin to
    /// rest.
    fn joins_others(&self, impact: Contact, group: [bool; BALLS]) -> bool {
        let rests = |contact: &Contact| contact.is_among(group) && contact.is_among(self.rests);
        (0..BALLS).any(|ball| group[ball] && !impact.has(ball))
            || self.closed.iter().any(|contact| contact.balls() != impact.balls() && rests(contact))
    }

    /// One impact of free balls takes what the formulas say: with the contact's restitution or, where the balls stay in
    /// contact, with none. Where there are no formulas, nothing is asked.
    fn one_impact(&self, contact: Contact, before: &Column, lost: f64) -> Taken {
        let e = contact.restitution(self.numbers);
        let left = |numbers: &Numbers<f64>| Some(lost - impact_loss(numbers, contact, &plain(&self.before))?);
        let Some(unexplained) = left(self.numbers) else { return Taken::default() };
        let [opening, ..] = self.directions(contact);
        let speed = e * dot(&opening, before).abs();
        let may_stay = speed <= STOPPED_SPEED || contact.is_among(self.rests);
        let dead = left(&self.numbers.inelastic()).filter(|_| may_stay).unwrap_or(unexplained);
        if unexplained.abs() <= dead.abs() {
            return Taken { unexplained, bounces: None };
        }
        let bounces = Bounces::of(self.table, contact.balls().0, dot(&opening, before).abs(), e);
        let energy = bounces.energy / dot(&opening, &opening);
        Taken { unexplained: dead, bounces: Some(Bounces { energy, ..bounces }) }
    }

    /// Several impacts, or some on balls that rest against something: whatever changes must be the work of impulses in
    /// closed contacts, none of which pulls or rubs more than Coulomb allows. So no more is lost than the energy of the
    /// relative motion in these contacts; how much of it their order and restitutions decide.
    fn several(&self, group: [bool; BALLS], impacts: &[Contact], before: &Column, after: &Column) -> f64 {
        let mut contacts: Vec<Contact> = Vec::new();
        for contact in impacts.iter().chain(self.closed.iter().filter(|contact| contact.is_among(group))) {
            if !contacts.contains(contact) {
                contacts.push(*contact);
            }
        }
        let change = std::array::from_fn(|place| after[place] - before[place]);
        let mean = std::array::from_fn(|place| 0.5 * (after[place] + before[place]));
        let directions: Vec<_> = contacts.iter().flat_map(|contact| self.directions(*contact)).collect();
        let unexplained_by = |directions: &[Column]| {
            let found = fit(directions, &change);
            let mut unexplained = -dot(&mean, &found.residual);
            // Impulses are known no better than the change that tells them, over what that has of them alone.
            let rounding =
                f64::EPSILON * (ROUNDINGS + impacts.len() as f64) * dot(&mean, &mean).sqrt() / found.shortest;
            for (index, contact) in contacts.iter().enumerate() {
                let (Some(impulses), Some(mu)) = (&found.factors, contact.friction(self.numbers)) else { continue };
                let [push, along, up] = [0, 1, 2].map(|axis| impulses[3 * index + axis]);
                let excess = (along.hypot(up) - mu * push.max(0.0) - rounding).max(0.0);
                let [opening, slip, rise] = self.directions(*contact).map(|direction| dot(&direction, &mean));
                unexplained += excess * slip.hypot(rise) + (-push - rounding).max(0.0) * opening.abs();
            }
            unexplained
        };
        // What slips next to nothing on the cloth may stop there.
        let creeping = (0..BALLS).filter(|&ball| group[ball] && self.creeps(ball));
        let stops = creeping.flat_map(|ball| on_cloth(self.numbers, ball));
        let with_cloth: Vec<_> = directions.iter().copied().chain(stops).collect();
        let (alone, together) = (unexplained_by(&directions), unexplained_by(&with_cloth));
        if together.abs() < alone.abs() { together } else { alone }
    }
}
