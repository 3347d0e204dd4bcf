//! Where the cue ball is at some times, and the rails that it meets.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{Event, EventKind, Observer, Segment, watch};
use crate::{
    physics::Impulse,
    table::{Layout, Rail, Table},
};

/// A layout whose object balls are out of the way.
pub fn alone(place: DVec2) -> Layout {
    Layout::new([place, DVec2::new(1e3, 1e3), DVec2::new(-1e3, 1e3)])
}

/// Follows the cue ball.
#[derive(Debug)]
pub struct Follower<'a> {
    times: &'a [f64],
    end: DVec2,
    /// The place at each of the times that have passed, m.
    pub places: Vec<DVec2>,
    /// Time, rail and the ball's centre there.
    pub hits: Vec<(f64, Rail, DVec2)>,
    most_hits: usize,
}

impl<'a> Follower<'a> {
    /// Follows until all `times`, ascending, have passed and `most_hits` rails have been met.
    pub fn new(times: &'a [f64], most_hits: usize) -> Self {
        Self { times, end: DVec2::ZERO, places: Vec::with_capacity(times.len()), hits: Vec::new(), most_hits }
    }

    /// Plays a shot; a ball that lies still before the last time stays where it is.
    #[must_use]
    pub fn of(mut self, table: &Table, layout: &Layout, impulse: &Impulse) -> Self {
        self.end = layout.balls[0];
        watch(table, layout, impulse, &mut self);
        self.places.resize(self.times.len(), self.end);
        self
    }
}

impl Observer for Follower<'_> {
    fn wants_segments(&self) -> bool {
        true
    }

    fn wants_ends(&self) -> bool {
        // Which rails are met is known before the ball rests.
        !self.times.is_empty()
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if let EventKind::BallRail(0, rail) = event.kind {
            self.hits.push((event.time, rail, self.end));
        }
        if self.places.len() >= self.times.len() && self.hits.len() >= self.most_hits {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if ball != 0 {
            return;
        }
        while let Some(&time) = self.times.get(self.places.len()).filter(|&&time| time < end) {
            self.places.push(segment.position_after(time - segment.start));
        }
        self.end = segment.position_after(end - segment.start);
    }
}
