//! `carom evaluate`: measure the recommender or a policy on held-out layouts.

use std::{
    f64::consts::PI,
    io::Write,
    time::{Duration, Instant},
};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;

mod drawn_tables;
mod robustness;
mod self_play;

use self::{
    drawn_tables::DrawnTables,
    robustness::{Robustness, Said},
};
use super::{
    Failure,
    input::{note_doubts, table_named},
    lookup::{policy_called, skill_called},
    recommend::coach_for,
};
use crate::{
    coach::{Doubt, Request, Skill},
    game::{Reward, Rule, scores},
    learning::{
        Policy, PolicyError, Proposal,
        evaluation::{HELD_OUT_SEED, SuccessRate, held_out_layouts},
    },
    physics::{CueInputs, has_room},
    printing,
    table::{Layout, Table},
};

/// Measure the recommender, or with --policy-only the networks alone, on layouts that nobody has practised: the share on
/// which the shot succeeds, with the 95 % confidence interval.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Args {
    /// Number of layouts.
    #[arg(long, default_value_t = 2_000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    layouts: u32,
    /// Seed of the layouts.
    #[arg(long, default_value_t = HELD_OUT_SEED)]
    seed: u64,
    /// The table: "match", "textbook", "thesis" or the path of a TOML file.
    #[arg(long, default_value = "match")]
    table: String,
    /// The policy: "bundled", the path of a file that `carom train` wrote, or the name under which one was kept.
    #[arg(long, value_name = "FILE", default_value = "bundled")]
    policy: String,
    /// Play the networks' own shot: one pass, no simulator call. What they say of it is set against what comes of it.
    #[arg(long)]
    policy_only: bool,
    /// With --policy-only, play every layout on a table of its own, drawn from what tables in clubs differ by from --table. The
    /// networks are told its constants, if they take them; with --skill it is as well known as "match".
    #[arg(long, requires = "policy_only")]
    drawn_tables: bool,
    /// What counts as a point: straight, one-cushion or three-cushion.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// With --policy-only, what is measured in place of the rule: r1, r1-difficulty, r2, r3 or r4. Where it is more than
    /// yes or no, the mean is given.
    #[arg(long, requires = "policy_only", conflicts_with_all = ["rule", "random_search", "budget_ms"])]
    reward: Option<Reward>,
    /// Measure a search of so many shots of random phi and V, which the simulator checks: the first that succeeds counts.
    #[arg(long, value_name = "SHOTS", conflicts_with_all = ["policy_only", "policy", "budget_ms"],
        value_parser = clap::value_parser!(u32).range(1..))]
    random_search: Option<u32>,
    /// Who plays the shots: perfect, expert, world-class, national, club, beginner, own (what `carom drill skill --keep` kept), or a player's own standard errors in mm, degrees and m/s like
    /// "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1". The make probability is measured too, on independent errors.
    #[arg(long, value_parser = skill_called, conflicts_with_all = ["random_search", "reward"])]
    skill: Option<Skill>,
    /// What is not known besides the hand's errors: full, none, or like "table=1,placing=3". Shots are chosen with it and
    /// played on tables and from places that are drawn from it.
    #[arg(long, default_value_t = Doubt::FULL, conflicts_with_all = ["random_search", "reward"])]
    doubt: Doubt,
    /// Choose shots with this doubt instead, and only play them with --doubt.
    #[arg(long, value_name = "DOUBT", requires = "skill", conflicts_with_all = ["policy_only", "random_search", "self_play"])]
    choose_doubt: Option<Doubt>,
    /// Play innings: the recommended shot with the player's errors, until a miss, one inning a layout. The skill is
    /// expert where none is given.
    #[arg(long, conflicts_with_all = ["policy_only", "random_search", "reward"])]
    self_play: bool,
    /// With --self-play, points after which an inning is broken off.
    #[arg(long, requires = "self_play", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..))]
    most_points: u32,
    /// With --self-play, minutes after which play is broken off; fractions are accepted.
    #[arg(long, requires = "self_play", allow_negative_numbers = true)]
    minutes: Option<f64>,
    /// Rank shots by the probability of this point and the next.
    #[arg(long, conflicts_with_all = ["policy_only", "random_search"])]
    plan: bool,
    /// Advise neither jumps over a ball nor massés, as most clubs have it.
    #[arg(long, conflicts_with_all = ["policy_only", "random_search"])]
    no_jumps: bool,
    /// Time that the recommender has for a layout, ms.
    #[arg(long, default_value_t = 500, conflicts_with = "policy_only")]
    budget_ms: u64,
    /// Simulations that the recommender has for a layout in place of a time: the answer is then the same on any machine.
    #[arg(long, value_name = "COUNT", conflicts_with_all = ["policy_only", "random_search", "budget_ms"],
        value_parser = clap::value_parser!(u64).range(1..))]
    simulations: Option<u64>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// What is printed.
