//! Forces and accelerations of balls in resting contact.

use glam::{DVec2, DVec3};

use super::{
    ActiveSet, Contact, Contacts, Effort, Friction, MAX_CONTACTS, Scene,
    margin::{rates, with_margin},
    problem::{ForceKind, GYRATION, Limit, Problem, Row, Unknown, Values, ZERO_VALUES, coefficient},
    solve::{ATTEMPTS, Branch, Solution, solve},
};
use crate::table::{BALLS, Table};

/// A slip that begins with less than this share of g is treated as sticking: in a second it would reach 1e-9 m/s.
pub(super) const DEPARTING: f64 = 1e-10;

/// Speed that defines the direction of a beginning slip, m/s. On `match` it is ninety times the zero-slip tolerance, so that rounding does
/// not turn the direction. A slip that accelerates by a third of its friction's acceleration exceeds it after 2e-8 s and 1e-16 m on a cloth
/// of `mu_s = 0.2`, and after a few hundredths of a millisecond and 1e-13 m on one of 0.0001.
const STARTING: f64 = 1e-8;

/// A slip begins slowly if its acceleration is less than this share of its friction's. Its direction would then turn with the friction so
/// fast that integration steps would be tiny.
const SLOW_START: f64 = 0.3;

/// Accelerations of all balls, and forces of contacts and sticking frictions.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Acceleration, m/s².
    pub linear: [DVec2; BALLS],
    /// Angular acceleration, rad/s².
    pub angular: [DVec3; BALLS],
    /// Normal force per ball mass of each contact, m/s².
    pub normal: [f64; MAX_CONTACTS],
    /// Smallest margin by which the laws hold, m/s²; negative if the requested active set has ended.
    pub slack: f64,
    /// Whether the solver satisfied all laws to rounding, if it was used.
    pub converged: bool,
    /// Whether the forces are one of many equivalent solutions, because the balls are over-constrained.
    pub(super) redundant: bool,
    /// Friction per ball mass in each contact, along `t = z×n` and along z, m/s².
    pub(super) friction: [DVec2; MAX_CONTACTS],
    /// Forces per ball mass with which the cloth holds a ball: against slip, against rolling and against spin, m/s².
    pub(super) cloth: [DVec2; BALLS],
    pub(super) roll: [DVec2; BALLS],
    pub(super) spin: [f64; BALLS],
}

/// The active set that is valid in a state.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// Contacts that push.
    pub contacts: Contacts,
    /// Modes of their frictions.
    pub set: ActiveSet,
    /// Accelerations and forces.
    pub forces: Forces,
    /// Whether a friction at its limit still sticks, because several share the load. [`Forces::slack`] then does not predict how long the
    /// set lasts.
    pub shared: bool,
    /// The set in which yielding frictions stick again, or slip on against their friction; `None` if no yielding friction can.
    pub sticking: Option<ActiveSet>,
    /// Contacts that never slip and cannot rest: the force that prevents their slip separates the balls, which then come back.
    pub paradoxes: Vec<Contact>,
}

