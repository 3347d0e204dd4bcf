//! Everything of one shot: its events, and the balls at any time, read from the recorded segments without stepping.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{All, Constants, End, Event, Observer, Segment, simulate_with};
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
    /// The motion that the cue ball is to have is impossible.
    #[error(transparent)]
    Impulse(#[from] ImpulseError),
}

/// What sets the cue ball in motion.
#[derive(Clone, Copy, Debug)]
pub enum Start<'a> {
    /// A stroke. Whatever motion it gives is accepted.
    Stroke(&'a CueInputs),
    /// The motion just after the stroke, as a film shows it, whatever stroke has given it.
    Motion(&'a Impulse),
}

impl Start<'_> {
    /// The motion, if it is possible.
    fn impulse(self, table: &Table) -> Result<Impulse, ShotError> {
        match self {
            Self::Stroke(cue) => cue.validate().map(|()| strike(table, cue)).map_err(ShotError::from),
            Self::Motion(impulse) => impulse.validate().map(|()| *impulse).map_err(ShotError::from),
        }
    }
}

/// One shot from the stroke until the last ball stands still.
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
    /// What is wrong with the layout or the stroke.
    pub fn new(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        Self::simulated(table, layout, Start::Stroke(cue))
    }

    /// Checks and plays a shot in which the cue ball has this motion just after the stroke.
    ///
    /// # Errors
    /// What is wrong with the layout or the motion.
    pub fn with_impulse(table: &Table, layout: &Layout, impulse: &Impulse) -> Result<Self, ShotError> {
        Self::simulated(table, layout, Start::Motion(impulse))
    }

    fn simulated(table: &Table, layout: &Layout, start: Start<'_>) -> Result<Self, ShotError> {
        let play = |impulse: &Impulse, kept: &mut Recorder| (simulate_with::<All, _>(table, layout, impulse, kept), ());
        Ok(Self::played_by(table, layout, start, play)?.0)
    }

    /// Checks a shot and lets `play` play it, by whatever method: it gets what the stroke gives the cue ball, tells the
    /// recorder what happens, and returns how the shot ended with anything else that it has to say. All balls then rest where they
    /// have come to.
    ///
    /// # Errors
    /// What is wrong with the layout, the stroke or the motion.
    pub fn played_by<T>(
        table: &Table,
        layout: &Layout,
        start: Start<'_>,
        play: impl FnOnce(&Impulse, &mut Recorder) -> (End, T),
    ) -> Result<(Self, T), ShotError> {
        layout.validate(table)?;
        let (impulse, mut kept) = (start.impulse(table)?, Recorder::with_room());
        let (end, more) = play(&impulse, &mut kept);
        for (ball, segments) in kept.segments.iter_mut().enumerate() {
            let BallState { position, spin, .. } = end.balls[ball];
            let motion = if end.off_table[ball] { Motion::OffTable } else { Motion::Stationary };
            segments.push(Segment { start: end.time, spin, motion, ..Segment::at_rest(position) });
        }
        Ok((Self { constants: Constants::of(table), impulse, kept, duration: end.time }, more))
    }

    /// What the stroke gave the cue ball.
    pub fn impulse(&self) -> &Impulse {
        &self.impulse
    }

    /// All events in order of time.
    pub fn events(&self) -> &[Event] {
        &self.kept.events
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

    /// Where the balls come to rest; those that have left the table are on their spots.
    pub fn final_layout(&self) -> Layout {
        let Constants { length, radius, .. } = self.constants;
        Layout::new(self.positions(self.duration)).with_spotted(length, radius, self.off_table())
    }

    /// Which balls leave the table.
    pub fn off_table(&self) -> [bool; BALLS] {
        std::array::from_fn(|ball| self.motion(ball, self.duration) == Motion::OffTable)
    }

    /// How high a ball is over its place on the cloth at time `t`, s: in metres.
    pub fn height(&self, ball: usize, t: f64) -> f64 {
        let (segment, after) = self.segment(ball, t);
        segment.hops().map_or(0.0, |hops| hops.state_after(after).position.z)
    }

    /// A ball's position, velocity and spin in space at time `t`, s.
    pub fn spatial_state(&self, ball: usize, t: f64) -> SpatialState {
        let (segment, after) = self.segment(ball, t);
        segment.spatial_after(&self.constants, after)
    }

    /// The recorded segments of a ball, in order of time; each holds until the next one starts.
    pub fn segments(&self, ball: usize) -> &[Segment] {
        &self.kept.segments[ball]
    }

    /// The segment that holds at time `t`, and how long it has then lasted, s.
    fn segment(&self, ball: usize, t: f64) -> (&Segment, f64) {
        let t = t.clamp(0.0, self.duration);
        let segments = &self.kept.segments[ball];
        let begun = segments.partition_point(|segment| segment.start <= t);
        let segment = &segments[begun.saturating_sub(1)];
        (segment, t - segment.start)
    }
}

/// The observer that keeps everything for a [`Recording`].
#[derive(Clone, Debug)]
pub struct Recorder {
    events: Vec<Event>,
    segments: [Vec<Segment>; BALLS],
}

impl Recorder {
    /// Room for what an ordinary shot has: a dozen events, most of them the cue ball's.
    fn with_room() -> Self {
        Self { events: Vec::with_capacity(16), segments: [16, 4, 4].map(Vec::with_capacity) }
    }
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
    fn the_motion_that_a_stroke_gives_plays_as_the_stroke_does_bit_for_bit() {
        let table = Table::default();
        let layout = Layout::parse("-1,0 0,0.02 0.6,0.1", &table).unwrap();
        let cue = CueInputs::parse("0.2,0.3,4,1,4").unwrap();
        let struck = Recording::new(&table, &layout, &cue).unwrap();
        let moved = Recording::with_impulse(&table, &layout, struck.impulse()).unwrap();
        assert!(struck.events().len() > 5);
        assert_eq!(moved.events(), struck.events());
        assert_eq!((moved.duration(), moved.final_layout()), (struck.duration(), struck.final_layout()));
    }

    /// On a ball of 1 mm a stroke gives a spin that no motion may have. No method may refuse it.
    #[test]
    fn a_stroke_is_played_whatever_it_gives_by_whatever_method() {
        let table = Table { radius: 0.001, ..Table::preset("thesis").unwrap() };
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("0,0.45,0,0,25").unwrap();
        let shot = Recording::new(&table, &layout, &cue).unwrap();
        let play = |impulse: &Impulse, kept: &mut Recorder| (simulate(&table, &layout, impulse, kept), ());
        let (same, ()) = Recording::played_by(&table, &layout, Start::Stroke(&cue), play).unwrap();
        assert_eq!(same.events(), shot.events());
        let refused = Recording::played_by(&table, &layout, Start::Motion(shot.impulse()), play);
        assert!(matches!(refused, Err(ShotError::Impulse(ImpulseError::Spin(_)))), "{refused:?}");
    }

    #[test]
    fn a_ball_that_only_spins_is_played_and_an_impossible_motion_or_layout_is_refused() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let impulse = Impulse::on_cloth;
        let play = |layout: &Layout, impulse: &Impulse| Recording::with_impulse(&table, layout, impulse);
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
