//! The methods that are compared, and what each makes of a shot.

use std::{fmt, ops::ControlFlow};

use super::{
    reference_engine::{Finder, Numbers, Real, Vector, algorithm_1010, by_extrema, closed_form, play},
    shots::StudyShot,
    stability::{Trace, account},
    steps::Steps,
    truth::motion,
};
use crate::{
    simulation::{Event, EventKind, Observer, simulate},
    table::{Layout, Table},
};

/// A way to compute a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The program's own engine.
    Engine,
    /// The reference engine, by roots between extrema.
    Plain,
    /// The reference engine with Ferrari's closed form.
    ClosedForm,
    /// The reference engine with Algorithm 1010.
    Algorithm1010,
    /// The reference engine in single precision.
    Single,
    /// The intuitive method.
    Steps(Steps),
}

impl Method {
    /// Everything that is compared, with time steps down to `finest`, s.
    pub fn all(finest: f64) -> Vec<Self> {
        let mut methods = vec![Self::Engine, Self::Plain, Self::ClosedForm, Self::Algorithm1010, Self::Single];
        for locate in [false, true] {
            let steps = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6].into_iter().filter(|dt| *dt >= finest);
            methods.extend(steps.map(|dt| Self::Steps(Steps { dt, locate })));
        }
        methods
    }

    /// What people are told of its family.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Plain => "reference engine (64 bits), extrema",
            Self::ClosedForm => "reference engine (64 bits), Ferrari",
            Self::Algorithm1010 => "reference engine (64 bits), Algorithm 1010",
            Self::Single => "reference engine (32 bits), extrema",
            Self::Engine | Self::Steps(_) => self.family(),
        }
    }

    /// The family that it belongs to, as JSON and CSV name it: what differs by the time step alone is one.
    pub const fn family(self) -> &'static str {
        match self {
            Self::Engine => "engine",
            Self::Plain => "plain, roots between extrema",
            Self::ClosedForm => "plain, Ferrari's formula",
            Self::Algorithm1010 => "plain, Algorithm 1010",
            Self::Single => "plain, f32",
            Self::Steps(Steps { locate: false, .. }) => "steps",
            Self::Steps(Steps { locate: true, .. }) => "steps, events located",
        }
    }

    /// The time step, s.
    pub const fn time_step(self) -> Option<f64> {
        match self {
            Self::Steps(Steps { dt, .. }) => Some(dt),
            _ => None,
        }
    }

    /// Plays a shot to its end; `None` where the method gives up.
    pub fn play(self, table: &Table, shot: &StudyShot) -> Option<Run> {
        match self {
            Self::Engine => {
                let mut events = Events::default();
                let end = simulate(table, &shot.layout, &shot.impulse, &mut events);
                Some(Run { events: events.0, end: end.layout(table), unaccounted: None })
            }
            Self::Plain => plain(table, shot, by_extrema::<f64>),
            Self::ClosedForm => plain(table, shot, closed_form),
            Self::Algorithm1010 => plain(table, shot, algorithm_1010),
            Self::Single => plain(table, shot, by_extrema::<f32>),
            Self::Steps(steps) => {
                let mut events = Events::default();
                let stepped = steps.simulate(table, &shot.layout, &shot.impulse, &mut events);
                stepped.at_rest.then(|| Run { events: events.0, end: stepped.end.layout(table), unaccounted: None })
            }
        }
    }

    /// Share of the energy for which friction and impacts do not account; `None` for shots too long to keep, and for the steps'
    /// courses in the air, of which no account is kept.
    pub fn unaccounted(self, table: &Table, shot: &StudyShot, run: &Run) -> Option<f64> {
        let mut trace = Trace::new(table);
        match self {
            Self::Engine => {
                trace.record(&shot.layout, &shot.impulse, |trace| simulate(table, &shot.layout, &shot.impulse, trace));
            }
            Self::Steps(steps) => {
                trace.record(&shot.layout, &shot.impulse, |trace| {
                    steps.simulate(table, &shot.layout, &shot.impulse, trace).end
                });
                if trace.has_flights() {
                    return None;
                }
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

/// What a method makes of a shot.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its events and their times, s.
    pub events: Vec<(f64, EventKind)>,
    /// Where the balls come to rest.
    pub end: Layout,
    /// Share of the energy for which nothing accounts, where the run itself has kept account.
    pub unaccounted: Option<f64>,
}

/// Keeps the events alone: all that a comparison needs.
#[derive(Default)]
struct Events(Vec<(f64, EventKind)>);

impl Observer for Events {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.0.push((event.time, event.kind));
        ControlFlow::Continue(())
    }
}

fn plain<R: Real>(table: &Table, shot: &StudyShot, finder: Finder<R>) -> Option<Run> {
    let flat = |v: glam::DVec2| Vector::new(R::of(v.x), R::of(v.y), R::zero());
    let (velocity, spin) = motion(shot);
    let played = play(&Numbers::of(table), shot.layout.balls.map(flat), velocity, spin, finder).ok()?;
    Some(Run {
        events: played.events.iter().map(|(time, kind)| (time.to_f64(), *kind)).collect(),
        end: played.layout(table),
        unaccounted: Some((played.energy[1] / played.energy[0]).to_f64().abs()),
    })
}
