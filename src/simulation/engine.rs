//! The event-driven engine (thesis 3.2 and Algorithm 1): it advances from one event to the next, without time steps.

use std::{marker::PhantomData, ops::ControlFlow};

use glam::DVec2;

use super::{
    Constants, Event, EventKind, Observer, Rail, Segment,
    chatter::Chatters,
    guards::{AIR_BUDGET, BUDGET_WITHOUT_REST, ITERATION_COST, LAST_RESORT, RESTING_BUDGET},
    resting::Resting,
    savings::{AllSavings, Savings},
};
use crate::{
    physics::{BallState, Cloth, Effort, ImpactLaw, Impulse, Motion},
    table::{BALLS, Layout, PAIRS, Table},
};

/// Impacts within this time count as simultaneous, s: about two roundings of a time of two seconds.
pub(super) const SAME_TIME: f64 = 1e-15;

/// Final state of a simulation: all balls are at rest, or the shot was ended by the observer or because it took too much work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Time of the last event, s.
    pub time: f64,
    /// States of the balls at that time.
    pub balls: [BallState; BALLS],
    /// Whether each ball has left the table; such a ball stays where it left.
    pub off_table: [bool; BALLS],
    /// Whether the shot took so much work that it was ended before the balls were at rest: the state is not that of a real shot.
    pub is_exhausted: bool,
}

impl End {
    /// Returns the final layout; balls that have left the table are on their spots.
    pub fn layout(&self, table: &Table) -> Layout {
        Layout::new(self.balls.map(|ball| ball.position)).with_spotted(table.length, table.radius, self.off_table)
    }
}

/// Plays a shot: the cue ball starts with `impulse`, and `observer` receives the events until all balls are at rest or it breaks. The
/// layout is not checked: see [`Layout::validate`].
///
/// Deterministic: every run of the same shot gives identical bits.
pub fn simulate(table: &Table, layout: &Layout, impulse: &Impulse, observer: &mut dyn Observer) -> End {
    simulate_with::<AllSavings, _>(table, layout, impulse, observer)
}

/// As [`simulate`], monomorphized for one type of observer, which is faster: for callers that play millions of shots. `S` disables
/// optimizations, to measure their effect.
pub fn simulate_with<S: Savings, O: Observer + ?Sized>(
    table: &Table,
    layout: &Layout,
    impulse: &Impulse,
    observer: &mut O,
) -> End {
    let mut engine = Engine::<S, O>::new(table, layout, observer);
    let time = engine.run(impulse);
    engine.finish(time)
}

/// As [`simulate`], only for the observer's events: the final state is not computed.
pub fn watch(table: &Table, layout: &Layout, impulse: &Impulse, observer: &mut dyn Observer) {
    watch_with::<AllSavings, _>(table, layout, impulse, observer);
}

/// As [`watch`], monomorphized for one type of observer.
pub fn watch_with<S: Savings, O: Observer + ?Sized>(
    table: &Table,
    layout: &Layout,
    impulse: &Impulse,
    observer: &mut O,
) {
    Engine::<S, O>::new(table, layout, observer).run(impulse);
}

/// Contact mode of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ContactMode {
    /// Free motion, on the cloth or in the air, with occasional impacts.
    Free,
    /// Chatter: the bounces are simulated one by one, but reported only as the beginning of a contact. Also after a resting contact, while
    /// the ball may bounce again.
    Bouncing,
    /// Resting contact, the limit of the bounces.
    Resting,
}

/// The present trajectory of a ball and its own next event.
pub(super) struct Ball {
    pub(super) segment: Segment,
    /// Duration of the motion, s after the segment's start.
    pub(super) duration: f64,
    /// When the ball hits `rail`, s after the segment's start; infinity if never.
    pub(super) rail_after: f64,
    pub(super) rail: Rail,
    pub(super) mode: ContactMode,
}

/// Predicted collision of a pair: `after` seconds after `since`. Both are stored, because their sum is rounded.
#[derive(Clone, Copy)]
pub(super) struct PairPrediction {
    pub(super) since: f64,
    pub(super) after: f64,
    /// Whether a resting contact of the pair was possible when this was predicted.
    pub(super) may_rest: bool,
}

impl PairPrediction {
    /// No collision is known at `since`.
    pub(super) const fn none(since: f64, may_rest: bool) -> Self {
        Self { since, after: f64::INFINITY, may_rest }
    }
}

