//! `carom evaluate --self-play`: innings of the recommended shots under a player's errors.

use std::{
    io::Write,
    time::{Duration, Instant},
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::spec::{Shard, Spec};
use crate::{
    coach::{Coach, Doubt, Inning, Request, Skill, inning, layout_seed},
    commands::{
        Failure,
        output::{json_line, plural, print_note},
    },
    learning::evaluation::held_out_layouts,
    printing,
    statistics::SuccessRate,
    table::Layout,
};

/// Limit of the play time if none is given: a hundred years.
const NO_LIMIT: Duration = Duration::from_secs(100 * 365 * 24 * 3600);

/// Number of points between two lines of progress.
const PROGRESS: u32 = 100;

/// The result of an inning from one layout.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InningRecord {
    /// Number of the layout, from 0.
    pub layout: u32,
    points: u32,
    missed: bool,
    simulations: u64,
    /// Total time of the coach, for all turns.
    seconds: f64,
    /// Time of the slowest turn.
    slowest_seconds: f64,
}

/// The report.
#[derive(Debug, Serialize)]
struct SelfPlayReport<'a> {
    player: &'a str,
    table: &'a str,
    rule: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    skill: Option<Skill>,
    doubt: Doubt,
    seed: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    budget_ms: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    simulations: Option<u64>,
    plan: bool,
    /// Layouts that were planned to be played.
    layouts: u32,
    /// Innings that were started, and those of them that were stopped by the limit of points or of time.
    innings: usize,
    broken_off: usize,
    points: u32,
    misses: u32,
    /// Mean points per inning; a stopped inning counts with its points so far.
    mean_run: f64,
    /// Points per miss.
    average: Option<f64>,
    /// Its 95 % interval, from Wilson's interval for the share of misses, wider if the runs vary more than those of independent turns: the
    /// turns of an inning share a table.
    average_interval: [Option<f64>; 2],
    longest: u32,
    runs: Vec<u32>,
    simulations_per_turn: f64,
    mean_ms: f64,
    slowest_ms: f64,
}

/// Plays an inning from every layout of the part, but starts none after the time `limit`.
pub fn play(
    spec: &Spec,
    shard: Shard,
    coach: &Coach,
    request: &Request,
    limit: Option<Duration>,
) -> Result<Vec<InningRecord>, Failure> {
    let until = Instant::now() + limit.unwrap_or(NO_LIMIT).min(NO_LIMIT);
    let most = spec.most_points.unwrap_or(u32::MAX);
    let mut records = Vec::new();
    let layouts = held_out_layouts(&spec.table, spec.layouts as usize, spec.seed);
    for (index, layout) in (0..).zip(&layouts).filter(|(index, _)| shard.contains(*index)) {
        if Instant::now() >= until {
            break;
        }
        let number = index + 1;
        let mut say = |so_far: &Inning, _: &Layout| {
            if so_far.points.is_multiple_of(PROGRESS) {
                print_note(format_args!("inning {number}: {}", plural(so_far.points as usize, "point")));
            }
        };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(!layout_seed(spec.seed, index));
        let request = Request { seed: layout_seed(spec.seed, index), ..request.clone() };
        let Inning { points, missed, simulations, elapsed, slowest } =
            inning(coach, layout, &request, most, until, &mut rng, &mut say).map_err(Failure::wrong_input)?;
        print_note(format_args!(
            "inning {number}: {}{}",
            plural(points as usize, "point"),
            if missed { "" } else { ", broken off" }
        ));
        records.push(InningRecord {
            layout: index,
            points,
            missed,
            simulations,
            seconds: elapsed.as_secs_f64(),
            slowest_seconds: slowest.as_secs_f64(),
        });
    }
    Ok(records)
}

/// Prints the report over all innings.
pub fn print(spec: &Spec, records: &[InningRecord], json: bool) -> std::io::Result<()> {
    let report = report(spec, records);
    if json { json_line(&report) } else { print_text(&mut printing::stdout(), &report) }
}

