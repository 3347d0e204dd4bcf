//! Micro-collisions: continuation of a shot whose resting contacts exceed their budget.
//!
//! Occasionally no forces are found that obey all laws, or contacts begin and end again and again: balls wedged in a corner, or a cloth
//! with a friction of 1000. From then on nothing rests. Pressed balls bounce, and slow bounces lose nothing (Mirtich and Canny,
//! "Impulse-based simulation of rigid bodies", 1995). There are then some thousand bounces a second instead of ever more, and on average
//! they push like the resting contact. Between bounces the balls move freely, and every bounce obeys the laws of friction, so that energy
//! is only lost where something slips. The cost is accuracy: a ball that should touch another may be a micrometre away from it.

use std::ops::ControlFlow;

use super::{
    Constants, Observer,
    engine::{ContactMode, Engine},
    savings::Savings,
};
use crate::{
    physics::{BallState, Effort, ImpactLaw},
    table::BALLS,
};

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Frees the resting balls at `now` and disables resting contacts for the rest of the shot.
    #[cold]
    pub(super) fn begin_micro_collisions(&mut self, now: f64) -> ControlFlow<()> {
        self.micro_collisions = Some(Box::new(self.law.with_restitution(1.0)));
        self.end_step(now);
        self.effort = Effort::default();
        self.ended = None;
        if let Some(resting) = self.resting.take() {
            self.relaunch(now, resting.members, &resting.end);
            for (ball, _) in self.balls.iter_mut().zip(resting.members).filter(|(_, member)| *member) {
                ball.mode = ContactMode::Bouncing;
            }
        }
        self.predict_changed(now, [true; BALLS])
    }

    /// Returns the laws of an impact with this approach speed, m/s.
    #[inline(always)]
    pub(super) fn law_at(&self, approach: f64) -> &ImpactLaw {
        match &self.micro_collisions {
            Some(lossless) if approach < self.constants.tolerance.fastest_micro_collision => lossless,
            _ => &self.law,
        }
    }

    /// Returns the longest pause between two micro-collisions of a contact, s, if the pressing acceleration is at least a tenth of sliding
    /// friction's.
    pub(super) fn longest_pause(&self) -> f64 {
        let Constants { tolerance, sliding, .. } = &self.constants;
        20.0 * tolerance.fastest_micro_collision / sliding
    }

    /// Separates two colliding balls by the gap of a micro-collision, which they cross before the next one.
    pub(super) fn separate(&self, first: &mut BallState, second: &mut BallState) {
        let relative = first.position - second.position;
        let gap = relative.length() - self.constants.diameter;
        let moves = 0.5 * (self.constants.tolerance.micro_gap - gap) * relative.normalize();
        // A ball at a cushion stays there, or a series of bounces would push it outwards.
        let reach = self.constants.reach;
        first.position = (first.position + moves).clamp(-reach, reach);
        second.position = (second.position - moves).clamp(-reach, reach);
    }
}
