//! The work-precision study: all methods play the same shots, block by block, and are compared with the truth.

use serde::Serialize;

use super::{
    clock::timed,
    errors::Errors,
    methods::{Method, Run},
    reference_engine::Unjudged,
    shots::{MaxElevation, StudyShot},
    statistics::{Proportion, Spread},
    truth::Truth,
};
use crate::table::Table;

/// Shots in a timed block. Methods take turns block by block: a block is long enough for the clock, and short enough that
/// machine noise affects all methods equally.
const BLOCK: usize = 16;

/// A block that takes longer than this, s, is timed only once: machine noise is short in comparison.
const LONG_BLOCK: f64 = 0.1;

/// Approximate duration of a shot on the table, s, from which the number of time steps is estimated.
const TYPICAL_SHOT: f64 = 8.0;

/// The setup of a study.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The table.
    pub table: Table,
    /// The name or path by which `--table` finds the table.
    pub table_argument: String,
    /// Greatest cue elevation of the shots.
    pub max_elevation: MaxElevation,
    /// The shots.
    pub shots: Vec<StudyShot>,
    /// The methods.
    pub methods: Vec<Method>,
    /// Number of timings of each block of shots; the fastest counts.
    pub rounds: usize,
    /// Maximum number of time steps of a method in a round. Methods with short steps play fewer shots, always the first ones.
    pub steps: f64,
}

/// The results of one method on one table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The table's name.
    pub table: String,
    /// Greatest cue elevation, degrees.
    pub steepest_deg: f64,
    /// The method's family in JSON and CSV.
    pub method: &'static str,
    /// The method's family in reports.
    #[serde(skip)]
    pub description: &'static str,
    /// The time step, s; `None` for event-driven methods.
    pub dt: Option<f64>,
    /// Number of shots played.
    pub shots: usize,
    /// Number of shots on which the method gave up.
    pub failed: usize,
    /// Mean CPU time of a shot, µs.
    pub cost_us: f64,
    /// Spread of the cost over blocks of 16 shots, µs a shot.
    pub cost_spread_us: Option<Spread>,
    /// Distance between the final positions and the true ones, m.
    pub rest_m: Option<Spread>,
    /// `rest_m` in units of `(1 + condition) 2^-53`.
    pub rest_units: Option<Spread>,
    /// Shots with an error at rest of more than 1e-9 m.
    pub beyond_1e_9_m: Proportion,
    /// Error of the event times, s.
    pub time_s: Option<Spread>,
    /// `time_s` in units of `(1 + condition) 2^-53`.
    pub time_units: Option<Spread>,
    /// Shots with a wrong sequence of events.
    pub wrong_sequence: Proportion,
    /// Median index of the first event that differs, over the shots with a wrong sequence.
    pub first_wrong: Option<f64>,
    /// Unexplained energy as a share of the initial energy.
    pub energy: Option<Spread>,
    /// Shots whose outcome is wrong under straight rail.
    pub flips_straight: Proportion,
    /// Shots whose outcome is wrong under three-cushion.
    pub flips_three_cushion: Proportion,
    /// The shot with the largest error in units, as a command line.
    pub worst_shot: String,
}

/// One shot of one method, for the plots.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// The shot's condition, m.
    pub condition: f64,
    /// Error at rest, m.
    pub rest: f64,
}

/// The results of a study.
#[derive(Clone, Debug)]
pub struct Study {
    /// Summary of the shots and their truth.
    pub summary: Summary,
    /// The methods in the plan's order.
    pub rows: Vec<Row>,
    /// The plotted shots of each method.
    pub points: Vec<Vec<Point>>,
    /// Why the truth is not known, for each shot without a truth.
    pub unjudged: Vec<Unjudged>,
}

impl Study {
    /// Returns the distinct reasons for which shots are not judged.
    pub fn why_unjudged(&self) -> String {
        let mut reasons: Vec<String> = Vec::new();
        for why in &self.unjudged {
            let why = why.to_string();
            if !reasons.contains(&why) {
                reasons.push(why);
            }
        }
        reasons.join("; ")
    }
}

/// Summary of one table's shots and their truth.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The table's name.
    pub table: String,
    /// Greatest cue elevation, degrees.
    pub steepest_deg: f64,
    /// Share of the judged shots in which a ball leaves the cloth.
    pub flies: Proportion,
    /// Shots whose truth is known; all others are neither judged nor timed.
    pub judged: Proportion,
    /// Share of the judged shots in which balls chatter or rest against something while they move.
    pub chatters: Proportion,
    /// Condition of the judged shots, m.
    pub condition_m: Option<Spread>,
    /// Error of the truth's own energy balance, as a share of the initial energy.
    pub truth_energy: Option<Spread>,
    /// Mean CPU time of the truth, including its two perturbed shots, µs a shot.
    pub truth_cost_us: f64,
}

/// Accumulated results of one method.
#[derive(Default)]
struct Gathered {
    cost: f64,
    blocks: Vec<f64>,
    shots: Vec<(usize, Option<Errors>, Option<f64>)>,
}

impl Plan {
    /// Number of shots that `method` plays.
    fn limit(&self, method: Method) -> usize {
        let steps = method.time_step().map_or(f64::INFINITY, |dt| self.steps * dt / TYPICAL_SHOT);
        (steps.max(4.0) as usize).min(self.shots.len())
    }

