//! `carom evaluate`: measure a policy on held-out layouts.

use std::{path::Path, time::Instant};

use serde::Serialize;

use super::{Failure, input::table_named};
use crate::{
    game::Reward,
    learning::{
        Policy, PolicyError,
        evaluation::{HELD_OUT_SEED, SuccessRate, held_out_layouts},
    },
    physics::CueInputs,
    table::{Layout, Table},
};

/// Measure a policy on layouts that it has not practised: the share on which its shot succeeds, with the 95 % confidence
/// interval.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Number of layouts.
    #[arg(long, default_value_t = 2_000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    layouts: u32,
    /// Seed of the layouts.
    #[arg(long, default_value_t = HELD_OUT_SEED)]
    seed: u64,
    /// The table: "match", "thesis" or the path of a TOML file.
    #[arg(long, default_value = "match")]
    table: String,
    /// The policy: "bundled" or the path of a file that `carom train` wrote.
    #[arg(long, value_name = "FILE", default_value = "bundled")]
    policy: String,
    /// Play the networks' own shot: one pass, no simulator call.
    #[arg(long)]
    policy_only: bool,
    /// What counts as a success: r1 or r3. Of the others, which have no success, the mean is given.
    #[arg(long, default_value_t = Reward::R3)]
    reward: Reward,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// What is printed.
#[derive(Debug, Serialize)]
struct Report {
    player: &'static str,
    policy: String,
    table: String,
    reward: Reward,
    seed: u64,
    mean_reward: f64,
    /// Of rewards that are 0 or 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    success: Option<SuccessRate>,
    /// Decisions a second; judging the shots is not counted.
    layouts_per_second: f64,
    slowest_ms: f64,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let table = table_named(&args.table)?;
    let policy = policy_named(&args.policy, &table)?;
    let trained_on = &policy.origin().table;
    if *trained_on != table.name {
        eprintln!("note: this policy was trained on \"{trained_on}\", not on \"{}\"", table.name);
    }
    // The player is all that differs between what can be measured.
    let report = measure(args, &table, "policy", &mut |layout| policy.propose(&table, layout));
    if args.json {
        println!("{}", serde_json::to_string(&report).map_err(Failure::failed)?);
    } else {
        print(&report, args.layouts);
    }
    Ok(())
}

/// Lets `player` decide on every layout and plays what it decides.
fn measure(args: &Args, table: &Table, name: &'static str, player: &mut dyn FnMut(&Layout) -> CueInputs) -> Report {
    let (mut total, mut successes, mut seconds, mut slowest) = (0.0, 0, 0.0, 0.0_f64);
    for layout in held_out_layouts(table, args.layouts as usize, args.seed) {
        let start = Instant::now();
        let cue = player(&layout);
        let taken = start.elapsed().as_secs_f64();
        seconds += taken;
        slowest = slowest.max(taken);
        let reward = args.reward.of(table, &layout, &cue);
        total += reward;
        successes += usize::from(reward >= 1.0);
    }
    let count = args.layouts as usize;
    let is_binary = matches!(args.reward, Reward::R1 | Reward::R3);
    Report {
        player: name,
        policy: args.policy.clone(),
        table: table.name.clone(),
        reward: args.reward,
        seed: args.seed,
        mean_reward: total / count as f64,
        success: is_binary.then(|| SuccessRate::new(successes, count)),
        layouts_per_second: count as f64 / seconds.max(f64::MIN_POSITIVE),
        slowest_ms: 1e3 * slowest,
    }
}

fn print(report: &Report, layouts: u32) {
    let Report { player, policy, table, reward, .. } = report;
    match report.success {
        Some(SuccessRate { rate, low, high, .. }) => println!(
            "{player} {policy} on \"{table}\": {reward} on {:.2} % of {layouts} layouts (95 % interval {:.2} to {:.2} %)",
            100.0 * rate,
            100.0 * low,
            100.0 * high
        ),
        None => {
            println!(
                "{player} {policy} on \"{table}\": mean {reward} {:.4} over {layouts} layouts",
                report.mean_reward
            );
        }
    }
    println!("{:.0} layouts a second, the slowest took {:.2} ms", report.layouts_per_second, report.slowest_ms);
}

/// The bundled policy for `table`, or the one in the file.
fn policy_named(name: &str, table: &Table) -> Result<Policy, Failure> {
    let policy = if name == "bundled" {
        Policy::bundled(&table.name).ok_or_else(|| {
            Failure::wrong_input(format_args!(
                "no policy is bundled for the table \"{}\"; use --table match, or --policy FILE with one from `carom train`",
                table.name
            ))
        })?
    } else {
        Policy::load(Path::new(name))
    };
    policy.map_err(|error: PolicyError| Failure::failed(error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    fn args(line: &[&str]) -> Args {
        Line::parse_from(std::iter::once(&"evaluate").chain(line)).args
    }

    #[test]
    fn a_player_is_measured_with_its_interval() {
        let table = Table::default();
        let args = args(&["--layouts", "50", "--reward", "r1"]);
        let mut at_the_first_ball = |layout: &Layout| CueInputs {
            a: 0.0,
            b: 0.0,
            theta: 0.1,
            phi: (layout.balls[1] - layout.balls[0]).to_angle(),
            speed: 4.0,
        };
        let report = measure(&args, &table, "straight", &mut at_the_first_ball);
        let success = report.success.unwrap();
        assert_eq!((report.mean_reward, success.successes, success.layouts), (1.0, 50, 50));
        assert!(success.low > 0.9 && report.layouts_per_second > 0.0);
    }

    #[test]
    fn unknown_tables_and_policies_are_named() {
        assert!(table_named("snooker").unwrap_err().to_string().contains("snooker"));
        let thesis = Table::preset("thesis").unwrap();
        assert!(policy_named("bundled", &thesis).unwrap_err().to_string().contains("thesis"));
        assert!(policy_named("no/such/file", &thesis).unwrap_err().to_string().contains("no/such/file"));
    }
}
