//! Recording of one shot: its events, and the balls' states at any time, evaluated in closed form from the recorded segments.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{AllSavings, Constants, End, Event, Observer, Segment, simulate_with};
use crate::{
    physics::{BallState, CueError, CueInputs, Impulse, ImpulseError, Motion, SpatialState, strike},
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
    /// The initial motion of the cue ball is impossible.
    #[error(transparent)]
    Impulse(#[from] ImpulseError),
}

/// Initial condition of the cue ball.
#[derive(Clone, Copy, Debug)]
pub enum Start<'a> {
    /// A stroke. The motion that it causes is not limited.
    Stroke(&'a CueInputs),
    /// The motion just after the stroke, for example from a film, independent of the stroke.
    Motion(&'a Impulse),
}

impl Start<'_> {
    /// Returns the motion, if it is possible.
    fn impulse(self, table: &Table) -> Result<Impulse, ShotError> {
        match self {
            Self::Stroke(cue) => cue.validate().map(|()| strike(table, cue)).map_err(ShotError::from),
            Self::Motion(impulse) => impulse.validate().map(|()| *impulse).map_err(ShotError::from),
        }
    }
}

/// One shot from the stroke until the last ball is at rest.
#[derive(Clone, Debug)]
pub struct Recording {
    constants: Constants,
    impulse: Impulse,
    kept: Recorder,
    duration: f64,
}

impl Recording {
    /// Checks and plays a shot.
    ///
    /// # Errors
    /// The first problem of the layout or the stroke.
    pub fn new(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        Self::started(table, layout, Start::Stroke(cue))
    }

    /// Checks and plays a shot with this initial condition.
    ///
    /// # Errors
    /// The first problem of the layout, the stroke or the motion.
    pub fn started(table: &Table, layout: &Layout, start: Start<'_>) -> Result<Self, ShotError> {
        let play =
            |impulse: &Impulse, kept: &mut Recorder| (simulate_with::<AllSavings, _>(table, layout, impulse, kept), ());
        Ok(Self::record_with(table, layout, start, play)?.0)
    }

    /// Checks a shot and plays it by the function `play`, which can use any method. It receives the motion of the cue ball and a recorder
    /// for the events, and returns the end of the shot with any additional result. Afterwards all balls rest at their final positions.
    ///
    /// # Errors
    /// The first problem of the layout, the stroke or the motion.
    pub fn record_with<T>(
        table: &Table,
        layout: &Layout,
        start: Start<'_>,
        play: impl FnOnce(&Impulse, &mut Recorder) -> (End, T),
    ) -> Result<(Self, T), ShotError> {
        layout.validate(table)?;
        let impulse = start.impulse(table)?;
        // Capacity for an ordinary shot: a dozen events, most of them of the cue ball.
        let mut kept = Recorder { events: Vec::with_capacity(16), segments: [16, 4, 4].map(Vec::with_capacity) };
        let (end, more) = play(&impulse, &mut kept);
        for (ball, segments) in kept.segments.iter_mut().enumerate() {
            let BallState { position, spin, .. } = end.balls[ball];
            let motion = if end.off_table[ball] { Motion::OffTable } else { Motion::Stationary };
            segments.push(Segment { start: end.time, spin, motion, ..Segment::at_rest(position) });
        }
        Ok((Self { constants: Constants::of(table), impulse, kept, duration: end.time }, more))
    }

    /// Returns the motion of the cue ball just after the stroke.
    pub fn impulse(&self) -> &Impulse {
        &self.impulse
    }

    /// Returns all events in order of time.
    pub fn events(&self) -> &[Event] {
        &self.kept.events
    }

    /// Returns the time until the last ball is at rest, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns a ball's position, velocity and spin at time `t`, s; times are clamped to the shot's duration.
    pub fn state(&self, ball: usize, t: f64) -> BallState {
        let (segment, after) = self.segment(ball, t);
        segment.state_after(&self.constants, after)
    }

    /// Returns the motion phase of a ball at time `t`, s.
    pub fn motion(&self, ball: usize, t: f64) -> Motion {
        self.segment(ball, t).0.motion
    }

    /// Returns the balls' centres at time `t`, m.
    pub fn positions(&self, t: f64) -> [DVec2; BALLS] {
        std::array::from_fn(|ball| self.state(ball, t).position)
    }

    /// Returns the final layout; balls that have left the table are on their spots.
    pub fn final_layout(&self) -> Layout {
        let Constants { length, radius, .. } = self.constants;
        Layout::new(self.positions(self.duration)).with_spotted(length, radius, self.off_table())
    }

    /// Returns for each ball whether it leaves the table.
    pub fn off_table(&self) -> [bool; BALLS] {
        std::array::from_fn(|ball| self.motion(ball, self.duration) == Motion::OffTable)
    }

    /// Returns the height of a ball above its position on the cloth at time `t` (s), m.
    pub fn height(&self, ball: usize, t: f64) -> f64 {
        self.spatial_state(ball, t).position.z
    }

    /// Returns a ball's position, velocity and spin in three dimensions at time `t`, s.
    pub fn spatial_state(&self, ball: usize, t: f64) -> SpatialState {
        let (segment, after) = self.segment(ball, t);
        segment.spatial_after(&self.constants, after)
    }

    /// Returns the recorded segments of a ball in order of time; each is valid until the next one starts.
    pub fn segments(&self, ball: usize) -> &[Segment] {
        &self.kept.segments[ball]
    }

    /// Returns the segment that is valid at time `t`, and the time since its start, s.
    fn segment(&self, ball: usize, t: f64) -> (&Segment, f64) {
        let t = t.clamp(0.0, self.duration);
        let segments = &self.kept.segments[ball];
        let begun = segments.partition_point(|segment| segment.start <= t);
        let segment = &segments[begun.saturating_sub(1)];
        (segment, t - segment.start)
    }
}

/// The observer that stores events and segments for a [`Recording`].
#[derive(Clone, Debug)]
pub struct Recorder {
    events: Vec<Event>,
    segments: [Vec<Segment>; BALLS],
}

impl Observer for Recorder {
    fn wants_segments(&self) -> bool {
        true
    }

    #[inline]
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.events.push(event);
        ControlFlow::Continue(())
    }

    #[inline]
    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if end > segment.start {
            self.segments[ball].push(segment.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::simulate;
    use glam::DVec3;

    #[test]
    fn motion_of_a_stroke_plays_bit_identically_to_the_stroke() {
        let table = Table::default();
        let layout = Layout::parse("-1,0 0,0.02 0.6,0.1", &table).unwrap();
        let cue = CueInputs::parse("0.2,0.3,4,1,4").unwrap();
        let struck = Recording::new(&table, &layout, &cue).unwrap();
        let moved = Recording::started(&table, &layout, Start::Motion(struck.impulse())).unwrap();
        assert!(struck.events().len() > 5);
        assert_eq!(moved.events(), struck.events());
        assert_eq!((moved.duration(), moved.final_layout()), (struck.duration(), struck.final_layout()));
    }

    /// On a ball of 1 mm, a stroke causes a spin beyond the limit of an initial motion. No method may refuse it.
    #[test]
    fn strokes_may_exceed_the_limits_of_given_motions() {
        let table = Table { radius: 0.001, ..Table::preset("thesis").unwrap() };
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("0,0.45,0,0,25").unwrap();
        let shot = Recording::new(&table, &layout, &cue).unwrap();
        let play = |impulse: &Impulse, kept: &mut Recorder| (simulate(&table, &layout, impulse, kept), ());
        let (same, ()) = Recording::record_with(&table, &layout, Start::Stroke(&cue), play).unwrap();
        assert_eq!(same.events(), shot.events());
        let refused = Recording::record_with(&table, &layout, Start::Motion(shot.impulse()), play);
        assert!(matches!(refused, Err(ShotError::Impulse(ImpulseError::Spin(_)))), "{refused:?}");
    }

    #[test]
    fn spinning_ball_plays_and_impossible_motion_or_layout_is_refused() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let impulse = Impulse::on_cloth;
        let play = |layout: &Layout, impulse: &Impulse| Recording::started(&table, layout, Start::Motion(impulse));
        let still = play(&layout, &impulse(DVec2::ZERO, DVec3::ZERO)).unwrap();
        assert_eq!((still.duration(), still.events().len(), still.final_layout()), (0.0, 0, layout));
        let spinning = play(&layout, &impulse(DVec2::ZERO, DVec3::new(0.0, 0.0, 30.0))).unwrap();
        assert_eq!(spinning.final_layout(), layout, "on the spot");
        assert_eq!(spinning.state(0, 0.0).spin.z, 30.0);
        let draw = play(&layout, &impulse(DVec2::ZERO, DVec3::new(0.0, 60.0, 0.0))).unwrap();
        assert!(draw.final_layout().balls[0].x > layout.balls[0].x + 0.01, "spin about y carries it along x");
        let wild = play(&layout, &impulse(DVec2::new(f64::NAN, 0.0), DVec3::ZERO));
        assert!(matches!(wild, Err(ShotError::Impulse(_))), "{wild:?}");
        let nowhere = Layout::new([DVec2::ZERO; BALLS]);
        assert!(matches!(play(&nowhere, &impulse(DVec2::X, DVec3::ZERO)), Err(ShotError::Layout(_))));
    }
}
