//! Forces and accelerations of balls in resting contact.
//!
//! Where it is known which contacts push and which frictions hold — the regime — the forces follow from a linear system.
//! The regime is found by an active-set method: the law that is broken most is mended until none is. Should that go in
//! circles, projected sweeps find forces that obey all laws, if more slowly.

use glam::{DVec2, DVec3};

use super::{
    Laws, MAX_TOUCHES, Touch,
    linear::Factorized,
    problem::{Accelerations, Direction, Limit, MAX_GRIPS, Problem},
    regime::{NEGLIGIBLE, Regime, Solution, limit_of},
    sweeps::sweep,
};
use crate::{
    physics::BallState,
    table::{BALLS, Table},
};

/// Most changes of regime that are tried. A ball that comes to stick in several places at once needs about ten.
const MAX_CHANGES: usize = 40;

/// Added to the system's diagonal, whose entries are 1 to 10. A ball that sticks to several things at once is held more
/// often than needed, so that forces are not unique; this picks those nearest to what they were.
const PROXIMITY: f64 = 1e-7;

/// Rounds of refinement that take the effect of [`PROXIMITY`] out again.
const MAX_REFINEMENTS: usize = 8;

/// Most attempts to find other forces with the same effect where those found break their limits.
const MAX_PULLS: usize = 40;

/// Share of its limit to which a friction beyond it is pulled back, so that it will not be at the limit again at once.
const WELL_INSIDE: f64 = 0.9;

/// Forces per mass that come back to within this of what they were are the only ones, m/s².
const UNIQUE: f64 = 1e-9;

/// Residual accelerations above this show that what is to hold cannot, m/s². What sticks to several things at once does
/// so to within the rounding of its speeds only.
const INCONSISTENT: f64 = 1e-11;

/// Residual accelerations below this are rounding, m/s².
const RESIDUAL: f64 = 1e-14;

/// Accelerations of all balls, and how hard each contact pushes.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Acceleration, m/s².
    pub linear: [DVec2; BALLS],
    /// Angular acceleration, rad/s².
    pub angular: [DVec3; BALLS],
    /// Normal force per ball mass of each contact, m/s².
    pub normal: [f64; MAX_TOUCHES],
    /// By how much all laws hold, m/s²: negative where the regime that was asked for has ended.
    pub slack: f64,
    /// How fast something that is about to slip begins to, m/s²; zero where all that holds goes on holding.
    pub departure: f64,
    grip: [DVec2; MAX_GRIPS],
    regime: Regime,
}

/// Accelerations of balls in resting contact; those without a contact get none. `laws` say what slips. The search starts
/// from the forces of a `similar` state with the same contacts and laws, if there is one.
pub fn contact_forces(
    table: &Table,
    balls: &[BallState; BALLS],
    touches: &[Touch],
    laws: &Laws,
    similar: Option<&Forces>,
) -> Forces {
    let problem = Problem::new(table, balls, touches, laws);
    let mut regime =
        Regime { shared: Regime::HOLDING.shared, ..similar.map_or(Regime::HOLDING, |similar| similar.regime) };
    let mut guess = Solution::guess(&problem, similar);
    for _ in 0..MAX_CHANGES {
        let Some(solution) = solve(&problem, &regime, &guess, MAX_PULLS) else { break };
        guess = solution;
        if !regime.mend(&problem, &solution) {
            return Forces::of(&problem, regime, &solution);
        }
    }
    let (regime, solution) = sweep(&problem, &guess);
    Forces::of(&problem, regime, &solution)
}

/// The same where what pushes and holds is known to be what it was in a `similar` state: a smooth function of the state,
/// also a little beyond the regime's end, which [`Forces::slack`] tells.
pub fn forces_in_regime(
    table: &Table,
    balls: &[BallState; BALLS],
    touches: &[Touch],
    laws: &Laws,
    similar: &Forces,
) -> Forces {
    let problem = Problem::new(table, balls, touches, laws);
    let guess = Solution::guess(&problem, Some(similar));
    match solve(&problem, &similar.regime, &guess, 0) {
        Some(solution) => Forces::of(&problem, similar.regime, &solution),
        None => contact_forces(table, balls, touches, laws, Some(similar)),
    }
}

