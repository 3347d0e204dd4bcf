//! Forces of a known active set: every rate that a contact or friction holds is zero, which gives a small linear system for the contact
//! forces. The holding forces of the cloth are eliminated beforehand: a rolling or standing ball responds to a force with less motion than
//! a sliding one.

/// Evaluates an expression with `ROOM` as the smallest compiled size (1, 2, 3 or the maximum) that fits the contacts.
macro_rules! in_room {
    ($contacts:expr, $room:ident => $value:expr) => {
        match $contacts.len() {
            0 | 1 => in_room!(@ $room, 1, $value),
            2 => in_room!(@ $room, 2, $value),
            3 => in_room!(@ $room, 3, $value),
            _ => in_room!(@ $room, MAX_CONTACTS, $value),
        }
    };
    (@ $room:ident, $size:expr, $value:expr) => {{
        const $room: usize = $size;
        $value
    }};
}

mod filippov;
mod joint;
mod sticking;
mod stopping;

use glam::{DVec2, DVec3};

use self::joint::{Joint, Movement, Response, Triple};
use self::sticking::{ClothMode, Sticking};
pub use self::stopping::stop_by_impulses;
use super::{
    ActiveSet, Contact, Forces, Friction, MAX_CONTACTS, Scene, involve,
    linear::{PROXIMITY, eliminate, factorize, substitute},
    problem::{coefficient, rolling_resistance},
};
use crate::{
    physics::slip,
    table::{BALLS, Table},
};

/// A system whose smallest pivot is below this is treated as singular; the entries of a force system are 1 to 10.
const SINGULAR: f64 = 1e-6;

/// Largest number of iterative refinements, which remove the effect of [`PROXIMITY`].
const MAX_REFINEMENTS: usize = 8;

/// If a refinement leaves this share of the residual or more, the residual is not an effect of [`PROXIMITY`]: the constraints are
/// inconsistent.
const INCONSISTENT: f64 = 0.95;

/// Residuals below this share of the largest number are rounding errors.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// Linear system of one active set in one state, with a compile-time capacity for contacts. It is solved about thirty times per integration
/// step, mostly for one or two contacts, and arrays of full capacity would be filled and moved each time.
struct ConstraintSystem<const ROOM: usize> {
    joints: [Joint; ROOM],
    contacts: usize,
    sticking: [Sticking; BALLS],
    members: [bool; BALLS],
    /// The unknowns of each contact.
    values: [Triple; ROOM],
    /// Whether the unknowns are known to be non-unique: the balls are over-constrained.
    redundant: bool,
    /// Opening rate of a contact, m/s², if the curvature of the trajectories separates over-constrained contacts; otherwise zero.
    inconsistent: f64,
}

/// Motion of the balls under each unknown of each contact alone.
type Responses<const ROOM: usize> = [[Response; 3]; ROOM];

/// Capacity for a square matrix with a row for each unknown: its entries are stored first.
type Matrix<const ROOM: usize> = [[[[f64; 3]; 3]; ROOM]; ROOM];

/// Returns the whole storage of a matrix.
fn entries<const ROOM: usize>(matrix: &mut Matrix<ROOM>) -> &mut [f64] {
    matrix.as_flattened_mut().as_flattened_mut().as_flattened_mut()
}

impl<const ROOM: usize> ConstraintSystem<ROOM> {
    /// Creates the system of the contacts; `has_friction` decides whether the normal force of a slipping contact includes its friction.
    #[inline(always)]
    fn new(scene: Scene<'_>, has_friction: impl Fn(&Contact) -> bool) -> Self {
        let Scene { table, balls, contacts, set } = scene;
        let joint = |index: usize| {
            let contact = &contacts[index];
            let mu = if has_friction(contact) { coefficient(table, contact) } else { 0.0 };
            Joint::new(table.radius, balls, contact, set.contact[index], mu)
        };
        let joints = std::array::from_fn(|index| if index < contacts.len() { joint(index) } else { Joint::default() });
        Self {
            joints,
            contacts: contacts.len().min(ROOM),
            sticking: std::array::from_fn(|ball| Sticking::of(set, ball)),
            members: std::array::from_fn(|ball| involve(contacts, ball)),
            values: [[0.0; 3]; ROOM],
            redundant: false,
            inconsistent: 0.0,
        }
    }

