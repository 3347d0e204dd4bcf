//! What the checks measure of a shot or of many, and which of it is a violation.

use serde::Serialize;

use crate::table::Table;

/// The largest of some error, and when in its shot it happened.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Size of the error, in the unit of its figure.
    pub value: f64,
    /// Time since the stroke, s.
    pub time: f64,
}

impl Default for Worst {
    fn default() -> Self {
        Self { value: f64::NEG_INFINITY, time: 0.0 }
    }
}

impl Worst {
    /// Takes note of an error. NaN counts as the largest of all; of equal ones the earliest is kept, in whatever order they
    /// come.
    pub fn note(&mut self, value: f64, time: f64) {
        let earlier = value == self.value && time < self.time;
        if value.is_nan() && !self.value.is_nan() || value > self.value || earlier {
            *self = Self { value, time };
        }
    }
}

/// The largest errors of one shot or of many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Figures {
    /// Shots that were checked.
    pub shots: u64,
    /// How deep two balls overlap, m. It is less than zero where they stay apart.
    pub overlap: Worst,
    /// How far a ball's centre is beyond its reach, m.
    pub outside: Worst,
    /// Energy gained at an event or on the way to the next, in units of what rounding explains.
    pub energy: Worst,
    /// The same in m²/s², energy per mass of a ball.
    pub gained: Worst,
    /// Energy lost that no friction and no impact takes, or that one should have taken and did not, at an event, on the way
    /// to the next, or in the whole shot, in units of what rounding and the tolerances explain.
    pub unexplained: Worst,
    /// The same in m²/s².
    pub missing: Worst,
    /// How far a ball is displaced from one piece of its course to the next, m.
    pub jump: Worst,
    /// How far apart balls, or ball and cushion, are that are told to collide, m.
    pub apart: Worst,
    /// How far time runs backwards, s.
    pub backwards: Worst,
    /// Shots in which some number was not finite.
    pub not_finite: u64,
    /// Shots that were broken off, or whose balls still moved at the end.
    pub unfinished: u64,
    /// Most events of a shot.
    pub events: usize,
    /// Most pieces of course of a shot.
    pub steps: usize,
    /// Longest time that the simulation of a shot took, s: of a slow one the least of several attempts.
    pub seconds: f64,
}

/// What a shot may not do.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[serde(rename_all = "kebab-case", tag = "kind", content = "value")]
pub enum Violation {
    /// Some number is NaN or infinite.
    #[error("a number is not finite")]
    NotFinite,
    /// Two balls overlap.
    #[error("two balls overlap by {value:.3e} m at {time} s", value = .0.value, time = .0.time)]
    Overlap(Worst),
    /// A ball leaves the table.
    #[error("a ball is {value:.3e} m outside at {time} s", value = .0.value, time = .0.time)]
    Outside(Worst),
    /// Energy is gained.
    #[error("energy grows by {value:.1} times what rounding explains at {time} s", value = .0.value, time = .0.time)]
    Energy(Worst),
    /// Energy is lost that nothing takes, or not lost where something takes it.
    #[error("energy is off by {value:.3e} times what is explained at {time} s", value = .0.value, time = .0.time)]
    Unexplained(Worst),
    /// A ball is put somewhere else.
    #[error("a ball jumps by {value:.3e} m at {time} s", value = .0.value, time = .0.time)]
    Jump(Worst),
    /// A collision of what does not touch.
    #[error("a collision over a gap of {value:.3e} m at {time} s", value = .0.value, time = .0.time)]
    Apart(Worst),
    /// Events out of order.
    #[error("time runs back by {value:.3e} s at {time} s", value = .0.value, time = .0.time)]
    Backwards(Worst),
    /// The shot did not end by itself.
    #[error("the shot does not end")]
    Unfinished,
    /// The shot takes too long to simulate.
    #[error("the shot takes {ms:.0} ms", ms = 1e3 * .0)]
    Slow(f64),
    /// The shot needs more events than any real one.
    #[error("the shot needs {0} events")]
    Events(usize),
    /// What its case asks of it besides does not hold.
    #[error("{0}")]
    Wrong(String),
}

/// The largest errors that are none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Overlaps, distances outside, jumps and gaps in collisions, m.
    pub distance: f64,
    /// Events of a shot.
    pub events: usize,
    /// Time that the simulation of a shot may take, s.
    pub seconds: f64,
}

impl Limits {
    /// The goal on tables as people play on: a billionth of a metre, five hundred events, 50 ms.
    pub const STRICT: Self = Self { distance: 1e-9, events: 500, seconds: 0.05 };

    /// For tables on which a shot has more events by nature.
    pub const ANY_EVENTS: Self = Self { events: usize::MAX, ..Self::STRICT };

    /// These limits on a table: on one that is longer than those people play on, distances may be larger in proportion, as
    /// the rounding of places is.
    #[must_use]
    pub fn on(self, table: &Table) -> Self {
        Self { distance: self.distance * (table.length / LONGEST_USUAL).max(1.0), ..self }
    }
}

/// Length of a match table, m.
const LONGEST_USUAL: f64 = 2.84;

impl Figures {
    /// Adds the figures of other shots.
    pub fn merge(&mut self, other: &Self) {
        self.shots += other.shots;
        for (mine, theirs) in [
            (&mut self.overlap, other.overlap),
            (&mut self.outside, other.outside),
            (&mut self.energy, other.energy),
            (&mut self.gained, other.gained),
            (&mut self.unexplained, other.unexplained),
            (&mut self.missing, other.missing),
            (&mut self.jump, other.jump),
            (&mut self.apart, other.apart),
            (&mut self.backwards, other.backwards),
        ] {
            mine.note(theirs.value, theirs.time);
        }
        self.not_finite += other.not_finite;
        self.unfinished += other.unfinished;
        self.events = self.events.max(other.events);
        self.steps = self.steps.max(other.steps);
        self.seconds = self.seconds.max(other.seconds);
    }

    /// What is beyond `limits`, worst things first.
    pub fn violations(&self, limits: &Limits) -> Vec<Violation> {
        let beyond = |worst: Worst, limit: f64| worst.value.is_nan() || worst.value > limit;
        let candidates = [
            (self.not_finite > 0, Violation::NotFinite),
            (self.unfinished > 0, Violation::Unfinished),
            (beyond(self.outside, limits.distance), Violation::Outside(self.outside)),
            (beyond(self.overlap, limits.distance), Violation::Overlap(self.overlap)),
            (beyond(self.jump, limits.distance), Violation::Jump(self.jump)),
            (beyond(self.apart, limits.distance), Violation::Apart(self.apart)),
            (beyond(self.energy, 1.0), Violation::Energy(self.energy)),
            (beyond(self.unexplained, 1.0), Violation::Unexplained(self.unexplained)),
            (beyond(self.backwards, 0.0), Violation::Backwards(self.backwards)),
            (self.events > limits.events, Violation::Events(self.events)),
            (self.seconds > limits.seconds, Violation::Slow(self.seconds)),
        ];
        candidates.into_iter().filter_map(|(is, violation)| is.then_some(violation)).collect()
    }
}