/// Takes out of velocities and spins what is left of speeds that are to be zero: the opening of `touches` and the slips that
/// do not last by `laws`, by impulses in those contacts, as the ends of slips do. Where they cannot all vanish, all stay.
pub fn stop_by_impulses(table: &Table, balls: &mut [BallState; BALLS], touches: &[Touch], laws: &Laws) {
    let problem = Problem::new(table, balls, touches, laws);
    let unknown =
        |direction: Direction, place| Unknown { force: direction, rate: direction, bias: 0.0, size: 0.0, place };
    let normals =
        problem.contacts.iter().enumerate().map(|(index, contact)| unknown(contact.normal, Place::Normal(index)));
    let grips = problem.grips.iter().enumerate().flat_map(|(index, grip)| {
        (0..grip.axes).map(move |axis| unknown(grip.directions[axis], Place::Grip(index, axis)))
    });
    let mut unknowns: Vec<Unknown> = normals.chain(grips).collect();
    let speeds = Accelerations { linear: balls.map(|ball| ball.velocity), angular: balls.map(|ball| ball.spin) };
    let stopped = System::new(&problem, speeds, &unknowns).and_then(|system| system.balance(&mut unknowns));
    if let Some(Accelerations { linear, angular }) = stopped {
        for (ball, (velocity, spin)) in balls.iter_mut().zip(linear.into_iter().zip(angular)) {
            (ball.velocity, ball.spin) = (velocity, spin);
        }
    }
}

impl Forces {
    fn of(problem: &Problem, mut regime: Regime, solution: &Solution) -> Self {
        let departure = regime.share(problem, solution);
        Self {
            linear: solution.accelerations.linear,
            angular: solution.accelerations.angular,
            normal: solution.normal,
            slack: regime.slack(problem, solution),
            departure,
            grip: solution.grip,
            regime,
        }
    }

    /// Whether several frictions hold together more than is needed, so that [`Forces::slack`] does not tell for how long.
    pub fn is_shared(&self) -> bool {
        self.regime.shared.contains(&true)
    }

    /// The largest difference of accelerations, m/s²; `radius` in metres turns angular into linear ones.
    pub fn distance(&self, other: &Self, radius: f64) -> f64 {
        (0..BALLS).fold(0.0, |largest, ball| {
            let linear = self.linear[ball].distance(other.linear[ball]);
            let angular = radius * self.angular[ball].distance(other.angular[ball]);
            linear.max(angular).max(largest)
        })
    }
}

impl Solution {
    fn guess(problem: &Problem, similar: Option<&Forces>) -> Self {
        Self {
            normal: similar.map_or([0.0; MAX_TOUCHES], |similar| similar.normal),
            grip: similar.map_or([DVec2::ZERO; MAX_GRIPS], |similar| similar.grip),
            accelerations: problem.known,
        }
    }
}

/// An unknown force: what it does, and the rate that it keeps at zero.
struct Unknown {
    force: Direction,
    rate: Direction,
    bias: f64,
    size: f64,
    place: Place,
}

#[derive(Clone, Copy)]
enum Place {
    Normal(usize),
    Grip(usize, usize),
}

