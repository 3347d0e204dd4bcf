//! The event-driven engine (thesis 3.2 and Algorithm 1): from one event to the next, with nothing in between.

use std::{marker::PhantomData, ops::ControlFlow};

use glam::DVec2;

use super::{
    Constants, Event, EventKind, Observer, Rail, Segment,
    chatter::{Chatters, settles},
    contact_mode::ContactMode,
    contacts::{PAIRS, close, touching},
    resting::{Outcome, Resting},
    savings::{All, Savings},
    segment::still,
};
use crate::{
    physics::{
        ActiveSet, BallState, Contact, Contacts, ImpactLaw, Impulse, Motion, collide_balls, collide_rail,
        collide_together, stop_by_impulses,
    },
    table::{BALLS, Layout, Table},
};

/// Impacts that follow each other within this time are at the same moment, s: a ball moves by less than a gap that counts as
/// none meanwhile, at any speed on a table.
const MOMENT: f64 = 1e-15;

/// Steps of contacts and bounces of chatters after which a shot is brought to its end. This is a guard, not physics: what
/// takes part in another contact stands still from then on. The stability table counts the shots that come to it.
const MOST_STEPS: u32 = 1500;

/// Impacts at one moment after which those that go on are solved without restitution: three touching balls against a
/// cushion exchange some dozens, an inelastic collapse infinitely many.
const MOST_ROUNDS: u32 = 64;

/// How a simulation ended: when all balls stood still, or when the observer had seen enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Time of the last event, s.
    pub time: f64,
    /// The balls at that time.
    pub balls: [BallState; BALLS],
}

impl End {
    /// Where the balls are.
    pub fn layout(&self) -> Layout {
        Layout::new(self.balls.map(|ball| ball.position))
    }
}

/// Plays a shot: the cue ball starts with `impulse`, and `observer` is told what happens until all balls stand still or
/// it breaks off. The layout is taken as it is: see [`Layout::validate`].
///
/// Every run of the same shot gives the same bits.
pub fn simulate<O: Observer>(table: &Table, layout: &Layout, impulse: &Impulse, observer: &mut O) -> End {
    simulate_with::<All, O>(table, layout, impulse, observer)
}

/// The same with some savings switched off, to see what they bring.
pub fn simulate_with<S: Savings, O: Observer>(
    table: &Table,
    layout: &Layout,
    impulse: &Impulse,
    observer: &mut O,
) -> End {
    let mut engine = Engine::<S, O>::new(table, layout, observer);
    let time = engine.run(impulse);
    engine.finish(time)
}

/// Plays a shot like [`simulate`] just for what the observer is told, and does not work out where the balls are at the
/// end.
pub fn watch<O: Observer>(table: &Table, layout: &Layout, impulse: &Impulse, observer: &mut O) {
    watch_with::<All, O>(table, layout, impulse, observer);
}

/// The same with some savings switched off.
pub fn watch_with<S: Savings, O: Observer>(table: &Table, layout: &Layout, impulse: &Impulse, observer: &mut O) {
    Engine::<S, O>::new(table, layout, observer).run(impulse);
}

/// A ball's present course and what it alone will do next.
pub(super) struct Ball {
    pub(super) segment: Segment,
    /// How long the motion can last, s after the segment's start.
    pub(super) lasts: f64,
    /// When the ball meets `rail`, s after the segment's start; infinity if never.
    pub(super) rail_after: f64,
    pub(super) rail: Rail,
    /// What its contacts do.
    pub(super) mode: ContactMode,
}

/// When a pair of balls meets: `after` seconds after `since`. Both are kept, since their sum is rounded.
#[derive(Clone, Copy)]
pub(super) struct Meeting {
    pub(super) since: f64,
    pub(super) after: f64,
    /// Whether the balls might have come to rest against each other when this was predicted.
    pub(super) may_rest: bool,
}

impl Meeting {
    /// No meeting, as far as was known at `since`.
    pub(super) const fn unseen(since: f64, may_rest: bool) -> Self {
        Self { since, after: f64::INFINITY, may_rest }
    }
}

