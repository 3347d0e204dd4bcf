//! `carom evaluate --self-play`: innings of the recommended shots under a player's errors.

use std::{
    io::Write,
    time::{Duration, Instant},
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;

use super::{Args, request};
use crate::{
    coach::{Doubt, Inning, Skill, inning},
    commands::{Failure, input::minutes, output::tell, recommend::coach_for},
    learning::evaluation::{SuccessRate, held_out_layouts},
    printing,
    table::{Layout, Table},
};

/// Longest play where no limit is given: a hundred years' worth of nobody waiting.
const NO_LIMIT: Duration = Duration::from_secs(100 * 365 * 24 * 3600);

/// Turns between two lines of progress.
const PROGRESS: u32 = 100;

/// What is printed.
#[derive(Debug, Serialize)]
struct SelfPlayReport {
    player: &'static str,
    table: String,
    rule: &'static str,
    skill: Skill,
    doubt: Doubt,
    seed: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    budget_ms: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    simulations: Option<u64>,
    plan: bool,
    /// Innings begun, and among them those that were broken off, by the limit of points or of time.
    innings: usize,
    broken_off: usize,
    points: u32,
    misses: u32,
    /// Mean points of the innings, a broken-off one as long as it got.
    mean_run: f64,
    /// Points for each miss.
    average: f64,
    /// Its 95 % interval, from Wilson's for the share of misses: turns are taken as independent.
    average_interval: [Option<f64>; 2],
    longest: u32,
    runs: Vec<u32>,
    simulations_per_turn: f64,
    mean_ms: f64,
    slowest_ms: f64,
}

pub fn run(args: &Args, table: Table) -> Result<(), Failure> {
    let limit = args.minutes.map_or(Ok(NO_LIMIT), minutes)?;
    let coach = coach_for(table, &args.policy)?;
    let skill = args.skill.unwrap_or(Skill::EXPERT);
    let request = request(args, skill);
    let start = Instant::now();
    let until = start + limit.min(NO_LIMIT);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(!args.seed);
    let mut innings = Vec::new();
    for layout in held_out_layouts(coach.table(), args.layouts as usize, args.seed) {
        if Instant::now() >= until {
            break;
        }
        let number = innings.len() + 1;
        let mut say = |so_far: &Inning, _: &Layout| {
            if so_far.points.is_multiple_of(PROGRESS) {
                tell(format_args!("inning {number}: {} points", so_far.points));
            }
        };
        let played = inning(&coach, &layout, &request, args.most_points, until, &mut rng, &mut say)
            .map_err(Failure::wrong_input)?;
        tell(format_args!(
            "inning {number}: {} points{}",
            played.points,
            if played.missed { "" } else { ", broken off" }
        ));
        innings.push(played);
    }
    let report = report(args, &coach.table().name, skill, &innings, start.elapsed());
    let mut out = printing::stdout();
    if args.json {
        printing::json(&mut out, &report)?;
        writeln!(out)?;
    } else {
        print(&mut out, &report)?;
    }
    Ok(())
}

fn report(args: &Args, table: &str, skill: Skill, innings: &[Inning], elapsed: Duration) -> SelfPlayReport {
    let points: u32 = innings.iter().map(|inning| inning.points).sum();
    let misses = innings.iter().filter(|inning| inning.missed).count() as u32;
    let turns = f64::from((points + misses).max(1));
    let missed = SuccessRate::new(misses as usize, (points + misses) as usize);
    let average = |miss: f64| (miss > 0.0).then(|| (1.0 - miss) / miss);
    SelfPlayReport {
        player: "recommender",
        table: table.to_owned(),
        rule: args.rule.name(),
        skill,
        doubt: args.doubt,
        seed: args.seed,
        budget_ms: args.simulations.is_none().then_some(args.budget_ms),
        simulations: args.simulations,
        plan: args.plan,
        innings: innings.len(),
        broken_off: innings.len() - misses as usize,
        points,
        misses,
        mean_run: f64::from(points) / innings.len().max(1) as f64,
        average: f64::from(points) / f64::from(misses.max(1)),
        average_interval: [average(missed.high), average(missed.low)],
        longest: innings.iter().map(|inning| inning.points).max().unwrap_or(0),
        runs: innings.iter().map(|inning| inning.points).collect(),
        simulations_per_turn: innings.iter().map(|inning| inning.simulations).sum::<u64>() as f64 / turns,
        mean_ms: 1e3 * elapsed.as_secs_f64() / turns,
        slowest_ms: 1e3 * innings.iter().map(|inning| inning.slowest).max().unwrap_or_default().as_secs_f64(),
    }
}

fn print(out: &mut impl Write, report: &SelfPlayReport) -> std::io::Result<()> {
    let end = |end: Option<f64>| end.map_or_else(|| "no limit".to_owned(), |end| format!("{end:.1}"));
    let [low, high] = report.average_interval.map(end);
    writeln!(
        out,
        "self-play on \"{}\", {}, skill \"{}\", doubt \"{}\": {} points and {} misses in {} innings ({} broken off)",
        report.table,
        report.rule,
        report.skill,
        report.doubt,
        report.points,
        report.misses,
        report.innings,
        report.broken_off
    )?;
    writeln!(
        out,
        "average {:.2} (95 % interval {low} to {high}), mean run {:.1}, longest {}",
        report.average, report.mean_run, report.longest
    )?;
    writeln!(
        out,
        "{:.0} simulations and {:.1} ms a turn, the slowest took {:.1} ms",
        report.simulations_per_turn, report.mean_ms, report.slowest_ms
    )
}
