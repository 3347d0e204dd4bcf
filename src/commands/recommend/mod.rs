//! `carom recommend`: recommends a shot for a layout, or for each layout in a file.

mod description;
mod margins;
mod time_limit;

use std::{
    collections::HashSet,
    io::{self, Write},
    time::{Duration, Instant},
};

use clap::builder::NonEmptyStringValueParser;
use serde::{Deserialize, Serialize};

use self::{
    description::{Description, Reasons},
    margins::Margins,
    time_limit::with_time_limit,
};
use super::{
    Failure,
    input::{
        PositionArgs, TableCache, answer_lines, note_training_mismatch, parse_seed, search_limits, whole_number,
        whole_number_from,
    },
    lookup::{policy_by_name, skill_by_name},
    output::{chance_words, impulse_words, player_and_rule_words, player_words, units},
    request::{Key, Keys, RuleName},
};
use crate::{
    coach::{
        Coach, Doubt, FirstContact, Kind, NO_MATCHING_ATTEMPT, Recommendation, Request, Risk, Shooter, Skill, Source,
        systems::{Guide, guide},
    },
    game::{Point, Rule},
    learning::{Proposal, policy::library::BUNDLED},
    physics::{CueInputs, strike},
    printing::{self, fixed},
    simulation::{Recording, ShotError},
    statistics::SuccessRate,
    table::{BALL_NAMES, Layout, Table},
};

/// Default time of the search, ms, if neither a time nor a number of simulations is given.
const BUDGET_MS: u64 = 500;

/// Recommend a shot for a layout, or for a file of layouts.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Args {
    #[command(flatten)]
    position: PositionArgs,
    /// What counts as a point: straight, one-cushion or three-cushion. In a batch, for lines without `rule`.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// Who plays the shot: perfect, expert, world-class, national, club, beginner or own.
    ///
    /// "own" is the skill that `carom drill skill --keep` saved. An average at three-cushion like 0.6 is accepted, too, and standard errors
    /// in mm, degrees and m/s, like "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1". The recommended shot is the one that this player makes most
    /// often; for a perfect player it is the first one that makes the point.
    #[arg(long, default_value_t = Skill::EXPERT, value_parser = skill_by_name)]
    skill: Skill,
    /// Uncertainty in addition to the errors of the hand: full or none.
    ///
    /// With "full", the table is known as well as it was measured, and the positions of the balls within 3 mm. A multiple of the first and
    /// a value in mm for the second are accepted, too, like "table=1,placing=3". A part that is
    /// left out is as with "full". A perfect player has no doubts.
    #[arg(long, default_value_t = Doubt::FULL)]
    doubt: Doubt,
    /// Rank shots by the probability of this point and the next, so that the balls stay easy to play.
    #[arg(long, conflicts_with = "policy_only")]
    plan: bool,
    /// Recommend neither jumps over a ball nor massés, which most clubs forbid.
    #[arg(long, conflicts_with = "policy_only")]
    no_jumps: bool,
    /// What the cue ball must meet first: any, yellow, red or cushion.
    ///
    /// Only shots that begin in this way are searched. "yellow" and "red" mean without a cushion before; after a cushion, the cue ball may
    /// meet either ball.
    #[arg(long, default_value = "any", conflicts_with = "policy_only")]
    first: FirstContact,
    /// Also report how far off each input may be, with maps of the outcome, and where to aim.
    #[arg(long)]
    margins: bool,
    /// Time of the search, ms. Default: 500, or unlimited if --simulations is given.
    #[arg(long, value_parser = whole_number(0..=3_600_000_u64))]
    budget_ms: Option<u64>,
    /// Number of simulations after which the search starts nothing new.
    ///
    /// Without --budget-ms, the answer is then the same however fast the machine is; with it, both limits apply. This is not a hard limit: a
    /// minimal search and judging the shots that were found take thousands of simulations in addition.
    #[arg(long, value_parser = whole_number_from(1_u64))]
    simulations: Option<u64>,
    /// Return the networks' own shot, without any search.
    #[arg(long)]
    policy_only: bool,
    /// The policy: "bundled", the path of a file that `carom train` wrote, the folder or name of its run, or the name of a saved or bundled policy.
    #[arg(long, value_name = "FILE", default_value = "bundled", value_parser = NonEmptyStringValueParser::new())]
    policy: String,
    /// Seed of the search: if time does not run out, the same seed finds the same shot.
    #[arg(long, default_value_t = 0, value_parser = parse_seed)]
    seed: u64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// JSON Lines of layouts with `preset`, `layout` and `rule`; "-" reads the standard input.
    #[arg(long, value_name = "FILE", value_parser = NonEmptyStringValueParser::new())]
    batch: Option<String>,
}