pub(super) struct Engine<'a, S, O> {
    table: &'a Table,
    pub(super) constants: Constants,
    pub(super) observer: &'a mut O,
    pub(super) balls: [Ball; BALLS],
    pub(super) pairs: [Meeting; 3],
    /// When each ball, and then each pair, has its next event, s; infinity for none.
    pub(super) times: [f64; 2 * BALLS],
    pub(super) resting: Option<Box<Resting>>,
    /// Longest step that the next resting contact tries, s.
    next_step: f64,
    /// Whether a prediction has found balls pressed together that are not yet in `resting`.
    pub(super) pressed: bool,
    /// Time of the last impact, s, and how many there have been at that moment.
    last_impact: f64,
    rounds: u32,
    /// Steps of contacts and bounces of chatters so far.
    steps: u32,
    /// The slow bounces, once there is one.
    chatters: Option<Box<Chatters>>,
    savings: PhantomData<S>,
}

impl<'a, S: Savings, O: Observer> Engine<'a, S, O> {
    fn new(table: &'a Table, layout: &Layout, observer: &'a mut O) -> Self {
        Self {
            table,
            constants: Constants::of(table),
            observer,
            balls: layout.balls.map(Ball::at_rest),
            pairs: [Meeting::unseen(0.0, false); 3],
            times: [f64::INFINITY; 2 * BALLS],
            resting: None,
            next_step: f64::INFINITY,
            pressed: false,
            last_impact: f64::NEG_INFINITY,
            rounds: 0,
            steps: 0,
            chatters: None,
            savings: PhantomData,
        }
    }

    /// Plays the shot; returns the time of the last event.
    fn run(&mut self, impulse: &Impulse) -> f64 {
        let cue_ball =
            BallState { position: self.balls[0].segment.position, velocity: impulse.velocity, spin: impulse.spin };
        self.launch(0, 0.0, &cue_ball);
        let mut flow = self.look_ahead_of(0.0, 0);
        let mut now = 0.0;
        if S::ALONE && S::KEPT_PREDICTIONS && flow.is_continue() && self.moves_alone(0) {
            flow = self.play_alone(0, &mut now);
        }
        while flow.is_continue() {
            let (mut next, mut source) = (f64::INFINITY, usize::MAX);
            for (index, &time) in self.times.iter().enumerate() {
                if time < next {
                    (next, source) = (time, index);
                }
            }
            if source == usize::MAX || (S::LAST_ROLLS && !O::ENDS && self.only_rolls_out(source)) {
                break;
            }
            flow = match source.checked_sub(BALLS) {
                Some(pair) => self.collide(pair, next),
                None if self.balls[source].rail_after < self.balls[source].lasts => self.rebound(source, next),
                None if self.balls[source].segment.motion == Motion::Resting => self.rest_on(next),
                None => self.change_motion(source, next),
            };
            now = next;
        }
        now
    }

    /// Whether nothing is left to happen but that this ball, which comes next, rolls to its stop.
    #[inline(always)]
    fn only_rolls_out(&self, source: usize) -> bool {
        source < BALLS
            && self.balls[source].segment.motion == Motion::Rolling
            && self.balls[source].rail_after == f64::INFINITY
            && (0..self.times.len()).all(|other| other == source || self.times[other] == f64::INFINITY)
    }

    /// The end of sliding or rolling.
    #[inline(always)]
    fn change_motion(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        let ball = &self.balls[index];
        let ended = ball.segment.motion;
        let (mut segment, lasts) = ball.segment.successor(&self.constants, ball.lasts);
        segment.start = now;
        self.close(index, now);
        if ended == Motion::Sliding
            && !(self.balls[index].mode == ContactMode::Bouncing && self.still_chatters(now, index)?)
        {
            self.tell(now, EventKind::SlidingRolling(index))?;
        }
        if segment.motion == Motion::Stationary {
            self.tell(now, EventKind::RollingStationary(index))?;
        }
        self.set(index, segment, lasts);
        self.look_ahead_of(now, index)
    }

