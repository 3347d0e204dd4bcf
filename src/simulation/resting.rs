//! Time integration of resting contacts: balls that are pressed against cushions or each other, with adaptive steps.
//!
//! The equations have no closed form, because the slip turns under the frictions of cloth and cushion together. They are integrated from
//! one change of the active set to the next, with an estimated error of at most [`super::Tolerance::step_error`] per step. When a slip
//! ends, its direction is singular in time. With time rescaled by the slip, `dt = |u|/|u₀| dτ`, the slip decays exponentially and the
//! solution stays smooth.

mod active_set;
mod bounds;
mod course;
mod stiffness;
mod within;

use glam::{DVec2, DVec3};

use self::active_set::{find_active_set, remove_rounding, without_ending_slips};
use super::{
    Constants, Rail,
    contacts::{close_gaps, touching},
    extrapolation::{Phase, State, Step, extrapolate},
    guards::{RESTING_BUDGET, STEP_BUDGET, STEP_COST, known_set_cost},
};
use crate::{
    physics::{ActiveSet, BallState, Contact, Contacts, Effort, Forces, Friction, Resolved, Scene, involve, slip},
    table::{BALLS, Table},
};

/// A slip may decay by this power of `e` in a step, to about a quarter.
const FALL: f64 = 1.3;

/// Largest accepted deviation of a pressed ball's trajectory from the quintic polynomial that represents it, m: a tenth of the accepted
/// overlap in a layout.
const MAX_DEVIATION: f64 = 1e-10;

/// Largest change of speed by the cloth's friction in a step, m/s; used if nothing else limits the step.
const LONGEST_CURVE: f64 = 0.08;

/// A step is implicit in a slip direction if it is longer than this many time constants with which the direction follows the forces.
/// Explicit steps are unstable there.
const STIFF: f64 = 4.0;

/// Largest initial turn rate of a slip times the length of an implicit step, rad.
const MAX_TURN: f64 = 0.03;

/// A law that breaks within this share of a step breaks immediately: the forces of jammed balls stay at the edge of the admissible set.
const AT_ONCE: f64 = 1e-3;

/// Number of consecutive such steps after which the forces are determined by the solver in every state.
const MAX_SHORT_STEPS: u32 = 16;

/// Ratio of the next trial step to one in which a state has no forces.
const WITHOUT_FORCES: f64 = 0.1;

/// Largest number of iterations for the time at which a law breaks; false position needs about ten.
const MAX_GUESSES: usize = 60;

/// Location of a slip: a ball on the cloth, its centre, or a contact, by index.
#[derive(Clone, Copy, Debug)]
enum SlipLocation {
    Cloth(usize),
    Roll(usize),
    Contact(usize),
}

/// One step of the balls in resting contact.
#[derive(Clone, Debug)]
pub struct Resting {
    /// The balls that take part.
    pub members: [bool; BALLS],
    /// Start time of the step, s.
    pub start: f64,
    /// Length of the step, s.
    pub step: f64,
    /// State at its start, in which slips that have ended are exactly zero.
    pub begin: State,
    /// State at its end.
    pub end: State,
    pub(super) contacts: Contacts,
    pub(super) set: ActiveSet,
    /// The slip that ends first, which defines the rescaled time, and its magnitude at the start, m/s; `None` if no slip ends soon and time
    /// is not rescaled.
    time_scale: Option<(SlipLocation, f64)>,
    first: Forces,
    pub(super) last: Forces,
    shared: bool,
    /// Number of consecutive steps that have ended immediately.
    short_steps: u32,
    /// Number of consecutive restarts.
    restarts: u32,
    /// Whether the active set at the end is still that of the start.
    keeps_set: bool,
    /// Work that the engine has not yet counted.
    pub(super) effort: Effort,
    /// Whether another event has ended the step.
    pub(super) interrupted: bool,
    /// Trial step, s; after the step, the next trial step.
    pub next_step: f64,
    constants: Constants,
}

