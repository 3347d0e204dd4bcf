//! `carom evaluate`: measures the recommender or a policy on held-out layouts.

mod comparison;
mod drawn_tables;
mod robustness;
mod self_play;
mod shots;
mod spec;

use std::path::PathBuf;

use clap::builder::NonEmptyStringValueParser;

use self::{
    comparison::Comparison,
    drawn_tables::DrawnTables,
    shots::Player,
    spec::{Part, Records, Shard, Spec, merge},
};
use super::{
    Failure,
    input::{
        note_training_mismatch, parse_minutes, parse_seed, search_limits, table_by_name, whole_number,
        whole_number_from,
    },
    lookup::{bundled_policy, policy_by_name, skill_by_name},
    output::{json_line, print_line},
    recommend::coach_for,
};
use crate::{
    coach::{Doubt, Request, Skill},
    game::{Reward, Rule},
    learning::{Policy, evaluation::EVALUATION_SEED, policy::library::BUNDLED},
    platform::limit_threads,
    printing::{COMMIT, VERSION},
};

/// Options that need a search of shots, so that they conflict with the networks alone. clap does not require `--policy-only` if one of
/// these is given.
const OF_SEARCHES: [&str; 7] =
    ["random_search", "self_play", "choose_doubt", "plan", "no_jumps", "budget_ms", "simulations"];

/// Measure the recommender, or with --policy-only the networks alone.
///
/// The layouts took no part in any training. The output is the success rate of the shots, with its 95 % confidence interval.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Args {
    /// Number of layouts.
    #[arg(long, default_value_t = 2_000, value_parser = whole_number(1..=10_000_000_u32))]
    layouts: u32,
    /// Seed of the layouts.
    #[arg(long, default_value_t = EVALUATION_SEED, value_parser = parse_seed)]
    seed: u64,
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file.
    #[arg(long, default_value = "match")]
    table: String,
    /// The policy: "bundled", the path of a file that `carom train` wrote, its run (the folder or the name), the name of a saved policy, or
    /// the name of a bundled one like "match-r3".
    #[arg(long, value_name = "FILE", default_value = "bundled", value_parser = NonEmptyStringValueParser::new())]
    policy: String,
    /// Play the networks' own shot: one pass, no simulator call. Their predictions are compared with the results.
    #[arg(long)]
    policy_only: bool,
    /// With --policy-only: play every layout on its own random table, which differs from --table as tables in clubs do. Networks that
    /// accept the constants of the table receive them; with --skill, the table is as well known as "match".
    #[arg(long, requires = "policy_only", conflicts_with_all = OF_SEARCHES)]
    drawn_tables: bool,
    /// What counts as a point: straight, one-cushion or three-cushion.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// With --policy-only: measure this reward instead of the rule: r1, r1-difficulty, r2, r3, r4, one-cushion or three-cushion. If the
    /// reward is not just 0 or 1, the mean is reported.
    #[arg(long, requires = "policy_only", conflicts_with_all = OF_SEARCHES, conflicts_with = "rule")]
    reward: Option<Reward>,
    /// Measure a search of this many shots with random phi and V, which the simulator checks: the first success counts.
    #[arg(long, value_name = "SHOTS", conflicts_with_all = ["policy_only", "policy", "budget_ms"],
        value_parser = whole_number_from(1_u32))]
    random_search: Option<u32>,
    /// Who plays the shots: perfect, expert, world-class, national, club, beginner, own (saved by `carom drill skill --keep`), an average
    /// at three-cushion like 0.6, or a player's own standard errors in mm, degrees and m/s like "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1". The
    /// make probability is then measured, too, with independent errors.
    #[arg(long, value_parser = skill_by_name, conflicts_with_all = ["random_search", "reward"])]
    skill: Option<Skill>,
    /// Uncertainty in addition to the errors of the hand: full, none, or like "table=1,placing=3". Shots are chosen with it and played on
    /// tables and from positions that are drawn from it.
    /// Default: full
    #[arg(long, conflicts_with_all = ["random_search", "reward"])]
    doubt: Option<Doubt>,
    /// Choose shots with this doubt instead, but still play them with --doubt.
    #[arg(long, value_name = "DOUBT", requires = "skill", conflicts_with_all = ["policy_only", "random_search", "self_play"])]
    choose_doubt: Option<Doubt>,
    /// Play innings: the recommended shot with the player's errors, until a miss, one inning for each layout. Default skill: expert.
    #[arg(long, conflicts_with_all = ["policy_only", "random_search", "reward"])]
    self_play: bool,
    /// With --self-play: points after which an inning is stopped.
    #[arg(long, requires = "self_play", conflicts_with_all = ["policy_only", "random_search"], default_value_t = 1000, value_parser = whole_number_from(1_u32))]
    most_points: u32,
    /// With --self-play: minutes after which play is stopped; fractions are accepted.
    #[arg(long, requires = "self_play", conflicts_with_all = ["policy_only", "random_search"])]
    minutes: Option<f64>,
    /// Rank shots by the probability of this point and the next.
    #[arg(long, conflicts_with_all = ["policy_only", "random_search"])]
    plan: bool,
    /// Recommend neither jumps over a ball nor massés, which most clubs forbid.
    #[arg(long, conflicts_with_all = ["policy_only", "random_search"])]
    no_jumps: bool,
    /// Time that the recommender has for a layout, ms.
    #[arg(long, default_value_t = 500, conflicts_with = "policy_only", value_parser = whole_number(0..=3_600_000_u64))]
    budget_ms: u64,
    /// Number of simulations after which the recommender starts nothing new on a layout, instead of a time: the answer is then the same
    /// however fast the machine is. As for `carom recommend`, a minimum of work is always done in addition.
    #[arg(long, value_name = "COUNT", conflicts_with_all = ["policy_only", "random_search", "budget_ms"],
        value_parser = whole_number_from(1_u64))]
    simulations: Option<u64>,
    /// Threads that the recommender may use. Default: one on each processor
    #[arg(long, value_name = "N", conflicts_with_all = ["policy_only", "random_search"], value_parser = whole_number(1..=1024_u16))]
    threads: Option<u16>,
    /// Measure only part K of N of the layouts, and print the records as JSON for --merge.
    #[arg(long, value_name = "K/N", conflicts_with = "json")]
    shard: Option<Shard>,
    /// Measure nothing; report the combined result from the files of all parts.
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = [
        "layouts", "seed", "table", "policy", "policy_only", "drawn_tables", "rule", "reward", "random_search", "skill", "doubt", "choose_doubt",
        "self_play", "most_points", "minutes", "plan", "no_jumps", "budget_ms", "simulations", "threads", "shard",
    ])]
    merge: Vec<PathBuf>,
    /// With --merge: compare with the combined result from these files on the same layouts: the mean difference, with its 95 % interval.
    #[arg(long, value_name = "FILE", num_args = 1.., requires = "merge")]
    against: Vec<PathBuf>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let (spec, records) = if args.merge.is_empty() { measure(args)? } else { merge(&args.merge)? };
    if let Some(shard) = args.shard {
        return Ok(json_line(&Part { spec, shard, records })?);
    }
    if !args.against.is_empty() {
        let comparison = Comparison::of(&spec, &records, &args.against)?;
        return if args.json { Ok(json_line(&comparison)?) } else { print_line(comparison) };
    }
    match records {
        Records::Shots(records) => shots::print(&spec, &records, args.json)?,
        Records::Innings(records) => self_play::print(&spec, &records, args.json)?,
    }
    Ok(())
}

