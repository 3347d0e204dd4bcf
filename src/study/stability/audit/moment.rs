//! Changes at one time: impacts, ends of slips, and resting contacts that begin or end.

use super::{
    laws::impact_loss,
    least_squares::{Column, fit},
    motion::{directions, energy, motion, on_cloth, reference_balls},
    uncertainty::{RESTING_SPEED, STOPPED_SPEED},
};
use crate::{
    physics::{BallState, slip},
    statistics::dot,
    study::reference_engine::{Contact, Numbers, RailLaw},
    table::{BALLS, Table},
};

/// The balls just before and just after a change.
pub struct Moment<'a> {
    pub table: &'a Table,
    pub numbers: &'a Numbers<f64>,
    pub before: [BallState; BALLS],
    pub after: [BallState; BALLS],
    /// Whether each ball was in resting contact before, and whether it is after.
    pub rested: [bool; BALLS],
    pub rests: [bool; BALLS],
    /// The reported impacts, in order.
    pub impacts: Vec<Contact>,
    /// The closed contacts.
    pub closed: Vec<Contact>,
}

/// The part of an energy loss that no law explains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Energy lost beyond the laws, m²/s²; negative if too little is lost.
    pub unexplained: f64,
    /// The bounces that a resting contact replaces from now on.
    pub bounces: Option<Bounces>,
}

/// A chatter reported as one resting contact, whose remaining bounces dissipate their energy gradually.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounces {
    /// The ball that bounces.
    pub ball: usize,
    /// Energy of the first omitted bounce, m²/s².
    pub energy: f64,
    /// Minimum duration of the bounces, s.
    pub duration: f64,
}

impl Bounces {
    /// Returns the bounces of a `ball` after an impact at a `speed`, m/s, with restitution `e`; the energy is per mass of the
    /// bouncing body.
    pub fn of(table: &Table, ball: usize, speed: f64, e: f64) -> Self {
        // At most the friction of the cloth under all balls presses them together.
        let pull = BALLS as f64 * table.sliding_friction * table.gravity;
        let speed = e * speed.max(0.0);
        Self { ball, energy: 0.5 * speed * speed, duration: 2.0 * speed / (pull * (1.0 - e)) }
    }
}

/// Rounding of the states before and after a change, in roundings of the fastest velocity; each impact adds one. With a smaller
/// value, impulses that such velocities hardly determine seem to pull, or to rub more than Coulomb allows. With a larger value,
/// some impulses that do so are missed.
const ROUNDINGS: f64 = 4.0;

/// Bounces slower than this may be the last of a chatter, m/s: they dissipate and leave as little energy as a resting contact.
const LAST_BOUNCE: f64 = 1e-7;

/// Speed below which bounces lose nothing in a shot past the work limit after which no contact may rest, m/s.
pub fn fastest_micro_collision(table: &Table) -> f64 {
    1e-3 * (table.gravity * table.radius).sqrt()
}

