//! An observer that records a shot's whole course for the checks, and aborts a shot that does not end.

use std::{ops::ControlFlow, time::Instant};

use crate::{
    physics::{Impulse, strike},
    simulation::{Constants, End, Event, Observer, Segment, simulate},
    study::clock::timed,
    table::{BALLS, Layout, Table},
};

use super::Shot;

/// Number of events after which a shot is aborted. It is no limit of the engine: only a loop without progress comes near it.
const BREAK_AFTER_EVENTS: usize = 2_000_000;

/// Maximum number of stored events, and of stored pieces of one ball's course. The rest of a longer shot is only counted.
const MAX_STORED: usize = 200_000;

/// Computing time after which a shot is aborted, s.
const BREAK_AFTER_SECONDS: f64 = 10.0;

/// A piece of a ball's course and its end.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The segment of the course.
    pub segment: Segment,
    /// Time of its end, s.
    pub end: f64,
}

/// The course of one shot. It is reused for the next shot, so that a sweep does not allocate.
#[derive(Debug)]
pub struct Trace {
    /// The table's constants.
    pub constants: Constants,
    /// Initial positions of the balls.
    pub layout: Layout,
    /// Impulse of the stroke on the cue ball.
    pub impulse: Impulse,
    /// Events in order until [`Trace::kept_until`], bounces of resting contacts included.
    pub events: Vec<Event>,
    /// The pieces of every ball's course with a positive duration, in order.
    pub pieces: [Vec<Piece>; BALLS],
    /// Time until which everything is stored, s: infinity except for shots with far too many events.
    pub kept_until: f64,
    /// Number of events.
    pub event_count: usize,
    /// Number of steps of resting contacts and of bounces of chatters.
    pub contact_steps: usize,
    /// Number of pieces, those without duration included.
    pub steps: usize,
    /// The final state.
    pub end: End,
    /// Whether all balls came to rest; otherwise the shot was aborted.
    pub finished: bool,
    /// Computing time of the simulation, s: CPU time of the thread if available.
    pub seconds: f64,
    started: Instant,
}

impl Trace {
    /// Creates an empty trace for shots on `table`.
    pub fn new(table: &Table) -> Self {
        let still = crate::physics::BallState::at_rest(glam::DVec2::ZERO);
        Self {
            constants: Constants::of(table),
            layout: Layout::opening(table),
            impulse: Impulse::on_cloth(glam::DVec2::ZERO, glam::DVec3::ZERO),
            events: Vec::new(),
            pieces: [const { Vec::new() }; BALLS],
            kept_until: f64::INFINITY,
            event_count: 0,
            contact_steps: 0,
            steps: 0,
            end: End { time: 0.0, balls: [still; BALLS], off_table: [false; BALLS], is_exhausted: false },
            finished: true,
            seconds: 0.0,
            started: Instant::now(),
        }
    }

    /// Records the course of one shot.
    pub fn of(table: &Table, shot: &Shot) -> Self {
        let mut trace = Self::new(table);
        trace.play(table, shot);
        trace
    }

    /// Plays `shot` without validation, and records its course.
    pub fn play(&mut self, table: &Table, shot: &Shot) {
        let impulse = strike(table, &shot.cue.into());
        self.record(&shot.layout, &impulse, |trace| simulate(table, &shot.layout, &impulse, trace));
    }

    /// Records the course of a shot that starts from `layout` with `impulse` and is simulated by `play`.
    pub fn record(&mut self, layout: &Layout, impulse: &Impulse, play: impl FnOnce(&mut Self) -> End) {
        self.events.clear();
        self.pieces.iter_mut().for_each(Vec::clear);
        self.contact_steps = 0;
        (self.event_count, self.steps, self.finished, self.kept_until) = (0, 0, true, f64::INFINITY);
        (self.layout, self.impulse) = (*layout, *impulse);
        self.started = Instant::now();
        (self.end, self.seconds) = timed(|| play(self));
    }

    /// Stores an event or a bounce.
    fn store(&mut self, event: Event) {
        if self.kept_until == f64::INFINITY {
            self.events.push(event);
        }
        self.fill(self.events.len());
    }

    /// Aborts the shot after `most` of its `steps`, or if it takes too long.
    fn abort_after(&mut self, most: usize, steps: usize) -> ControlFlow<()> {
        // The clock is read rarely, because reading it costs as much as the physics.
        let too_long = steps.is_multiple_of(1024) && self.started.elapsed().as_secs_f64() > BREAK_AFTER_SECONDS;
        if too_long || steps >= most {
            self.finished = false;
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Stops recording once `count` items of a kind are stored.
    fn fill(&mut self, count: usize) {
        if count >= MAX_STORED && self.kept_until == f64::INFINITY {
            let ends = self.pieces.iter().map(|pieces| pieces.last().map_or(0.0, |piece| piece.end));
            self.kept_until = ends.fold(f64::INFINITY, f64::min);
        }
    }
}

impl Observer for Trace {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.event_count += 1;
        self.store(event);
        self.abort_after(BREAK_AFTER_EVENTS, self.event_count)
    }

    fn bounce(&mut self, bounce: Event) {
        // A bounce is no event of the shot, but an impact of its course.
        self.store(bounce);
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.contact_steps += 1;
        self.abort_after(usize::MAX, self.contact_steps)
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        self.steps += 1;
        // NaN must not pass as a piece without duration.
        if end != segment.start && self.kept_until == f64::INFINITY {
            self.pieces[ball].push(Piece { segment: segment.clone(), end });
            self.fill(self.pieces[ball].len());
        }
    }
}