    #[inline(always)]
    fn rebound(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        if self.is_crowded(now) && self.collide_at_once(now)? {
            return ControlFlow::Continue(());
        }
        let Ball { rail_after, rail, .. } = self.balls[index];
        let n = rail.normal();
        let freed = if self.resting.is_some() { self.release(now, only(index)) } else { None };
        let mut state = match &freed {
            Some(states) => states[index],
            None => self.balls[index].segment.state_after(&self.constants, rail_after),
        };
        // The ball stands exactly at the cushion: the prediction's rounding must not leave a gap to fall through.
        state.position += (-n.abs().dot(self.constants.reach) - state.position.dot(n)) * n;
        let c = &self.constants;
        let before = state;
        collide_rail(c.radius, c.rail_restitution, c.rail_friction, n, &mut state);
        let mut told = true;
        if state.velocity.dot(n) <= c.tolerance.slow_bounce {
            let contact = Contact::with_cushion(index, n);
            told = self.slow_bounce(now, &contact)?;
            if let Some(rests) = self.settles(now, freed.as_ref(), &contact, &[(index, state)]) {
                return self.end_chatter(
                    now,
                    freed,
                    &[(index, before)],
                    &rests,
                    EventKind::BallRail(index, rail),
                    told,
                );
            }
        }
        self.close(index, now);
        self.launch(index, now, &state);
        self.tell_impact(now, EventKind::BallRail(index, rail), told)?;
        if freed.is_some() {
            self.look_ahead(now, either(true, self.freed_members(), only(index)))
        } else {
            self.look_ahead_of(now, index)
        }
    }

    fn collide(&mut self, pair: usize, now: f64) -> ControlFlow<()> {
        if self.is_crowded(now) && self.collide_at_once(now)? {
            return ControlFlow::Continue(());
        }
        let (first, second) = PAIRS[pair];
        let Meeting { since, after, .. } = self.pairs[pair];
        let mut changed = only(first);
        changed[second] = true;
        let freed = if self.resting.is_some() { self.release(now, changed) } else { None };
        let state_of = |index: usize| match &freed {
            Some(states) if self.freed_members()[index] => states[index],
            _ => {
                let segment = &self.balls[index].segment;
                segment.state_after(&self.constants, (since - segment.start) + after)
            }
        };
        let (mut a, mut b) = (state_of(first), state_of(second));
        let before = (a, b);
        let c = self.constants;
        collide_balls(c.radius, c.ball_restitution, c.ball_friction, &mut a, &mut b);
        let opening = (a.velocity - b.velocity).dot(a.position - b.position);
        let mut told = true;
        if opening <= c.diameter * c.tolerance.slow_bounce {
            let contact = Contact::of_balls(first, second);
            told = self.slow_bounce(now, &contact)?;
            if let Some(rests) = self.settles(now, freed.as_ref(), &contact, &[(first, a), (second, b)]) {
                let before = [(first, before.0), (second, before.1)];
                return self.end_chatter(now, freed, &before, &rests, EventKind::BallBall(first, second), told);
            }
        }
        self.close(first, now);
        self.close(second, now);
        self.launch(first, now, &a);
        self.launch(second, now, &b);
        self.tell_impact(now, EventKind::BallBall(first, second), told)?;
        self.look_ahead(now, either(freed.is_some(), self.freed_members(), changed))
    }

    /// Whether other impacts happen at this very moment, or too many have.
    #[inline(always)]
    fn is_crowded(&mut self, now: f64) -> bool {
        self.rounds = if now - self.last_impact <= MOMENT { self.rounds + 1 } else { 0 };
        self.last_impact = now;
        let mut at_once = 0;
        for time in self.times {
            at_once += u32::from(time <= now + MOMENT);
        }
        at_once > 1 || self.rounds > MOST_ROUNDS
    }

