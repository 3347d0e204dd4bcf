//! The cue ball's way after it has met its first ball: where the other one could have lain to be met, too.

use std::ops::ControlFlow;

use glam::DVec2;

use crate::{
    learning::evaluation::CONTACT_STEPS,
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Segment, StepBudget, watch},
    table::{Layout, Table},
};

/// What is kept of a shot.
#[derive(Debug)]
pub struct CueWay {
    /// The ball that the cue ball met first, and when, s.
    pub met: Option<(usize, f64)>,
    /// Pieces of the way and when they end, s.
    segments: Vec<(Segment, f64)>,
    patience: StepBudget,
}

impl CueWay {
    /// Plays a shot, with at most [`CONTACT_STEPS`] steps of resting contacts.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Self {
        let mut way = Self { met: None, segments: Vec::new(), patience: StepBudget(CONTACT_STEPS) };
        watch(table, layout, &strike(table, cue), &mut way);
        way
    }

    /// Where the cue ball was at `time` and how fast, m and m/s; nothing before its first meeting or after its end.
    pub fn at(&self, time: f64) -> Option<[DVec2; 2]> {
        let (segment, _) = self.segments.iter().find(|(segment, end)| segment.start <= time && time <= *end)?;
        Some([segment.position_after(time - segment.start), segment.velocity_after(time - segment.start)])
    }
}

impl Observer for CueWay {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if let EventKind::BallBall(0, ball) = event.kind
            && self.met.is_none()
        {
            self.met = Some((ball, event.time));
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if ball == 0 && self.met.is_some() {
            self.segments.push((segment.clone(), end));
        }
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.patience.step()
    }
}