/// Result of a step over a `span` of rescaled time, with the forces there for the active set of the step's start.
#[derive(Clone, Copy, Debug)]
struct Trial {
    span: f64,
    step: Step,
    forces: Forces,
}

impl Trial {
    /// Whether one of its states has no forces.
    fn has_no_forces(&self) -> bool {
        self.step.error == f64::INFINITY
    }
}

impl Resting {
    /// Takes one step of at most `next_step` seconds from `balls` at time `start`, if any contact presses. The `previous` step, if there is
    /// one, determines which frictions yield. Also returns the states of all balls without the slips that end here, and the work spent.
    pub fn begin(
        table: &Table,
        constants: &Constants,
        start: f64,
        balls: &State,
        on_cloth: [bool; BALLS],
        previous: Option<&Self>,
        next_step: f64,
    ) -> (Option<Box<Self>>, State, Effort) {
        let mut contacts =
            touching(constants, balls, on_cloth, |opening| opening.abs() <= 2.0 * constants.tolerance.opening);
        let (mut free, effort) = (*balls, Effort::default());
        effort.add(STEP_COST);
        let Some((begin, resolved)) = find_active_set(table, constants, &mut free, &mut contacts, previous, &effort)
        else {
            return (None, without_ending_slips(table, constants, &free, &contacts), effort);
        };
        let Resolved { contacts, set, forces, shared, .. } = resolved;
        let mut resting = Self {
            members: std::array::from_fn(|ball| involve(&contacts, ball)),
            start,
            step: 0.0,
            end: begin,
            begin,
            contacts,
            set,
            time_scale: None,
            first: forces,
            last: forces,
            shared,
            short_steps: previous.map_or(0, |previous| previous.short_steps),
            restarts: previous.map_or(0, |previous| previous.restarts + 1),
            keeps_set: false,
            effort,
            interrupted: false,
            next_step,
            constants: *constants,
        };
        resting.advance(table);
        let effort = std::mem::take(&mut resting.effort);
        (Some(Box::new(resting)), begin, effort)
    }

    /// Takes the next step if the active set has not changed at the end of this one. Returns whether it has done so.
    pub fn continue_step(&mut self, table: &Table) -> bool {
        if self.keeps_set && !self.is_still() {
            (self.start, self.begin, self.first) = (self.start + self.step, self.end, self.last);
            self.restarts = 0;
            self.effort.add(STEP_COST);
            self.advance(table);
            return true;
        }
        false
    }

    /// Chooses the step length and takes the step.
    fn advance(&mut self, table: &Table) {
        let shortest = self.constants.tolerance.shortest_step;
        let begin = self.initial_trial();
        let mut span = self.longest_step().min(self.next_step).max(shortest);
        let (trial, broken) = loop {
            let mut trial = self.attempt(table, &begin, span);
            if trial.has_no_forces() {
                if span <= shortest {
                    // The active set has ended.
                    break (trial, true);
                }
                span = trial.step.best_length.max(shortest);
                continue;
            }
            let middle = self.forces(self.scene(table, &self.half_way(&trial)), &trial.forces);
            let accurate = self.longest_polynomial_step(&trial, &middle);
            trial.step.best_length = trial.step.best_length.min(accurate);
            let Some(shorter) = self.shorter(table, &trial, accurate).filter(|_| span > shortest) else {
                let trial = self.breaking_half(table, &begin, &trial, &middle).unwrap_or(trial);
                let doubtful = trial.forces.slack < -self.constants.tolerance.force_error || self.shared;
                let broken = doubtful && !self.satisfies_laws(table, &trial);
                break (if broken { self.until_a_law_breaks(table, &begin, &trial) } else { trial }, broken);
            };
            span = shorter.max(shortest);
        };
        if !self.uses_solver() {
            let at_once = broken && (trial.has_no_forces() || trial.span < AT_ONCE * span);
            self.short_steps = if at_once { self.short_steps + 1 } else { 0 };
            if self.uses_solver() {
                self.advance(table);
                return;
            }
        }
        self.end_if_given_up();
        if self.is_given_up() || trial.step.end.time.is_nan() || trial.step.end.time <= 0.0 {
            // Nothing can be computed: time advances without motion.
            (self.step, self.end, self.keeps_set) = (shortest, self.begin, false);
            return;
        }
        let mut end = trial.step.end;
        let keeps_set = !broken && !self.shared && self.set.begins_no_slip();
        let ends = if keeps_set { self.slips_end_after(&end.balls, &trial.forces) } else { None };
        if let Some(time) = ends {
            for (ball, state) in end.balls.iter_mut().enumerate().filter(|(ball, _)| self.members[*ball]) {
                let linear = trial.forces.linear[ball];
                state.position += time * (state.velocity + 0.5 * time * linear);
                state.velocity += time * linear;
                state.spin += time * trial.forces.angular[ball];
            }
            end.time += time;
        }
        (self.step, self.last, self.keeps_set) = (end.time, trial.forces, keeps_set && ends.is_none());
        let changes = broken || ends.is_some();
        let rate = self.time_rate(&end.balls);
        self.next_step = if changes { f64::INFINITY } else { trial.step.best_length * rate };
        self.end = if self.keeps_set {
            close_gaps(&self.constants, &mut end.balls, &self.contacts);
            end.balls
        } else {
            self.without_rounding(table, end.balls)
        };
    }