/// Measures all layouts, or those of one part.
fn measure(args: &Args) -> Result<(Spec, Records), Failure> {
    if let Some(threads) = args.threads {
        limit_threads(threads.into());
    }
    let table = table_by_name(&args.table)?;
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let reward = args.reward.unwrap_or_else(|| Reward::for_rule(args.rule));
    let skill = if args.self_play { args.skill.or(Some(Skill::EXPERT)) } else { args.skill };
    if (args.doubt.is_some() || args.plan) && skill.is_none_or(|skill| skill.is_perfect()) {
        return Err(Failure::wrong_input(
            "--doubt and --plan change nothing for a player without errors; accepted are both with --skill, like \"--skill club\", or with \
             --self-play",
        ));
    }
    let player = if let Some(shots) = args.random_search {
        Player::RandomSearch(shots)
    } else if args.policy_only {
        let errs = skill.is_some_and(|skill| !skill.is_perfect());
        // All drawn tables use the same policy.
        let on = if args.drawn_tables { DrawnTables::around(&table, args.seed).of(0) } else { table.clone() };
        if args.drawn_tables && args.policy == BUNDLED && Policy::bundled_for(&on, Rule::default(), errs).is_none() {
            return Err(Failure::wrong_input(format_args!(
                "no bundled policy knows tables like \"{}\"; use --table match or textbook, or --policy FILE",
                table.name
            )));
        }
        let policy = if args.policy == BUNDLED {
            bundled_policy(&on, reward.rule().unwrap_or_default(), errs)?
        } else {
            policy_by_name(&args.policy)?
        };
        note_training_mismatch(&policy, &table, reward.rule());
        Player::Policy(Box::new(policy))
    } else {
        let coach = coach_for(table.clone(), &args.policy)?;
        Player::Recommender(Box::new(coach), request(args, skill.unwrap_or(Skill::PERFECT)))
    };
    let spec = Spec {
        player: player.name().to_owned(),
        policy: args.random_search.is_none().then(|| args.policy.clone()),
        checksum: player.checksum().map_err(Failure::failed)?,
        version: Some(COMMIT.map_or_else(|| VERSION.to_owned(), |source| format!("{VERSION} ({source})"))),
        networks: player.networks().map(str::to_owned),
        table,
        measure: args.reward.map_or(args.rule.name(), Reward::name).to_owned(),
        is_yes_or_no: reward == Reward::R1 || reward.rule().is_some(),
        seed: args.seed,
        layouts: args.layouts,
        drawn_tables: args.drawn_tables,
        skill,
        doubt: args.doubt.unwrap_or(Doubt::FULL),
        choose_doubt: args.choose_doubt,
        plan: args.plan,
        no_jumps: args.no_jumps,
        budget_ms: (!args.policy_only && args.random_search.is_none() && args.simulations.is_none())
            .then_some(args.budget_ms),
        simulations: args.simulations,
        random_search: args.random_search,
        most_points: args.self_play.then_some(args.most_points),
    };
    let records = match &player {
        Player::Recommender(coach, request) if args.self_play => {
            let limit = args.minutes.map(parse_minutes).transpose()?;
            Records::Innings(self_play::play(&spec, shard, coach, request, limit)?)
        }
        player => Records::Shots(shots::measure(&spec, shard, player, args.rule, reward)),
    };
    Ok((spec, records))
}

/// Returns the request to the recommender.
fn request(args: &Args, skill: Skill) -> Request {
    // The command line accepts one of the two; the default of the other does not count.
    let (budget, simulations) = search_limits(None, args.simulations, args.budget_ms);
    let doubt = args.choose_doubt.or(args.doubt).unwrap_or(Doubt::FULL);
    let Args { rule, plan, no_jumps, seed, .. } = *args;
    Request { rule, skill, doubt, plan, jumps: !no_jumps, budget, simulations, seed, ..Request::default() }
}
