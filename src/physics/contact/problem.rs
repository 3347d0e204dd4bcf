//! Equations of balls in contact: accelerations as functions of the forces, and the law of each force.
//!
//! The generalized velocity of all balls is scaled so that the kinetic energy per ball mass is half its squared norm: `v` and `√(2/5) R w`
//! of each ball. The mass matrix is then the identity, and the acceleration by a force along some direction is the same row that gives the
//! rate of change of the slip along that direction.

use glam::{DVec2, DVec3};

use super::{ActiveSet, Contact, Friction, MAX_CONTACTS, Partner, Scene, involve};
use crate::{
    physics::{BallState, Rolling, slip},
    table::{BALLS, Table},
};

/// Largest number of scalar unknowns: one normal and two friction forces per contact, five friction forces of the cloth per ball.
pub const MAX_UNKNOWNS: usize = 3 * MAX_CONTACTS + 5 * BALLS;

/// Values of all unknowns; zero beyond those that a problem has.
pub type Values = [f64; MAX_UNKNOWNS];

/// All unknowns zero.
pub const ZERO_VALUES: Values = [0.0; MAX_UNKNOWNS];

/// Generalized velocity components per ball.
pub const PER_BALL: usize = 5;

/// `√(2/5)`: radius of gyration divided by the ball's radius.
pub const GYRATION: f64 = 0.632_455_532_033_675_9;

/// Generalized velocities, accelerations or directions of all balls: `v` in m/s and `√(2/5) R w` in m/s, and so on.
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

    /// Adds a velocity, and a spin times the radius, to one ball.
    fn with(mut self, ball: usize, linear: DVec2, angular: DVec3) -> Self {
        let part = &mut self.0[PER_BALL * ball..][..PER_BALL];
        part[0] += linear.x;
        part[1] += linear.y;
        part[2] += angular.x / GYRATION;
        part[3] += angular.y / GYRATION;
        part[4] += angular.z / GYRATION;
        self
    }

    /// Returns a ball's components: velocity, and spin times `√(2/5) R`.
    pub fn of_ball(&self, ball: usize) -> (DVec2, DVec3) {
        let part = &self.0[PER_BALL * ball..][..PER_BALL];
        (DVec2::new(part[0], part[1]), DVec3::new(part[2], part[3], part[4]))
    }

    /// Returns the row of the slip on the cloth along x or y, `u = v + R z×w` (thesis equation 1).
    fn cloth(ball: usize, axis: DVec2) -> Self {
        Self::ZERO.with(ball, axis, -axis.perp().extend(0.0))
    }

    /// Returns the three rows of a contact: opening, slip along `t = z×n`, slip along z.
    pub fn contact(contact: &Contact, n: DVec2) -> [Self; 3] {
        let t = n.perp();
        let mut rows = [
            Self::ZERO.with(contact.first, n, DVec3::ZERO),
            Self::ZERO.with(contact.first, t, DVec3::NEG_Z),
            Self::ZERO.with(contact.first, DVec2::ZERO, t.extend(0.0)),
        ];
        if let Some(second) = contact.second() {
            rows[0] = rows[0].with(second, -n, DVec3::ZERO);
            rows[1] = rows[1].with(second, -t, DVec3::NEG_Z);
            rows[2] = rows[2].with(second, DVec2::ZERO, t.extend(0.0));
        }
        rows
    }
}

/// Coefficient of friction for the solver if balls have none, because their impacts never slip (17): large, but finite, so that forces
/// exist in every state. If a force reaches this limit, [`Problem::grip`] removes it.
const NO_SLIP: f64 = 1e3;

/// Returns the rolling resistance per mass, m/s²: the force on the centre of a rolling ball, which decelerates it by five sevenths of its
/// value.
///
/// It equals that of a ball that starts to roll freely in this state. If the two differed, balls whose contact opens under one would close
/// again under the other, immediately and without end.
pub fn rolling_resistance(table: &Table, ball: &BallState) -> f64 {
    let rolling = Rolling::of(table);
    table.rolling_friction * table.gravity + 1.4 * (rolling.deceleration(ball.velocity.length()) - rolling.least)
}

/// Returns the Coulomb coefficient of a contact.
pub fn coefficient(table: &Table, contact: &Contact) -> f64 {
    match contact.partner {
        Partner::Ball(_) => table.ball_friction.unwrap_or(NO_SLIP),
        Partner::Cushion(rail) => table.friction_of(rail),
    }
}

/// Upper bound of a friction force.
#[derive(Clone, Copy, Debug)]
pub enum Limit {
    /// Constant bound per mass, m/s².
    Fixed(f64),
    /// Coulomb coefficient, and the contact whose normal force it multiplies.
    Coulomb(f64, usize),
}