#[derive(Debug, Serialize)]
struct EvaluationReport {
    player: &'static str,
    /// Of players that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    policy: Option<String>,
    table: String,
    /// The reward or the rule.
    measure: &'static str,
    seed: u64,
    mean_reward: f64,
    /// Of rewards that are 0 or 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    success: Option<SuccessRate>,
    /// Decisions a second; judging the shots is not counted.
    layouts_per_second: f64,
    slowest_ms: f64,
    /// The share of the strokes that are harder than [`HARD`].
    hard_share: f64,
    /// Of the recommender.
    #[serde(skip_serializing_if = "Option::is_none")]
    simulations_per_layout: Option<f64>,
    /// What the networks say of their shots, where no skill is given.
    #[serde(flatten)]
    said: Option<Said>,
    /// What each shot earned.
    #[serde(skip)]
    rewards: Vec<f64>,
    /// How often the player of the skill makes the shots.
    #[serde(skip_serializing_if = "Option::is_none")]
    robustness: Option<Robustness>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let table = table_named(&args.table)?;
    let rule_reward = Reward::for_rule(args.rule);
    if args.self_play {
        return self_play::run(args, table);
    }
    // The player and what it is measured by are all that differs.
    let report = if let Some(shots) = args.random_search {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(args.seed);
        measure(args, &table, "random search", rule_reward, &mut |table, layout| {
            random_search(table, layout, args.rule, shots, &mut rng)
        })
    } else if args.policy_only {
        let reward = args.reward.unwrap_or(rule_reward);
        let skill = args.skill.unwrap_or(Skill::PERFECT);
        let policy = policy_named(&args.policy, &table, reward.rule().unwrap_or_default())?;
        note_doubts(&policy, &table, reward.rule());
        let mut said = Vec::new();
        let mut report = measure(args, &table, POLICY, reward, &mut |table, layout| {
            let Proposal { cue, success } = policy.proposals(table, layout, &skill)[0];
            said.push(Some(success));
            cue
        });
        report.take_note_of(&said);
        report
    } else {
        let coach = coach_for(table.clone(), &args.policy)?;
        let request = request(args, args.skill.unwrap_or(Skill::PERFECT));
        let mut simulations = 0;
        let mut claimed = Vec::new();
        let mut report = measure(args, &table, "recommender", rule_reward, &mut |_, layout| {
            coach.recommend(layout, &request).map_or(NO_SHOT, |advice| {
                simulations += advice.simulations;
                claimed.push(advice.make_probability.map(|chance| chance.rate));
                advice.cue
            })
        });
        report.simulations_per_layout = Some(simulations as f64 / f64::from(args.layouts));
        if let Some(robustness) = &mut report.robustness {
            robustness.claim(&claimed);
        }
        report
    };
    if args.json {
        let mut out = printing::stdout();
        printing::json(&mut out, &report)?;
        writeln!(out)?;
    } else {
        print(&mut printing::stdout(), &report, args.layouts)?;
    }
    Ok(())
}

impl EvaluationReport {
    /// Takes note of what was said of every shot beforehand: of the player's attempts, or else of the shot itself where that is
    /// a point or none.
    fn take_note_of(&mut self, said: &[Option<f64>]) {
        match &mut self.robustness {
            Some(robustness) => robustness.claim(said),
            None if self.success.is_some() => self.said = Some(Said::new(said, &self.rewards)),
            None => {}
        }
    }
}

/// What the recommender is asked for.
fn request(args: &Args, skill: Skill) -> Request {
    let (budget, simulations) = match args.simulations {
        Some(simulations) => (Duration::MAX, simulations),
        None => (Duration::from_millis(args.budget_ms), u64::MAX),
    };
    let doubt = args.choose_doubt.unwrap_or(args.doubt);
    let Args { rule, plan, no_jumps, seed, .. } = *args;
    Request { rule, skill, doubt, plan, jumps: !no_jumps, budget, simulations, seed, ..Request::default() }
}

/// Speed above which a stroke counts as a hard one, m/s: filmed players' balls leave the cue at 3.5 m/s, after a stroke of 2.5.
const HARD: f64 = 5.0;

/// Name of the networks alone as a player.
const POLICY: &str = "policy";

/// What a recommender plays that refuses a layout. Held-out layouts are possible, so none is refused.
const NO_SHOT: CueInputs = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: 1e-3 };

/// The first of `shots` shots in a random direction at a random speed that the cue has room for and that makes the point; the last
/// one where none does.
fn random_search(table: &Table, layout: &Layout, rule: Rule, shots: u32, rng: &mut Xoshiro256PlusPlus) -> CueInputs {
    let mut cue = NO_SHOT;
    for _ in 0..shots {
        let (phi, speed) = (rng.random_range(-PI..PI), rng.random_range(0.5..6.0));
        cue = CueInputs { a: 0.0, b: 0.0, theta: 10_f64.to_radians(), phi, speed };
        if has_room(table, layout, &cue) && scores(rule, table, layout, &cue) {
            break;
        }
    }
    cue
}