pub(super) struct Engine<'a, S, O: ?Sized> {
    pub(super) table: &'a Table,
    pub(super) constants: Constants,
    pub(super) law: ImpactLaw,
    /// Whether all impacts on this table are perfectly inelastic.
    pub(super) inelastic: bool,
    /// The cloth, if balls can leave it.
    pub(super) cloth: Option<Cloth>,
    pub(super) observer: &'a mut O,
    pub(super) balls: [Ball; BALLS],
    pub(super) pairs: [PairPrediction; PAIRS.len()],
    /// Time of the next event of each ball, then of each pair, s; infinity for none.
    pub(super) times: [f64; BALLS + PAIRS.len()],
    pub(super) resting: Option<Box<Resting>>,
    /// The contact step that has just ended, until the next active set is known.
    pub(super) ended: Option<Box<Resting>>,
    /// Longest step that the next resting contact tries, s.
    pub(super) next_step: f64,
    /// Whether a prediction has found balls that press on each other but are not yet in `resting`.
    pub(super) pressed: bool,
    /// Time of the last impact, s, and the number of impacts at that moment.
    pub(super) last_impact: f64,
    pub(super) rounds: u32,
    /// Work of the event loops, chatters and resting contacts so far; after the switch to micro-collisions, since then.
    pub(super) effort: Effort,
    /// Work of impacts in the air, which micro-collisions would not reduce.
    pub(super) effort_in_air: Effort,
    /// Law of slow impacts after resting contacts have been disabled.
    pub(super) micro_collisions: Option<Box<ImpactLaw>>,
    /// Records of slow bounces.
    pub(super) chatters: Chatters,
    savings: PhantomData<S>,
}

impl<'a, S: Savings, O: Observer + ?Sized> Engine<'a, S, O> {
    pub(super) fn new(table: &'a Table, layout: &Layout, observer: &'a mut O) -> Self {
        let restitution = table.largest_restitution();
        Self {
            table,
            constants: Constants::of(table),
            law: ImpactLaw::of(table),
            inelastic: restitution == 0.0,
            cloth: Cloth::of(table),
            observer,
            balls: layout.balls.map(Ball::at_rest),
            pairs: [PairPrediction::none(0.0, false); PAIRS.len()],
            times: [f64::INFINITY; BALLS + PAIRS.len()],
            resting: None,
            ended: None,
            next_step: f64::INFINITY,
            pressed: false,
            last_impact: f64::NEG_INFINITY,
            rounds: 0,
            effort: Effort::default(),
            effort_in_air: Effort::default(),
            micro_collisions: None,
            chatters: Chatters::default(),
            savings: PhantomData,
        }
    }

    /// Plays the shot. Returns the time of the last event.
    pub(super) fn run(&mut self, impulse: &Impulse) -> f64 {
        let cue_ball =
            BallState { position: self.balls[0].segment.position, velocity: impulse.velocity, spin: impulse.spin };
        let mut flow = ControlFlow::Continue(());
        if impulse.lift > 0.0 {
            flow = self.lift(0, 0.0, cue_ball, impulse.lift);
        } else {
            self.launch(0, 0.0, &cue_ball);
        }
        if flow.is_continue() {
            flow = self.predict_ball(0.0, 0);
        }
        self.run_events(flow)
    }

    /// Runs the event loop from the stroke to the end. Returns the time of the last event.
    #[inline(always)]
    pub(super) fn run_events(&mut self, mut flow: ControlFlow<()>) -> f64 {
        let mut now = 0.0;
        if S::LONE_BALL && S::KEPT_PREDICTIONS && flow.is_continue() && self.is_only_moving_ball(0) {
            flow = self.play_lone_ball(0, &mut now);
        }
        while flow.is_continue() && self.effort.spent() + self.effort_in_air.spent() < LAST_RESORT {
            self.effort.add(ITERATION_COST);
            if self.resting_budget_spent() {
                flow = self.begin_micro_collisions(now);
                if flow.is_break() {
                    break;
                }
            }
            let (mut next, mut source) = (f64::INFINITY, usize::MAX);
            for (index, &time) in self.times.iter().enumerate() {
                if time < next {
                    (next, source) = (time, index);
                }
            }
            // An event that follows sooner may close a contact again.
            if next - now > self.constants.tolerance.shortest_parting
                && self.balls.iter().any(|ball| ball.mode == ContactMode::Bouncing)
            {
                let nothing = source == usize::MAX || self.only_rolls_out(source);
                flow = self.report_free(now, nothing);
            }
            if flow.is_break()
                || source == usize::MAX
                || (S::LAST_ROLLS && !self.observer.wants_ends() && self.only_rolls_out(source))
            {
                break;
            }
            flow = match source.checked_sub(BALLS) {
                Some(pair) => self.collide(pair, next),
                None if self.balls[source].rail_after < self.balls[source].duration => self.rebound(source, next),
                None => match self.balls[source].segment.motion {
                    Motion::Resting => self.continue_resting(next),
                    Motion::Flying => self.stay_on_cloth(source, &mut next),
                    _ => self.change_motion(source, next),
                },
            };
            now = next;
        }
        now
    }