    /// Returns the time until the next slips end, s, if it is so short that the forces no longer change.
    fn slips_end_after(&self, balls: &State, forces: &Forces) -> Option<f64> {
        let mut soonest = f64::INFINITY;
        self.slips(balls, forces, |_, slip, rate| {
            let falls = -slip.length_squared() / rate.dot(slip);
            if falls > 0.0 {
                soonest = soonest.min(falls);
            }
        });
        let tolerance = &self.constants.tolerance;
        let mut error = 0.0_f64;
        self.slips(balls, forces, |_, slip, rate| {
            // Slips that do not end at the same time turn slightly until then.
            if (slip + soonest * rate).length() > tolerance.slip {
                error = error.max(self.constants.sliding * soonest * soonest * rate.length() / slip.length());
            }
        });
        let turned = |ball: usize| {
            let spin = balls[ball].spin.z + soonest * forces.angular[ball].z;
            self.members[ball] && self.turns_over(ball, spin)
        };
        let is_near = error <= tolerance.negligible && soonest * self.constants.sliding <= tolerance.yielding;
        (is_near && !(0..BALLS).any(turned)).then_some(soonest)
    }

    /// Whether a `spin` about the vertical, rad/s, has the sign opposite to that of this active set.
    fn turns_over(&self, ball: usize, spin: f64) -> bool {
        match self.set.spin[ball] {
            Friction::Slips(sign) => self.constants.radius * spin * sign.x < -self.constants.tolerance.slip,
            Friction::Sticks | Friction::Yields | Friction::Filippov => false,
        }
    }