/// One line of a batch.
#[derive(Deserialize)]
struct BatchLine {
    preset: String,
    layout: Layout,
    rule: Option<RuleName>,
}

impl Keys for BatchLine {
    const KEYS: &'static [Key] = &[Key::PRESET, Key::LAYOUT, Key::RULE];
    const FORM: &'static str = "preset (the table, like \"match\") and layout (like [[-0.71, 0.18], [-0.71, 0], [0.71, 0]]); rule may \
                                be left out";
}

/// A shot in JSON. Unknown values are absent.
#[derive(Serialize)]
struct Shot {
    cue: CueInputs,
    /// How often the player makes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    make_probability: Option<f64>,
    /// Its 95 % interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    make_interval: Option<[f64; 2]>,
    /// Probability of the next point, if it was estimated.
    #[serde(skip_serializing_if = "Option::is_none")]
    next_probability: Option<f64>,
    source: Source,
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<Kind>,
    #[serde(skip_serializing_if = "Option::is_none")]
    description: Option<String>,
    /// The shot in words, if anything was simulated.
    #[serde(flatten)]
    description_in_words: Option<Description>,
}

/// The answer in JSON.
#[derive(Serialize)]
struct RecommendAnswer {
    #[serde(flatten)]
    shot: Shot,
    /// Absent if nothing was simulated.
    #[serde(skip_serializing_if = "Option::is_none")]
    solved: Option<bool>,
    /// How often each source of error alone misses the shot, if anything is in doubt.
    #[serde(skip_serializing_if = "Option::is_none")]
    risk: Option<Risk>,
    simulations: u64,
    elapsed_ms: f64,
    alternatives: Vec<Shot>,
    /// Present if they were requested.
    #[serde(flatten)]
    margins: Option<Margins>,
    /// Present for a shot that makes the point.
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<Reasons>,
    /// The player's calculation on the diamonds, if a system applies.
    #[serde(skip_serializing_if = "Option::is_none")]
    system: Option<Guide>,
}

impl Shot {
    fn of(cue: CueInputs, chance: Option<SuccessRate>, next: Option<f64>, source: Source, kind: Option<Kind>) -> Self {
        Self {
            cue,
            make_probability: chance.map(|rate| rate.rate),
            make_interval: chance.map(|rate| [rate.low, rate.high]),
            next_probability: next,
            source,
            kind,
            description: kind.map(|kind| kind.to_string()),
            description_in_words: None,
        }
    }
}