    /// Runs the study. `progress` receives the number of shots done.
    pub fn run(&self, mut progress: impl FnMut(usize)) -> Study {
        let mut truths: Vec<Result<Truth, Unjudged>> = Vec::with_capacity(self.shots.len());
        let mut gathered: Vec<Gathered> = self.methods.iter().map(|_| Gathered::default()).collect();
        let mut truth_cost = 0.0;
        for start in (0..self.shots.len()).step_by(BLOCK) {
            let block = start..(start + BLOCK).min(self.shots.len());
            let shots = self.shots[block.clone()].iter().map(|shot| Truth::of(&self.table, shot));
            truth_cost += timed(|| truths.extend(shots)).1;
            let judged: Vec<usize> = block.clone().filter(|&index| truths[index].is_ok()).collect();
            let mut fastest = vec![f64::INFINITY; self.methods.len()];
            let mut runs: Vec<Vec<Option<Run>>> = vec![Vec::new(); self.methods.len()];
            for round in 0..self.rounds {
                for (index, &method) in self.methods.iter().enumerate() {
                    if round > 0 && fastest[index] > LONG_BLOCK {
                        continue;
                    }
                    let shots = judged.iter().filter(|&&shot| shot < self.limit(method));
                    let play = |&shot: &usize| method.play(&self.table, &self.shots[shot]);
                    let seconds;
                    (runs[index], seconds) = timed(|| shots.map(play).collect());
                    fastest[index] = fastest[index].min(seconds);
                }
            }
            for (index, gathered) in gathered.iter_mut().enumerate() {
                if !runs[index].is_empty() {
                    gathered.cost += fastest[index];
                    gathered.blocks.push(1e6 * fastest[index] / runs[index].len() as f64);
                }
                for (&shot, run) in judged.iter().zip(&runs[index]) {
                    let errors =
                        run.as_ref().zip(truths[shot].as_ref().ok()).map(|(run, truth)| Errors::of(truth, run));
                    let account = |run| self.methods[index].unaccounted(&self.table, &self.shots[shot], run);
                    gathered.shots.push((shot, errors, run.as_ref().and_then(account)));
                }
            }
            progress(block.end);
        }
        self.study(&truths, &gathered, truth_cost)
    }

    fn study(&self, truths: &[Result<Truth, Unjudged>], gathered: &[Gathered], truth_cost: f64) -> Study {
        let known = || truths.iter().flatten();
        let points = |gathered: &Gathered| {
            let point = |&(shot, errors, _): &(usize, Option<Errors>, _)| {
                let condition = truths[shot].as_ref().ok()?.condition;
                Some(Point { condition, rest: errors?.rest })
            };
            gathered.shots.iter().filter_map(point).collect()
        };
        let summary = Summary {
            table: self.table.name.clone(),
            steepest_deg: self.max_elevation.degrees(),
            flies: Proportion::of(known().map(Truth::flies)),
            judged: Proportion::of(truths.iter().map(Result::is_ok)),
            chatters: Proportion::of(known().map(|truth| truth.chatters)),
            condition_m: Spread::of(known().map(|truth| truth.condition)),
            truth_energy: Spread::of(known().map(|truth| truth.unaccounted.abs())),
            truth_cost_us: 1e6 * truth_cost / truths.len().max(1) as f64,
        };
        let methods = self.methods.iter().zip(gathered);
        Study {
            summary,
            rows: methods.map(|(&method, gathered)| self.row(method, truths, gathered)).collect(),
            points: gathered.iter().map(points).collect(),
            unjudged: truths.iter().filter_map(|truth| truth.as_ref().err().copied()).collect(),
        }
    }

    fn row(&self, method: Method, truths: &[Result<Truth, Unjudged>], gathered: &Gathered) -> Row {
        let errors = || gathered.shots.iter().filter_map(|(_, errors, _)| *errors);
        let unit = |shot: usize| truths[shot].as_ref().map_or(f64::NAN, Truth::unit);
        let timed = || gathered.shots.iter().filter_map(|(shot, errors, _)| Some((*shot, errors.as_ref()?.time?)));
        let worst = gathered.shots.iter().max_by(|one, other| {
            let size = |shot: &(usize, Option<Errors>, _)| shot.1.map_or(0.0, |errors: Errors| errors.rest_units);
            size(one).total_cmp(&size(other))
        });
        Row {
            table: self.table.name.clone(),
            steepest_deg: self.max_elevation.degrees(),
            method: method.family(),
            description: method.description(),
            dt: method.time_step(),
            shots: gathered.shots.len(),
            failed: gathered.shots.iter().filter(|(_, errors, _)| errors.is_none()).count(),
            cost_us: 1e6 * gathered.cost / gathered.shots.len().max(1) as f64,
            cost_spread_us: Spread::of(gathered.blocks.iter().copied()),
            rest_m: Spread::of(errors().map(|errors| errors.rest)),
            rest_units: Spread::of(errors().map(|errors| errors.rest_units)),
            beyond_1e_9_m: Proportion::of(errors().map(|errors| errors.rest > 1e-9)),
            time_s: Spread::of(timed().map(|(_, time)| time)),
            time_units: Spread::of(timed().map(|(shot, time)| time / unit(shot))),
            wrong_sequence: Proportion::of(errors().map(|errors| errors.differs_at.is_some())),
            first_wrong: Spread::of(errors().filter_map(|errors| errors.differs_at).map(|index| index as f64))
                .map(|spread| spread.median),
            energy: Spread::of(gathered.shots.iter().filter_map(|(_, _, energy)| *energy)),
            flips_straight: Proportion::of(errors().map(|errors| errors.flips[0])),
            flips_three_cushion: Proportion::of(errors().map(|errors| errors.flips[1])),
            worst_shot: worst
                .map_or_else(String::new, |(shot, ..)| self.shots[*shot].command_line(&self.table_argument)),
        }
    }
}