/// Lets `player` decide on every layout and plays what it decides.
fn measure(
    args: &Args,
    table: &Table,
    name: &'static str,
    reward: Reward,
    player: &mut dyn FnMut(&Table, &Layout) -> CueInputs,
) -> EvaluationReport {
    let (mut total, mut successes, mut hard, mut seconds, mut slowest) = (0.0, 0, 0, 0.0, 0.0_f64);
    let (mut chances, mut rewards) = (Vec::new(), Vec::new());
    let mut drawn = args.drawn_tables.then(|| DrawnTables::around(table, args.seed));
    for layout in held_out_layouts(table, args.layouts as usize, args.seed) {
        let own = drawn.as_mut().map(DrawnTables::draw);
        let table = own.as_ref().unwrap_or(table);
        let start = Instant::now();
        let cue = player(table, &layout);
        let taken = start.elapsed().as_secs_f64();
        seconds += taken;
        slowest = slowest.max(taken);
        let earned = reward.of(table, &layout, &cue);
        total += earned;
        rewards.push(earned);
        successes += usize::from(earned >= 1.0);
        hard += usize::from(cue.speed > HARD);
        if let Some(skill) = args.skill {
            chances.push(robustness::chance(args, table, &layout, skill, &cue));
        }
    }
    let count = args.layouts as usize;
    EvaluationReport {
        player: name,
        policy: args.random_search.is_none().then(|| args.policy.clone()),
        table: if args.drawn_tables { format!("tables like {}", table.name) } else { table.name.clone() },
        measure: if name == POLICY { reward.name() } else { args.rule.name() },
        seed: args.seed,
        mean_reward: total / count as f64,
        success: (reward == Reward::R1 || reward.rule().is_some()).then(|| SuccessRate::new(successes, count)),
        layouts_per_second: count as f64 / seconds.max(f64::MIN_POSITIVE),
        slowest_ms: 1e3 * slowest,
        hard_share: hard as f64 / count as f64,
        simulations_per_layout: None,
        said: None,
        rewards,
        robustness: args.skill.map(|skill| Robustness::new(skill, args.doubt, chances)),
    }
}

fn print(out: &mut impl Write, report: &EvaluationReport, layouts: u32) -> std::io::Result<()> {
    let EvaluationReport { player, policy, table, measure, .. } = report;
    let policy = policy.as_ref().map_or_else(String::new, |policy| format!(" {policy}"));
    match report.success {
        Some(SuccessRate { rate, low, high, .. }) => writeln!(
            out,
            "{player}{policy} on \"{table}\": {measure} on {:.2} % of {layouts} layouts (95 % interval {:.2} to {:.2} %)",
            100.0 * rate,
            100.0 * low,
            100.0 * high
        )?,
        None => writeln!(
            out,
            "{player}{policy} on \"{table}\": mean {measure} {:.4} over {layouts} layouts",
            report.mean_reward
        )?,
    }
    write!(out, "{:.0} layouts a second, the slowest took {:.2} ms", report.layouts_per_second, report.slowest_ms)?;
    match report.simulations_per_layout {
        Some(simulations) => writeln!(out, ", {simulations:.1} simulations a layout")?,
        None => writeln!(out)?,
    }
    writeln!(out, "{:.1} % of the strokes are harder than {HARD} m/s", 100.0 * report.hard_share)?;
    report.said.as_ref().map_or(Ok(()), |said| writeln!(out, "{said}"))?;
    report.robustness.as_ref().map_or(Ok(()), |robustness| writeln!(out, "{robustness}"))
}

/// The bundled policy for `rule` on `table`, or the one in the file.
fn policy_named(name: &str, table: &Table, rule: Rule) -> Result<Policy, Failure> {
    let policy = if name == "bundled" {
        Policy::bundled(table, rule).ok_or_else(|| {
            Failure::wrong_input(format_args!(
                "no policy is bundled for this table \"{}\"; use --table match or thesis, or --policy FILE with one from \
                 `carom train`",
                table.name
            ))
        })?
    } else {
        policy_called(name)
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
        let args = args(&["--layouts", "50"]);
        let mut at_the_first_ball = |_: &Table, layout: &Layout| CueInputs {
            a: 0.0,
            b: 0.0,
            theta: 0.1,
            phi: (layout.balls[1] - layout.balls[0]).to_angle(),
            speed: 4.0,
        };
        let report = measure(&args, &table, "straight", Reward::R1, &mut at_the_first_ball);
        let success = report.success.unwrap();
        assert_eq!((report.mean_reward, success.successes, success.trials), (1.0, 50, 50));
        assert!(success.low > 0.9 && report.layouts_per_second > 0.0);
    }

    #[test]
    fn unknown_tables_and_policies_are_named() {
        assert!(table_named("snooker").unwrap_err().to_string().contains("snooker"));
        let mut own = Table::preset("thesis").unwrap();
        own.name = "cellar".to_owned();
        assert!(policy_named("bundled", &own, Rule::OneCushion).unwrap_err().to_string().contains("cellar"));
        assert!(policy_named("no/such/file", &own, Rule::OneCushion).unwrap_err().to_string().contains("no/such/file"));
    }
}