impl Moment<'_> {
    /// Whether an impact of a group is so slow that it may end a chatter.
    pub fn ends_a_chatter(&self, group: [bool; BALLS]) -> bool {
        let mut inside = self.impacts.iter().filter(|contact| group[contact.balls().0]);
        inside.any(|contact| self.closing_speed(*contact).abs() < LAST_BOUNCE)
    }

    /// Whether a ball of a group hits a cushion whose law the reference engine does not implement.
    pub fn follows_an_unknown_law(&self, group: [bool; BALLS]) -> bool {
        self.impacts.iter().any(|contact| {
            matches!(*contact, Contact::Rail(ball, rail)
                if group[ball] && matches!(self.numbers.cushion(rail).law, RailLaw::Integrated))
        })
    }

    /// Whether a contact of a group is closed without an impact. The engine checks whether such a contact rests, and removes
    /// its closing speed.
    pub fn touches_without_impact(&self, group: [bool; BALLS]) -> bool {
        self.closed.iter().any(|contact| contact.is_among(group) && !self.impacts.contains(contact))
    }

    /// Returns the balls connected with `ball` by impacts or closed contacts, itself included.
    pub fn group(&self, ball: usize, changed: [bool; BALLS]) -> [bool; BALLS] {
        let mut group: [bool; BALLS] = std::array::from_fn(|other| other == ball);
        // Two passes connect all three balls.
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

    /// Returns the part of the loss of a group's balls that its impacts do not explain.
    pub fn residual(&self, group: [bool; BALLS]) -> Residual {
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
        let several = || Residual { unexplained: self.several(group, &impacts, &before, &after), bounces: None };
        let nearer =
            |one: Residual, other: Residual| if other.unexplained.abs() < one.unexplained.abs() { other } else { one };
        match impacts[..] {
            [] if !self.begins_to_grip(group) => {
                let nothing = Residual { unexplained: lost, bounces: None };
                nearer(nothing, if self.stops_softly(group) { several() } else { nothing })
            }
            [contact] if was_free && !self.grips(contact) && !self.joins_others(contact, group) => {
                let alone = self.one_impact(contact, &before, lost);
                let speed = self.closing_speed(contact);
                // A slip on the cloth that ends at this time presses as well.
                let ends_a_slip = self.creeps(contact.balls().0) && speed < STOPPED_SPEED;
                // Such an impact may lose nothing along the normal.
                let may_be_micro = speed < fastest_micro_collision(self.table);
                nearer(alone, if ends_a_slip || may_be_micro { several() } else { alone })
            }
            _ => several(),
        }
    }

    /// Whether a closed contact closes so slowly that the engine stops it without an event: the stopping impulse also rubs.
    fn stops_softly(&self, group: [bool; BALLS]) -> bool {
        let inside = || self.closed.iter().filter(|contact| contact.is_among(group));
        inside().any(|contact| self.closing_speed(*contact) > 0.0)
            && inside().all(|contact| self.closing_speed(*contact) < STOPPED_SPEED)
    }

    /// Whether the slip of a ball on the cloth is so small that it may be set to zero.
    fn creeps(&self, ball: usize) -> bool {
        let BallState { velocity, spin, .. } = self.before[ball];
        slip(self.table.radius, velocity, spin).length() < STOPPED_SPEED
    }

    /// Returns the closing speed of a contact before the change, m/s.
    fn closing_speed(&self, contact: Contact) -> f64 {
        -contact.relative_velocity(&reference_balls(&self.before)).dot(contact.normal(&reference_balls(&self.after)))
    }

    /// Returns the directions of a contact at the positions after the change.
    fn directions(&self, contact: Contact) -> [Column; 3] {
        directions(self.numbers, contact, &reference_balls(&self.after))
    }

    /// Whether balls that never slip at their contact begin to rest against each other: the rest of their slip ends
    /// immediately, as in an impact.
    fn begins_to_grip(&self, group: [bool; BALLS]) -> bool {
        self.closed.iter().any(|contact| {
            let gripped = || contact.is_among(self.rested) && !self.slipped(*contact);
            self.grips(*contact) && contact.is_among(group) && !gripped()
        })
    }

    /// Whether a contact slipped before the change.
    fn slipped(&self, contact: Contact) -> bool {
        let before = motion(self.table.radius, &self.before);
        let [_, along, up] = self.directions(contact).map(|direction| dot(&direction, &before));
        along.hypot(up) > RESTING_SPEED
    }

    /// Whether two balls that never slip at their contact rest against each other: the slip after an impact ends immediately as
    /// well.
    fn grips(&self, contact: Contact) -> bool {
        contact.is_among(self.rests) && contact.friction(self.numbers).is_none()
    }

    /// Whether other contacts are involved in an impact: contacts of a third ball that changes at the same time, and contacts
    /// in which balls begin to rest.
    fn joins_others(&self, impact: Contact, group: [bool; BALLS]) -> bool {
        let rests = |contact: &Contact| contact.is_among(group) && contact.is_among(self.rests);
        (0..BALLS).any(|ball| group[ball] && !impact.involves(ball))
            || self.closed.iter().any(|contact| contact.balls() != impact.balls() && rests(contact))
    }

    /// Audits one impact of free balls by the formulas: with the contact's restitution or, if the balls stay in contact,
    /// without. Impacts without formulas are not checked.
    fn one_impact(&self, contact: Contact, before: &Column, lost: f64) -> Residual {
        let e = contact.restitution(self.numbers);
        let left = |numbers: &Numbers<f64>| Some(lost - impact_loss(numbers, contact, &reference_balls(&self.before))?);
        let Some(unexplained) = left(self.numbers) else { return Residual::default() };
        let [opening, ..] = self.directions(contact);
        let speed = e * dot(&opening, before).abs();
        let may_stay = speed <= STOPPED_SPEED || contact.is_among(self.rests);
        let dead = left(&self.numbers.with_restitution(0.0)).filter(|_| may_stay).unwrap_or(unexplained);
        if unexplained.abs() <= dead.abs() {
            return Residual { unexplained, bounces: None };
        }
        let bounces = Bounces::of(self.table, contact.balls().0, dot(&opening, before).abs(), e);
        let energy = bounces.energy / dot(&opening, &opening);
        Residual { unexplained: dead, bounces: Some(Bounces { energy, ..bounces }) }
    }

    /// Audits several impacts, or impacts on balls that rest against something: every change must be the work of impulses in
    /// closed contacts, none of which pulls or rubs more than Coulomb allows. The loss is therefore at most the energy of the
    /// relative motion in these contacts; its amount depends on the order of the impacts and on the restitutions.
    fn several(&self, group: [bool; BALLS], impacts: &[Contact], before: &Column, after: &Column) -> f64 {
        let mut contacts: Vec<Contact> = Vec::new();
        for contact in impacts.iter().chain(self.closed.iter().filter(|contact| contact.is_among(group))) {
            if !contacts.contains(contact) {
                contacts.push(*contact);
            }
        }
        let change = std::array::from_fn(|place| after[place] - before[place]);
        let mean: Column = std::array::from_fn(|place| 0.5 * (after[place] + before[place]));
        let directions: Vec<_> = contacts.iter().flat_map(|contact| self.directions(*contact)).collect();
        let unexplained_by = |directions: &[Column]| {
            let found = fit(directions, &change);
            let mut unexplained = -dot(&mean, &found.residual);
            // The uncertainty of the impulses is that of the change, divided by the shortest independent part of the
            // directions.
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
        // A very small slip on the cloth may stop at this time.
        let creeping = (0..BALLS).filter(|&ball| group[ball] && self.creeps(ball));
        let stops = creeping.flat_map(|ball| on_cloth(self.numbers, ball));
        let with_cloth: Vec<_> = directions.iter().copied().chain(stops).collect();
        let (alone, together) = (unexplained_by(&directions), unexplained_by(&with_cloth));
        if together.abs() < alone.abs() { together } else { alone }
    }
}
