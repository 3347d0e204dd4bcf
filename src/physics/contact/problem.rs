//! The equations of balls in contact: which accelerations follow from which forces, and which law each force obeys.
//!
//! Velocities and spins of all balls are one vector in which the kinetic energy is half the square of the length: `v` and
//! `√(2/5) R w` of each ball. A force along some direction then accelerates along the same row of numbers that tells the
//! rate at which the slip along that direction changes.

use glam::{DVec2, DVec3};

use super::{ActiveSet, Contact, Friction, MAX_CONTACTS, Scene};
use crate::{
    physics::{BallState, Rolling, slip},
    table::{BALLS, Table},
};

/// Most scalar unknowns: a normal and two frictions a contact, five frictions of the cloth a ball.
pub const MOST_UNKNOWNS: usize = 3 * MAX_CONTACTS + 5 * BALLS;

/// Sizes of all unknowns; those that a problem does not have are zero.
pub type Sizes = [f64; MOST_UNKNOWNS];

/// None at all.
pub const NO_SIZES: Sizes = [0.0; MOST_UNKNOWNS];

/// Numbers that tell a ball's velocity and spin.
pub const PER_BALL: usize = 5;

/// `√(2/5)`: radius of gyration over the ball's radius.
pub const GYRATION: f64 = 0.632_455_532_033_675_9;

/// Velocities, accelerations or directions of all balls: `v` in m/s and `√(2/5) R w` in m/s, and so on.
#[derive(Clone, Copy, Debug)]
pub struct Row(pub [f64; PER_BALL * BALLS]);

impl Row {
    pub const ZERO: Self = Self([0.0; PER_BALL * BALLS]);

    pub fn dot(&self, other: &Self) -> f64 {
        self.0.iter().zip(&other.0).map(|(a, b)| a * b).sum()
    }

    pub fn add(&mut self, size: f64, row: &Self) {
        for (sum, part) in self.0.iter_mut().zip(&row.0) {
            *sum += size * part;
        }
    }

    /// Adds a velocity and a spin times the radius to one ball.
    fn with(mut self, ball: usize, linear: DVec2, angular: DVec3) -> Self {
        let part = &mut self.0[PER_BALL * ball..][..PER_BALL];
        part[0] += linear.x;
        part[1] += linear.y;
        part[2] += angular.x / GYRATION;
        part[3] += angular.y / GYRATION;
        part[4] += angular.z / GYRATION;
        self
    }

    /// A ball's part: velocity, and spin times `√(2/5) R`.
    pub fn of_ball(&self, ball: usize) -> (DVec2, DVec3) {
        let part = &self.0[PER_BALL * ball..][..PER_BALL];
        (DVec2::new(part[0], part[1]), DVec3::new(part[2], part[3], part[4]))
    }

    /// Slip on the cloth along x or y, `u = v + R z×w` (thesis equation 1).
    fn cloth(ball: usize, axis: DVec2) -> Self {
        Self::ZERO.with(ball, axis, -axis.perp().extend(0.0))
    }

    /// The three rows of a contact: opening, slip along `t = z×n`, slip along z.
    pub fn contact(contact: &Contact, n: DVec2) -> [Self; 3] {
        let t = n.perp();
        let mut rows = [
            Self::ZERO.with(contact.first, n, DVec3::ZERO),
            Self::ZERO.with(contact.first, t, DVec3::NEG_Z),
            Self::ZERO.with(contact.first, DVec2::ZERO, t.extend(0.0)),
        ];
        if let Some(second) = contact.second {
            rows[0] = rows[0].with(second, -n, DVec3::ZERO);
            rows[1] = rows[1].with(second, -t, DVec3::NEG_Z);
            rows[2] = rows[2].with(second, DVec2::ZERO, t.extend(0.0));
        }
        rows
    }
}

/// Friction with which forces are sought for balls that have no coefficient, since their impacts never slip (17): large, and
/// with forces in every state. Where they reach it, [`Problem::grip`] takes the limit away.
const NO_SLIP: f64 = 1e3;

/// What rolling resists, per mass, m/s²: the force on the centre of a ball that rolls, which slows it down by five sevenths of itself.
///
/// It is that of a ball which begins to roll freely here: where the two differ, balls whose contact opens by the one close again by the
/// other, at once and without end.
pub fn rolling_resistance(table: &Table, ball: &BallState) -> f64 {
    let rolling = Rolling::of(table);
    table.rolling_friction * table.gravity + 1.4 * (rolling.deceleration(ball.velocity.length()) - rolling.least)
}

/// Coulomb's coefficient in a contact.
pub fn coefficient(table: &Table, contact: &Contact) -> f64 {
    if contact.second.is_some() { table.ball_friction.unwrap_or(NO_SLIP) } else { table.rail_friction }
}

/// How large a friction can be.
#[derive(Clone, Copy, Debug)]
pub enum Limit {
    /// Per mass, m/s².
    Fixed(f64),
    /// Coulomb's coefficient, and the contact whose normal force counts.
    Coulomb(f64, usize),
}

/// What an unknown force stands for.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// The normal force of a contact.
    Normal(usize),
    /// A friction that holds: the cloth's against slip, against rolling, against spin, or a contact's.
    Cloth(usize),
    Roll(usize),
    Spin(usize),
    Contact(usize),
}

/// An unknown force, or two of a friction in a plane: rows `first..first + count` of the problem.
#[derive(Clone, Copy, Debug)]
pub struct Unknown {
    pub place: Place,
    pub first: usize,
    pub count: usize,
    /// The friction's limit; a normal force has none.
    pub limit: Limit,
}