    /// As [`Self::new`], starting at the `similar` forces, so that non-unique forces come out near them.
    #[inline(always)]
    fn near(scene: Scene<'_>, similar: Option<&Forces>) -> Self {
        let mut system = Self::new(scene, |_| true);
        if let Some(similar) = similar {
            system.redundant = similar.redundant;
            for (index, joint) in system.joints[..system.contacts].iter().enumerate() {
                let friction = if joint.unknowns == 3 { similar.friction[index] } else { DVec2::ZERO };
                system.values[index] = [similar.normal[index], friction.x, friction.y];
            }
        }
        system
    }

    fn joints(&self) -> &[Joint] {
        &self.joints[..self.contacts]
    }

    /// Numbers the unknowns. `SHAPE` gives the compiler the number of unknowns of each contact, two bits each; zero if it is unknown.
    #[inline(always)]
    fn number<const SHAPE: usize>(&mut self) {
        let mut at = 0;
        for (index, joint) in self.joints.iter_mut().enumerate() {
            if SHAPE != 0 {
                joint.unknowns = SHAPE >> (2 * index) & 3;
            }
            joint.at = at;
            at += joint.unknowns;
        }
    }

    /// Returns the number of unknowns.
    #[inline(always)]
    fn unknowns(&self) -> usize {
        self.joints.iter().map(|joint| joint.unknowns).sum()
    }

    /// Returns the motion of the balls under each unknown alone, after the cloth's holding forces, contact by contact.
    #[inline(always)]
    fn responses(&self) -> Responses<ROOM> {
        let mut responses = [[Response::default(); 3]; ROOM];
        for (joint, responses) in self.joints.iter().zip(&mut responses) {
            for (unknown, response) in responses[..joint.unknowns].iter_mut().enumerate() {
                let (push, twist) = joint.act(joint.unit(unknown));
                for (place, (ball, sense)) in joint.members().enumerate() {
                    (response.linear[place], response.angular[place]) =
                        self.sticking[ball].remaining_motion(sense * push, twist);
                }
            }
        }
        responses
    }

    /// Returns the rates of all unknowns under all unknowns, row by row, as a square matrix at the start of the storage.
    #[inline(always)]
    fn matrix(&self, responses: &Responses<ROOM>) -> Matrix<ROOM> {
        let mut matrix = [[[[0.0; 3]; 3]; ROOM]; ROOM];
        let (entries, count) = (entries(&mut matrix), self.unknowns());
        for (acting, responses) in self.joints.iter().zip(responses) {
            for unknown in 0..acting.unknowns {
                for joint in &self.joints {
                    let rates = joint.rates_by(acting, &responses[unknown]);
                    for row in 0..joint.unknowns {
                        entries[(joint.at + row) * count + acting.at + unknown] = rates[row];
                    }
                }
            }
        }
        matrix
    }

    /// Computes the unknowns for which all rates vanish, if the balls would move like `free` without the contacts. `with_bias` selects
    /// whether the curvature of the trajectories counts. Returns the remaining motion, even if curvature separates over-constrained
    /// contacts. `None` if the rates cannot vanish together for any other reason.
    #[inline(always)]
    fn solve(&mut self, free: &Movement, with_bias: bool) -> Option<Movement> {
        let shape = self.joints().iter().rev().fold(0, |shape, joint| 4 * shape + joint.unknowns);
        // Compile-time counts make the most frequent systems cheaper: combinations of slipping and sticking contacts.
        match (ROOM, shape) {
            (1, 0b01) => self.solve_in_shape::<0b01>(free, with_bias),
            (1, 0b11) => self.solve_in_shape::<0b11>(free, with_bias),
            (2, 0b11_01) => self.solve_in_shape::<0b11_01>(free, with_bias),
            (2, 0b11_10) => self.solve_in_shape::<0b11_10>(free, with_bias),
            (2, 0b11_11) => self.solve_in_shape::<0b11_11>(free, with_bias),
            _ => self.solve_in_shape::<0>(free, with_bias),
        }
    }