/// The forces in a given regime, near to `guess` where they are not unique; `None` where nothing holds what is to hold.
/// Those that break their limits are exchanged for others with the same effect, if there are any, in as many `pulls`.
fn solve(problem: &Problem, regime: &Regime, guess: &Solution, pulls: usize) -> Option<Solution> {
    let mut base = problem.known;
    let mut unknowns: Vec<Unknown> = Vec::with_capacity(problem.contacts.len() + 2 * problem.grips.len());
    let mut rubs = [DVec2::ZERO; MAX_TOUCHES];
    for (rub, contact) in rubs.iter_mut().zip(&problem.contacts) {
        *rub = contact.rub;
    }
    for (index, grip) in problem.grips.iter().enumerate() {
        if !regime.grips(grip.limit) {
            continue;
        }
        match (regime.limited[index], grip.limit) {
            (Some(direction), Limit::Fixed(limit)) => {
                for (along, share) in grip.directions.iter().zip(direction.to_array()) {
                    along.push(limit * share, problem.twist, &mut base);
                }
            }
            (Some(direction), Limit::Coulomb(mu, contact)) => {
                rubs[contact] = direction * mu.unwrap_or(0.0);
            }
            (None, _) => {
                for axis in 0..grip.axes {
                    unknowns.push(Unknown {
                        force: grip.directions[axis],
                        rate: grip.directions[axis],
                        bias: grip.bias[axis],
                        size: guess.grip[index][axis],
                        place: Place::Grip(index, axis),
                    });
                }
            }
        }
    }
    for (index, contact) in problem.contacts.iter().enumerate() {
        if regime.pushing[index] {
            unknowns.push(Unknown {
                force: contact.normal.with_friction(&contact.tangents, rubs[index]),
                rate: contact.normal,
                bias: contact.centripetal,
                size: guess.normal[index],
                place: Place::Normal(index),
            });
        }
    }
    let system = System::new(problem, base, &unknowns)?;
    let accelerations = system.balance(&mut unknowns)?;
    let mut solution = read(problem, regime, &unknowns, accelerations);
    for _ in 0..pulls {
        let before: Vec<f64> = unknowns.iter().map(|unknown| unknown.size).collect();
        if !pull_inside(problem, &solution, &mut unknowns) {
            break;
        }
        let accelerations = system.balance(&mut unknowns)?;
        solution = read(problem, regime, &unknowns, accelerations);
        let moved = before.iter().zip(&unknowns).map(|(before, unknown)| (unknown.size - before).abs());
        if moved.fold(0.0, f64::max) < UNIQUE {
            break;
        }
    }
    Some(solution)
}

/// The solution that the unknowns' sizes describe.
fn read(problem: &Problem, regime: &Regime, unknowns: &[Unknown], accelerations: Accelerations) -> Solution {
    let mut solution = Solution { normal: [0.0; MAX_TOUCHES], grip: [DVec2::ZERO; MAX_GRIPS], accelerations };
    for unknown in unknowns {
        match unknown.place {
            Place::Normal(index) => solution.normal[index] = unknown.size,
            Place::Grip(index, axis) => solution.grip[index][axis] = unknown.size,
        }
    }
    for (index, grip) in problem.grips.iter().enumerate() {
        if let Some(direction) = regime.limited[index]
            && regime.grips(grip.limit)
        {
            solution.grip[index] = limit_of(grip.limit, &solution).unwrap_or(0.0) * direction;
        }
    }
    solution
}

/// Brings forces that break their limits well inside them; tells whether any did.
fn pull_inside(problem: &Problem, solution: &Solution, unknowns: &mut [Unknown]) -> bool {
    let mut pulled = false;
    for unknown in unknowns {
        match unknown.place {
            Place::Normal(index) => {
                if solution.normal[index] < -NEGLIGIBLE {
                    unknown.size = 0.0;
                    pulled = true;
                }
            }
            Place::Grip(index, _) => {
                let size = solution.grip[index].length();
                if let Some(limit) = limit_of(problem.grips[index].limit, solution)
                    && size > limit + NEGLIGIBLE
                {
                    unknown.size *= WELL_INSIDE * limit.max(0.0) / size;
                    pulled = true;
                }
            }
        }
    }
    pulled
}

/// The linear system of a regime.
struct System {
    base: Accelerations,
    twist: f64,
    factors: Factorized,
}

impl System {
    fn new(problem: &Problem, base: Accelerations, unknowns: &[Unknown]) -> Option<Self> {
        let count = unknowns.len();
        let mut matrix = Vec::with_capacity(count * count);
        for (row, of) in unknowns.iter().enumerate() {
            for (column, by) in unknowns.iter().enumerate() {
                let proximity = if row == column { PROXIMITY } else { 0.0 };
                matrix.push(of.rate.response(&by.force, problem.twist) + proximity);
            }
        }
        Some(Self { base, twist: problem.twist, factors: Factorized::new(count, matrix)? })
    }