    /// All contacts that close now collide together, if there are several.
    #[cold]
    fn collide_at_once(&mut self, now: f64) -> ControlFlow<(), bool> {
        self.steps += 1;
        let members = self.freed_members();
        let held = self.resting.as_ref().map(|resting| resting.after(self.table, now - resting.start));
        let mut states: [BallState; BALLS] = std::array::from_fn(|index| match &held {
            Some(states) if members[index] => states[index],
            _ => self.state(index, now),
        });
        let c = self.constants;
        let collapsed = self.rounds > MOST_ROUNDS;
        let contacts = touching(&c, &states, |opening| opening < -c.tolerance.opening || (collapsed && opening <= 0.0));
        if contacts.as_slice().len() < 2 {
            return ControlFlow::Continue(false);
        }
        let mut changed = [false; BALLS];
        for (ball, changed) in changed.iter_mut().enumerate() {
            *changed = contacts.hold(ball);
        }
        let freed = if self.resting.is_some() { self.release(now, changed) } else { None };
        for contact in contacts.as_slice() {
            // Exactly at the cushion, as in a single impact.
            let n = contact.cushion_normal;
            let ball = &mut states[contact.first];
            if contact.second.is_none() {
                ball.position += (-n.abs().dot(c.reach) - ball.position.dot(n)) * n;
            }
        }
        let law = ImpactLaw::of(self.table);
        let law = if collapsed { law.inelastic() } else { law };
        let impulses = collide_together(c.radius, &law, &mut states, contacts.as_slice());
        let mut told = [false; crate::physics::MAX_CONTACTS];
        for (index, contact) in contacts.as_slice().iter().enumerate() {
            if impulses[index] > 0.0 {
                let slow = contact.opening_speed(&states) <= c.tolerance.slow_bounce;
                told[index] = !slow || self.slow_bounce(now, contact)?;
            }
        }
        for index in (0..BALLS).filter(|&index| changed[index]) {
            self.close(index, now);
            self.launch(index, now, &states[index]);
        }
        for (index, contact) in contacts.as_slice().iter().enumerate().filter(|(index, _)| impulses[*index] > 0.0) {
            let rail = Rail::ALL.into_iter().find(|rail| rail.normal() == contact.cushion_normal);
            let kind = match (contact.second, rail) {
                (Some(second), _) => EventKind::BallBall(contact.first, second),
                (None, rail) => EventKind::BallRail(contact.first, rail.unwrap_or(Rail::Left)),
            };
            self.tell_impact(now, kind, told[index])?;
        }
        self.look_ahead(now, either(freed.is_some(), self.freed_members(), changed))?;
        ControlFlow::Continue(true)
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.steps += 1;
        self.observer.contact_step()
    }

    /// Whether a bouncing ball still chatters; tells the end of its contact if not.
    #[cold]
    fn still_chatters(&mut self, now: f64, ball: usize) -> ControlFlow<(), bool> {
        if self.chatters.as_ref().is_some_and(|chatters| !chatters.are_over(ball, now)) {
            return ControlFlow::Continue(true);
        }
        self.balls[ball].mode = ContactMode::Free;
        self.tell(now, EventKind::ContactEnds(ball))?;
        ControlFlow::Continue(false)
    }

    /// Tells an impact, or only who keeps accounts of it where it belongs to a chatter.
    #[inline(always)]
    fn tell_impact(&mut self, now: f64, kind: EventKind, told: bool) -> ControlFlow<()> {
        if told {
            return self.tell(now, kind);
        }
        self.observer.bounce(Event { time: now, kind });
        ControlFlow::Continue(())
    }

    /// Takes note of a slow bounce: tells the beginning of a chatter once, and whether the bounce itself is to be told.
    #[cold]
    fn slow_bounce(&mut self, now: f64, contact: &Contact) -> ControlFlow<(), bool> {
        self.steps += 1;
        let chatters = self.chatters.get_or_insert_with(|| Box::new(Chatters::new()));
        if !chatters.bounce(contact, now) {
            return ControlFlow::Continue(true);
        }
        self.contact_step()?;
        for ball in [Some(contact.first), contact.second].into_iter().flatten() {
            if self.balls[ball].mode == ContactMode::Free {
                self.balls[ball].mode = ContactMode::Bouncing;
                self.tell(now, EventKind::ContactBegins(ball))?;
            }
        }
        ControlFlow::Continue(false)
    }

    /// The contacts that come to rest with one that has just bounced; `bounced` are its balls after the bounce.
    #[cold]
    fn settles(
        &self,
        now: f64,
        freed: Option<&[BallState; BALLS]>,
        contact: &Contact,
        bounced: &[(usize, BallState)],
    ) -> Option<Contacts> {
        let shrinking = self.chatters.as_ref().map_or(0.0, |chatters| chatters.shrinking(contact));
        settles(self.table, &self.constants, contact, &self.states_with(now, freed, bounced), shrinking)
    }

    /// All balls now, some of them as given.
    fn states_with(
        &self,
        now: f64,
        freed: Option<&[BallState; BALLS]>,
        given: &[(usize, BallState)],
    ) -> [BallState; BALLS] {
        let mut balls = std::array::from_fn(|index| match freed {
            Some(states) if self.freed_members()[index] => states[index],
            _ => self.state(index, now),
        });
        for (index, state) in given {
            balls[*index] = *state;
        }
        balls
    }

