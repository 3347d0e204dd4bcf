//! Checks the truth and the engine against shots that an independent program computed with 50 digits.

use serde::Serialize;

use super::{
    reference_engine::{DoubleDouble, Real},
    shots::{ReferenceEvent, ReferenceShot, references},
    statistics::{Proportion, Spread},
    truth::Truth,
};
use crate::{
    simulation::{EventKind, Rail, Recording},
    table::Layout,
};

/// Goal for the median of the engine's error in units of `(1 + condition) 2^-53`.
pub const GOAL_MEDIAN: f64 = 1.0;

/// Goal for the 99th percentile of the same error.
pub const GOAL_P99: f64 = 16.0;

/// Goal of the largest error of the engine in shots with resting contacts (`contact.jsonl`), m.
pub const GOAL_CONTACT: f64 = 1e-10;

/// Event times are compared only for shots below this condition, m; their times are accurate to 1e-9 s.
const MAX_CONDITION_FOR_TIMES: f64 = 1e6;

/// The results on one reference file.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceRow {
    /// The file's name: shots, hard, contact or flights.
    pub file: &'static str,
    /// Number of shots in it.
    pub shots: usize,
    /// Number of shots whose truth is not known.
    pub unjudged: usize,
    /// Distance between the truth's final positions and the file's, m. The file's own digits end at about 3e-16.
    pub truth_m: Option<Spread>,
    /// `truth_m` in units of `(1 + condition) 2^-53`, for shots whose condition is in the file.
    pub truth_units: Option<Spread>,
    /// Shots in which the truth has a different sequence of events.
    pub truth_wrong: Proportion,
    /// Distance between the engine's final positions and the file's, m.
    pub engine_m: Option<Spread>,
    /// `engine_m` in units of `(1 + condition) 2^-53`.
    pub engine_units: Option<Spread>,
    /// Shots in which the engine has a different sequence of events.
    pub engine_wrong: Proportion,
    /// The largest error of an event time in each shot with a correct sequence, s. Shots with a condition of a million or more
    /// are excluded.
    pub engine_time_s: Option<Spread>,
    /// The error of the time at which all balls rest, s, with the same exclusion.
    pub engine_duration_s: Option<Spread>,
    /// Distance between the engine's final positions and the truth's, m.
    pub engine_to_truth_m: Option<Spread>,
}

/// Checks all files. A shot whose table or layout is rejected counts as an infinite error.
pub fn check_references() -> Vec<ReferenceRow> {
    references().into_iter().map(|(file, shots)| row(file, &shots)).collect()
}

/// The results on one shot.
struct Checked {
    unit: Option<f64>,
    truth: Option<f64>,
    truth_wrong: Option<bool>,
    engine: f64,
    engine_wrong: Option<bool>,
    engine_time: Option<f64>,
    engine_duration: Option<f64>,
    engine_to_truth: Option<f64>,
}

fn row(file: &'static str, shots: &[ReferenceShot]) -> ReferenceRow {
    let checked: Vec<Checked> = shots.iter().map(check).collect();
    let in_units = |error: fn(&Checked) -> Option<f64>| {
        Spread::of(checked.iter().filter_map(move |shot| Some(error(shot)? / shot.unit?)))
    };
    ReferenceRow {
        file,
        shots: shots.len(),
        unjudged: checked.iter().filter(|shot| shot.truth.is_none()).count(),
        truth_m: Spread::of(checked.iter().filter_map(|shot| shot.truth)),
        truth_units: in_units(|shot| shot.truth),
        truth_wrong: Proportion::of(checked.iter().filter_map(|shot| shot.truth_wrong)),
        engine_m: Spread::of(checked.iter().map(|shot| shot.engine)),
        engine_units: in_units(|shot| Some(shot.engine)),
        engine_wrong: Proportion::of(checked.iter().filter_map(|shot| shot.engine_wrong)),
        engine_time_s: Spread::of(checked.iter().filter_map(|shot| shot.engine_time)),
        engine_duration_s: Spread::of(checked.iter().filter_map(|shot| shot.engine_duration)),
        engine_to_truth_m: Spread::of(checked.iter().filter_map(|shot| shot.engine_to_truth)),
    }
}

fn check(reference: &ReferenceShot) -> Checked {
    let table = reference.table();
    let known_end = table.as_ref().map_or(reference.end, |table| reference.final_layout(table));
    let truth = table.as_ref().and_then(|table| Truth::of_reference(table, reference).ok());
    let recording = table.and_then(|table| Recording::new(&table, &reference.layout, &reference.cue.into()).ok());
    let has_events = !reference.events.is_empty();
    let differs = |kinds: &mut dyn Iterator<Item = EventKind>| {
        let kinds: Vec<EventKind> = kinds.collect();
        kinds.len() != reference.events.len()
            || !kinds.iter().zip(&reference.events).all(|(kind, it)| matches_event(*kind, it))
    };
    let end = recording.as_ref().map(Recording::final_layout);
    let engine_wrong = has_events
        .then(|| recording.as_ref().is_none_or(|it| differs(&mut it.events().iter().map(|event| event.kind))));
    let steady =
        recording.as_ref().filter(|_| reference.condition.is_none_or(|condition| condition < MAX_CONDITION_FOR_TIMES));
    let time_error = |recording: &Recording| {
        let pairs = recording.events().iter().zip(&reference.events);
        pairs.map(|(ours, theirs)| (ours.time - theirs.t).abs()).fold(0.0, f64::max)
    };
    Checked {
        unit: reference.condition.map(|condition| (1.0 + condition) * f64::ROUNDING),
        truth: truth.as_ref().map(|truth| truth.distance(&known_end)),
        truth_wrong: truth
            .as_ref()
            .filter(|_| has_events)
            .map(|truth| differs(&mut truth.events.iter().map(|event| event.1))),
        // A ball that left the table is compared where it ended, not on its spot.
        engine: recording
            .as_ref()
            .map_or(f64::INFINITY, |it| distance(&Layout::new(it.positions(it.duration())), &reference.end)),
        engine_wrong,
        engine_time: steady.filter(|_| engine_wrong == Some(false)).map(time_error),
        engine_duration: steady.map(|it| (it.duration() - reference.duration).abs()),
        engine_to_truth: truth.zip(end).map(|(truth, end)| truth.distance(&end)),
    }
}

fn distance(one: &Layout, other: &Layout) -> f64 {
    // In double-double, because the difference is of the order of rounding errors.
    let apart = |a: f64, b: f64| (DoubleDouble::of(a) - DoubleDouble::of(b)).to_f64();
    let pairs = one.balls.iter().zip(&other.balls);
    pairs.map(|(a, b)| apart(a.x, b.x).hypot(apart(a.y, b.y))).fold(0.0, f64::max)
}

fn matches_event(kind: EventKind, written: &ReferenceEvent) -> bool {
    let (first, second) = kind.balls();
    let balls: Vec<usize> = [Some(first), second].into_iter().flatten().collect();
    kind.name() == written.kind && balls == written.balls && kind.rail().map(Rail::name) == written.rail.as_deref()
}