    /// Whether the only remaining event is this ball's next one, and it rolls to rest without an impact.
    #[inline(always)]
    fn only_rolls_out(&self, source: usize) -> bool {
        source < BALLS
            && self.balls[source].segment.motion == Motion::Rolling
            && self.balls[source].rail_after == f64::INFINITY
            && self.balls[source].segment.rolls_to_rest(&self.constants)
            && (0..self.times.len()).all(|other| other == source || self.times[other] == f64::INFINITY)
    }

    /// Handles the end of sliding or rolling.
    #[inline(always)]
    fn change_motion(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        let ball = &self.balls[index];
        let ended = ball.segment.motion;
        let (mut segment, duration) = ball.segment.successor(&self.constants, ball.duration);
        segment.start = now;
        self.end_segment(index, now);
        // For a bouncing ball, this is reported when its contact is known to have ended.
        let bounces = self.balls[index].mode == ContactMode::Bouncing;
        if ended == Motion::Sliding && !bounces {
            self.report(now, EventKind::SlidingRolling(index))?;
        }
        if segment.motion == Motion::Stationary && !bounces {
            self.report(now, EventKind::RollingStationary(index))?;
        }
        self.set(index, segment, duration);
        self.predict_ball(now, index)
    }

    /// Starts the free trajectory of a ball from its state.
    #[inline(always)]
    pub(super) fn launch(&mut self, index: usize, now: f64, state: &BallState) {
        let (segment, duration) = if self.is_exhausted() {
            let spin = glam::DVec3::new(0.0, 0.0, state.spin.z);
            Segment::free(&self.constants, now, &BallState { velocity: DVec2::ZERO, spin, ..*state })
        } else {
            Segment::free(&self.constants, now, state)
        };
        self.set(index, segment, duration);
    }

    /// Ends the present trajectories of the selected balls and starts free ones from these states.
    pub(super) fn relaunch(&mut self, now: f64, which: [bool; BALLS], states: &[BallState; BALLS]) {
        for index in (0..BALLS).filter(|&index| which[index]) {
            self.end_segment(index, now);
            self.launch(index, now, &states[index]);
        }
    }

    /// Whether the work exceeds the budget for shots with resting contacts.
    pub(super) fn resting_budget_spent(&self) -> bool {
        self.micro_collisions.is_none() && self.effort.spent() > RESTING_BUDGET
    }

    /// Whether the work of the shot exceeds its budget.
    pub(super) fn is_exhausted(&self) -> bool {
        let in_air = self.effort_in_air.spent();
        self.micro_collisions.is_some() && self.effort.spent() + in_air > BUDGET_WITHOUT_REST || in_air > AIR_BUDGET
    }

    pub(super) fn state(&self, index: usize, now: f64) -> BallState {
        let segment = &self.balls[index].segment;
        segment.state_after(&self.constants, now - segment.start)
    }

    #[inline(always)]
    pub(super) fn report(&mut self, time: f64, kind: EventKind) -> ControlFlow<()> {
        let flow = self.observer.event(Event { time, kind });
        if S::EARLY_END { flow } else { ControlFlow::Continue(()) }
    }

    /// Reports that a ball rolls, is at rest or is in the air: its motion has not been reported for a while.
    pub(super) fn report_motion(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        match self.balls[index].segment.motion {
            Motion::Rolling => self.report(now, EventKind::SlidingRolling(index)),
            Motion::Stationary => self.report(now, EventKind::RollingStationary(index)),
            Motion::Flying => self.report(now, EventKind::Jumps(index)),
            _ => ControlFlow::Continue(()),
        }
    }

    /// Reports that a free ball begins to bounce slowly.
    pub(super) fn begin_contact(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        if self.balls[index].mode != ContactMode::Free {
            return ControlFlow::Continue(());
        }
        self.balls[index].mode = ContactMode::Bouncing;
        self.report(now, EventKind::ContactBegins(index))
    }

    /// Passes a finished segment to an observer that records.
    #[inline]
    pub(super) fn end_segment(&mut self, index: usize, end: f64) {
        if self.observer.wants_segments() {
            self.observer.segment(index, &self.balls[index].segment, end);
        }
    }

    pub(super) fn finish(mut self, time: f64) -> End {
        for index in 0..BALLS {
            self.end_segment(index, time);
        }
        let balls = std::array::from_fn(|index| {
            let mut state = self.state(index, time);
            if matches!(self.balls[index].segment.motion, Motion::Stationary | Motion::OffTable) {
                state.velocity = DVec2::ZERO;
            }
            state
        });
        let off_table = std::array::from_fn(|index| self.balls[index].segment.motion == Motion::OffTable);
        End { time, balls, off_table, is_exhausted: self.is_exhausted() }
    }
}

pub(super) fn only_ball(index: usize) -> [bool; BALLS] {
    std::array::from_fn(|other| other == index)
}