impl RecommendAnswer {
    fn of(shot: Shot, simulations: u64, elapsed: Duration) -> Self {
        Self {
            shot,
            solved: None,
            risk: None,
            simulations,
            elapsed_ms: 1e3 * elapsed.as_secs_f64(),
            alternatives: Vec::new(),
            margins: None,
            why: None,
            system: None,
        }
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(file) = &args.batch {
        let mut coaches = TableCache::new(|table| coach_for(table, &args.policy));
        let mut noted = HashSet::new();
        return answer_lines(file, |BatchLine { preset, layout, rule }: BatchLine| {
            let rule = rule.map_or(args.rule, |RuleName(rule)| rule);
            let coach = coaches.get(&preset)?;
            if noted.insert((preset, rule)) {
                note(args, coach, rule);
            }
            answer(args, coach, &layout, rule)
        });
    }
    let (table, layout) = args.position.read()?;
    let coach = coach_for(table, &args.policy)?;
    note(args, &coach, args.rule);
    let answer = answer(args, &coach, &layout, args.rule)?;
    let mut out = printing::stdout().exact(args.json);
    if args.json {
        printing::json_line(&mut out, &answer)?;
    } else {
        describe(&mut out, args, coach.table(), &answer)?;
    }
    if answer.solved == Some(false) {
        let begins = args.first.opening_words(BALL_NAMES);
        if let Some(rule) = args.first.forbidden_by(Point::of(args.rule, coach.table(), &layout)) {
            return Err(Failure::failed(format_args!("there is no point{begins}: {rule}")));
        }
        let without = if args.no_jumps { " without jumps and massés" } else { "" };
        let meets_first = answer.shot.description_in_words.as_ref().is_none_or(|words| words.begins_with(args.first));
        let attempt = if meets_first { "this is the best attempt" } else { NO_MATCHING_ATTEMPT };
        return Err(Failure::failed(format_args!(
            "no point was found{begins}{without} in {:.0} ms; {attempt}, a larger {} may help",
            answer.elapsed_ms,
            if args.simulations.is_some() { "--simulations" } else { "--budget-ms" }
        )));
    }
    Ok(())
}

/// Returns the coach for `table` with the bundled policy, or with another one.
pub(super) fn coach_for(table: Table, policy: &str) -> Result<Coach, Failure> {
    let coach = Coach::new(table);
    if policy == BUNDLED {
        return Ok(coach);
    }
    Ok(coach.with_policy(policy_by_name(policy)?))
}

/// Prints notes about the networks' own shots, if these are requested.
fn note(args: &Args, coach: &Coach, rule: Rule) {
    if let Some(policy) = coach.policy(rule, &args.skill).filter(|_| args.policy_only) {
        note_training_mismatch(policy, coach.table(), Some(rule));
    }
}

fn answer(args: &Args, coach: &Coach, layout: &Layout, rule: Rule) -> Result<RecommendAnswer, Failure> {
    let mut answer = shot(args, coach, layout, rule)?;
    if args.margins {
        let (table, layout, cue) = (coach.table().clone(), *layout, answer.shot.cue);
        let doubt = Shooter { skill: args.skill, doubt: args.doubt }.effective_doubt();
        answer.margins = with_time_limit("the margins", move || Margins::of(rule, &table, &layout, &cue, doubt))?;
    }
    if answer.solved == Some(true) {
        let (table, layout, cue) = (coach.table().clone(), *layout, answer.shot.cue);
        answer.system = with_time_limit("the diamond systems", move || {
            Ok::<_, ShotError>(guide(&table, &Recording::new(&table, &layout, &cue)?))
        })?
        .flatten();
    }
    Ok(answer)
}

fn shot(args: &Args, coach: &Coach, layout: &Layout, rule: Rule) -> Result<RecommendAnswer, Failure> {
    if args.policy_only {
        layout.validate(coach.table()).map_err(Failure::wrong_input)?;
        let start = Instant::now();
        let policy = coach.policy(rule, &args.skill).ok_or_else(|| no_policy(coach.table()))?;
        let Proposal { cue, success } = policy.proposals(coach.table(), layout, &args.skill)[0];
        // Other networks predict the success of the shot without execution errors, whoever plays it.
        let predicted = policy.is_valid_for(&args.skill).then_some(success);
        let shot = Shot { make_probability: predicted, ..Shot::of(cue, None, None, Source::Policy, None) };
        return Ok(RecommendAnswer::of(shot, 0, start.elapsed()));
    }
    let (budget, simulations) = search_limits(args.budget_ms, args.simulations, BUDGET_MS);
    let request = Request {
        rule,
        skill: args.skill,
        doubt: args.doubt,
        plan: args.plan,
        jumps: !args.no_jumps,
        first: args.first,
        budget,
        simulations,
        seed: args.seed,
        ..Request::default()
    };
    let advice = coach.recommend(layout, &request).map_err(Failure::wrong_input)?;
    let mut answer = RecommendAnswer::from(advice.clone());
    let (table, layout, shooter, seed) = (coach.table().clone(), *layout, request.shooter(), args.seed);
    let shots: Vec<CueInputs> =
        std::iter::once(advice.cue).chain(advice.alternatives.iter().map(|shot| shot.cue)).collect();
    let words = with_time_limit("the words for the shot", move || {
        let described = shots.iter().map(|cue| Description::of(&table, &layout, cue)).collect::<Result<Vec<_>, _>>()?;
        let why = advice.solved.then(|| Reasons::of(shooter, rule, &table, &layout, &advice, seed)).transpose()?;
        Ok::<_, ShotError>((described, why))
    })?;
    if let Some((described, why)) = words {
        let mut described = described.into_iter();
        answer.shot.description_in_words = described.next();
        answer.alternatives.iter_mut().zip(described).for_each(|(shot, words)| shot.description_in_words = Some(words));
        answer.why = why;
    }
    Ok(answer)
}

fn no_policy(table: &Table) -> Failure {
    Failure::wrong_input(format_args!(
        "no policy is bundled for this table \"{}\"; leave out --policy-only, or give --policy FILE",
        table.name
    ))
}

impl From<Recommendation> for RecommendAnswer {
    fn from(advice: Recommendation) -> Self {
        let Recommendation { cue, make_probability: chance, next_probability: next, source, kind, .. } = advice;
        let alternatives = advice
            .alternatives
            .into_iter()
            .map(|shot| Shot::of(shot.cue, shot.make_probability, shot.next_probability, shot.source, Some(shot.kind)));
        Self {
            solved: Some(advice.solved),
            risk: advice.risk,
            alternatives: alternatives.collect(),
            ..Self::of(Shot::of(cue, chance, next, source, kind), advice.simulations, advice.elapsed)
        }
    }
}

/// Describes the recommendation as text.
fn describe(out: &mut impl Write, args: &Args, table: &Table, answer: &RecommendAnswer) -> io::Result<()> {
    let shot = &answer.shot;
    if let Some(description) = &shot.description_in_words {
        description.describe(out, units(), answer.solved != Some(false))?;
    }
    if let Some(why) = &answer.why {
        why.describe(out, units())?;
    }
    writeln!(out, "{}", player_and_rule_words(args.skill, args.rule))?;
    if shot.description_in_words.is_some() {
        writeln!(out)?;
    }
    let CueInputs { a, b, theta, speed, .. } = shot.cue;
    let side = match a {
        a if a >= 5e-4 => " (left of centre)",
        a if a <= -5e-4 => " (right of centre)",
        _ => "",
    };
    writeln!(out, "a      {:>8} R{side}", fixed(a, 3))?;
    writeln!(out, "b      {:>8} R", fixed(b, 3))?;
    writeln!(out, "theta  {:>8.3} degrees", theta.to_degrees())?;
    writeln!(out, "phi    {:>8} degrees", shot.cue.phi_text(3))?;
    let (factor, symbol) = units().length.speed();
    // A typed shot is always in metres per second, whatever unit is displayed.
    let typed = if symbol == "m/s" { String::new() } else { format!(" ({speed:.3} m/s where a shot is typed)") };
    writeln!(out, "V      {:>8.3} {symbol}{typed}", factor * speed)?;
    writeln!(out, "{}", impulse_words(&strike(table, &shot.cue), units().length))?;
    match answer.solved {
        Some(true) => writeln!(out, "a point by simulation: {}", words(shot, args))?,
        Some(false) => writeln!(out, "no point by simulation: the best attempt")?,
        None => {
            writeln!(
                out,
                "the networks' own shot, not simulated{}",
                predicted_chance(shot.make_probability, args.skill)
            )?;
        }
    }
    if let Some(system) = &answer.system {
        writeln!(out, "{}", system.shot_words())?;
    }
    if let Some(risk) = &answer.risk {
        writeln!(out, "{}", risk.words(shot.make_probability.map(|made| 1.0 - made)))?;
    }
    if let Some(next) = shot.next_probability {
        writeln!(out, "after it the next point is made about {:.0} % of the time", 100.0 * next)?;
    }
    if let Some(margins) = &answer.margins {
        margins.describe(out, table, units())?;
    }
    for shot in &answer.alternatives {
        let Shot { cue, description_in_words: description, next_probability: next, .. } = shot;
        let CueInputs { a, b, theta, speed, .. } = *cue;
        let ([a, b], theta, phi) = ([a, b].map(|place| fixed(place, 3)), theta.to_degrees(), cue.phi_text(3));
        let pattern = description
            .as_ref()
            .and_then(|description| description.pattern)
            .map_or_else(String::new, |name| format!("{name}; "));
        let next = next.map_or_else(String::new, |next| format!(", the next point {:.0} %", 100.0 * next));
        writeln!(out, "or {a},{b},{theta:.3},{phi},{speed:.3}: {pattern}{}{next}", words(shot, args))?;
        if let Some(description) = description {
            writeln!(out, "   {}", description.sentence(units()))?;
        }
    }
    writeln!(out, "source: {}, {} simulations in {:.1} ms", shot.source, answer.simulations, answer.elapsed_ms)
}

/// States the make probability that the networks predict for their shot, if they do.
fn predicted_chance(predicted: Option<f64>, skill: Skill) -> String {
    predicted.map_or_else(String::new, |rate| {
        format!("; they say that {} makes it {:.0} % of the time", player_words(skill), 100.0 * rate)
    })
}

/// Describes the kind of shot, and how often the player makes it.
fn words(shot: &Shot, args: &Args) -> String {
    let description = shot.kind.map(|kind| kind.words(units().length)).unwrap_or_default();
    match (shot.make_probability, shot.make_interval) {
        (Some(rate), Some(interval)) => format!("{description}; {}", chance_words(args.skill, rate, interval)),
        _ => description,
    }
}
