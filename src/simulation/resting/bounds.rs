//! Limits on the length of a step of a resting contact: its error, the deviation of its trajectory from a polynomial, and the size of slips
//! that have begun slowly.

use glam::DVec2;

use super::{MAX_DEVIATION, Resting, State, Trial};
use crate::{
    physics::{BallState, Forces, Friction, slip},
    table::{BALLS, Table},
};

/// A step is repeated if the length that would halve the accepted deviation is below this share of it: `2^(-1/6)`.
const DEVIATION_MARGIN: f64 = 0.89;

/// Largest accepted ratio of a slip that has begun slowly to its limit, at the end of a step.
const MAX_YIELDED: f64 = 1.5;

/// Largest number of halvings of the interval to a point within a step, if a single step to it is not accurate enough.
const MAX_HALVINGS: u32 = 6;

impl Resting {
    /// Returns the state after `span`, from within a completed step, as accurately as the step itself, in several parts if necessary. A
    /// shorter interval may fail although the whole one converged, because the first errors of an extrapolation are poor estimates.
    pub(super) fn step_to(&self, table: &Table, from: &Trial, span: f64) -> Trial {
        self.step_to_in_halves(table, from, span, MAX_HALVINGS)
    }

    fn step_to_in_halves(&self, table: &Table, from: &Trial, span: f64, halvings: u32) -> Trial {
        let (whole, tolerance) = (self.attempt(table, from, span), &self.constants.tolerance);
        if whole.step.error <= tolerance.step_error || halvings == 0 || span - from.span <= tolerance.shortest_step {
            return whole;
        }
        let middle = self.step_to_in_halves(table, from, 0.5 * (from.span + span), halvings - 1);
        self.step_to_in_halves(table, &middle, span, halvings - 1)
    }

    /// Returns the first half of a step if a law holds at both ends but is broken in the `middle`: a tiny normal force becomes negative and
    /// returns.
    pub(super) fn breaking_half(&self, table: &Table, begin: &Trial, whole: &Trial, middle: &Forces) -> Option<Trial> {
        let breaks = |forces: &Forces| forces.slack < -self.constants.tolerance.force_error;
        if breaks(&whole.forces) || !(middle.converged && breaks(middle)) {
            return None;
        }
        Some(self.step_to(table, begin, 0.5 * (begin.span + whole.span))).filter(|half| breaks(&half.forces))
    }

    /// Returns a shorter step if the error is too large, the trajectory is not close to a polynomial, or a slip that has begun slowly
    /// becomes too fast. `accurate` is the longest step with an accurate trajectory.
    pub(super) fn shorter(&self, table: &Table, trial: &Trial, accurate: f64) -> Option<f64> {
        let tolerance = &self.constants.tolerance;
        if trial.step.error.is_nan() || trial.step.error > tolerance.step_error {
            return Some(trial.step.best_length.min(0.7 * trial.span));
        }
        if accurate < DEVIATION_MARGIN * trial.span {
            return Some(accurate);
        }
        let yielded = self.yielded(table, &trial.step.end.balls) / tolerance.yielding;
        (yielded > MAX_YIELDED).then(|| (1.0 / yielded).max(0.1) * trial.span)
    }

    /// Returns the longest step whose trajectory is represented by its polynomial, estimated from the deviation at half the time: h²/24
    /// times the error of the polynomial's acceleration there, by the remainder term of a polynomial of degree five.
    pub(super) fn longest_polynomial_step(&self, trial: &Trial, middle: &Forces) -> f64 {
        let h = trial.step.end.time;
        let missed = |ball: usize| {
            let [begin, end] = [&self.begin, &trial.step.end.balls].map(|balls| balls[ball].velocity);
            let ends = self.first.linear[ball] + trial.forces.linear[ball];
            (1.5 / h * (end - begin) - 0.25 * ends).distance(middle.linear[ball])
        };
        let members = (0..BALLS).filter(|&ball| self.members[ball]);
        let strays = h * h / 24.0 * members.map(missed).fold(f64::MIN_POSITIVE, f64::max);
        // The deviation grows with the sixth power of the step.
        libm::pow(0.5 * MAX_DEVIATION / strays, 1.0 / 6.0) * trial.span
    }

    /// Returns the state at half the time, from polynomials through both ends.
    pub(super) fn half_way(&self, trial: &Trial) -> State {
        let h = trial.step.end.time;
        std::array::from_fn(|ball| {
            let (begin, end) = (&self.begin[ball], &trial.step.end.balls[ball]);
            let [a0, a1] = [&self.first, &trial.forces].map(|forces| forces.linear[ball]);
            let [w0, w1] = [&self.first, &trial.forces].map(|forces| forces.angular[ball]);
            let passed = 5.0 / 32.0 * h * (begin.velocity - end.velocity) + h * h / 64.0 * (a0 + a1);
            BallState {
                position: 0.5 * (begin.position + end.position) + passed,
                velocity: 1.875 / h * (end.position - begin.position) - 0.4375 * (begin.velocity + end.velocity)
                    + h / 32.0 * (a1 - a0),
                spin: 0.5 * (begin.spin + end.spin) + h / 8.0 * (w0 - w1),
            }
        })
    }

    /// Returns the largest slip whose friction opposes its rate, m/s.
    fn yielded(&self, table: &Table, balls: &State) -> f64 {
        let yields = |friction: Friction, slip: DVec2| if friction == Friction::Yields { slip.length() } else { 0.0 };
        let members = balls.iter().enumerate().filter(|(ball, _)| self.members[*ball]);
        let on_cloth = members.fold(0.0_f64, |largest, (ball, state)| {
            let slip = slip(table.radius, state.velocity, state.spin);
            largest.max(yields(self.set.cloth[ball], slip)).max(yields(self.set.roll[ball], state.velocity))
        });
        let contacts = self.contacts.iter().zip(self.set.contact);
        let contacts = contacts.filter(|(contact, _)| !contact.never_slips(table));
        contacts.fold(on_cloth, |largest, (contact, does)| largest.max(yields(does, contact.slip(table.radius, balls))))
    }
}
