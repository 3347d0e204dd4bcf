//! Micro-collisions: how a shot goes on whose resting contacts would take too much work.
//!
//! Now and then no forces are found that obey all laws, or contacts begin and end again and again: balls wedged in a corner, a cloth
//! with a friction of 1000. From then on nothing rests. What is pressed bounces, and slow bounces lose nothing (Mirtich and Canny,
//! "Impulse-based simulation of rigid bodies", 1995): so there are some thousand of them a second rather than ever more, and on
//! average they push as the resting contact does. Between them balls move freely, and every bounce obeys the laws of friction, so
//! that energy is only lost where something slips. What it costs is exactness: a ball that should touch another is up to a micrometre away.

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
    /// Frees what rests at `now`; nothing comes to rest against anything any more.
    #[cold]
    pub(super) fn begin_micro_collisions(&mut self, now: f64) -> ControlFlow<()> {
        self.micro_collisions = Some(Box::new(self.law.with_restitution(1.0)));
        self.cut(now);
        self.effort = Effort::default();
        self.ended = None;
        if let Some(resting) = self.resting.take() {
            self.relaunch(now, resting.members, &resting.end);
            for (ball, _) in self.balls.iter_mut().zip(resting.members).filter(|(_, member)| *member) {
                ball.mode = ContactMode::Bouncing;
            }
        }
        self.look_ahead(now, [true; BALLS])
    }

    /// The laws of an impact by the speed of its approach, m/s.
    #[inline(always)]
    pub(super) fn law_at(&self, approach: f64) -> &ImpactLaw {
        match &self.micro_collisions {
            Some(lossless) if approach < self.constants.tolerance.fastest_micro_collision => lossless,
            _ => &self.law,
        }
    }

    /// How long a micro-collision and the next of the same contact may be apart, s: what presses may be a tenth of the friction of a ball
    /// that slides. Less than nothing while there are none.
    pub(super) fn longest_pause(&self) -> f64 {
        let Constants { tolerance, sliding, .. } = &self.constants;
        if self.micro_collisions.is_some() {
            20.0 * tolerance.fastest_micro_collision / sliding
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Parts two balls that collide by the room of a micro-collision, through which they fall before the next.
    pub(super) fn part(&self, first: &mut BallState, second: &mut BallState) {
        let apart = first.position - second.position;
        let gap = apart.length() - self.constants.diameter;
        let moves = 0.5 * (self.constants.tolerance.micro_room - gap) * apart.normalize();
        first.position += moves;
        second.position -= moves;
    }
}
