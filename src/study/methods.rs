//! The compared methods, and the result of each on a shot.

use std::{fmt, ops::ControlFlow};

use super::{
    reference_engine::{Finder, Numbers, Real, algorithm_1010, by_extrema, closed_form, play},
    shots::StudyShot,
    stability::{Trace, account},
    steps::Steps,
    truth::{motion, positions},
};
use crate::{
    simulation::{Event, EventKind, Observer, simulate},
    table::{Layout, Table},
};

/// A way to compute a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The engine of this program.
    Engine,
    /// The reference engine with roots bracketed between extrema.
    Extrema,
    /// The reference engine with Ferrari's closed form.
    ClosedForm,
    /// The reference engine with Algorithm 1010.
    Algorithm1010,
    /// The reference engine in single precision.
    Single,
    /// Fixed time steps: the intuitive method of the thesis.
    Steps(Steps),
}

impl Method {
    /// Returns every compared method, with time steps down to `finest`, s.
    pub fn all(finest: f64) -> Vec<Self> {
        let mut methods = vec![Self::Engine, Self::Extrema, Self::ClosedForm, Self::Algorithm1010, Self::Single];
        for locate in [false, true] {
            let steps = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6].into_iter().filter(|dt| *dt >= finest);
            methods.extend(steps.map(|dt| Self::Steps(Steps { dt, locate })));
        }
        methods
    }

    /// Returns the name of the method's family in reports.
    pub const fn description(self) -> &'static str {
        match self {
            Self::Extrema => "reference engine (64 bits), extrema",
            Self::ClosedForm => "reference engine (64 bits), Ferrari",
            Self::Algorithm1010 => "reference engine (64 bits), Algorithm 1010",
            Self::Single => "reference engine (32 bits), extrema",
            Self::Engine | Self::Steps(_) => self.family(),
        }
    }

    /// Returns the name of the method's family in JSON and CSV. Methods that differ only by the time step share a family.
    pub const fn family(self) -> &'static str {
        match self {
            Self::Engine => "engine",
            Self::Extrema => "plain, roots between extrema",
            Self::ClosedForm => "plain, Ferrari's formula",
            Self::Algorithm1010 => "plain, Algorithm 1010",
            Self::Single => "plain, f32",
            Self::Steps(Steps { locate: false, .. }) => "steps",
            Self::Steps(Steps { locate: true, .. }) => "steps, events located",
        }
    }

    /// Returns the time step, s; `None` for event-driven methods.
    pub const fn time_step(self) -> Option<f64> {
        match self {
            Self::Steps(Steps { dt, .. }) => Some(dt),
            _ => None,
        }
    }

    /// Plays a shot to its end; `None` if the method gives up.
    pub fn play(self, table: &Table, shot: &StudyShot) -> Option<Run> {
        match self {
            Self::Engine => {
                let mut events = Events::default();
                let end = simulate(table, &shot.layout, &shot.impulse, &mut events);
                Some(Run { events: events.0, end: end.layout(table), unaccounted: None })
            }
            Self::Extrema => play_reference(table, shot, by_extrema::<f64>),
            Self::ClosedForm => play_reference(table, shot, closed_form),
            Self::Algorithm1010 => play_reference(table, shot, algorithm_1010),
            Self::Single => play_reference(table, shot, by_extrema::<f32>),
            Self::Steps(steps) => {
                let mut events = Events::default();
                let stepped = steps.simulate(table, &shot.layout, &shot.impulse, &mut events);
                stepped.at_rest.then(|| Run { events: events.0, end: stepped.end.layout(table), unaccounted: None })
            }
        }
    }

    /// Returns the share of the energy that friction and impacts do not explain. `None` for shots too long to store, and for
    /// steps on tables where balls fly, which have no energy audit.
    pub fn unaccounted(self, table: &Table, shot: &StudyShot, run: &Run) -> Option<f64> {
        let mut trace = Trace::new(table);
        match self {
            Self::Engine => {
                trace.record(&shot.layout, &shot.impulse, |trace| simulate(table, &shot.layout, &shot.impulse, trace));
            }
            Self::Steps(_) if table.flight.is_some() => return None,
            Self::Steps(steps) => {
                trace.record(&shot.layout, &shot.impulse, |trace| {
                    steps.simulate(table, &shot.layout, &shot.impulse, trace).end
                });
            }
            _ => return run.unaccounted,
        }
        if trace.kept_until < f64::INFINITY {
            return None;
        }
        let account = account(table, &trace);
        Some((account.unexplained / account.start).abs())
    }
}

impl fmt::Display for Method {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.time_step() {
            Some(dt) => formatter.pad(&format!("{}, dt {dt:e} s", self.family())),
            None => formatter.pad(self.family()),
        }
    }
}

/// The result of a method on a shot.
#[derive(Clone, Debug)]
pub struct Run {
    /// The events and their times, s.
    pub events: Vec<(f64, EventKind)>,
    /// Final positions of the balls.
    pub end: Layout,
    /// Share of unexplained energy; `None` if the run itself does not audit it.
    pub unaccounted: Option<f64>,
}

/// Records the events only: all that a comparison needs.
#[derive(Default)]
struct Events(Vec<(f64, EventKind)>);

impl Observer for Events {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.0.push((event.time, event.kind));
        ControlFlow::Continue(())
    }
}

fn play_reference<R: Real>(table: &Table, shot: &StudyShot, finder: Finder<R>) -> Option<Run> {
    let (velocity, spin) = motion(shot);
    let played = play(&Numbers::of(table), positions(&shot.layout), velocity, spin, finder).ok()?;
    Some(Run {
        events: played.events.iter().map(|(time, kind)| (time.to_f64(), *kind)).collect(),
        end: played.layout(table),
        unaccounted: Some((played.energy[1] / played.energy[0]).to_f64().abs()),
    })
}
