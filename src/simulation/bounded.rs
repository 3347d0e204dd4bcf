//! Recording with limits on time and on the number of events: a valid table may still be too stiff to be simulated in reasonable time.

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use super::{Event, Observer, Recorder, Recording, Segment, ShotError, Start, simulate};
use crate::table::{BALLS, Layout, Table};

/// An observer that records until a limit is reached.
#[derive(Debug)]
pub struct BoundedRecorder<'a> {
    recorder: &'a mut Recorder,
    until: Instant,
    /// Events and steps that may still follow.
    left: u32,
    is_over: bool,
}

impl<'a> BoundedRecorder<'a> {
    /// Records for at most `longest`, and at most `most` events and steps of resting contacts.
    pub fn new(recorder: &'a mut Recorder, longest: Duration, most: u32) -> Self {
        Self { recorder, until: Instant::now() + longest, left: most, is_over: false }
    }

    /// Whether the shot was given up.
    pub const fn is_over(&self) -> bool {
        self.is_over
    }

    fn check_limits(&mut self) -> ControlFlow<()> {
        self.is_over |= self.left == 0 || Instant::now() > self.until;
        self.left = self.left.saturating_sub(1);
        if self.is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Observer for BoundedRecorder<'_> {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.recorder.event(event)?;
        self.check_limits()
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.check_limits()
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        self.recorder.segment(ball, segment, end);
    }
}

impl Recording {
    /// Checks a shot and plays it within the limits of [`BoundedRecorder::new`]; also returns whether it was given up.
    ///
    /// # Errors
    /// As [`Recording::record_with`].
    pub fn within_bounds(
        table: &Table,
        layout: &Layout,
        start: Start<'_>,
        longest: Duration,
        most: u32,
    ) -> Result<(Self, bool), ShotError> {
        Self::record_with(table, layout, start, |impulse, recorder| {
            let mut bounded = BoundedRecorder::new(recorder, longest, most);
            let end = simulate(table, layout, impulse, &mut bounded);
            (end, end.is_exhausted || bounded.is_over())
        })
    }

    /// Whether all numbers of the recording are finite.
    pub fn is_finite(&self) -> bool {
        let end = self.duration();
        end.is_finite()
            && self.final_layout().balls.iter().all(|position| position.is_finite())
            && (0..BALLS).all(|ball| self.state(ball, end).spin.is_finite())
            && self.events().iter().all(|event| event.time.is_finite())
    }
}