impl Scene<'_> {
    /// Returns the problem and its solution. The friction of balls that never slip has no limit, unless no forces obey all laws then.
    pub(super) fn solved(self, similar: Option<&Forces>, attempts: u32, effort: &Effort) -> (Problem, Solution) {
        let Self { table, contacts, .. } = self;
        let mut problem = Problem::new(self);
        let guess = similar.map_or(ZERO_VALUES, |similar| similar.values(&problem));
        let mut solution = solve(&problem, &guess, attempts, effort);
        let reaches_its_limit = |(unknown, branch): (&Unknown, &Branch)| match unknown.kind {
            ForceKind::Contact(index) => matches!(branch, Branch::Limited(_)) && contacts[index].never_slips(table),
            _ => false,
        };
        if problem.unknowns.iter().zip(&solution.branches).any(reaches_its_limit) {
            problem.grip(contacts);
            let gripped = solve(&problem, &solution.values, 1, effort);
            if gripped.converged {
                solution = gripped;
            }
        }
        (problem, solution)
    }

    /// Evaluates a solution of the problem. `None` if no normal force exceeds `least_push`, m/s², and no contact is a paradox.
    pub(super) fn read_off(
        self,
        least_push: f64,
        problem: &Problem,
        solution: &Solution,
        effort: &Effort,
    ) -> Option<Resolved> {
        let Self { table, contacts, set, .. } = self;
        let spared = with_margin(problem, solution, DEPARTING * table.gravity, effort);
        let solution = spared.as_ref().unwrap_or(solution);
        let accelerations = problem.accelerations(&solution.values);
        let mut resolved = Resolved {
            contacts: Contacts::new(),
            set: *set,
            forces: Forces::of(table.radius, problem, solution, &accelerations),
            shared: false,
            sticking: None,
            paradoxes: Vec::new(),
        };
        let never_slips = |index: usize| contacts[index].never_slips(table);
        for (index, (unknown, branch)) in problem.unknowns.iter().zip(&solution.branches).enumerate() {
            if *branch == Branch::Holds {
                // Balls that never slip stop at once, others slip on against their friction.
                let stops = matches!(unknown.kind, ForceKind::Contact(index) if never_slips(index));
                let ends = if stops { Friction::Sticks } else { Friction::Slips(DVec2::ZERO) };
                resolved.sticking =
                    sticking_at(&resolved.sticking.unwrap_or(*set), unknown.kind, ends).or(resolved.sticking);
            }
            let Branch::Limited(force) = *branch else { continue };
            let rate = DVec2::from_array(rates(problem, solution, index)).length();
            let holds = rate <= DEPARTING * table.gravity;
            resolved.shared |= holds;
            let size =
                solution.values[unknown.first..][..unknown.count].iter().fold(0.0_f64, |size, x| libm::hypot(size, *x));
            let starts = match unknown.count {
                1 => Friction::Slips(-force),
                _ if rate < SLOW_START * size => Friction::Yields,
                _ => Friction::Slips(-STARTING * force),
            };
            match unknown.kind {
                _ if holds => {}
                ForceKind::Contact(index) if never_slips(index) => resolved.paradoxes.push(contacts[index]),
                kind => {
                    if let Some(friction) = resolved.set.friction_mut(kind) {
                        *friction = starts;
                    }
                }
            }
        }
        let pushes = |index: &usize| {
            resolved.forces.normal[*index] > least_push && !resolved.paradoxes.contains(&contacts[*index])
        };
        let mut kept = [Friction::Sticks; MAX_CONTACTS];
        for index in (0..contacts.len()).filter(pushes) {
            kept[resolved.contacts.len()] = resolved.set.contact[index];
            resolved.contacts.push(contacts[index]);
        }
        if resolved.contacts.is_empty() && resolved.paradoxes.is_empty() {
            return None;
        }
        resolved.set.contact = kept;
        let values = &solution.values;
        let slack = problem.unknowns.iter().fold(f64::INFINITY, |slack, unknown| slack.min(slack_of(unknown, values)));
        resolved.forces.slack = Scene { set: &resolved.set, ..self }.spin_slack().min(slack);
        Some(resolved)
    }

    /// Returns the forces from the complementarity solver, starting at `similar`. It determines in every state which laws hold, for sets in
    /// which a friction yields or whose linear system has no solution. `is_short` limits the search, for steps that fail. Nor is a long
    /// search worthwhile after a state without a solution: there are mostly no forces.
    pub fn search_forces(self, similar: &Forces, is_short: bool, effort: &Effort) -> Forces {
        let (table, mut set) = (self.table, *self.set);
        let attempts = if similar.converged && !is_short { ATTEMPTS } else { 1 };
        let (problem, solution) = self.solved(Some(similar), attempts, effort);
        let accelerations = problem.accelerations(&solution.values);
        let mut forces = Forces::of(table.radius, &problem, &solution, &accelerations);
        forces.slack = self.spin_slack();
        for (unknown, branch) in problem.unknowns.iter().zip(&solution.branches) {
            let yields = set.friction_mut(unknown.kind).is_some_and(|friction| *friction == Friction::Yields);
            // The active set ends when any law changes its branch. The margin is the growth rate, or the distance of the force from its
            // limit.
            let rows = &problem.rates[unknown.first..][..unknown.count];
            let slack = match branch {
                Branch::Holds if yields => -slack_of(unknown, &solution.values),
                Branch::Holds => slack_of(unknown, &solution.values),
                Branch::Limited(_) if yields => f64::INFINITY,
                _ => -rows.iter().fold(0.0_f64, |rate, row| libm::hypot(rate, row.dot(&accelerations))),
            };
            forces.slack = forces.slack.min(slack);
        }
        forces.slack = forces.slack.min(table.gravity);
        forces
    }

    /// Returns the margin of the signs of the spins: a spin that has changed its sign has already ended.
    fn spin_slack(self) -> f64 {
        self.set.spin.iter().zip(self.balls).fold(f64::INFINITY, |slack, (spin, ball)| match spin {
            Friction::Slips(sign) if sign.x != 0.0 => slack.min(self.table.radius * ball.spin.z * sign.x),
            _ => slack,
        })
    }
}