/// Returns the variance of the completed runs over that of independent turns, which is `m (1 + m)` at a mean of `m` points; at least 1.
fn overdispersion(records: &[InningRecord]) -> f64 {
    let runs: Vec<f64> = records.iter().filter(|inning| inning.missed).map(|inning| f64::from(inning.points)).collect();
    let count = runs.len() as f64;
    let mean = runs.iter().sum::<f64>() / count;
    let variance = runs.iter().map(|run| (run - mean).powi(2)).sum::<f64>() / (count - 1.0);
    // `max` also leaves out what is not a number: fewer than two runs, or no points.
    (variance / (mean * (1.0 + mean))).max(1.0)
}

fn report<'a>(spec: &'a Spec, records: &[InningRecord]) -> SelfPlayReport<'a> {
    let points: u32 = records.iter().map(|inning| inning.points).sum();
    let misses = records.iter().filter(|inning| inning.missed).count() as u32;
    let turns = f64::from((points + misses).max(1));
    let missed = SuccessRate::of_clustered(misses as usize, (points + misses) as usize, overdispersion(records));
    let average = |miss: f64| (miss > 0.0).then(|| (1.0 - miss) / miss);
    SelfPlayReport {
        player: &spec.player,
        table: &spec.table.name,
        rule: &spec.measure,
        skill: spec.skill,
        doubt: spec.doubt,
        seed: spec.seed,
        budget_ms: spec.budget_ms,
        simulations: spec.simulations,
        plan: spec.plan,
        layouts: spec.layouts,
        innings: records.len(),
        broken_off: records.len() - misses as usize,
        points,
        misses,
        mean_run: f64::from(points) / records.len().max(1) as f64,
        average: (misses > 0).then(|| f64::from(points) / f64::from(misses)),
        average_interval: [average(missed.high), average(missed.low)],
        longest: records.iter().map(|inning| inning.points).max().unwrap_or(0),
        runs: records.iter().map(|inning| inning.points).collect(),
        simulations_per_turn: records.iter().map(|inning| inning.simulations).sum::<u64>() as f64 / turns,
        mean_ms: 1e3 * records.iter().fold(0.0, |all, inning| all + inning.seconds) / turns,
        slowest_ms: 1e3 * records.iter().map(|inning| inning.slowest_seconds).fold(0.0, f64::max),
    }
}

fn print_text(out: &mut impl Write, report: &SelfPlayReport<'_>) -> std::io::Result<()> {
    let end = |end: Option<f64>| end.map_or_else(|| "no limit".to_owned(), |end| format!("{end:.2}"));
    let [low, high] = report.average_interval.map(end);
    let not_begun = match (report.layouts as usize).saturating_sub(report.innings) {
        0 => String::new(),
        missing => format!("; on {missing} of {} layouts none was started, because the time was up", report.layouts),
    };
    writeln!(
        out,
        "self-play on \"{}\", {}, skill \"{}\", doubt \"{}\": {} and {} {} in {} ({} broken off{not_begun})",
        report.table,
        report.rule,
        report.skill.unwrap_or(Skill::EXPERT),
        report.doubt,
        plural(report.points as usize, "point"),
        report.misses,
        if report.misses == 1 { "miss" } else { "misses" },
        plural(report.innings, "inning"),
        report.broken_off
    )?;
    writeln!(
        out,
        "average {} (95 % interval {low} to {high}), mean run {:.1}, longest {}",
        report
            .average
            .map_or_else(|| "unknown, because nothing was missed".to_owned(), |average| format!("{average:.2}")),
        report.mean_run,
        report.longest
    )?;
    writeln!(
        out,
        "{:.0} simulations and {:.1} ms a turn, the slowest took {:.1} ms",
        report.simulations_per_turn, report.mean_ms, report.slowest_ms
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_that_depend_on_the_table_are_overdispersed() {
        let of = |runs: &[u32]| {
            let record = |points: &u32| InningRecord {
                layout: 0,
                points: *points,
                missed: true,
                simulations: 0,
                seconds: 0.0,
                slowest_seconds: 0.0,
            };
            overdispersion(&runs.iter().map(record).collect::<Vec<_>>())
        };
        // Mean 5, variance 100 / 3, which is 30 for independent turns.
        assert!((of(&[0, 0, 10, 10]) - 10.0 / 9.0).abs() < 1e-12);
        assert_eq!([&[][..], &[3], &[0, 0], &[4, 5, 6]].map(of), [1.0; 4]);
    }
}
