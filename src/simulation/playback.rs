//! Everything of one shot: its events, and the balls at any time, read from the recorded segments without stepping.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{Constants, End, Event, Observer, Segment, Stepped, Steps, simulate};
use crate::{
    physics::{BallState, CueError, CueInputs, Impulse, Motion, strike},
    table::{BALLS, Layout, LayoutError, Table},
};

/// Why a shot cannot be played.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum ShotError {
    /// The layout is impossible.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The stroke is impossible.
    #[error(transparent)]
    Cue(#[from] CueError),
}

/// One shot from the stroke until the last ball stands still.
#[derive(Clone, Debug)]
pub struct Recording {
    constants: Constants,
    impulse: Impulse,
    events: Vec<Event>,
    segments: [Vec<Segment>; BALLS],
    duration: f64,
}

impl Recording {
    /// Checks and plays a shot.
    ///
    /// # Errors
    /// What is wrong with the layout or the stroke.
    pub fn new(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        layout.validate(table)?;
        cue.validate()?;
        let impulse = strike(table, cue);
        let mut recorder = Recorder::default();
        let end = simulate(table, layout, &impulse, &mut recorder);
        Ok(Self::of(table, impulse, recorder, &end))
    }

    /// The same by the intuitive method of fixed steps, and what the steps did.
    ///
    /// # Errors
    /// What is wrong with the layout or the stroke.
    pub fn stepped(
        table: &Table,
        layout: &Layout,
        cue: &CueInputs,
        steps: Steps,
    ) -> Result<(Self, Stepped), ShotError> {
        layout.validate(table)?;
        cue.validate()?;
        let impulse = strike(table, cue);
        let mut recorder = Recorder::default();
        let stepped = steps.simulate(table, layout, &impulse, &mut recorder);
        Ok((Self::of(table, impulse, recorder, &stepped.end), stepped))
    }

    fn of(table: &Table, impulse: Impulse, recorder: Recorder, end: &End) -> Self {
        let Recorder { events, mut segments } = recorder;
        for (ball, segments) in segments.iter_mut().enumerate() {
            let last =
                Segment { start: end.time, spin: end.balls[ball].spin, ..Segment::at_rest(end.balls[ball].position) };
            segments.push(last);
        }
        Self { constants: Constants::of(table), impulse, events, segments, duration: end.time }
    }

    /// What the stroke gave the cue ball.
    pub fn impulse(&self) -> &Impulse {
        &self.impulse
    }

    /// All events in order of time.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Time until the last ball stands still, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// A ball's position, velocity and spin at time `t`, s; at rest before the stroke and after the end.
    pub fn state(&self, ball: usize, t: f64) -> BallState {
        let (segment, after) = self.segment(ball, t);
        segment.state_after(&self.constants, after)
    }

    /// Which equation of motion a ball follows at time `t`, s.
    pub fn motion(&self, ball: usize, t: f64) -> Motion {
        self.segment(ball, t).0.motion
    }

    /// The balls' centres at time `t`, m.
    pub fn positions(&self, t: f64) -> [DVec2; BALLS] {
        std::array::from_fn(|ball| {
            let (segment, after) = self.segment(ball, t);
            segment.position_after(after)
        })
    }

    /// Where the balls come to rest.
    pub fn final_layout(&self) -> Layout {
        Layout::new(self.positions(self.duration))
    }

    /// The recorded segments of a ball, in order of time; each holds until the next one starts.
    pub fn segments(&self, ball: usize) -> &[Segment] {
        &self.segments[ball]
    }

    /// The segment that holds at time `t`, and how long it has then lasted, s.
    fn segment(&self, ball: usize, t: f64) -> (&Segment, f64) {
        let t = t.clamp(0.0, self.duration);
        let segments = &self.segments[ball];
        let begun = segments.partition_point(|segment| segment.start <= t);
        let segment = &segments[begun.saturating_sub(1)];
        (segment, t - segment.start)
    }
}

/// Keeps everything.
#[derive(Default)]
struct Recorder {
    events: Vec<Event>,
    segments: [Vec<Segment>; BALLS],
}

impl Observer for Recorder {
    const SEGMENTS: bool = true;

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.events.push(event);
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if end > segment.start {
            self.segments[ball].push(*segment);
        }
    }
}
