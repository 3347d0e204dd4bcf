//! The errors that the checks measure on one shot or on many, and their limits.

use serde::Serialize;

use crate::table::Table;

/// The largest value of an error, and its time in the shot.
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
    /// Records an error. NaN counts as the largest value. Of equal values the earliest is stored, whatever the order of the
    /// calls.
    pub fn record(&mut self, value: f64, time: f64) {
        let earlier = value == self.value && time < self.time;
        if value.is_nan() && !self.value.is_nan() || value > self.value || earlier {
            *self = Self { value, time };
        }
    }
}

/// The largest errors of one shot or of many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Figures {
    /// Number of checked shots.
    pub shots: u64,
    /// Overlap of two balls, m; negative if they stay apart.
    pub overlap: Worst,
    /// Distance of a ball's centre beyond its reach, m.
    pub outside: Worst,
    /// Energy gained at an event or between events, relative to the tolerance of a gain.
    pub energy: Worst,
    /// The same in m²/s² (energy per ball mass).
    pub gained: Worst,
    /// Unexplained energy at an event or between events, relative to rounding and tolerances: a loss without a friction or
    /// impact that dissipates it, or a dissipation without a loss.
    pub unexplained: Worst,
    /// The same in m²/s², also of a whole shot.
    #[serde(rename = "missing")]
    pub unexplained_energy: Worst,
    /// Displacement of a ball between two pieces of its course, m.
    pub jump: Worst,
    /// Gap between two balls, or between ball and cushion, at a reported collision, m.
    #[serde(rename = "apart")]
    pub contact_gap: Worst,
    /// Time by which the course runs backwards or has a gap, s.
    pub backwards: Worst,
    /// Number of shots with a number that is not finite.
    pub not_finite: u64,
    /// Number of shots that were aborted, or whose balls still moved at the end.
    pub unfinished: u64,
    /// Number of shots that the engine gave up because they took too much work: their ends are not those of real shots.
    pub exhausted: u64,
    /// Number of shots whose course was too long to be checked whole.
    pub truncated: u64,
    /// Largest number of events of a shot.
    pub events: usize,
    /// Largest number of pieces of the courses of a shot.
    pub steps: usize,
    /// Longest computing time of a shot, s; for slow shots the minimum of several attempts.
    pub seconds: f64,
}

/// A violation of an invariant.
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
    #[error("energy grows by {value:.1} times the tolerance at {time} s", value = .0.value, time = .0.time)]
    Energy(Worst),
    /// Energy is lost without an explanation, or not lost although something dissipates it.
    #[error("energy is off by {value:.3e} times the tolerance at {time} s", value = .0.value, time = .0.time)]
    Unexplained(Worst),
    /// A ball jumps to another position.
    #[error("a ball jumps by {value:.3e} m at {time} s", value = .0.value, time = .0.time)]
    Jump(Worst),
    /// A collision of bodies that do not touch.
    #[error("a collision over a gap of {value:.3e} m at {time} s", value = .0.value, time = .0.time)]
    #[serde(rename = "apart")]
    ContactGap(Worst),
    /// Events out of order, or pieces of a course that do not cover the shot.
    #[error("time runs backwards, or a course has a gap, by {value:.3e} s at {time} s", value = .0.value, time = .0.time)]
    Backwards(Worst),
    /// The shot was aborted, or balls still moved at its end.
    #[error("the shot does not end")]
    Unfinished,
    /// The engine gave the shot up before its balls came to rest by themselves.
    #[error("the shot is given up because it takes too much work")]
    Exhausted,
    /// The course is only stored, and so only checked, to a part.
    #[error("the course has too many pieces to be checked whole")]
    Truncated,
    /// The shot takes too much computing time.
    #[error("the shot takes {ms:.0} ms", ms = 1e3 * .0)]
    Slow(f64),
    /// The shot needs more events than any real one.
    #[error("the shot needs {0} events")]
    Events(usize),
    /// The additional check of its case failed.
    #[error("{0}")]
    Wrong(String),
}

/// The largest acceptable errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Overlaps, distances outside, jumps and gaps at collisions, m.
    pub distance: f64,
    /// Number of events of a shot.
    pub events: usize,
    /// Computing time of a shot, s.
    pub seconds: f64,
}

impl Limits {
    /// The goal on tables of usual size: 1e-9 m, 500 events, 50 ms.
    pub const STRICT: Self = Self { distance: 1e-9, events: 500, seconds: 0.05 };

    /// For tables on which shots inherently have more events.
    pub const ANY_EVENTS: Self = Self { events: usize::MAX, ..Self::STRICT };

    /// Returns these limits for a table. On a table longer than usual, the limit of distances grows in proportion, as the
    /// rounding of positions does.
    #[must_use]
    pub fn on(self, table: &Table) -> Self {
        Self { distance: self.distance * (table.length / LONGEST_USUAL).max(1.0), ..self }
    }
}

/// Length of a match table, m.
const LONGEST_USUAL: f64 = 2.84;

impl Figures {
    /// Merges the figures of other shots.
    pub fn merge(&mut self, other: &Self) {
        self.shots += other.shots;
        for (mine, theirs) in [
            (&mut self.overlap, other.overlap),
            (&mut self.outside, other.outside),
            (&mut self.energy, other.energy),
            (&mut self.gained, other.gained),
            (&mut self.unexplained, other.unexplained),
            (&mut self.unexplained_energy, other.unexplained_energy),
            (&mut self.jump, other.jump),
            (&mut self.contact_gap, other.contact_gap),
            (&mut self.backwards, other.backwards),
        ] {
            mine.record(theirs.value, theirs.time);
        }
        self.not_finite += other.not_finite;
        self.unfinished += other.unfinished;
        self.exhausted += other.exhausted;
        self.truncated += other.truncated;
        self.events = self.events.max(other.events);
        self.steps = self.steps.max(other.steps);
        self.seconds = self.seconds.max(other.seconds);
    }

    /// Returns the violations of `limits`, the most serious first.
    pub fn violations(&self, limits: &Limits) -> Vec<Violation> {
        let beyond = |worst: Worst, limit: f64| worst.value.is_nan() || worst.value > limit;
        let candidates = [
            (self.not_finite > 0, Violation::NotFinite),
            (self.unfinished > 0, Violation::Unfinished),
            (self.exhausted > 0, Violation::Exhausted),
            (self.truncated > 0, Violation::Truncated),
            (beyond(self.outside, limits.distance), Violation::Outside(self.outside)),
            (beyond(self.overlap, limits.distance), Violation::Overlap(self.overlap)),
            (beyond(self.jump, limits.distance), Violation::Jump(self.jump)),
            (beyond(self.contact_gap, limits.distance), Violation::ContactGap(self.contact_gap)),
            (beyond(self.energy, 1.0), Violation::Energy(self.energy)),
            (beyond(self.unexplained, 1.0), Violation::Unexplained(self.unexplained)),
            (beyond(self.backwards, 0.0), Violation::Backwards(self.backwards)),
            (self.events > limits.events, Violation::Events(self.events)),
            (self.seconds > limits.seconds, Violation::Slow(self.seconds)),
        ];
        candidates.into_iter().filter_map(|(is, violation)| is.then_some(violation)).collect()
    }
}