    /// As [`Self::solve`], with the number of unknowns per contact known at compile time: see [`ConstraintSystem::number`].
    #[inline(always)]
    fn solve_in_shape<const SHAPE: usize>(&mut self, free: &Movement, with_bias: bool) -> Option<Movement> {
        self.number::<SHAPE>();
        let responses = self.responses();
        if !self.redundant {
            let mut moved = self.without_unknowns(free);
            let (mut matrix, mut side) = (self.matrix(&responses), self.right_side(&moved, with_bias));
            if eliminate(entries(&mut matrix), &mut side.as_flattened_mut()[..self.unknowns()]) {
                self.clear();
                self.add(side.as_flattened(), &responses, &mut moved);
                return Some(moved);
            }
        }
        self.refine(&responses, free, with_bias)
    }

    /// Returns the motion of the balls before the unknowns act: under `free` accelerations and a prescribed upward friction.
    #[inline(always)]
    fn without_unknowns(&self, free: &Movement) -> Movement {
        let mut moved = *free;
        for (joint, values) in self.joints.iter().zip(&self.values).filter(|(joint, _)| joint.unknowns == 2) {
            moved.angular[joint.first] += joint.act([0.0, 0.0, values[2]]).1;
        }
        self.with_cloth(&moved)
    }

    /// Sets the unknowns to zero.
    #[inline(always)]
    fn clear(&mut self) {
        for (joint, values) in self.joints.iter().zip(&mut self.values) {
            values[..joint.unknowns].fill(0.0);
        }
    }

    /// Returns the right-hand side of the system: minus the rates that the unknowns must cancel. `with_bias` selects whether the
    /// curvature of the trajectories counts.
    #[inline(always)]
    fn right_side(&self, moved: &Movement, with_bias: bool) -> [[f64; 3]; ROOM] {
        let mut side = [[0.0; 3]; ROOM];
        for joint in &self.joints {
            let rates = joint.rates(moved);
            let places = &mut side.as_flattened_mut()[joint.at..][..joint.unknowns];
            for ((place, rate), bias) in places.iter_mut().zip(rates).zip(joint.bias) {
                *place = -(rate + if with_bias { bias } else { 0.0 });
            }
        }
        side
    }

    /// Adds changes to the unknowns, and their effect to a motion.
    #[inline(always)]
    fn add(&mut self, changes: &[f64], responses: &Responses<ROOM>, moved: &mut Movement) {
        for ((joint, values), responses) in self.joints.iter().zip(&mut self.values).zip(responses) {
            for unknown in 0..joint.unknowns {
                let change = changes[joint.at + unknown];
                values[unknown] += change;
                joint.add(moved, change, &responses[unknown]);
            }
        }
    }

    /// As [`Self::solve`] by iterative refinement, for small pivots or non-unique unknowns.
    #[inline(never)]
    fn refine(&mut self, responses: &Responses<ROOM>, free: &Movement, with_bias: bool) -> Option<Movement> {
        let count = self.unknowns();
        let mut matrix = self.matrix(responses);
        let mut pivots = [[0; 3]; ROOM];
        let pivots = &mut pivots.as_flattened_mut()[..count];
        let factors = &mut entries(&mut matrix)[..count * count];
        let unique = !self.redundant && factorize(factors, pivots) > SINGULAR;
        let mut moved = if unique {
            self.clear();
            self.without_unknowns(free)
        } else {
            self.redundant = true;
            matrix = self.matrix(responses);
            let factors = &mut entries(&mut matrix)[..count * count];
            for index in 0..count {
                factors[index * (count + 1)] += PROXIMITY;
            }
            factorize(factors, pivots);
            self.with_cloth(&self.without_cloth(free))
        };
        let factors = &entries(&mut matrix)[..count * count];
        let scale = (0..BALLS).fold(f64::MIN_POSITIVE, |scale, ball| {
            scale.max(free.linear[ball].abs().max_element()).max(free.angular[ball].abs().max_element())
        });
        let mut smallest = f64::INFINITY;
        for round in 0..MAX_REFINEMENTS {
            let mut side = self.right_side(&moved, with_bias);
            let side = side.as_flattened_mut();
            let (mut residual, mut opens, mut scale) = (0.0_f64, 0.0_f64, scale);
            for (joint, values) in self.joints.iter().zip(&self.values) {
                for unknown in 0..joint.unknowns {
                    let rate = -side[joint.at + unknown];
                    residual = residual.max(rate.abs());
                    opens = if unknown == 0 { opens.max(rate) } else { opens };
                    let bias = if with_bias { joint.bias[unknown] } else { 0.0 };
                    scale = scale.max(values[unknown].abs()).max(bias.abs());
                }
            }
            // At rounding level, further rounds only change noise. A residual that is tiny compared with a spin may still carry a ball
            // away.
            let stays = round > 0 && (unique || residual >= 0.5 * smallest);
            if residual <= 16.0 * f64::EPSILON * scale || stays && residual <= ROUNDING * scale {
                return Some(moved);
            }
            if with_bias
                && round > 0
                && !unique
                && residual >= INCONSISTENT * smallest
                && opens >= INCONSISTENT * residual
            {
                self.inconsistent = opens;
                return Some(moved);
            }
            smallest = smallest.min(residual);
            substitute(factors, pivots, &mut side[..count]);
            self.add(side, responses, &mut moved);
        }
        None
    }