    /// Ends a chatter with one impact without restitution of all contacts that rest from now on; `before` are the balls of the
    /// contact that has met.
    #[cold]
    fn end_chatter(
        &mut self,
        now: f64,
        freed: Option<[BallState; BALLS]>,
        before: &[(usize, BallState)],
        rests: &Contacts,
        impact: EventKind,
        told: bool,
    ) -> ControlFlow<()> {
        let mut states = self.states_with(now, freed.as_ref(), before);
        let c = self.constants;
        let contacts = rests.as_slice();
        close(&c, &mut states, contacts);
        let law = ImpactLaw::of(self.table).inelastic();
        for _ in 0..MOST_ROUNDS {
            if !contacts.iter().any(|contact| contact.opening_speed(&states) < -0.1 * c.tolerance.opening) {
                break;
            }
            collide_together(c.radius, &law, &mut states, contacts);
        }
        // What one of them has given another is a bounce, too.
        stop_by_impulses(self.table, &mut states, contacts, &ActiveSet::SLIPPING);
        let changed = std::array::from_fn(|ball| rests.hold(ball));
        for index in (0..BALLS).filter(|&index| changed[index]) {
            self.close(index, now);
            self.launch(index, now, &states[index]);
        }
        self.tell_impact(now, impact, told)?;
        self.look_ahead(now, either(freed.is_some(), self.freed_members(), changed))
    }

    /// The next step of the balls in resting contact.
    #[cold]
    fn rest_on(&mut self, now: f64) -> ControlFlow<()> {
        let Some(mut resting) = self.resting.take() else { return ControlFlow::Continue(()) };
        let mut members: Vec<&mut BallState> =
            resting.end.iter_mut().zip(resting.members).filter_map(|(ball, member)| member.then_some(ball)).collect();
        still(self.constants.tolerance.still, self.constants.radius, &mut members);
        for index in (0..BALLS).filter(|&index| resting.members[index]) {
            self.close(index, now);
            self.launch(index, now, &resting.end[index]);
        }
        // Whether they go on resting is asked of all contacts together.
        self.pressed = true;
        self.look_ahead(now, resting.members)
    }

    /// Ends the resting contacts at `now` if one of the `changed` balls takes part: their members go on freely until it
    /// is known what presses now. Returns the states of all members.
    #[cold]
    fn release(&mut self, now: f64, changed: [bool; BALLS]) -> Option<[BallState; BALLS]> {
        let resting = self.resting.as_ref()?;
        if !(0..BALLS).any(|index| changed[index] && resting.members[index]) {
            return None;
        }
        let members = resting.members;
        self.cut(now);
        let states = self.resting.as_ref()?.end;
        for index in (0..BALLS).filter(|&index| members[index] && !changed[index]) {
            self.close(index, now);
            self.launch(index, now, &states[index]);
        }
        self.pressed = true;
        Some(states)
    }

    /// Ends the present step of the resting contacts at `now`.
    #[cold]
    fn cut(&mut self, now: f64) {
        let Some(resting) = &mut self.resting else { return };
        let time = now - resting.start;
        if time >= resting.step {
            return;
        }
        resting.cut(self.table, time);
        self.next_step = resting.next_step;
        for index in (0..BALLS).filter(|&index| resting.members[index] && time > 0.0) {
            let segment = &mut self.balls[index].segment;
            if segment.start == resting.start {
                let (half_acceleration, curve) = resting.course(index);
                (segment.half_acceleration, segment.curve) = (half_acceleration, Some(Box::new(curve)));
            }
        }
    }

    /// The balls of the resting contact that is still on record.
    fn freed_members(&self) -> [bool; BALLS] {
        self.resting.as_ref().map_or([false; BALLS], |resting| resting.members)
    }

    /// Sends a ball off on the free course that follows from its state.
    #[inline(always)]
    fn launch(&mut self, index: usize, now: f64, state: &BallState) {
        let (segment, lasts) = if self.steps <= MOST_STEPS {
            Segment::free(&self.constants, now, state)
        } else {
            let spin = glam::DVec3::new(0.0, 0.0, state.spin.z);
            Segment::free(&self.constants, now, &BallState { velocity: DVec2::ZERO, spin, ..*state })
        };
        self.set(index, segment, lasts);
    }