    /// Passes every slip of this active set and its rate to `each`.
    fn slips(&self, balls: &State, forces: &Forces, mut each: impl FnMut(SlipLocation, DVec2, DVec2)) {
        let radius = self.constants.radius;
        let rates: State = std::array::from_fn(|ball| BallState {
            position: balls[ball].position,
            velocity: forces.linear[ball],
            spin: forces.angular[ball],
        });
        let slips = |friction: Friction| matches!(friction, Friction::Slips(_));
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            let (state, rate) = (&balls[ball], &rates[ball]);
            let slip = |state: &BallState| slip(radius, state.velocity, state.spin);
            if slips(self.set.cloth[ball]) {
                each(SlipLocation::Cloth(ball), slip(state), slip(rate));
            } else if slips(self.set.roll[ball]) || self.set.roll[ball] == Friction::Filippov {
                each(SlipLocation::Roll(ball), state.velocity, rate.velocity);
            }
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            if slips(self.set.contact[index]) {
                each(SlipLocation::Contact(index), contact.slip(radius, balls), contact.slip(radius, &rates));
            }
        }
    }

    /// Whether the solver determines the forces in every state, because the active sets found before have repeatedly not lasted.
    const fn uses_solver(&self) -> bool {
        self.short_steps > MAX_SHORT_STEPS
    }

    /// Whether the step has exceeded its work budget.
    fn is_given_up(&self) -> bool {
        self.effort.spent() > STEP_BUDGET
    }

    /// After a step that is given up, resting contacts are disabled: the shot continues in micro-collisions.
    fn end_if_given_up(&self) {
        if self.is_given_up() {
            self.effort.add(RESTING_BUDGET);
        }
    }

    /// Returns the start of the step.
    const fn initial_trial(&self) -> Trial {
        let step = Step { end: Phase { balls: self.begin, time: 0.0 }, error: 0.0, best_length: 0.0 };
        Trial { span: 0.0, step, forces: self.first }
    }

    /// Returns the result of a step from `from` to `span`.
    fn attempt(&self, table: &Table, from: &Trial, span: f64) -> Trial {
        let begin = &from.step.end;
        let mut last = from.forces;
        let (yields, mut has_no_forces) = (self.set.yields() || self.uses_solver(), false);
        let slope = |phase: &Phase| {
            let held = if yields || has_no_forces {
                None
            } else {
                self.effort.add(known_set_cost(self.contacts.len()));
                self.scene(table, &phase.balls).accelerations(&self.first)
            };
            let (linear, angular) = held.unwrap_or_else(|| {
                // Without forces, the step has failed.
                if !has_no_forces {
                    last = self.search_forces(self.scene(table, &phase.balls), &last, !yields);
                    has_no_forces = !yields && !last.converged;
                }
                (last.linear, last.angular)
            });
            self.slope(&phase.balls, &linear, &angular)
        };
        let first = self.slope(&begin.balls, &from.forces.linear, &from.forces.angular);
        let (length, tolerance) = (span - from.span, self.constants.tolerance.step_error);
        let stiff = self.stiff(table, from, length);
        let mut step = extrapolate(begin, &first, slope, &stiff, length, (table.radius, tolerance));
        let forces = self.forces(self.scene(table, &step.end.balls), &from.forces);
        // If a friction yields, forces are at the edge of the laws and rarely converge to rounding; only the error of the step counts then.
        if has_no_forces || !yields && !forces.converged {
            (step.error, step.best_length) = (f64::INFINITY, WITHOUT_FORCES * length);
        }
        Trial { span, step, forces }
    }

    /// Whether the forces at a step's end obey all laws.
    fn satisfies_laws(&self, table: &Table, trial: &Trial) -> bool {
        let end = &trial.step.end.balls;
        let turned = |ball: usize| self.members[ball] && self.turns_over(ball, end[ball].spin.z);
        if self.is_given_up() || (0..BALLS).any(turned) {
            return false;
        }
        let force_error = self.constants.tolerance.force_error;
        let lawful = self.scene(table, end).resolve(force_error, Some(&trial.forces), &self.effort);
        lawful.is_some_and(|lawful| {
            trial.forces.distance(&lawful.forces, table.radius) <= 1e3 * force_error
                && lawful.contacts[..] == self.contacts[..]
                && !lawful.set.releases(&self.set)
        })
    }

    /// Returns the longest step that is worth trying, in rescaled time, and sets the time scale.
    fn longest_step(&mut self) -> f64 {
        self.time_scale = None;
        let sliding = self.constants.sliding;
        // While a slip turns in `turn` seconds under the acceleration `a`, a step of `h` seconds deviates by about `a h⁶/(2000 turn⁴)`.
        let strays = |turn: f64| {
            let square = turn * turn;
            libm::pow(2000.0 * MAX_DEVIATION / sliding * (square * square), 1.0 / 6.0)
        };
        let mut longest = LONGEST_CURVE / sliding;
        let (mut soonest, mut time_scale) = (f64::INFINITY, None);
        self.slips(&self.begin, &self.first, |place, slip, rate| {
            let length = slip.length();
            if length <= self.constants.tolerance.slip {
                return;
            }
            longest = longest.min(strays(length / rate.length()));
            // An implicit step requires a direction that already follows the forces; before that, it turns fast.
            let turning = (slip.perp_dot(rate) / (length * length)).abs();
            longest = longest.min((STIFF * length / (3.5 * sliding)).max(MAX_TURN / turning));
            let falls = -length * length / rate.dot(slip);
            if falls > 0.0 && falls < soonest {
                (soonest, time_scale) = (falls, Some((place, length)));
            }
        });
        // A slip that is far from its end needs no rescaled time.
        if longest < 0.1 * soonest {
            return longest;
        }
        self.time_scale = time_scale;
        let share = 1.0 - longest / soonest;
        if share > 0.0 { soonest * FALL.min(-libm::log(share)) } else { FALL * soonest }
    }

    /// Returns the derivative of time with respect to rescaled time.
    fn time_rate(&self, balls: &State) -> f64 {
        let radius = self.constants.radius;
        let Some((place, from)) = self.time_scale else { return 1.0 };
        let slip = match place {
            SlipLocation::Cloth(ball) => slip(radius, balls[ball].velocity, balls[ball].spin),
            SlipLocation::Roll(ball) => balls[ball].velocity,
            SlipLocation::Contact(index) => self.contacts[index].slip(radius, balls),
        };
        slip.length() / from
    }

    /// Returns a later state without rounding errors.
    fn without_rounding(&self, table: &Table, mut balls: State) -> State {
        let contacts = &self.contacts;
        let set =
            ActiveSet::of(table, &balls, contacts, self.constants.tolerance.slip).with_yielding_as_slipping(&self.set);
        remove_rounding(table, &self.constants, &mut balls, contacts, &set);
        balls
    }

    /// Returns the scene of a state with this step's contacts and active set.
    fn scene<'a>(&'a self, table: &'a Table, balls: &'a State) -> Scene<'a> {
        Scene { table, balls, contacts: &self.contacts, set: &self.set }
    }

    /// Returns the forces in a scene. They are sought from `near` if a friction yields, or if the linear system of the active set has no
    /// solution.
    fn forces(&self, scene: Scene<'_>, near: &Forces) -> Forces {
        if scene.set.yields() || self.uses_solver() {
            return self.search_forces(scene, near, false);
        }
        self.effort.add(known_set_cost(self.contacts.len()));
        scene.forces(Some(&self.first)).unwrap_or_else(|| self.search_forces(scene, near, true))
    }

    /// Returns the forces in a scene by the solver, with a short search if no forces are likely to exist.
    fn search_forces(&self, scene: Scene<'_>, near: &Forces, is_short: bool) -> Forces {
        if self.is_given_up() { *near } else { scene.search_forces(near, is_short, &self.effort) }
    }

    /// Returns the derivatives of a state with these accelerations, m/s² and rad/s², with respect to rescaled time.
    fn slope(&self, state: &State, linear: &[DVec2; BALLS], angular: &[DVec3; BALLS]) -> Phase {
        let rate = self.time_rate(state);
        let slope = |ball: usize| BallState {
            position: rate * state[ball].velocity,
            velocity: rate * linear[ball],
            spin: rate * angular[ball],
        };
        let none = BallState::at_rest(DVec2::ZERO);
        let balls = std::array::from_fn(|ball| if self.members[ball] { slope(ball) } else { none });
        Phase { balls, time: rate }
    }

    /// Whether these two balls press each other.
    pub fn presses_together(&self, (first, second): (usize, usize)) -> bool {
        self.contacts.contains(&Contact::of_balls(first, second))
    }

    /// Whether this cushion holds the ball.
    pub fn presses_cushion(&self, ball: usize, rail: Rail) -> bool {
        self.contacts.contains(&Contact::with_cushion(ball, rail))
    }
}