    /// Removes the upward friction from the unknowns at a cushion that holds one of these rolling balls, because the cloth constrains the
    /// same motion. Returns the index of that contact.
    fn fix_redundant_friction(&mut self, applies_to: impl Fn(usize) -> bool) -> Option<usize> {
        let holds = |joint: &Joint| {
            let rolls = self.sticking[joint.first].cloth == ClothMode::Rolls;
            rolls && joint.second.is_none() && joint.unknowns == 3 && applies_to(joint.first)
        };
        let index = self.joints().iter().position(holds)?;
        self.joints[index].unknowns = 2;
        Some(index)
    }

    /// Returns the force in a contact.
    fn force(&self, index: usize) -> Triple {
        let [normal, along, up] = self.values[index];
        let slip_friction = self.joints[index].slip_friction;
        [normal, along + slip_friction.x * normal, up + slip_friction.y * normal]
    }

    /// Returns the motion of the balls under the contact forces if the cloth did not hold them.
    fn without_cloth(&self, free: &Movement) -> Movement {
        let mut without_cloth = *free;
        for (index, joint) in self.joints().iter().enumerate() {
            let (push, twist) = joint.act(self.force(index));
            for (ball, sense) in joint.members() {
                without_cloth.linear[ball] += sense * push;
                without_cloth.angular[ball] += twist;
            }
        }
        without_cloth
    }

    /// Returns the motion of the contacts' balls after the cloth's holding forces.
    fn with_cloth(&self, movement: &Movement) -> Movement {
        let mut held = *movement;
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            (held.linear[ball], held.angular[ball]) =
                self.sticking[ball].remaining_motion(movement.linear[ball], movement.angular[ball]);
        }
        held
    }
}

impl Scene<'_> {
    /// Returns the forces of the active set: a smooth function of the state, also slightly beyond the set's end, which [`Forces::slack`]
    /// indicates. Non-unique forces are those nearest to `similar`.
    pub fn forces(self, similar: Option<&Forces>) -> Option<Forces> {
        in_room!(self.contacts, ROOM => Some(Solved::<ROOM>::new(self, similar)?.forces(self)))
    }

    /// Returns the accelerations of the active set, with forces near `similar`: linear in m/s², angular in rad/s².
    pub fn accelerations(self, similar: &Forces) -> Option<([DVec2; BALLS], [DVec3; BALLS])> {
        let moved = in_room!(self.contacts, ROOM => {
            let mut system = ConstraintSystem::<ROOM>::near(self, Some(similar));
            let free = self.free(system.members);
            if let Some(ball) = self.set.filippov_ball() {
                Solved::in_filippov_mode(self, system, &free, ball)?.moved
            } else {
                // The motion does not depend on how redundant holding forces are divided.
                system.redundant = system.redundant && system.fix_redundant_friction(|_| true).is_none();
                system.solve(&free, true)?
            }
        });
        Some((moved.linear, moved.angular.map(|angular| angular / self.table.radius)))
    }

    /// Returns the accelerations of the `members` without their contacts.
    #[inline(always)]
    fn free(self, members: [bool; BALLS]) -> Movement {
        let Self { table, balls, set, .. } = self;
        let [sliding, _, spinning] = frictions(table);
        let mut free = Movement::default();
        for ball in (0..BALLS).filter(|&ball| members[ball]) {
            let state = &balls[ball];
            let (linear, angular) = (&mut free.linear[ball], &mut free.angular[ball]);
            if let Some(against) = set.cloth[ball].direction(slip(table.radius, state.velocity, state.spin)) {
                *linear = -sliding * against;
                *angular = (2.5 * sliding * against.perp()).extend(0.0);
            } else if let Some(against) = set.roll[ball].direction(state.velocity) {
                *linear = -rolling_resistance(table, state) * against;
            }
            *linear += table.tilt;
            if let Friction::Slips(sign) = set.spin[ball] {
                angular.z = -2.5 * spinning * sign.x;
            }
        }
        free
    }
}