    /// Puts the balls that press and are pressed on their common course, and frees those that no longer are.
    #[cold]
    pub(super) fn press(&mut self, now: f64, changed: &mut [bool; BALLS]) -> ControlFlow<()> {
        if let Some(resting) = &self.resting
            && !self.pressed
            && !(0..BALLS).any(|index| changed[index] && resting.members[index])
        {
            return ControlFlow::Continue(());
        }
        self.cut(now);
        // Other members of a contact that goes on are part of the new one.
        let mut states: [BallState; BALLS] = match &self.resting {
            Some(resting) if resting.start < now => std::array::from_fn(|index| {
                if resting.members[index] && self.balls[index].segment.start < now {
                    resting.end[index]
                } else {
                    self.state(index, now)
                }
            }),
            _ => std::array::from_fn(|index| self.state(index, now)),
        };
        self.contact_step()?;
        let previous = self.resting.take();
        self.resting =
            match Resting::begin(self.table, &self.constants, now, &states, previous.as_deref(), self.next_step) {
                Outcome::Rests(resting) => {
                    self.next_step = resting.next_step;
                    for index in (0..BALLS).filter(|&index| !resting.members[index]) {
                        if resting.begin[index] != states[index] {
                            states[index] = resting.begin[index];
                            self.close(index, now);
                            self.launch(index, now, &states[index]);
                            changed[index] = true;
                        }
                    }
                    Some(resting)
                }
                Outcome::Free(ended, balls) => {
                    // A slip that ends here ends for good.
                    for index in (0..BALLS).filter(|&index| balls[index]) {
                        self.close(index, now);
                        self.launch(index, now, &ended[index]);
                        changed[index] = true;
                    }
                    states = ended;
                    None
                }
            };
        let members = self.freed_members();
        for index in 0..BALLS {
            let was = self.balls[index].mode;
            if members[index] {
                self.balls[index].mode = ContactMode::Resting;
                self.rest(index, now);
                changed[index] = true;
                if was == ContactMode::Free {
                    self.tell(now, EventKind::ContactBegins(index))?;
                }
            } else if was == ContactMode::Resting {
                self.balls[index].mode = ContactMode::Free;
                // A ball whose contact ended by what another did is still on its common course.
                if self.balls[index].segment.motion == Motion::Resting {
                    self.close(index, now);
                    self.launch(index, now, &states[index]);
                    changed[index] = true;
                }
                self.tell(now, EventKind::ContactEnds(index))?;
                if self.balls[index].segment.motion == Motion::Rolling {
                    self.tell(now, EventKind::SlidingRolling(index))?;
                } else if self.balls[index].segment.motion == Motion::Stationary {
                    self.tell(now, EventKind::RollingStationary(index))?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    #[cold]
    fn rest(&mut self, index: usize, now: f64) {
        let Some(resting) = &self.resting else { return };
        let state = &resting.begin[index];
        let (half_acceleration, curve) = resting.course(index);
        let step = resting.step;
        let segment = Segment {
            start: now,
            position: state.position,
            velocity: state.velocity,
            half_acceleration,
            spin: state.spin,
            motion: Motion::Resting,
            curve: Some(Box::new(curve)),
        };
        if self.balls[index].segment.start < now {
            self.close(index, now);
        }
        self.set(index, segment, step);
    }

    fn state(&self, index: usize, now: f64) -> BallState {
        let segment = &self.balls[index].segment;
        segment.state_after(&self.constants, now - segment.start)
    }

    #[inline(always)]
    pub(super) fn tell(&mut self, time: f64, kind: EventKind) -> ControlFlow<()> {
        let flow = self.observer.event(Event { time, kind });
        if S::EARLY_END { flow } else { ControlFlow::Continue(()) }
    }

    /// Hands a finished segment to an observer that records.
    #[inline]
    fn close(&mut self, index: usize, end: f64) {
        if O::SEGMENTS {
            self.observer.segment(index, &self.balls[index].segment, end);
        }
    }

    fn finish(mut self, time: f64) -> End {
        for index in 0..BALLS {
            self.close(index, time);
        }
        let balls = std::array::from_fn(|index| {
            let mut state = self.state(index, time);
            if self.balls[index].segment.motion == Motion::Stationary {
                state.velocity = DVec2::ZERO;
            }
            state
        });
        End { time, balls }
    }
}

fn only(index: usize) -> [bool; BALLS] {
    std::array::from_fn(|other| other == index)
}

fn either(freed: bool, of_contact: [bool; BALLS], changed: [bool; BALLS]) -> [bool; BALLS] {
    if freed { std::array::from_fn(|index| changed[index] || of_contact[index]) } else { changed }
}