    /// Changes the sizes of the unknown forces, as little as possible, until all their rates vanish; returns the
    /// accelerations.
    fn balance(&self, unknowns: &mut [Unknown]) -> Option<Accelerations> {
        let mut side = vec![0.0; unknowns.len()];
        let mut smallest = f64::INFINITY;
        for _ in 0..MAX_REFINEMENTS {
            let mut accelerations = self.base;
            for unknown in &*unknowns {
                unknown.force.push(unknown.size, self.twist, &mut accelerations);
            }
            let mut residual = 0.0_f64;
            for (side, unknown) in side.iter_mut().zip(&*unknowns) {
                *side = -(unknown.rate.rate(&accelerations) + unknown.bias);
                residual = residual.max(side.abs());
            }
            // Once rounding is reached, more rounds would only stir it.
            if residual <= RESIDUAL || (residual <= INCONSISTENT && residual >= 0.5 * smallest) {
                return Some(accelerations);
            }
            smallest = smallest.min(residual);
            self.factors.solve(&mut side);
            for (unknown, change) in unknowns.iter_mut().zip(&side) {
                unknown.size += change;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::{SLIP_TOLERANCE, slip};

    const ALONE: [BallState; 2] = [BallState::at_rest(DVec2::new(0.5, 0.0)), BallState::at_rest(DVec2::new(-0.5, 0.0))];

    fn forces(ball: BallState, touches: &[Touch]) -> Forces {
        let table = Table::preset("thesis").unwrap();
        let balls = [ball, ALONE[0], ALONE[1]];
        contact_forces(&table, &balls, touches, &Laws::of(table.radius, &balls, touches, SLIP_TOLERANCE), None)
    }

    #[test]
    fn a_cushion_pushes_back_just_what_the_cloth_presses() {
        let table = Table::preset("thesis").unwrap();
        let position = DVec2::new(table.half_length(), 0.0);
        // Topspin towards the right cushion, and some speed along it.
        let ball = BallState { position, velocity: DVec2::new(0.0, 0.7), spin: DVec3::new(3.0, 80.0, -5.0) };
        let touch = Touch { first: 0, second: None, rail_normal: DVec2::NEG_X };
        let forces = forces(ball, &[touch]);
        let u = slip(table.radius, ball.velocity, ball.spin).normalize();
        let pressed = table.sliding_friction * table.gravity * -u.x;
        assert!((forces.normal[0] - pressed).abs() < 1e-14);
        assert!(forces.linear[0].x.abs() < 1e-14);
        // The ball slips along +y on the cushion: the friction opposes it and has at most Coulomb's size.
        let friction = forces.linear[0].y + table.sliding_friction * table.gravity * u.y;
        assert!(friction.abs() <= table.rail_friction * pressed + 1e-14 && friction < 0.0);
    }

    #[test]
    fn a_cushion_never_pulls() {
        let table = Table::preset("thesis").unwrap();
        let position = DVec2::new(table.half_length(), 0.0);
        let ball = BallState { position, velocity: DVec2::ZERO, spin: DVec3::new(0.0, -80.0, 0.0) };
        let touch = Touch { first: 0, second: None, rail_normal: DVec2::NEG_X };
        let forces = forces(ball, &[touch]);
        assert_eq!(forces.normal[0], 0.0);
        assert!(forces.linear[0].x < 0.0);
    }

    #[test]
    fn a_rolling_ball_against_a_cushion_decelerates_as_it_does_alone() {
        let table = Table::preset("thesis").unwrap();
        let velocity = DVec2::new(0.0, 0.4);
        // It rolls on the cushion too: nothing presses it.
        let spin = crate::physics::rolling_spin(table.radius, velocity).extend(velocity.y / table.radius);
        let position = DVec2::new(table.half_length(), 0.0);
        let touch = Touch { first: 0, second: None, rail_normal: DVec2::NEG_X };
        let forces = forces(BallState { position, velocity, spin }, &[touch]);
        assert!(forces.linear[0].x.abs() < 1e-13 && forces.linear[0].y < 0.0, "{forces:?}");
    }
}