/// A system of forces and the resulting accelerations.
struct Solved<const ROOM: usize> {
    system: ConstraintSystem<ROOM>,
    /// Accelerations without the contacts.
    free: Movement,
    moved: Movement,
    /// Margin of the share of a rolling resistance in Filippov mode from its ends, m/s²; infinite if there is none.
    share_margin: f64,
}

impl<const ROOM: usize> Solved<ROOM> {
    fn new(scene: Scene<'_>, similar: Option<&Forces>) -> Option<Self> {
        let mut system = ConstraintSystem::near(scene, similar);
        let free = scene.free(system.members);
        if let Some(ball) = scene.set.filippov_ball() {
            return Self::in_filippov_mode(scene, system, &free, ball);
        }
        let moved = system.solve(&free, true)?;
        Some(Self { system, free, moved, share_margin: f64::INFINITY })
    }

    /// Returns all forces, and the margin by which their laws hold.
    fn forces(&self, scene: Scene<'_>) -> Forces {
        let Scene { table, balls, contacts, set } = scene;
        let Self { system, free, moved, share_margin } = self;
        let without_cloth = system.without_cloth(free);
        let [sliding, rolling, spinning] = frictions(table);
        let mut forces = Forces::NONE;
        forces.slack = if system.inconsistent > 0.0 { -system.inconsistent } else { *share_margin };
        forces.redundant = system.redundant;
        let mut limit = |limit: f64, force: f64| forces.slack = forces.slack.min(limit - force);
        for ball in (0..BALLS).filter(|&ball| system.members[ball]) {
            let sticking = system.sticking[ball];
            let (cloth, roll, spin) = sticking.holding_forces(without_cloth.linear[ball], without_cloth.angular[ball]);
            (forces.cloth[ball], forces.roll[ball], forces.spin[ball]) = (cloth, roll, spin);
            if sticking.cloth != ClothMode::Slides && set.roll[ball] != Friction::Filippov {
                limit(sliding, cloth.length());
            }
            if sticking.cloth == ClothMode::Stands {
                limit(rolling, roll.length());
            }
            if sticking.spin {
                limit(spinning, spin.abs());
            }
            // A spin that has changed its sign has already ended.
            if let Friction::Slips(sign) = set.spin[ball]
                && sign.x != 0.0
            {
                limit(table.radius * balls[ball].spin.z * sign.x, 0.0);
            }
            forces.linear[ball] = moved.linear[ball];
            forces.angular[ball] = moved.angular[ball] / table.radius;
        }
        for (index, contact) in contacts.iter().enumerate() {
            let [normal, along, up] = system.force(index);
            (forces.normal[index], forces.friction[index]) = (normal, DVec2::new(along, up));
            limit(normal, 0.0);
            if system.joints[index].unknowns == 3 && !contact.never_slips(table) {
                limit(coefficient(table, contact) * normal, libm::hypot(along, up));
            }
        }
        forces
    }
}

/// Returns the limits of the cloth's friction against sliding, rolling and spinning, per mass, m/s².
fn frictions(table: &Table) -> [f64; 3] {
    [table.sliding_friction, table.rolling_friction, table.spinning_friction].map(|mu| mu * table.gravity)
}

#[cfg(test)]
mod tests;