/// Returns the set in which the yielding friction of an unknown has the mode `does`; `None` if it does not yield.
fn sticking_at(set: &ActiveSet, kind: ForceKind, does: Friction) -> Option<ActiveSet> {
    let mut set = *set;
    let friction = set.friction_mut(kind)?;
    if *friction != Friction::Yields {
        return None;
    }
    *friction = does;
    Some(set)
}

/// Returns the margin by which the law of a force holds, if the force was computed for an assumed active set.
fn slack_of(unknown: &Unknown, values: &[f64]) -> f64 {
    let own = &values[unknown.first..][..unknown.count];
    let size = own.iter().fold(0.0_f64, |length, x| libm::hypot(length, *x));
    match (unknown.kind, unknown.limit) {
        (ForceKind::Normal(_), _) => own[0],
        (_, Limit::Fixed(limit)) => limit - size,
        (_, Limit::Coulomb(mu, contact)) => mu * values[contact] - size,
    }
}

impl Forces {
    pub(super) const NONE: Self = Self {
        linear: [DVec2::ZERO; BALLS],
        angular: [DVec3::ZERO; BALLS],
        normal: [0.0; MAX_CONTACTS],
        slack: f64::INFINITY,
        converged: true,
        redundant: false,
        friction: [DVec2::ZERO; MAX_CONTACTS],
        cloth: [DVec2::ZERO; BALLS],
        roll: [DVec2::ZERO; BALLS],
        spin: [0.0; BALLS],
    };

    fn of(radius: f64, problem: &Problem, solution: &Solution, accelerations: &Row) -> Self {
        let Solution { values, converged, .. } = solution;
        let mut forces = Self { converged: *converged, ..Self::NONE };
        for ball in 0..BALLS {
            let (linear, angular) = accelerations.of_ball(ball);
            forces.linear[ball] = linear;
            forces.angular[ball] = angular / (GYRATION * radius);
        }
        for unknown in &problem.unknowns {
            let one = values[unknown.first];
            let both = || DVec2::new(one, values[unknown.first + 1]);
            match unknown.kind {
                ForceKind::Normal(index) => forces.normal[index] = one,
                ForceKind::Contact(index) => forces.friction[index] = both(),
                ForceKind::Cloth(ball) => forces.cloth[ball] = both(),
                ForceKind::Roll(ball) => forces.roll[ball] = both(),
                ForceKind::Spin(ball) => forces.spin[ball] = one,
            }
        }
        forces
    }

    /// Returns the problem's unknowns that correspond to these forces.
    fn values(&self, problem: &Problem) -> Values {
        let mut values = ZERO_VALUES;
        for unknown in &problem.unknowns {
            let own = match unknown.kind {
                ForceKind::Normal(index) => [self.normal[index], 0.0],
                ForceKind::Spin(ball) => [self.spin[ball], 0.0],
                ForceKind::Contact(index) => self.friction[index].to_array(),
                ForceKind::Cloth(ball) => self.cloth[ball].to_array(),
                ForceKind::Roll(ball) => self.roll[ball].to_array(),
            };
            values[unknown.first..][..unknown.count].copy_from_slice(&own[..unknown.count]);
        }
        values
    }

    /// Returns the same forces for other contacts; new contacts have zero force.
    #[must_use]
    pub fn of_contacts(&self, own: &[Contact], contacts: &[Contact]) -> Self {
        let mut forces = Self { normal: [0.0; MAX_CONTACTS], friction: [DVec2::ZERO; MAX_CONTACTS], ..*self };
        for (index, contact) in contacts.iter().enumerate() {
            if let Some(before) = own.iter().position(|before| before == contact) {
                (forces.normal[index], forces.friction[index]) = (self.normal[before], self.friction[before]);
            }
        }
        forces
    }

