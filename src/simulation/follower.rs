//! Observer that samples the position of the cue ball at given times and records the rails that it hits.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{Event, EventKind, Observer, Segment, watch};
use crate::{
    physics::Impulse,
    table::{Layout, Rail, Table},
};

/// Returns a layout with the object balls far outside the table.
pub fn lone_ball_layout(position: DVec2) -> Layout {
    Layout::new([position, DVec2::new(1e3, 1e3), DVec2::new(-1e3, 1e3)])
}

/// Observer that follows the cue ball.
#[derive(Debug)]
pub struct Follower<'a> {
    times: &'a [f64],
    end: DVec2,
    /// Positions at the times that have passed, m.
    pub positions: Vec<DVec2>,
    /// Time, rail and centre of the ball for each rail impact.
    pub hits: Vec<(f64, Rail, DVec2)>,
    most_hits: usize,
}

impl<'a> Follower<'a> {
    /// Follows the ball until all `times`, in ascending order, have passed and `most_hits` rails have been hit.
    pub fn new(times: &'a [f64], most_hits: usize) -> Self {
        Self { times, end: DVec2::ZERO, positions: Vec::with_capacity(times.len()), hits: Vec::new(), most_hits }
    }

    /// Plays a shot. If the ball comes to rest before the last time, its position remains constant.
    #[must_use]
    pub fn follow(mut self, table: &Table, layout: &Layout, impulse: &Impulse) -> Self {
        self.end = layout.balls[0];
        watch(table, layout, impulse, &mut self);
        self.positions.resize(self.times.len(), self.end);
        self
    }
}

impl Observer for Follower<'_> {
    fn wants_segments(&self) -> bool {
        true
    }

    fn wants_ends(&self) -> bool {
        // The rail impacts are complete before the ball comes to rest.
        !self.times.is_empty()
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if let EventKind::BallRail(0, rail) = event.kind {
            self.hits.push((event.time, rail, self.end));
        }
        if self.positions.len() >= self.times.len() && self.hits.len() >= self.most_hits {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if ball != 0 {
            return;
        }
        while let Some(&time) = self.times.get(self.positions.len()).filter(|&&time| time < end) {
            self.positions.push(segment.position_after(time - segment.start));
        }
        self.end = segment.position_after(end - segment.start);
    }
}
