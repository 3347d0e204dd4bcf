//! Resting contacts in the engine: their beginning, steps and end.

use std::ops::ControlFlow;

use super::{
    EventKind, Observer, Segment,
    contacts::PAIRS_OF,
    engine::{ContactMode, Engine, only_ball},
    resting::Resting,
    savings::Savings,
};
use crate::{
    physics::{BallState, Motion},
    table::{BALLS, PAIRS},
};

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Handles the next step of the balls in resting contact.
    #[cold]
    pub(super) fn continue_resting(&mut self, now: f64) -> ControlFlow<()> {
        let Some(mut resting) = self.resting.take() else { return ControlFlow::Continue(()) };
        let members = resting.members;
        if self.is_out_of_reach(|index| self.state(index, now)) {
            return ControlFlow::Break(());
        }
        if !self.is_exhausted() && resting.continue_step(self.table) {
            self.effort.absorb(&resting.effort);
            self.observer.contact_step()?;
            self.resting = Some(resting);
            for index in (0..BALLS).filter(|&index| members[index]) {
                self.rest(index, now);
            }
            self.predict_pressed(now, members);
            return ControlFlow::Continue(());
        }
        // A ball that another one strikes repeatedly is this slow only between two impacts.
        if resting.is_still() && !self.is_touched(now, members) {
            resting.come_to_rest();
        }
        self.relaunch(now, members, &resting.end);
        // Whether they continue to rest is decided for all contacts together.
        self.pressed = true;
        // Termination guard: a ball in another contact stands still, and its contact restarts.
        self.ended = (!self.is_exhausted()).then_some(resting);
        self.predict_changed(now, members)
    }

    /// Whether a moving ball that is not one of the `members` touches one of them.
    fn is_touched(&self, now: f64, members: [bool; BALLS]) -> bool {
        let on_cloth = self.on_cloth();
        let moves = |ball: usize| on_cloth[ball] && self.balls[ball].segment.motion != Motion::Stationary;
        PAIRS.iter().any(|&(first, second)| {
            let (member, other) = if members[first] { (first, second) } else { (second, first) };
            members[member] && !members[other] && moves(other) && {
                let [one, another] = [member, other].map(|ball| self.state(ball, now).position);
                one.distance(another) - self.constants.diameter <= self.constants.tolerance.coupled_gap
            }
        })
    }

    /// Ends the resting contacts at `now` if one of the `changed` balls takes part: their members move freely until the next active set is
    /// known. Returns the states of all members.
    #[cold]
    pub(super) fn release(&mut self, now: f64, changed: [bool; BALLS]) -> Option<[BallState; BALLS]> {
        let members = self.resting_members();
        if !(0..BALLS).any(|index| changed[index] && members[index]) {
            return None;
        }
        self.end_step(now);
        let states = self.resting.as_ref()?.end;
        self.relaunch(now, std::array::from_fn(|index| members[index] && !changed[index]), &states);
        self.pressed = true;
        Some(states)
    }

    /// Ends the present step of the resting contacts at `now`.
    #[cold]
    pub(super) fn end_step(&mut self, now: f64) {
        let Some(resting) = &mut self.resting else { return };
        let time = now - resting.start;
        if time >= resting.step {
            return;
        }
        resting.shorten(self.table, time);
        self.next_step = resting.next_step;
        for index in (0..BALLS).filter(|&index| resting.members[index] && time > 0.0) {
            let segment = &mut self.balls[index].segment;
            if segment.start == resting.start {
                (segment.half_acceleration, segment.course) = resting.course(index);
            }
        }
    }

    /// Returns the members of the stored resting contact.
    pub(super) fn resting_members(&self) -> [bool; BALLS] {
        self.resting.as_ref().map_or([false; BALLS], |resting| resting.members)
    }

    /// Returns the `changed` balls, together with the members of the stored resting contact if it has been `freed`.
    pub(super) fn with_freed(&self, freed: bool, changed: [bool; BALLS]) -> [bool; BALLS] {
        let members = self.resting_members();
        std::array::from_fn(|index| changed[index] || (freed && members[index]))
    }

    /// Starts the common trajectory of all balls in resting contact, and frees those that no longer press.
    #[cold]
    pub(super) fn press(&mut self, now: f64, changed: &mut [bool; BALLS]) -> ControlFlow<()> {
        if let Some(resting) = &self.resting
            && !self.pressed
            && !(0..BALLS).any(|index| changed[index] && resting.members[index])
        {
            return ControlFlow::Continue(());
        }
        self.end_step(now);
        // Other members of a continuing contact are part of the new one.
        let states: [BallState; BALLS] = std::array::from_fn(|index| match &self.resting {
            Some(resting) if resting.start.max(self.balls[index].segment.start) < now && resting.members[index] => {
                resting.end[index]
            }
            _ => self.state(index, now),
        });
        if self.is_out_of_reach(|index| states[index]) {
            return ControlFlow::Break(());
        }
        let previous = self.resting.take().or(self.ended.take());
        self.observer.contact_step()?;
        if let Some(previous) = &previous {
            self.effort.absorb(&previous.effort);
            previous.contacts.iter().for_each(|contact| self.chatters.rest(contact, now));
        }
        let (on_cloth, previous) = (self.on_cloth(), previous.as_deref());
        let (resting, begin, effort) =
            Resting::begin(self.table, &self.constants, now, &states, on_cloth, previous, self.next_step);
        self.effort.absorb(&effort);
        if let Some(resting) = &resting {
            self.next_step = resting.next_step;
            resting.contacts.iter().for_each(|contact| self.chatters.begin_rest(contact, now));
        }
        self.resting = resting;
        let members = self.resting_members();
        // A slip that ends here has ended for good.
        let moved: [bool; BALLS] = std::array::from_fn(|index| !members[index] && begin[index] != states[index]);
        self.relaunch(now, moved, &begin);
        *changed = std::array::from_fn(|index| changed[index] || moved[index]);
        for index in 0..BALLS {
            let was = self.balls[index].mode;
            if members[index] {
                self.balls[index].mode = ContactMode::Resting;
                self.rest(index, now);
                changed[index] = true;
                if was == ContactMode::Free {
                    self.report(now, EventKind::ContactBegins(index))?;
                }
            } else if was == ContactMode::Resting {
                self.balls[index].mode = ContactMode::Bouncing;
                // A ball whose contact ended because of another ball is still on the common trajectory.
                if self.balls[index].segment.motion == Motion::Resting {
                    self.relaunch(now, only_ball(index), &begin);
                    changed[index] = true;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Reports the end of the contacts of balls that neither rest nor bounce any longer, or are in the air. If `nothing` but rolling to
    /// rest remains, reports all of them.
    #[cold]
    pub(super) fn report_free(&mut self, now: f64, nothing: bool) -> ControlFlow<()> {
        for index in 0..BALLS {
            let bounces = || self.is_on_cloth(index) && self.may_bounce(index);
            if self.balls[index].mode != ContactMode::Bouncing || (!nothing && bounces()) {
                continue;
            }
            self.balls[index].mode = ContactMode::Free;
            self.report(now, EventKind::ContactEnds(index))?;
            self.report_motion(index, now)?;
        }
        ControlFlow::Continue(())
    }

    /// Whether a ball may bounce again before one of its chatters ends: its own next event, or any event of the ball with which it
    /// chatters, is early enough. In micro-collisions, any event may make it bounce again.
    fn may_bounce(&self, index: usize) -> bool {
        let own = self.times[index];
        if self.micro_collisions.is_some() {
            let soonest = self.times.into_iter().fold(f64::INFINITY, f64::min);
            return self.chatters.ends(index, self.longest_pause()).any(|(_, end)| soonest <= end);
        }
        let next = |other: usize| {
            if other == index {
                return own;
            }
            PAIRS_OF[other]
                .iter()
                .fold(own.min(self.times[other]), |next, (pair, _)| next.min(self.times[BALLS + pair]))
        };
        self.chatters.ends(index, f64::NEG_INFINITY).any(|(other, end)| next(other) <= end)
    }

    #[cold]
    pub(super) fn rest(&mut self, index: usize, now: f64) {
        let Some(resting) = &self.resting else { return };
        let BallState { position, velocity, spin } = resting.begin[index];
        let (half_acceleration, course) = resting.course(index);
        let step = resting.step;
        let motion = Motion::Resting;
        let segment = Segment { start: now, position, velocity, half_acceleration, spin, motion, course };
        if self.balls[index].segment.start < now {
            self.end_segment(index, now);
        }
        self.set(index, segment, step);
    }
}
