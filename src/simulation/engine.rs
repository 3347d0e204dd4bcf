//! The event-driven engine (thesis 3.2 and Algorithm 1): from one event to the next, with nothing in between.

use std::{marker::PhantomData, ops::ControlFlow};

use super::{
    Constants, Event, EventKind, Observer, Rail, Segment,
    crowd::Crowd,
    resting::{Resting, STILL_AT_REST},
    savings::{All, Savings},
    segment::{STILL, still},
    settling::{FASTEST, settles},
    touches::PAIRS,
};
use crate::{
    physics::{BallState, Impulse, Motion, Touch, collide_balls, collide_rail},
    table::{BALLS, Layout, Table},
};

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
    /// Whether a resting contact holds it.
    pub(super) resting: bool,
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
    /// Whether a prediction has found balls pressed together that are not yet in `resting`.
    pub(super) pressed: bool,
    pub(super) crowd: Crowd,
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
            pressed: false,
            crowd: Crowd::NONE,
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
        if ended == Motion::Sliding {
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
        let Ball { rail_after, rail, .. } = self.balls[index];
        self.crowd.rebound();
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
        let touch = Touch { first: index, second: None, rail_normal: n };
        if state.velocity.dot(n) <= FASTEST && self.settle(now, freed.as_ref(), &touch, &[(index, state)]) {
            state = before;
            collide_rail(c.radius, 0.0, c.rail_friction, n, &mut state);
            state.velocity -= state.velocity.dot(n) * n;
        }
        still(STILL * self.crowd.stillness(), c.radius, &mut [&mut state]);
        self.close(index, now);
        self.launch(index, now, &state);
        self.tell(now, EventKind::BallRail(index, rail))?;
        if freed.is_some() {
            self.look_ahead(now, members(true, self.freed_members(), only(index)))
        } else {
            self.look_ahead_of(now, index)
        }
    }

    fn collide(&mut self, pair: usize, now: f64) -> ControlFlow<()> {
        let (first, second) = PAIRS[pair];
        let Meeting { since, after, .. } = self.pairs[pair];
        self.crowd.impact(now);
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
        let touch = Touch { first, second: Some(second), rail_normal: glam::DVec2::ZERO };
        let opening = (a.velocity - b.velocity).dot(a.position - b.position);
        if opening <= 2.0 * c.radius * FASTEST && self.settle(now, freed.as_ref(), &touch, &[(first, a), (second, b)]) {
            (a, b) = before;
            collide_balls(c.radius, 0.0, c.ball_friction, &mut a, &mut b);
        }
        still(STILL * self.crowd.stillness(), c.radius, &mut [&mut a, &mut b]);
        self.close(first, now);
        self.close(second, now);
        self.launch(first, now, &a);
        self.launch(second, now, &b);
        self.tell(now, EventKind::BallBall(first, second))?;
        self.look_ahead(now, members(freed.is_some(), self.freed_members(), changed))
    }

    /// Whether a contact that has just bounced comes to rest; `bounced` are its balls after the bounce.
    #[cold]
    fn settle(
        &self,
        now: f64,
        freed: Option<&[BallState; BALLS]>,
        touch: &Touch,
        bounced: &[(usize, BallState)],
    ) -> bool {
        let mut balls = std::array::from_fn(|index| match freed {
            Some(states) if self.freed_members()[index] => states[index],
            _ => self.state(index, now),
        });
        for (index, state) in bounced {
            balls[*index] = *state;
        }
        settles(self.table, &self.constants, touch, &balls, self.crowd.coarseness())
    }

    /// The next step of the balls in resting contact.
    #[cold]
    fn rest_on(&mut self, now: f64) -> ControlFlow<()> {
        let Some(mut resting) = self.resting.take() else { return ControlFlow::Continue(()) };
        let mut members: Vec<&mut BallState> =
            resting.end.iter_mut().zip(resting.members).filter_map(|(ball, member)| member.then_some(ball)).collect();
        still(STILL_AT_REST * self.crowd.stillness(), self.constants.radius, &mut members);
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
        let states = resting.after(self.table, now - resting.start);
        for index in (0..BALLS).filter(|&index| members[index] && !changed[index]) {
            self.close(index, now);
            self.launch(index, now, &states[index]);
        }
        self.pressed = true;
        Some(states)
    }

    /// The balls of the resting contact that is still on record.
    fn freed_members(&self) -> [bool; BALLS] {
        self.resting.as_ref().map_or([false; BALLS], |resting| resting.members)
    }

    /// Sends a ball off on the free course that follows from its state.
    #[inline(always)]
    fn launch(&mut self, index: usize, now: f64, state: &BallState) {
        let (segment, lasts) = Segment::free(&self.constants, now, state);
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
        // Other members of a contact that goes on are part of the new one.
        let states: [BallState; BALLS] = match &self.resting {
            Some(resting) if resting.start < now => {
                let at = resting.after(self.table, now - resting.start);
                std::array::from_fn(|index| {
                    if resting.members[index] && self.balls[index].segment.start < now {
                        at[index]
                    } else {
                        self.state(index, now)
                    }
                })
            }
            _ => std::array::from_fn(|index| self.state(index, now)),
        };
        self.observer.contact_step()?;
        self.crowd.step();
        let coarseness = self.crowd.coarseness();
        self.resting = Resting::begin(self.table, &self.constants, now, &states, self.resting.as_deref(), coarseness)
            .map(Box::new);
        let members = self.freed_members();
        for index in 0..BALLS {
            let was = std::mem::replace(&mut self.balls[index].resting, members[index]);
            if members[index] {
                self.rest(index, now);
                changed[index] = true;
            }
            if members[index] && !was {
                self.tell(now, EventKind::ContactBegins(index))?;
            } else if was && !members[index] {
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
                state.velocity = glam::DVec2::ZERO;
            }
            state
        });
        End { time, balls }
    }
}

fn only(index: usize) -> [bool; BALLS] {
    std::array::from_fn(|other| other == index)
}

fn members(freed: bool, of_contact: [bool; BALLS], changed: [bool; BALLS]) -> [bool; BALLS] {
    if freed { std::array::from_fn(|index| changed[index] || of_contact[index]) } else { changed }
}
