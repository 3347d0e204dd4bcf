//! Impact events: single impacts, several at one moment, and the slow ones of a chatter.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{
    Constants, Event, EventKind, Observer,
    chatter::chatter_end,
    contacts::{PAIRS_OF, close_gaps, is_in_corner, move_to_cushion, touching},
    engine::{Ball, ContactMode, Engine, PairPrediction, SAME_TIME, only_ball},
    guards::{BALL_BOUNCE_COST, RAIL_BOUNCE_COST},
    savings::Savings,
};
use crate::{
    physics::{
        ActiveSet, BallState, Contact, Contacts, ImpactImpulse, MAX_CONTACTS, Motion, Partner, collide_together,
        involve, stop_by_impulses,
    },
    table::{BALLS, PAIRS},
};

/// Number of impacts at one moment after which further ones are solved without restitution. Three touching balls against a cushion need
/// some dozens; an inelastic collapse would need infinitely many.
pub(super) const MAX_ROUNDS: u32 = 64;

/// Number of impacts at one moment after which balls count as jammed between cushions. A ball that rolls past others in a row that fills
/// the table needs more room than rounding leaves, until it has passed, and no impulse creates that room.
const JAMMED_ROUNDS: u32 = 2 * MAX_ROUNDS;

/// Room behind a cushion for a jammed ball, in units of the touching tolerance: large enough for the next impact to come later.
const ROOM_FOR_JAMMED: f64 = 4.0;

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    #[inline(always)]
    pub(super) fn rebound(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        if self.balls[index].segment.motion == Motion::Flying {
            return self.rebound_in_space(index, now);
        }
        let Ball { rail_after, rail, segment, .. } = &self.balls[index];
        let (rail_after, rail, meets_two) =
            (*rail_after, *rail, is_in_corner(&self.constants, segment.position_after(*rail_after)));
        if (self.may_be_simultaneous(now) || meets_two || self.touches_another(index, now))
            && self.collide_simultaneously(now, &Contact::with_cushion(index, rail))?
        {
            return ControlFlow::Continue(());
        }
        let n = rail.normal();
        let freed = if self.resting.is_some() { self.release(now, only_ball(index)) } else { None };
        let mut state = match &freed {
            Some(states) => states[index],
            None => self.balls[index].segment.state_after(&self.constants, rail_after),
        };
        move_to_cushion(&self.constants, n, &mut state.position);
        let c = &self.constants;
        let before = state;
        let approach = -state.velocity.dot(n);
        let impulse = self.law_at(approach).cushion(rail).resolve(c.radius, n, &mut state);
        if self.micro_collisions.is_some() {
            state.position += c.tolerance.micro_gap * n;
        }
        if impulse.climb > c.least_climb {
            return self.climb_cushion(index, now, state, impulse.climb, freed.is_some());
        }
        let mut reported = true;
        if state.velocity.dot(n) <= c.tolerance.slow_bounce {
            let contact = Contact::with_cushion(index, rail);
            // An inelastic nose above the centre that does not throw the ball back has stopped it by its own law. In other cases, a bounce
            // that is too slow to be followed is undone.
            let [sine, _] = self.law_at(approach).cushion(rail).nose;
            let is_stopped = sine > 0.0 && approach > c.tolerance.slow_bounce && state.velocity.dot(n) <= 0.0;
            reported = self.slow_bounce(now, &contact)?;
            if let Some(rests) = self.chatter_end(now, freed.as_ref(), &contact, &[(index, state)]) {
                return self.end_chatter(
                    now,
                    freed,
                    &[(index, if is_stopped { state } else { before })],
                    &rests,
                    EventKind::BallRail(index, rail),
                    reported,
                );
            }
        }
        self.end_segment(index, now);
        self.launch(index, now, &state);
        self.report_impact(now, EventKind::BallRail(index, rail), reported)?;
        if freed.is_some() {
            self.predict_changed(now, self.with_freed(true, only_ball(index)))
        } else {
            self.predict_ball(now, index)
        }
    }

    pub(super) fn collide(&mut self, pair: usize, now: f64) -> ControlFlow<()> {
        let may_be_simultaneous = self.may_be_simultaneous(now);
        let (first, second) = PAIRS[pair];
        if !self.is_on_cloth(first) || !self.is_on_cloth(second) {
            return self.collide_in_space(pair, now);
        }
        let contact = Contact::of_balls(first, second);
        if (may_be_simultaneous || self.pair_touches_another(first, second, now))
            && self.collide_simultaneously(now, &contact)?
        {
            return ControlFlow::Continue(());
        }
        let PairPrediction { since, after, .. } = self.pairs[pair];
        let changed = std::array::from_fn(|ball| ball == first || ball == second);
        let freed = if self.resting.is_some() { self.release(now, changed) } else { None };
        let state_of = |index: usize| match &freed {
            Some(states) if self.resting_members()[index] => states[index],
            _ => {
                let segment = &self.balls[index].segment;
                segment.state_after(&self.constants, (since - segment.start) + after)
            }
        };
        let (mut a, mut b) = (state_of(first), state_of(second));
        let before = (a, b);
        let c = self.constants;
        if self.micro_collisions.is_some() {
            self.separate(&mut a, &mut b);
            let approach = (b.velocity - a.velocity).dot((a.position - b.position).normalize());
            self.law_at(approach).balls.resolve(c.radius, &mut a, &mut b);
        } else {
            self.law.balls.resolve(c.radius, &mut a, &mut b);
        }
        let opening = (a.velocity - b.velocity).dot(a.position - b.position);
        let mut reported = true;
        if opening <= c.diameter * c.tolerance.slow_bounce {
            reported = self.slow_bounce(now, &contact)?;
            if let Some(rests) = self.chatter_end(now, freed.as_ref(), &contact, &[(first, a), (second, b)]) {
                let before = [(first, before.0), (second, before.1)];
                return self.end_chatter(now, freed, &before, &rests, EventKind::BallBall(first, second), reported);
            }
        }
        self.end_segment(first, now);
        self.end_segment(second, now);
        self.launch(first, now, &a);
        self.launch(second, now, &b);
        self.report_impact(now, EventKind::BallBall(first, second), reported)?;
        self.predict_changed(now, self.with_freed(freed.is_some(), changed))
    }

    /// Whether a ball that hits a cushion touches another ball: they may collide a rounding error later, which no prediction contains.
    #[inline(always)]
    fn touches_another(&self, index: usize, now: f64) -> bool {
        // A resting contact has its own list of contacts.
        if self.resting.is_some() || self.balls[index].mode != ContactMode::Free {
            return false;
        }
        let here = self.place(index, now);
        PAIRS_OF[index].iter().any(|&(_, other)| self.may_touch(here, other, now))
    }

    /// Whether one of two balls that collide touches the third ball or a cushion: the closing speed may be so low that the impacts are
    /// predicted for different times, although rounding alone separates them.
    #[inline(always)]
    fn pair_touches_another(&self, first: usize, second: usize, now: f64) -> bool {
        let is_free = |ball: usize| self.balls[ball].mode == ContactMode::Free;
        if self.resting.is_some() || !is_free(first) || !is_free(second) {
            return false;
        }
        let Constants { reach, tolerance, .. } = &self.constants;
        [first, second].into_iter().any(|ball| {
            let here = self.place(ball, now);
            (*reach - here.abs()).min_element() <= tolerance.touching
                || self.may_touch(here, BALLS - first - second, now)
        })
    }

    /// Returns the position of a ball now along the table, m.
    #[inline(always)]
    pub(super) fn place(&self, ball: usize, now: f64) -> DVec2 {
        let segment = &self.balls[ball].segment;
        segment.position_after(now - segment.start)
    }

    /// Counts the impacts at this moment.
    #[inline(always)]
    pub(super) fn count_round(&mut self, now: f64) {
        self.rounds = if now - self.last_impact <= SAME_TIME { self.rounds + 1 } else { 0 };
        self.last_impact = now;
    }

    /// Whether other impacts may happen at this moment, or too many have happened.
    #[inline(always)]
    pub(super) fn may_be_simultaneous(&mut self, now: f64) -> bool {
        self.count_round(now);
        let mut count = 0;
        for predicted in self.times {
            count += u32::from(predicted <= now + self.constants.tolerance.simultaneous);
        }
        count > 1 || self.inelastic || self.rounds > MAX_ROUNDS
    }

    /// Resolves all contacts that close now together, if there are several; if a ball of them is in the air, only those that are linked to
    /// the `predicted` one. Returns whether they have collided.
    #[cold]
    pub(super) fn collide_simultaneously(&mut self, now: f64, predicted: &Contact) -> ControlFlow<(), bool> {
        if self.balls.iter().any(|ball| ball.segment.motion == Motion::Flying)
            && self.collide_together_aloft(now, predicted)?
        {
            return ControlFlow::Continue(true);
        }
        self.effort.add(RAIL_BOUNCE_COST);
        let held = self.resting.as_ref().map(|resting| resting.after(self.table, now - resting.start));
        let mut states = self.states_with(now, held.as_ref(), &[]);
        let c = self.constants;
        // Without restitution the rounds would never end; their limit is one impact of all touching contacts.
        let collapsed = (self.inelastic && self.micro_collisions.is_none()) || self.rounds > MAX_ROUNDS;
        let contacts = touching(&c, &states, self.on_cloth(), |opening| {
            opening < -c.tolerance.opening || (collapsed && opening <= 0.0)
        });
        if contacts.len() < 2 {
            return ControlFlow::Continue(false);
        }
        let changed = std::array::from_fn(|ball| involve(&contacts, ball));
        // In a micro-collision, a ball crosses a small gap before it bounces again; a jammed ball gets room behind the cushion.
        let room = match self.micro_collisions {
            Some(_) => c.tolerance.micro_gap,
            None if self.rounds > JAMMED_ROUNDS => -ROOM_FOR_JAMMED * c.tolerance.touching,
            None => 0.0,
        };
        for contact in &contacts {
            // Exactly at the cushion, as in a single impact.
            if let Partner::Cushion(rail) = contact.partner {
                let (n, ball) = (rail.normal(), &mut states[contact.first]);
                ball.position += (room - n.abs().dot(c.reach) - ball.position.dot(n)) * n;
            }
        }
        let closing = contacts.iter().fold(0.0_f64, |most, contact| most.max(-contact.opening_speed(&states)));
        let law = if collapsed { self.law.with_restitution(0.0) } else { self.law_at(closing).clone() };
        let impulses = collide_together(c.radius, &law, &mut states, &contacts);
        let met = || contacts.iter().zip(&impulses).filter(|(_, impulse)| impulse.normal > 0.0);
        if met().next().is_none() {
            // The balls only touch without closing: the predicted impact is a different one.
            return ControlFlow::Continue(false);
        }
        let freed = if self.resting.is_some() { self.release(now, changed) } else { None };
        let climbs = |impulse: &ImpactImpulse| impulse.climb > c.least_climb;
        let mut reported = Vec::with_capacity(MAX_CONTACTS);
        for (contact, impulse) in met() {
            let slow = contact.opening_speed(&states) <= c.tolerance.slow_bounce && !climbs(impulse);
            reported.push(!slow || self.slow_bounce(now, contact)?);
        }
        self.relaunch(now, changed, &states);
        for ((contact, _), reported) in met().zip(reported) {
            self.report_impact(now, kind(contact), reported)?;
        }
        for (contact, impulse) in met().filter(|(_, impulse)| climbs(impulse)) {
            self.lift(contact.first, now, states[contact.first], impulse.climb)?;
        }
        self.predict_changed(now, self.with_freed(freed.is_some(), changed))?;
        ControlFlow::Continue(true)
    }

    /// Reports an impact as an event, or as a bounce if it belongs to a chatter.
    #[inline(always)]
    pub(super) fn report_impact(&mut self, now: f64, kind: EventKind, reported: bool) -> ControlFlow<()> {
        if reported {
            return self.report(now, kind);
        }
        self.observer.bounce(Event { time: now, kind });
        ControlFlow::Continue(())
    }

    /// Records a slow bounce: reports the beginning of a chatter once, and returns whether the bounce itself is reported.
    #[cold]
    pub(super) fn slow_bounce(&mut self, now: f64, contact: &Contact) -> ControlFlow<(), bool> {
        self.effort.add(if contact.second().is_some() { BALL_BOUNCE_COST } else { RAIL_BOUNCE_COST });
        if !self.chatters.bounce(contact, now) && self.micro_collisions.is_none() {
            return ControlFlow::Continue(true);
        }
        self.observer.contact_step()?;
        for ball in [Some(contact.first), contact.second()].into_iter().flatten() {
            self.begin_contact(ball, now)?;
        }
        ControlFlow::Continue(false)
    }

    /// Returns the contacts that come to rest together with one that has just bounced; `bounced` are its balls after the bounce.
    #[cold]
    pub(super) fn chatter_end(
        &self,
        now: f64,
        freed: Option<&[BallState; BALLS]>,
        contact: &Contact,
        bounced: &[(usize, BallState)],
    ) -> Option<Contacts> {
        if self.micro_collisions.is_some() {
            return None;
        }
        let states = self.states_with(now, freed, bounced);
        let bounces = (self.law.restitution(contact), self.chatters.flight_ratio(contact));
        let (contacts, duration) =
            chatter_end(self.table, &self.constants, contact, &states, self.on_cloth(), bounces, &self.effort)?;
        (now + duration < self.next_meeting_aloft()).then_some(contacts)
    }

    /// Returns the next collision time of two balls, at least one of which is in the air, s: it may throw others back into the contacts
    /// that they have left.
    fn next_meeting_aloft(&self) -> f64 {
        let pairs = PAIRS.into_iter().zip(&self.times[BALLS..]);
        let aloft = pairs.filter(|&((first, second), _)| !self.is_on_cloth(first) || !self.is_on_cloth(second));
        aloft.fold(f64::INFINITY, |soonest, (_, time)| soonest.min(*time))
    }

    /// Returns the states of all balls now, some of them as `given`.
    pub(super) fn states_with(
        &self,
        now: f64,
        freed: Option<&[BallState; BALLS]>,
        given: &[(usize, BallState)],
    ) -> [BallState; BALLS] {
        let mut balls = std::array::from_fn(|index| match freed {
            Some(states) if self.resting_members()[index] => states[index],
            _ => self.state(index, now),
        });
        for (index, state) in given {
            balls[*index] = *state;
        }
        balls
    }

    /// Ends a chatter with one inelastic impact of all `contacts` that rest from now on; `before` are the balls of the contact that has
    /// closed.
    #[cold]
    pub(super) fn end_chatter(
        &mut self,
        now: f64,
        freed: Option<[BallState; BALLS]>,
        before: &[(usize, BallState)],
        contacts: &[Contact],
        impact: EventKind,
        reported: bool,
    ) -> ControlFlow<()> {
        let mut states = self.states_with(now, freed.as_ref(), before);
        let c = self.constants;
        close_gaps(&c, &mut states, contacts);
        let law = self.law.with_restitution(0.0);
        let mut given = [0.0; MAX_CONTACTS];
        for round in 0..MAX_ROUNDS {
            // The contact that has closed takes part however slowly it closes: balls that never slip lose their slip.
            if round > 0 && !contacts.iter().any(|contact| contact.opening_speed(&states) < -0.1 * c.tolerance.opening)
            {
                break;
            }
            let impulses = collide_together(c.radius, &law, &mut states, contacts);
            given.iter_mut().zip(impulses).for_each(|(given, impulse)| *given += impulse.normal);
        }
        // A push from one contact to another is a bounce, too, unless it is too fast to be omitted.
        let slow = |contact: &Contact| contact.opening_speed(&states) < c.tolerance.slowest_coupled_bounce;
        let (ended, given_there): (Vec<_>, Vec<_>) =
            contacts.iter().copied().zip(given).filter(|(contact, _)| slow(contact)).unzip();
        stop_by_impulses(self.table, &mut states, &ended, &ActiveSet::SLIPPING, &given_there);
        let changed = std::array::from_fn(|ball| involve(contacts, ball));
        self.relaunch(now, changed, &states);
        self.report_impact(now, impact, reported)?;
        let pushed = contacts.iter().zip(given).filter(|(_, given)| *given > 0.0);
        for contact in pushed.map(|(contact, _)| contact).filter(|contact| kind(contact) != impact) {
            let reported = self.slow_bounce(now, contact)?;
            self.report_impact(now, kind(contact), reported)?;
        }
        self.predict_changed(now, self.with_freed(freed.is_some(), changed))
    }
}

/// Returns the event of an impact.
pub(super) fn kind(contact: &Contact) -> EventKind {
    match contact.partner {
        Partner::Ball(second) => EventKind::BallBall(contact.first, second),
        Partner::Cushion(rail) => EventKind::BallRail(contact.first, rail),
    }
}