/// Everything that acts on the balls in one state.
#[derive(Clone, Debug)]
pub struct Problem {
    pub unknowns: Vec<Unknown>,
    /// For every scalar unknown the row of the rate that it keeps at zero.
    pub rates: Vec<Row>,
    /// What that rate has besides the accelerations' part, m/s²: two balls' courses around each other bend.
    pub bias: Vec<f64>,
    /// The row of what the force does, which is the rate's own but for a normal force with Coulomb's friction.
    pub forces: Vec<Row>,
    /// Accelerations by the forces that are known.
    pub known: Row,
}

impl Problem {
    pub fn new(scene: Scene<'_>) -> Self {
        let Scene { table, balls, contacts, set } = scene;
        let room = 3 * contacts.len() + 5 * BALLS;
        let mut problem = Self {
            unknowns: Vec::with_capacity(room),
            rates: Vec::with_capacity(room),
            bias: Vec::with_capacity(room),
            forces: Vec::with_capacity(room),
            known: Row::ZERO,
        };
        let mut frictions = Vec::with_capacity(contacts.len());
        for (index, contact) in contacts.iter().enumerate() {
            let (n, slip) = contact.normal_and_slip(table.radius, balls);
            let [opening, along, up] = Row::contact(contact, n);
            let [centripetal, _, turning] = contact.bends(table.radius, balls, n);
            let mu = coefficient(table, contact);
            problem.push(Place::Normal(index), Limit::Fixed(f64::INFINITY), &[opening], [centripetal, 0.0]);
            if let Some(against) = set.contact[index].direction(slip) {
                let force = &mut problem.forces[index];
                force.add(-mu * against.x, &along);
                force.add(-mu * against.y, &up);
            } else {
                frictions.push((index, mu, [along, up], turning));
            }
        }
        for (index, mu, rows, turning) in frictions {
            problem.push(Place::Contact(index), Limit::Coulomb(mu, index), &rows, [0.0, turning]);
        }
        for (ball, state) in balls.iter().enumerate() {
            if scene.holds(ball) {
                problem.lay_on_cloth(table, ball, state, set);
            }
        }
        problem
    }

    /// The cloth's forces on a ball: known where it slips, rolls or spins, unknown where they hold.
    fn lay_on_cloth(&mut self, table: &Table, ball: usize, state: &BallState, set: &ActiveSet) {
        let gravity = table.gravity;
        let sliding = table.sliding_friction * gravity;
        let resistance = rolling_resistance(table, state);
        let slips = [DVec2::X, DVec2::Y].map(|axis| Row::cloth(ball, axis));
        self.known = self.known.with(ball, table.tilt, DVec3::ZERO);
        if let Some(against) = set.cloth[ball].direction(slip(table.radius, state.velocity, state.spin)) {
            self.known.add(-sliding * against.x, &slips[0]);
            self.known.add(-sliding * against.y, &slips[1]);
        } else {
            self.push(Place::Cloth(ball), Limit::Fixed(sliding), &slips, [0.0; 2]);
            if set.cloth[ball] == Friction::Yields {
                // It slides, if ever so slowly: nothing resists its rolling.
            } else if let Some(against) = set.roll[ball].direction(state.velocity) {
                self.known = self.known.with(ball, -resistance * against, DVec3::ZERO);
            } else {
                let still = [DVec2::X, DVec2::Y].map(|axis| Row::ZERO.with(ball, axis, DVec3::ZERO));
                self.push(Place::Roll(ball), Limit::Fixed(resistance), &still, [0.0; 2]);
            }
        }
        let about_vertical = Row::ZERO.with(ball, DVec2::ZERO, DVec3::Z);
        let spinning = table.spinning_friction * gravity;
        match set.spin[ball] {
            Friction::Slips(sign) => self.known.add(-spinning * sign.x, &about_vertical),
            Friction::Sticks | Friction::Yields | Friction::Eases => {
                self.push(Place::Spin(ball), Limit::Fixed(spinning), &[about_vertical], [0.0; 2]);
            }
        }
    }

    fn push(&mut self, place: Place, limit: Limit, rows: &[Row], bias: [f64; 2]) {
        self.unknowns.push(Unknown { place, first: self.rates.len(), count: rows.len(), limit });
        self.rates.extend_from_slice(rows);
        self.forces.extend_from_slice(rows);
        self.bias.extend_from_slice(&bias[..rows.len()]);
    }

    /// Takes a share of its resistance to rolling from a ball in this state.
    pub fn ease(&mut self, table: &Table, ball: usize, state: &BallState, share: f64) {
        let resistance = rolling_resistance(table, state) * state.velocity.normalize_or_zero();
        self.known = self.known.with(ball, share * resistance, DVec3::ZERO);
    }

    /// Takes away the limit of frictions between balls.
    pub fn grip(&mut self, contacts: &[Contact]) {
        for unknown in &mut self.unknowns {
            if let Limit::Coulomb(mu, contact) = &mut unknown.limit
                && contacts[*contact].second.is_some()
            {
                *mu = f64::INFINITY;
            }
        }
    }

    /// Accelerations under forces of these sizes, m/s².
    pub fn accelerations(&self, sizes: &[f64]) -> Row {
        let mut sum = self.known;
        for (size, row) in sizes.iter().zip(&self.forces) {
            sum.add(*size, row);
        }
        sum
    }
}
