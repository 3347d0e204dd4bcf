//! One shot within bounds: of time, and of what numbers can hold. A table may be stiff beyond any use and still be a table.

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use super::Failure;
use crate::{
    physics::{CueInputs, Impulse, strike},
    simulation::{End, Event, Observer, Recorder, Recording, Segment, simulate},
    study::{Stepped, Steps},
    table::{BALLS, Layout, Table},
};

/// Longest time that one shot may take, s. The slowest on a table that exists take some milliseconds.
const LONGEST: u64 = 5;

/// Most steps of one shot: some seconds of them.
const MOST_STEPS: f64 = 4e6;

/// Plays a shot from event to event.
///
/// # Errors
/// What is wrong with the layout or the stroke; and where it takes too long or its numbers get out of hand.
pub fn play(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Recording, Failure> {
    let (recording, is_over) = Recording::played_by(table, layout, cue, |impulse, recorder| {
        let mut bounded = Bounded::new(recorder);
        let end = simulate(table, layout, impulse, &mut bounded);
        (end, bounded.is_over)
    })
    .map_err(Failure::wrong_input)?;
    finite(table, recording, is_over)
}

/// Plays a shot in which the cue ball has this motion just after the stroke.
///
/// # Errors
/// What is wrong with the layout or the motion; and where its numbers get out of hand.
pub fn play_impulse(table: &Table, layout: &Layout, impulse: &Impulse) -> Result<Recording, Failure> {
    finite(table, Recording::with_impulse(table, layout, impulse).map_err(Failure::wrong_input)?, false)
}

/// Plays a shot in fixed steps.
///
/// # Errors
/// As [`play`].
pub fn play_in_steps(
    table: &Table,
    layout: &Layout,
    cue: &CueInputs,
    steps: Steps,
) -> Result<(Recording, Stepped), Failure> {
    layout.validate(table).map_err(Failure::wrong_input)?;
    cue.validate().map_err(Failure::wrong_input)?;
    let finest = Steps::finest(table, &strike(table, cue), MOST_STEPS);
    if steps.dt < finest {
        return Err(Failure::wrong_input(format_args!(
            "dt = {} s would take more steps than can be waited for; accepted is {finest:.0e} s or more for this shot on \"{}\"",
            steps.dt, table.name
        )));
    }
    let play = |impulse: &Impulse, recorder: &mut Recorder| -> (End, (Stepped, bool)) {
        let mut bounded = Bounded::new(recorder);
        let stepped = steps.simulate(table, layout, impulse, &mut bounded);
        (stepped.end, (stepped, bounded.is_over))
    };
    let (recording, (stepped, is_over)) =
        Recording::played_by(table, layout, cue, play).map_err(Failure::wrong_input)?;
    Ok((finite(table, recording, is_over)?, stepped))
}

fn finite(table: &Table, recording: Recording, is_over: bool) -> Result<Recording, Failure> {
    let name = &table.name;
    if is_over {
        return Err(Failure::failed(format_args!(
            "the shot takes more than {LONGEST} s to compute on \"{name}\" and is given up; larger time steps or a table \
             that is less stiff would do"
        )));
    }
    let end = recording.duration();
    let positions = recording.final_layout().balls;
    let is_finite = end.is_finite()
        && positions.iter().all(|position| position.is_finite())
        && (0..BALLS).all(|ball| recording.state(ball, end).spin.is_finite())
        && recording.events().iter().all(|event| event.time.is_finite());
    if is_finite {
        return Ok(recording);
    }
    Err(Failure::failed(format_args!(
        "the shot's numbers do not stay finite on \"{name}\"; a table with less friction between balls or on cushions would do"
    )))
}

/// Records until it has taken too long.
struct Bounded<'a> {
    recorder: &'a mut Recorder,
    until: Instant,
    is_over: bool,
}

impl<'a> Bounded<'a> {
    fn new(recorder: &'a mut Recorder) -> Self {
        Self { recorder, until: Instant::now() + Duration::from_secs(LONGEST), is_over: false }
    }

    fn go_on(&mut self) -> ControlFlow<()> {
        self.is_over |= Instant::now() > self.until;
        if self.is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Observer for Bounded<'_> {
    const SEGMENTS: bool = true;

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.recorder.event(event)?;
        self.go_on()
    }

    fn bounce(&mut self, bounce: Event) {
        self.recorder.bounce(bounce);
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.recorder.contact_step()?;
        self.go_on()
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        self.recorder.segment(ball, segment, end);
    }
}
