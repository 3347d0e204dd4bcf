//! `carom train`: train an agent without a screen.

use std::{
    fmt::Write as _,
    io::{IsTerminal, Write as _},
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use indicatif::{ProgressBar, ProgressStyle};
use signal_hook::{
    consts::{SIGINT, SIGTERM},
    flag,
};

use super::{Failure, input::table_named};
use crate::{
    game::Reward,
    learning::{
        learner::{Agent, Learner, Plan, StartError},
        metrics::Record,
        run::{Run, RunError},
        timestamp,
    },
    storage::Places,
};

/// Train an agent without a screen. The run's folder holds its configuration, its metrics as JSON Lines, the last
/// checkpoint and the policy. Ctrl-C saves and stops; --resume goes on as if nothing had happened.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The agent.
    #[arg(long, default_value = "ddpg")]
    agent: String,
    /// What it is rewarded for: r1, r1-difficulty, r2, r3 or r4.
    #[arg(long, default_value_t = Reward::R3)]
    reward: Reward,
    /// The table: "match", "thesis" or the path of a TOML file.
    #[arg(long, default_value = "match")]
    table: String,
    /// Seed of everything random: the same seed gives the same weights.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Shots to play. The learning rates fall to nothing over them.
    #[arg(long, value_name = "SHOTS", default_value_t = 20_000_000, value_parser = clap::value_parser!(u64).range(1..))]
    steps: u64,
    /// Stop after this many minutes, finished or not.
    #[arg(long, allow_negative_numbers = true)]
    minutes: Option<f64>,
    /// Hyper-parameters that differ from the defaults, as a TOML file.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// The run's folder; by default a new one among the user's runs.
    #[arg(long, value_name = "DIR")]
    run: Option<PathBuf>,
    /// Go on with the run in this folder, with the settings that it was started with.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["agent", "reward", "table", "seed", "steps", "config", "run"])]
    resume: Option<PathBuf>,
    /// Print the metrics as JSON Lines on standard output.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let limit = args.minutes.map(minutes).transpose()?;
    let (run, mut learner) = match &args.resume {
        Some(folder) => Run::resume(folder).map_err(failure)?,
        None => start(args)?,
    };
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // The second signal ends the program at once: the first one waits for the turn and the evaluation.
        flag::register_conditional_shutdown(signal, 1, Arc::clone(&stop)).map_err(Failure::failed)?;
        flag::register(signal, Arc::clone(&stop)).map_err(Failure::failed)?;
    }
    let mut screen = Screen::new(learner.as_ref(), run.folder(), args.json);
    let stopped = || stop.load(Ordering::Relaxed);
    let score = run.practise(learner.as_mut(), limit, &stopped, &mut |record| screen.show(record)).map_err(failure)?;
    screen.bar.finish_and_clear();
    if !args.json {
        println!(
            "{}: mean {} {:.4} on held-out layouts after {} shots",
            run.policy_path().display(),
            learner.plan().reward,
            score.mean_reward,
            learner.shots()
        );
    }
    if !learner.is_finished() {
        eprintln!("stopped early; go on with: carom train --resume \"{}\"", run.folder().display());
    }
    Ok(())
}

fn start(args: &Args) -> Result<(Run, Box<dyn Learner>), Failure> {
    let agent = Agent::named(&args.agent).map_err(Failure::wrong_input)?;
    let settings = match &args.config {
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|error| Failure::failed(format_args!("{}: {error}", path.display())))?;
            toml::from_str(&text).map_err(|error| {
                Failure::wrong_input(format_args!("the settings in {}: {}", path.display(), error.message()))
            })?
        }
        None => serde_json::json!({}),
    };
    let table = table_named(&args.table)?;
    let folder = args.run.clone().unwrap_or_else(|| {
        let name = format!("{}-{}-{}-{}-{}", timestamp(), agent.name, table.name, args.reward, args.seed);
        Places::of_this_user().runs.join(name)
    });
    let plan = Plan { reward: args.reward, seed: args.seed, shots: args.steps };
    let learner = (agent.start)(plan, table, settings).map_err(|error| match error {
        StartError::Settings(_) => Failure::wrong_input(error),
        StartError::Network(_) => Failure::failed(error),
    })?;
    Ok((Run::create(&folder, learner.as_ref()).map_err(failure)?, learner))
}

fn minutes(value: f64) -> Result<Duration, Failure> {
    let accepted = value > 0.0;
    let duration = Duration::try_from_secs_f64(60.0 * value).ok().filter(|_| accepted);
    duration.ok_or_else(|| {
        Failure::wrong_input(format_args!("--minutes {value} is no time to train; accepted is a number above 0"))
    })
}

fn failure(error: RunError) -> Failure {
    match error {
        RunError::Occupied(_) => Failure::wrong_input(error),
        _ => Failure::failed(error),
    }
}

/// What the user sees while training: a bar on a terminal, else a line for every evaluation.
struct Screen {
    bar: ProgressBar,
    json: bool,
}

impl Screen {
    fn new(learner: &dyn Learner, folder: &Path, json: bool) -> Self {
        let plan = learner.plan();
        eprintln!(
            "training {} for {} on \"{}\" with seed {} in {}",
            learner.agent(),
            plan.reward,
            learner.table().name,
            plan.seed,
            folder.display()
        );
        let bar = if std::io::stderr().is_terminal() { ProgressBar::new(plan.shots) } else { ProgressBar::hidden() };
        let template = "{elapsed_precise} {wide_bar} {human_pos}/{human_len} shots, {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_position(learner.shots());
        bar.reset_eta();
        Self { bar, json }
    }

    fn show(&mut self, record: &Record) {
        if self.json
            && let Ok(line) = serde_json::to_string(record)
        {
            // A reader that has gone away must not end the training.
            let _ = writeln!(std::io::stdout(), "{line}");
        }
        let mut summary = format!("critic loss {:.4}", record.critic_loss);
        if let Some(reward) = record.held_out_reward {
            // Writing to a string cannot fail.
            let _ = write!(summary, ", held-out reward {reward:.4}");
        }
        self.bar.set_position(record.shots);
        if record.held_out_reward.is_some() {
            self.bar.set_message(summary.clone());
            if self.bar.is_hidden() {
                eprintln!(
                    "{:.0} s, {} shots, {:.0}/s, {summary}",
                    record.seconds, record.shots, record.shots_per_second
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_time_is_refused_and_named() {
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(minutes(wrong).unwrap_err().to_string().contains(&wrong.to_string()));
        }
        assert_eq!(minutes(0.5).unwrap(), Duration::from_secs(30));
    }
}
