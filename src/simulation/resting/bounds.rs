//! How long a step of a resting contact may be: it has to be right, its course must be one that a polynomial follows, and what
//! has begun to slip slowly must still be slow at its end.

use glam::DVec2;

use super::{MOST_STRAY, Resting, State, Trial};
use crate::{
    physics::{BallState, Forces, Friction, slip},
    table::{BALLS, Table},
};

/// A step is tried again if it is so much longer than one whose course strays by half of that: `2^(-1/6)`.
const ROOM_TO_STRAY: f64 = 0.89;

/// A slip that has begun slowly may get so many times too fast for it within a step.
const MOST_YIELDED: f64 = 1.5;

/// How often the way to a place within a step is halved where one step that leads there is not right.
const MOST_HALVINGS: u32 = 6;

impl Resting {
    /// What is reached after `span` from within a step that has been taken: as exact as the step, in several parts if need be. A shorter
    /// way may be given up where the whole one converged, for the first errors of an extrapolation tell little.
    pub(super) fn reach(&self, table: &Table, from: &Trial, span: f64) -> Trial {
        self.reach_in_halves(table, from, span, MOST_HALVINGS)
    }

    fn reach_in_halves(&self, table: &Table, from: &Trial, span: f64, halvings: u32) -> Trial {
        let (whole, tolerance) = (self.attempt(table, from, span), &self.constants.tolerance);
        if whole.step.error <= tolerance.step || halvings == 0 || span - from.span <= tolerance.shortest_step {
            return whole;
        }
        let middle = self.reach_in_halves(table, from, 0.5 * (from.span + span), halvings - 1);
        self.reach_in_halves(table, &middle, span, halvings - 1)
    }

    /// The first half of a step if a law is broken in the `middle` that holds at both ends: a push that is next to none falls below it and
    /// comes back.
    pub(super) fn breaking_half(&self, table: &Table, begin: &Trial, whole: &Trial, middle: &Forces) -> Option<Trial> {
        let breaks = |forces: &Forces| forces.slack < -self.constants.tolerance.slack;
        if breaks(&whole.forces) || !(middle.converged && breaks(middle)) {
            return None;
        }
        Some(self.reach(table, begin, 0.5 * (begin.span + whole.span))).filter(|half| breaks(&half.forces))
    }

    /// Which step to try instead of one whose error is too large, whose course no polynomial follows, or in which a slip that has begun
    /// slowly gets too fast. `course` is the longest step whose course is right.
    pub(super) fn shorter(&self, table: &Table, trial: &Trial, course: f64) -> Option<f64> {
        let tolerance = &self.constants.tolerance;
        if trial.step.error.is_nan() || trial.step.error > tolerance.step {
            return Some(trial.step.best_length.min(0.7 * trial.span));
        }
        if course < ROOM_TO_STRAY * trial.span {
            return Some(course);
        }
        let yielded = self.yielded(table, &trial.step.end.balls) / tolerance.yielding;
        (yielded > MOST_YIELDED).then(|| (1.0 / yielded).max(0.1) * trial.span)
    }

    /// The longest step whose course the polynomial as which it is handed on follows, by how far this one's strays half-way: a
    /// twenty-fourth of what it misses of the acceleration there, times the square of the step, as the rest of a polynomial of degree five
    /// tells.
    pub(super) fn longest_course(&self, trial: &Trial, middle: &Forces) -> f64 {
        let h = trial.step.end.time;
        let missed = |ball: usize| {
            let [begin, end] = [&self.begin, &trial.step.end.balls].map(|balls| balls[ball].velocity);
            let ends = self.first.linear[ball] + trial.forces.linear[ball];
            (1.5 / h * (end - begin) - 0.25 * ends).distance(middle.linear[ball])
        };
        let members = (0..BALLS).filter(|&ball| self.members[ball]);
        let strays = h * h / 24.0 * members.map(missed).fold(f64::MIN_POSITIVE, f64::max);
        // It grows with the sixth power of the step.
        libm::pow(0.5 * MOST_STRAY / strays, 1.0 / 6.0) * trial.span
    }

    /// The state half-way in time, by polynomials through both ends.
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

    /// The largest slip whose friction acts against its rate, m/s.
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
