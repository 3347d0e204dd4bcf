//! The equations of balls in resting contact at one time: the known forces, the unknown forces, and the law of each unknown.

use super::{
    Motion, Numbers, Real, Vector,
    complementarity::{Block, Law, Problem},
    contact::{Balls, Contact},
    laws::Laws,
    linear::solve,
    rows::{Movement, Row, movement},
    tolerance::slack,
};
use crate::table::BALLS;

/// A force of unknown size: its effect, and the rate of change that its law constrains.
#[derive(Clone, Copy, Debug)]
struct Unknown<R> {
    rate: Row<R>,
    force: Row<R>,
    /// Rate of change without any force, m/s².
    bias: R,
}

/// The equations of balls in contact at one time.
#[derive(Clone, Debug)]
pub struct System<R> {
    unknowns: Vec<Unknown<R>>,
    /// The laws of the unknowns.
    pub blocks: Vec<Block<R>>,
    known: Movement<R>,
    /// Power per mass of the known frictions, and of the contacts' frictions per unit of normal force.
    power: (R, Vec<(usize, R)>),
}

impl<R: Real> System<R> {
    /// Sets up the equations of `balls` under `laws`.
    pub fn new(numbers: &Numbers<R>, balls: &Balls<R>, laws: &Laws<R>) -> Self {
        let zero = R::zero();
        let known = [(Vector::zero(), Vector::zero()); BALLS];
        let mut system = Self { unknowns: Vec::new(), blocks: Vec::new(), known, power: (zero, Vec::new()) };
        for &(contact, slips) in &laws.contacts {
            system.add_contact(numbers, balls, contact, slips);
        }
        for (ball, motion) in laws.cloth.iter().enumerate() {
            if let Some(motion) = motion {
                system.add_cloth(numbers, balls, ball, *motion, laws.spin_signs[ball]);
            }
        }
        system
    }

    fn unknown(&mut self, law: Law<R>, rows: &[(Row<R>, R)]) {
        self.blocks.push(Block { at: self.unknowns.len(), axes: rows.len(), law });
        self.unknowns.extend(rows.iter().map(|&(row, bias)| Unknown { rate: row, force: row, bias }));
    }

    /// Adds a friction of known size against a speed.
    fn add_friction(&mut self, numbers: &Numbers<R>, row: &Row<R>, size: R, speed: R) {
        row.push(numbers, -size, &mut self.known);
        self.power.0 = self.power.0 + size * speed;
    }

    fn add_contact(&mut self, numbers: &Numbers<R>, balls: &Balls<R>, contact: Contact, slips: bool) {
        let n = contact.normal(balls);
        let t = Vector::up().cross(n);
        let push = self.unknowns.len();
        let friction = contact.friction(numbers);
        // The normal of two balls that pass each other rotates by this many radians a second.
        let turn = match contact {
            Contact::Balls(first, second) => {
                contact.relative_velocity(balls).dot(t) / (balls[first].position - balls[second].position).length()
            }
            Contact::Rail(..) => R::zero(),
        };
        self.unknown(Law::Push, &[(Row::opening(contact, n), turn * contact.relative_velocity(balls).dot(t))]);
        if let (true, Some(friction)) = (slips, friction) {
            let slip = contact.slip(numbers, balls);
            let along = Row::slip(numbers, contact, n, slip.direction());
            self.unknowns[push].force = self.unknowns[push].force.and(-friction, &along);
            self.power.1.push((push, friction * slip.length()));
        } else {
            // The rotation of the normal alone would change the slip `R n×w`.
            let lifting = -numbers.radius * turn * contact.spin(balls).dot(n);
            let along = Row::slip(numbers, contact, n, t);
            let upwards = Row::slip(numbers, contact, n, Vector::up());
            self.unknown(Law::Grip(friction, push), &[(along, R::zero()), (upwards, lifting)]);
        }
    }

    fn add_cloth(&mut self, numbers: &Numbers<R>, balls: &Balls<R>, ball: usize, motion: Motion, spin_sign: R) {
        let (zero, one) = (R::zero(), R::of(1.0));
        let axes = [Vector::new(one, zero, zero), Vector::new(zero, one, zero)];
        let state = &balls[ball];
        if motion == Motion::Sliding {
            let slip = state.slip(numbers);
            self.add_friction(numbers, &Row::cloth(numbers, ball, slip.direction()), numbers.slide, slip.length());
        } else {
            self.unknown(Law::Hold(numbers.slide), &axes.map(|axis| (Row::cloth(numbers, ball, axis), zero)));
        }
        if motion == Motion::Rolling {
            let velocity = state.velocity;
            let speed = velocity.length();
            let resistance = R::ratio(7.0, 5.0) * numbers.band(speed).deceleration;
            self.add_friction(numbers, &Row::centre(ball, velocity.direction()), resistance, speed);
        } else if motion == Motion::Stationary {
            self.unknown(Law::Hold(numbers.roll), &axes.map(|axis| (Row::centre(ball, axis), zero)));
        }
        let row = Row::turning(numbers, ball);
        let spinning = R::ratio(2.0, 5.0) * numbers.radius * numbers.spin_deceleration;
        if spin_sign == zero {
            self.unknown(Law::Hold(spinning), &[(row, zero)]);
        } else {
            self.add_friction(numbers, &row, spinning * spin_sign, numbers.radius * state.spin.z);
        }
    }