    /// Returns the limit of the friction in a contact per ball mass, m/s².
    pub fn friction_limit(&self, table: &Table, contacts: &[Contact], index: usize) -> f64 {
        coefficient(table, &contacts[index]) * self.normal[index]
    }

    /// Returns the largest difference of accelerations, m/s²; `radius` in metres converts angular into linear ones.
    pub fn distance(&self, other: &Self, radius: f64) -> f64 {
        (0..BALLS).fold(0.0, |largest, ball| {
            let linear = self.linear[ball].distance(other.linear[ball]);
            let angular = radius * self.angular[ball].distance(other.angular[ball]);
            linear.max(angular).max(largest)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::{BallState, slip},
        table::Rail,
    };

    /// The first of these balls is at the right cushion of `thesis`, with this velocity and spin.
    struct AtCushion {
        table: Table,
        balls: [BallState; BALLS],
        contacts: [Contact; 1],
        set: ActiveSet,
    }

    impl AtCushion {
        fn new(velocity: DVec2, spin: DVec3) -> Self {
            let table = Table::preset("thesis").unwrap();
            let mut balls = [table.half_length(), 0.5, -0.5].map(|x| BallState::at_rest(DVec2::new(x, 0.0)));
            (balls[0].velocity, balls[0].spin) = (velocity, spin);
            let contacts = [Contact::with_cushion(0, Rail::Right)];
            let set = ActiveSet::of(&table, &balls, &contacts, 1e-10);
            Self { table, balls, contacts, set }
        }

        fn scene(&self) -> Scene<'_> {
            Scene { table: &self.table, balls: &self.balls, contacts: &self.contacts, set: &self.set }
        }
    }

    /// A ball with topspin towards the cushion and some speed along it.
    fn pressed() -> (AtCushion, Resolved) {
        let ball = AtCushion::new(DVec2::new(0.0, 0.7), DVec3::new(3.0, 80.0, -5.0));
        let resolved = ball.scene().resolve(1e-11, None, &Effort::default()).unwrap();
        (ball, resolved)
    }

    #[test]
    fn cushion_force_balances_the_cloth_force() {
        let (AtCushion { table, balls: [ball, ..], .. }, Resolved { forces, .. }) = pressed();
        let u = slip(table.radius, ball.velocity, ball.spin).normalize();
        let pressed = table.sliding_friction * table.gravity * -u.x;
        assert!((forces.normal[0] - pressed).abs() < 1e-13);
        assert!(forces.linear[0].x.abs() < 1e-13);
        // The ball slips along +y on the cushion: the friction opposes the slip and has at most Coulomb's magnitude.
        let friction = forces.linear[0].y + table.sliding_friction * table.gravity * u.y;
        assert!(friction.abs() <= table.rail_friction * pressed + 1e-13 && friction < 0.0);
    }

    #[test]
    fn the_linear_system_agrees_with_the_solver() {
        let (ball, resolved) = pressed();
        let held = Scene { set: &resolved.set, ..ball.scene() }.forces(None).unwrap();
        assert!(resolved.forces.converged && held.distance(&resolved.forces, ball.table.radius) < 1e-12);
    }

    /// The unsuccessful search is counted as effort, too.
    #[test]
    fn a_cushion_never_pulls() {
        let (ball, effort) = (AtCushion::new(DVec2::ZERO, DVec3::new(0.0, -80.0, 0.0)), Effort::default());
        assert!(ball.scene().resolve(1e-11, None, &effort).is_none() && effort.spent() > 0);
    }

    /// The constraint that keeps a rolling ball on the contact also prevents its vertical slip there: the matrix is singular.
    #[test]
    fn forces_that_are_not_unique_are_found() {
        let radius = Table::preset("thesis").unwrap().radius;
        let ball = AtCushion::new(DVec2::new(0.0, 0.5), DVec3::new(-0.5, 0.0, -0.5) / radius);
        assert_eq!((ball.set.cloth[0], ball.set.contact[0]), (Friction::Sticks, Friction::Sticks));
        let held = ball.scene().forces(None).unwrap();
        let rates = std::array::from_fn(|index| BallState {
            velocity: held.linear[index],
            spin: held.angular[index],
            ..ball.balls[index]
        });
        let slips = ball.contacts[0].slip(radius, &rates);
        assert!(held.linear[0].x.abs() < 1e-13 && slips.length() < 1e-13 && held.linear[0].y < 0.0, "{held:?}");
    }
}
