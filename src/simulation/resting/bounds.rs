//! How long a step of a resting contact may be: it has to be right, its course must be one that a polynomial follows, and what
//! has begun to slip slowly must still be slow at its end.

use glam::DVec2;

use super::{Resting, State, Trial};
use crate::{
    physics::{Contact, Friction, slip},
    table::Table,
};

/// How far the courses of two pressed balls may part or overlap in between, m: half of what counts as an overlap.
const MOST_STRAY: f64 = 5e-10;

/// A slip that has begun slowly may get so many times too fast for it within a step.
const MOST_YIELDED: f64 = 1.5;

impl Resting {
    /// Which step to try instead of one that is wrong by too much, or does either of these.
    pub(super) fn shorter(&self, table: &Table, trial: &Trial) -> Option<f64> {
        let tolerance = &self.constants.tolerance;
        if trial.step.error.is_nan() || trial.step.error > tolerance.step {
            return Some(trial.step.best_length.min(0.7 * trial.span));
        }
        let strays = self.strays(trial) / MOST_STRAY;
        if strays > 1.0 {
            // It falls with the sixth power of the step.
            return Some(libm::pow(0.5 / strays, 1.0 / 6.0) * trial.span);
        }
        let yielded = self.yielded(table, &trial.step.end.balls) / tolerance.yielding;
        (yielded > MOST_YIELDED).then(|| (1.0 / yielded).max(0.1) * trial.span)
    }

    /// How far the polynomials as which a step's course is handed on let two pressed balls part or overlap half-way, m.
    fn strays(&self, trial: &Trial) -> f64 {
        let (h, end) = (trial.step.end.time, &trial.step.end.balls);
        let half_way = |ball: usize| {
            let (p0, p1) = (&self.begin[ball], &end[ball]);
            let bends = self.first.linear[ball] + trial.forces.linear[ball];
            0.5 * (p0.position + p1.position) + 5.0 / 32.0 * h * (p0.velocity - p1.velocity) + h * h / 64.0 * bends
        };
        let balls = self.contacts.as_slice().iter().filter_map(|contact| Some((contact.first, contact.second?)));
        balls.fold(0.0, |largest: f64, (one, other)| {
            largest.max((half_way(one).distance(half_way(other)) - self.constants.diameter).abs())
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
        let rubs = |contact: &Contact| table.ball_friction.is_some() || contact.second.is_none();
        let contacts = self.contacts.as_slice().iter().zip(self.set.contact).filter(|(contact, _)| rubs(contact));
        contacts.fold(on_cloth, |largest, (contact, does)| largest.max(yields(does, contact.slip(table.radius, balls))))
    }
}
