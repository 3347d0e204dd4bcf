//! `carom recommend`: a shot for a layout, or for a file of layouts.

use std::{
    io::{self, Write},
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize};

use super::{
    Failure,
    input::{ByTable, Scene, answer_lines, note_doubts},
    named::policy_called,
    output::impulse_words,
};
use crate::{
    coach::{Coach, Recommendation, Request, Skill, Source},
    game::Rule,
    physics::{CueInputs, strike},
    table::{Layout, Table},
};

/// Attempts from which a make probability is estimated; its standard error is at most 2.5 %.
const ATTEMPTS: u32 = 400;

/// Alternatives that are listed.
const ALTERNATIVES: usize = 5;

/// Recommend a shot for a layout, or for a file of layouts.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: Scene,
    /// What counts as a point: straight, one-cushion or three-cushion.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// Whose make probability is told: perfect, expert, club or beginner.
    #[arg(long, default_value_t = Skill::Expert)]
    skill: Skill,
    /// Time to look for a shot, ms.
    #[arg(long, default_value_t = 500, value_parser = clap::value_parser!(u64).range(0..=3_600_000))]
    budget_ms: u64,
    /// Give the networks' own shot, without any simulation.
    #[arg(long)]
    policy_only: bool,
    /// The policy: "bundled", the path of a file that `carom train` wrote, or the name under which one was kept.
    #[arg(long, value_name = "FILE", default_value = "bundled")]
    policy: String,
    /// Seed of the search: while time does not run out, the same seed finds the same shot.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// JSON Lines of layouts with `preset`, `layout` and `rule`; "-" reads the standard input.
    #[arg(long, value_name = "FILE", conflicts_with = "rule")]
    batch: Option<String>,
}

/// One line of a batch.
#[derive(Deserialize)]
struct Question {
    preset: String,
    layout: Layout,
    #[serde(default)]
    rule: Rule,
}

/// The answer in JSON.
#[derive(Serialize)]
struct Answer {
    cue: CueInputs,
    /// Absent where nothing was simulated.
    #[serde(skip_serializing_if = "Option::is_none")]
    solved: Option<bool>,
    /// Of a shot that makes the point.
    #[serde(skip_serializing_if = "Option::is_none")]
    make_probability: Option<f64>,
    source: Source,
    simulations: u64,
    elapsed_ms: f64,
    alternatives: Vec<Alternative>,
}

#[derive(Serialize)]
struct Alternative {
    cue: CueInputs,
    make_probability: f64,
    source: Source,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(file) = &args.batch {
        let mut coaches = ByTable::new(|table| coach_for(table, &args.policy));
        return answer_lines(file, |question: Question| {
            answer(args, coaches.get(&question.preset)?, &question.layout, question.rule)
        });
    }
    let (table, layout) = args.scene.read()?;
    let coach = coach_for(table, &args.policy)?;
    let answer = answer(args, &coach, &layout, args.rule)?;
    let mut out = io::stdout().lock();
    if args.json {
        serde_json::to_writer(&mut out, &answer).map_err(io::Error::from)?;
        writeln!(out)?;
    } else {
        describe(&mut out, args, coach.table(), &answer)?;
    }
    if answer.solved == Some(false) {
        return Err(Failure::failed(format_args!(
            "no point was found in {} ms; this is the best attempt, a larger --budget-ms may do",
            args.budget_ms
        )));
    }
    Ok(())
}

/// The coach for `table` with the bundled policy, or with that of a file.
pub(super) fn coach_for(table: Table, policy: &str) -> Result<Coach, Failure> {
    let coach = Coach::new(table).map_err(Failure::failed)?;
    if policy == "bundled" {
        return Ok(coach);
    }
    Ok(coach.with_policy(policy_called(policy).map_err(Failure::failed)?))
}

fn answer(args: &Args, coach: &Coach, layout: &Layout, rule: Rule) -> Result<Answer, Failure> {
    if args.policy_only {
        layout.validate(coach.table()).map_err(Failure::wrong_input)?;
        let start = Instant::now();
        let policy = coach.policy(rule).ok_or_else(|| no_policy(coach.table()))?;
        note_doubts(policy, coach.table(), Some(rule));
        let cue = policy.propose(coach.table(), layout);
        return Ok(Answer {
            cue,
            solved: None,
            make_probability: None,
            source: Source::Policy,
            simulations: 0,
            elapsed_ms: 1e3 * start.elapsed().as_secs_f64(),
            alternatives: Vec::new(),
        });
    }
    let budget = Duration::from_millis(args.budget_ms);
    let request = Request { rule, budget, seed: args.seed, ..Request::default() };
    let advice = coach.recommend(layout, &request).map_err(Failure::wrong_input)?;
    Ok(with_probabilities(args, coach.table(), layout, rule, &advice))
}

fn no_policy(table: &Table) -> Failure {
    Failure::wrong_input(format_args!(
        "no policy is bundled for this table \"{}\"; leave out --policy-only, or give --policy FILE",
        table.name
    ))
}

fn with_probabilities(args: &Args, table: &Table, layout: &Layout, rule: Rule, advice: &Recommendation) -> Answer {
    let chance = |cue: &CueInputs| args.skill.make_probability(rule, table, layout, cue, ATTEMPTS, args.seed);
    Answer {
        cue: advice.cue,
        solved: Some(advice.solved),
        make_probability: advice.solved.then(|| chance(&advice.cue)),
        source: advice.source,
        simulations: advice.simulations,
        elapsed_ms: 1e3 * advice.elapsed.as_secs_f64(),
        alternatives: advice
            .alternatives
            .iter()
            .take(ALTERNATIVES)
            .map(|shot| Alternative { cue: shot.cue, make_probability: chance(&shot.cue), source: shot.source })
            .collect(),
    }
}

/// The recommendation for people to read.
fn describe(out: &mut impl Write, args: &Args, table: &Table, answer: &Answer) -> io::Result<()> {
    let CueInputs { a, b, theta, phi, speed } = answer.cue;
    let side = match a {
        a if a > 0.0 => " (left of centre)",
        a if a < 0.0 => " (right of centre)",
        _ => "",
    };
    writeln!(out, "a      {a:>8.3} R{side}")?;
    writeln!(out, "b      {b:>8.3} R")?;
    writeln!(out, "theta  {:>8.3} degrees", theta.to_degrees())?;
    writeln!(out, "phi    {:>8.3} degrees", phi.to_degrees())?;
    writeln!(out, "V      {speed:>8.3} m/s")?;
    writeln!(out, "{}", impulse_words(&strike(table, &answer.cue)))?;
    match (answer.solved, answer.make_probability) {
        (Some(true), Some(chance)) => writeln!(
            out,
            "a point by simulation; a player of skill \"{}\" makes it {:.0} % of the time",
            args.skill,
            100.0 * chance
        )?,
        (Some(_), _) => writeln!(out, "no point by simulation: the best attempt")?,
        (None, _) => writeln!(out, "the networks' own shot, not simulated")?,
    }
    let others = answer.alternatives.len();
    writeln!(
        out,
        "source: {}, {} simulations in {:.1} ms, {others} alternatives",
        answer.source, answer.simulations, answer.elapsed_ms
    )
}