/// Kind of an unknown force.
#[derive(Clone, Copy, Debug)]
pub enum ForceKind {
    /// The normal force of a contact.
    Normal(usize),
    /// A sticking friction: of the cloth against slip, rolling or spin, or of a contact.
    Cloth(usize),
    Roll(usize),
    Spin(usize),
    Contact(usize),
}

/// An unknown force, or the two components of a friction: rows `first..first + count` of the problem.
#[derive(Clone, Copy, Debug)]
pub struct Unknown {
    pub kind: ForceKind,
    pub first: usize,
    pub count: usize,
    /// Bound of the friction; infinite for a normal force.
    pub limit: Limit,
}

/// All forces on the balls in one state.
#[derive(Clone, Debug)]
pub struct Problem {
    pub unknowns: Vec<Unknown>,
    /// For each scalar unknown, the row of the rate that it keeps at zero.
    pub rates: Vec<Row>,
    /// Part of that rate that does not depend on the accelerations, m/s²: the contact frame of two balls rotates.
    pub bias: Vec<f64>,
    /// Generalized direction of each force: equal to the row in `rates`, except for a normal force with its Coulomb friction.
    pub forces: Vec<Row>,
    /// Accelerations by the known forces.
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
            let [centripetal, _, turning] = contact.rotation_bias(table.radius, balls, n);
            let mu = coefficient(table, contact);
            problem.push(ForceKind::Normal(index), Limit::Fixed(f64::INFINITY), &[opening], [centripetal, 0.0]);
            if let Some(against) = set.contact[index].direction(slip) {
                let force = &mut problem.forces[index];
                force.add(-mu * against.x, &along);
                force.add(-mu * against.y, &up);
            } else {
                frictions.push((index, mu, [along, up], turning));
            }
        }
        for (index, mu, rows, turning) in frictions {
            problem.push(ForceKind::Contact(index), Limit::Coulomb(mu, index), &rows, [0.0, turning]);
        }
        for (ball, state) in balls.iter().enumerate() {
            if involve(contacts, ball) {
                problem.lay_on_cloth(table, ball, state, set);
            }
        }
        problem
    }

    /// Adds the cloth's forces on a ball: known if it slips, rolls or spins, unknown if they hold it.
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
            self.push(ForceKind::Cloth(ball), Limit::Fixed(sliding), &slips, [0.0; 2]);
            if set.cloth[ball] == Friction::Yields {
                // The ball slides, however slowly: it has no rolling resistance.
            } else if let Some(against) = set.roll[ball].direction(state.velocity) {
                self.known = self.known.with(ball, -resistance * against, DVec3::ZERO);
            } else {
                let still = [DVec2::X, DVec2::Y].map(|axis| Row::ZERO.with(ball, axis, DVec3::ZERO));
                self.push(ForceKind::Roll(ball), Limit::Fixed(resistance), &still, [0.0; 2]);
            }
        }
        let about_vertical = Row::ZERO.with(ball, DVec2::ZERO, DVec3::Z);
        let spinning = table.spinning_friction * gravity;
        match set.spin[ball] {
            Friction::Slips(sign) => self.known.add(-spinning * sign.x, &about_vertical),
            Friction::Sticks | Friction::Yields | Friction::Filippov => {
                self.push(ForceKind::Spin(ball), Limit::Fixed(spinning), &[about_vertical], [0.0; 2]);
            }
        }
    }

    fn push(&mut self, kind: ForceKind, limit: Limit, rows: &[Row], bias: [f64; 2]) {
        self.unknowns.push(Unknown { kind, first: self.rates.len(), count: rows.len(), limit });
        self.rates.extend_from_slice(rows);
        self.forces.extend_from_slice(rows);
        self.bias.extend_from_slice(&bias[..rows.len()]);
    }

    /// Removes a share of the rolling resistance from a ball in this state.
    pub fn reduce_resistance(&mut self, table: &Table, ball: usize, state: &BallState, share: f64) {
        let resistance = rolling_resistance(table, state) * state.velocity.normalize_or_zero();
        self.known = self.known.with(ball, share * resistance, DVec3::ZERO);
    }

    /// Removes the limit of the frictions between balls.
    pub fn grip(&mut self, contacts: &[Contact]) {
        for unknown in &mut self.unknowns {
            if let Limit::Coulomb(mu, contact) = &mut unknown.limit
                && contacts[*contact].second().is_some()
            {
                *mu = f64::INFINITY;
            }
        }
    }

    /// Returns the accelerations under forces of these values, m/s².
    pub fn accelerations(&self, values: &[f64]) -> Row {
        let mut sum = self.known;
        for (size, row) in values.iter().zip(&self.forces) {
            sum.add(*size, row);
        }
        sum
    }
}