    /// Returns the number of unknowns.
    pub fn len(&self) -> usize {
        self.unknowns.len()
    }

    /// Returns the rates of change per unit of each force: a row for every rate.
    pub fn matrix(&self, numbers: &Numbers<R>) -> Vec<Vec<R>> {
        let row = |of: &Unknown<R>| self.unknowns.iter().map(|by| of.rate.response(numbers, &by.force)).collect();
        self.unknowns.iter().map(row).collect()
    }

    /// Returns the rates of change under forces of these sizes.
    pub fn rates(&self, numbers: &Numbers<R>, forces: &[R]) -> Vec<R> {
        let accelerations = self.accelerations(numbers, forces);
        self.unknowns.iter().map(|unknown| unknown.rate.speed(&accelerations) + unknown.bias).collect()
    }

    /// Returns the forces near `guess` under which no contact opens and nothing that sticks slips.
    pub fn balance(&self, numbers: &Numbers<R>, guess: &[R]) -> Vec<R> {
        let missing = self.rates(numbers, guess).into_iter().map(|rate| -rate).collect();
        let changes = solve(self.matrix(numbers), missing);
        guess.iter().zip(changes).map(|(guess, change)| *guess + change).collect()
    }

    /// Returns forces that obey all laws, `None` if none are found.
    pub fn solve_forces(&self, numbers: &Numbers<R>) -> Option<Vec<R>> {
        let rates = self.rates(numbers, &vec![R::zero(); self.len()]);
        Problem { matrix: &self.matrix(numbers), rates: &rates, blocks: &self.blocks }.solve()
    }

    /// Whether forces that obey all laws keep every contact closed and everything that sticks from slipping.
    pub fn holds(&self, numbers: &Numbers<R>) -> bool {
        self.solve_forces(numbers)
            .is_some_and(|forces| self.rates(numbers, &forces).into_iter().all(|rate| rate.abs() <= slack()))
    }

    /// Returns the accelerations under forces of these sizes.
    pub fn accelerations(&self, numbers: &Numbers<R>, forces: &[R]) -> Movement<R> {
        let mut accelerations = self.known;
        for (unknown, force) in self.unknowns.iter().zip(forces) {
            unknown.force.push(numbers, *force, &mut accelerations);
        }
        accelerations
    }

    /// Returns the margin until each law breaks: the normal force itself, or the difference between the friction limit and the
    /// friction, m/s².
    pub fn margins(&self, forces: &[R]) -> Vec<R> {
        let margin = |block: &Block<R>| {
            let own = &forces[block.at..block.at + block.axes];
            let size = own.iter().fold(R::zero(), |sum, force| sum + *force * *force).sqrt();
            match block.law {
                Law::Push => forces[block.at],
                Law::Hold(limit) => limit - size,
                Law::Grip(Some(friction), push) => friction * forces[push] - size,
                Law::Grip(None, _) => R::of(1.0),
            }
        };
        self.blocks.iter().map(margin).collect()
    }

    /// Returns the power per mass of all frictions, m²/s³.
    pub fn power(&self, forces: &[R]) -> R {
        self.power.1.iter().fold(self.power.0, |sum, (push, share)| sum + forces[*push] * *share)
    }

    /// Sets the speeds that the laws constrain to `wanted`, by impulses of the unknown forces. Returns the dissipated energy
    /// per mass.
    pub fn set_speeds(&self, numbers: &Numbers<R>, balls: &mut Balls<R>, wanted: &[R]) -> R {
        let before = movement(balls);
        let missing = self.unknowns.iter().zip(wanted).map(|(unknown, wanted)| *wanted - unknown.rate.speed(&before));
        let impulses = solve(self.matrix(numbers), missing.collect());
        let mut after = before;
        for (unknown, impulse) in self.unknowns.iter().zip(&impulses) {
            unknown.force.push(numbers, *impulse, &mut after);
        }
        for (ball, (velocity, spin)) in balls.iter_mut().zip(after) {
            (ball.velocity, ball.spin) = (velocity, spin);
        }
        let forces = self.unknowns.iter().zip(impulses);
        forces.fold(R::zero(), |work, (unknown, impulse)| {
            work - R::of(0.5) * impulse * (unknown.force.speed(&before) + unknown.force.speed(&after))
        })
    }
}
