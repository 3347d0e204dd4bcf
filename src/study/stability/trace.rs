//! The observer that keeps a shot's whole course for the checks, and breaks a shot off that does not end.

use std::{ops::ControlFlow, time::Instant};

use crate::{
    physics::{Impulse, Motion, strike},
    simulation::{Constants, End, Event, Observer, Segment, simulate},
    study::clock::timed,
    table::{BALLS, Layout, Table},
};

use super::Shot;

/// Events after which a shot is broken off. It is no limit of the engine: nothing but a loop without progress comes near.
const BREAK_AFTER_EVENTS: usize = 2_000_000;

/// Events, and pieces of one ball's course, that are kept; the rest of a shot that needs more are counted.
const KEPT: usize = 20_000;

/// A shot is broken off after this long, s.
const BREAK_AFTER_SECONDS: f64 = 10.0;

/// A piece of a ball's course with the time at which it ended, s.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The course.
    pub segment: Segment,
    /// When it ended, s.
    pub end: f64,
}

/// One shot's course. It is used again for the next shot, so that a sweep does not allocate.
#[derive(Debug)]
pub struct Trace {
    /// The table's numbers.
    pub constants: Constants,
    /// Where the balls stood.
    pub layout: Layout,
    /// What the stroke gave the cue ball.
    pub impulse: Impulse,
    /// Events in order, until [`Trace::kept_until`].
    pub events: Vec<Event>,
    /// The pieces of every ball's course that last longer than nothing, in order.
    pub pieces: [Vec<Piece>; BALLS],
    /// Time until which everything is kept, s: infinity but for shots with far too many events.
    pub kept_until: f64,
    /// How many events there were.
    pub event_count: usize,
    /// Steps of resting contacts and bounces of chatters.
    pub contact_steps: usize,
    /// How many pieces there were, those of no length too.
    pub steps: usize,
    /// How the shot ended.
    pub end: End,
    /// Whether all balls came to rest; otherwise the shot was broken off.
    pub finished: bool,
    /// Time that the simulation took, s: the thread's own, where that is to be had.
    pub seconds: f64,
    started: Instant,
}

impl Trace {
    /// An empty trace for shots on `table`.
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
            end: End { time: 0.0, balls: [still; BALLS], off_table: [false; BALLS] },
            finished: true,
            seconds: 0.0,
            started: Instant::now(),
        }
    }

    /// Plays `shot`, which is taken as it is, and keeps its course.
    pub fn play(&mut self, table: &Table, shot: &Shot) {
        let impulse = strike(table, &shot.cue.into());
        self.record(&shot.layout, &impulse, |trace| simulate(table, &shot.layout, &impulse, trace));
    }

    /// Keeps the course of a shot from `layout` that begins with `impulse` and that `play` plays.
    pub fn record(&mut self, layout: &Layout, impulse: &Impulse, play: impl FnOnce(&mut Self) -> End) {
        self.events.clear();
        self.pieces.iter_mut().for_each(Vec::clear);
        self.contact_steps = 0;
        (self.event_count, self.steps, self.finished, self.kept_until) = (0, 0, true, f64::INFINITY);
        (self.layout, self.impulse) = (*layout, *impulse);
        self.started = Instant::now();
        (self.end, self.seconds) = timed(|| play(self));
    }

    /// Whether a ball has been in the air.
    pub fn has_flights(&self) -> bool {
        self.pieces.iter().flatten().any(|piece| piece.segment.motion == Motion::Flying)
    }

    /// Keeps no more once there are `count` of something.
    fn fill(&mut self, count: usize) {
        if count >= KEPT && self.kept_until == f64::INFINITY {
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
        if self.kept_until == f64::INFINITY {
            self.events.push(event);
        }
        self.fill(self.events.len());
        // The clock is read rarely: it would cost as much as the physics.
        let too_long =
            self.event_count.is_multiple_of(1024) && self.started.elapsed().as_secs_f64() > BREAK_AFTER_SECONDS;
        if too_long || self.event_count >= BREAK_AFTER_EVENTS {
            self.finished = false;
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn bounce(&mut self, bounce: Event) {
        // It is no event of the shot, but an impact of its course.
        if self.kept_until == f64::INFINITY {
            self.events.push(bounce);
        }
        self.fill(self.events.len());
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.contact_steps += 1;
        let too_long =
            self.contact_steps.is_multiple_of(1024) && self.started.elapsed().as_secs_f64() > BREAK_AFTER_SECONDS;
        if too_long {
            self.finished = false;
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        self.steps += 1;
        // NaN must not slip through as a piece of no length.
        if end != segment.start && self.kept_until == f64::INFINITY {
            self.pieces[ball].push(Piece { segment: segment.clone(), end });
            self.fill(self.pieces[ball].len());
        }
    }
}
