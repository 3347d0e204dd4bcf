//! `carom train`: train agents without a screen.

mod listing;
mod multi_seed;
mod progress;
mod spec;

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    sync::atomic::Ordering,
    time::Duration,
};

use serde_json::Value;

use self::progress::Progress;
pub(super) use self::{listing::print as print_runs, progress::line};
use super::{
    Failure,
    input::{minutes, seed, whole, whole_from},
    lookup::{LATEST, existing_run},
    output::tell,
};
use crate::{
    game::Reward,
    learning::{
        agents::AGENTS,
        ddpg::learner::STANDING_STILL,
        evaluation::Score,
        learner::StartError,
        run::{Ending, Limits, Run, RunError, discard, holds_checkpoints, seeds::is_group},
    },
    platform::{UNFINISHED, limit_threads, outlive_hang_up, stop_when_told},
    printing::{self, shell_word},
};

/// Train an agent without a screen.
///
/// The run's folder holds its configuration (config.json), its metrics as JSON Lines (metrics.jsonl), the last two checkpoints
/// and the policy. Ctrl-C saves and stops, twice it stops at once; --resume goes on as if nothing had happened, after a crash
/// too: to the same weights, bit for bit.
#[derive(Debug, clap::Args)]
#[command(override_usage = "carom train [OPTIONS]\n       carom train --list [DIR] [--json]")]
#[expect(clippy::option_option, reason = "clap's way to tell a flag that is missing from one without a value")]
pub struct Args {
    #[arg(long, help = agents())]
    agent: Option<String>,
    #[arg(long, help = rewards())]
    reward: Option<Reward>,
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file. By default as --from, or "match".
    #[arg(long)]
    table: Option<String>,
    /// Seed of everything random: the same seed gives the same weights.
    #[arg(long, default_value_t = 1, value_parser = seed)]
    seed: u64,
    /// Shots to play. The learning rates fall to nothing over them. The agent ddpg plays rollouts, of 192 shots by
    /// default: its run ends with the first rollout that reaches this number.
    #[arg(long, value_name = "SHOTS", default_value_t = 5_000_000, value_parser = whole_from(1_u64))]
    steps: u64,
    /// Settings of the agent that differ from its defaults, or from those of --from, as a TOML file.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// One such setting, after those of the file: --set actions=full, --set ranking=0.5, --set heads=8. May be repeated.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Start with the weights of another run (its folder, or its name), of a checkpoint or policy file, or of a policy that was kept
    /// or is bundled, by its name: same networks, new optimiser, new memory, new schedule.
    #[arg(long, value_name = "RUN|FILE|NAME")]
    from: Option<PathBuf>,
    /// Shots between two measurements on held-out layouts; by default a fiftieth of the shots, or 10,000 where that is more.
    #[arg(long, value_name = "SHOTS", value_parser = whole_from(1_u64))]
    evaluate_every: Option<u64>,
    /// Held-out layouts of a measurement.
    #[arg(long, value_name = "N", default_value_t = 2_000, value_parser = whole(1..=10_000_000_u32))]
    evaluation_layouts: u32,
    /// The run's folder; by default a new one among the user's runs, called after the moment of its start and what is
    /// trained, with -2, -3 and so on behind where that name is taken.
    #[arg(long, value_name = "DIR")]
    run: Option<PathBuf>,
    /// Go on with the run in the folder of --run where it holds one, and start it where it holds none: the same command
    /// again and again brings a run to its end.
    #[arg(long, requires = "run")]
    r#continue: bool,
    /// Train so many seeds, from --seed on, each in a folder of the run's folder, and write the spread to seeds.csv.
    #[arg(long, value_name = "N", value_parser = whole(1..=1000_u64))]
    seeds: Option<u64>,
    /// Go on with this run or these seeds (a folder, a name among the user's runs, or "latest"), with the settings they
    /// started with.
    #[arg(long, value_name = "RUN", conflicts_with_all = [
        "agent", "reward", "table", "seed", "steps", "config", "set", "from", "evaluate_every", "evaluation_layouts", "run",
        "seeds", "continue",
    ])]
    resume: Option<PathBuf>,
    /// Seeds that are trained at the same time, a thread each.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole(1..=256_u32))]
    jobs: u32,
    /// Threads that the searches of a run may use (setting searched). Default: one on each processor
    #[arg(long, value_name = "N", value_parser = whole(1..=1024_u16))]
    threads: Option<u16>,
    /// Stop after this many minutes, finished or not.
    #[arg(long)]
    minutes: Option<f64>,
    /// List the runs in this folder, by default the user's, and train nothing.
    #[arg(long, value_name = "DIR", num_args = 0..=1, conflicts_with_all = [
        "agent", "reward", "table", "seed", "steps", "config", "set", "from", "evaluate_every", "evaluation_layouts", "run",
        "continue", "seeds", "resume", "jobs", "threads", "minutes",
    ])]
    list: Option<Option<PathBuf>>,
    /// Print the metrics, or the list, as JSON Lines on standard output.
    #[arg(long)]
    json: bool,
    /// Print nothing on standard output but, at the end, the objective to maximise: the mean reward on the held-out layouts; of several
    /// seeds their mean, once all of them have played their last shot.
    #[arg(long, conflicts_with_all = ["json", "list"])]
    objective: bool,
}

fn agents() -> String {
    let agents = AGENTS.map(|agent| format!("{} ({})", agent.name, agent.title)).join(", ");
    format!("The agent: {agents}. By default that of --from, or ddpg")
}

fn rewards() -> String {
    let rewards = Reward::ALL.map(Reward::name).join(", ");
    format!("What it is rewarded for: {rewards}. By default as --from, or {}", Reward::default())
}

/// How long to train and how to report.
struct TrainOptions<'a> {
    limit: Option<Duration>,
    stop: &'a (dyn Fn() -> bool + Sync),
    json: bool,
    objective: bool,
}

impl TrainOptions<'_> {
    /// The limits of one run that may take so long.
    fn limits(&self, time: Option<Duration>) -> Limits<'_> {
        Limits { time, stop: self.stop }
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(folder) = &args.list {
        return listing::print(folder.as_deref(), args.json).map(drop);
    }
    let limit = args.minutes.map(minutes).transpose()?;
    if let Some(threads) = args.threads {
        limit_threads(threads.into());
    }
    // The first signal waits for the iteration and a measurement that is due, saves, and measures; the second ends that.
    let stop = stop_when_told(Some(UNFINISHED)).map_err(Failure::failed)?;
    // The run can be watched and stopped from the next terminal.
    outlive_hang_up().map_err(Failure::failed)?;
    let options =
        TrainOptions { limit, stop: &|| stop.load(Ordering::Relaxed), json: args.json, objective: args.objective };
    if let Some(name) = &args.resume {
        let found = existing_run(name)?;
        // The latest run may be one of several seeds, which go on together.
        let group = found.parent().filter(|folder| name == Path::new(LATEST) && is_group(folder));
        return resume(group.unwrap_or(&found), args.jobs, &options);
    }
    let folder = args.run.as_deref().filter(|folder| is_group(folder) || holds_checkpoints(folder));
    if let Some(folder) = folder.filter(|_| args.r#continue) {
        spec::same_spec(args, folder)?;
        return resume(folder, args.jobs, &options);
    }
    let read = spec::read(args)?;
    let rate = read.spec.settings.get("actor_learning_rate").and_then(Value::as_f64);
    if let Some(rate) = rate.filter(|rate| *rate < STANDING_STILL && args.from.is_some()) {
        tell(format_args!(
            "note: the actor stays as it is, for actor_learning_rate is {rate:e}, as --from may bring along; --set \
             actor_learning_rate=0.0004 lets it learn"
        ));
    }
    if let Some(seeds) = args.seeds {
        let last = u64::MAX - (seeds - 1);
        if args.seed > last {
            return Err(Failure::wrong_input(format_args!(
                "--seeds {seeds} from --seed {} on goes beyond the last seed there is; accepted is --seed 0 to {last}",
                args.seed
            )));
        }
        return multi_seed::start(&read, seeds, args.jobs, &options);
    }
    for_one_run(args.jobs)?;
    let spec::Read { spec, weights, .. } = &read;
    let run = read.begin(|folder| spec.start(folder, spec.plan.seed, weights.as_ref())).map_err(failure)?;
    train(run, &options)
}

/// Refuses to train one run several at a time.
fn for_one_run(jobs: u32) -> Result<(), Failure> {
    if jobs == 1 {
        return Ok(());
    }
    Err(Failure::wrong_input(format_args!("--jobs {jobs} is for several seeds; say how many by --seeds")))
}

/// Goes on with one run or several.
fn resume(folder: &Path, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    if is_group(folder) {
        return multi_seed::resume(folder, jobs, options);
    }
    for_one_run(jobs)?;
    let (run, notices) = Run::resume(folder).map_err(failure)?;
    for notice in notices {
        tell(format_args!("warning: {notice}"));
    }
    train(run, options)
}

/// Trains one run and says how it ended.
fn train(mut run: Run, options: &TrainOptions<'_>) -> Result<(), Failure> {
    let learner = run.learner();
    if learner.is_finished() {
        tell(format_args!(
            "{} is finished: it has played {} shots (asked for: {}); start a new run with its weights by --from",
            run.folder().display(),
            learner.shots(),
            learner.plan().shots
        ));
    }
    let mut progress = Progress::new(&run, options.json, None);
    let ending = run.train(&options.limits(options.limit), &mut progress);
    let written = progress.close();
    match ending.map_err(failure)? {
        Ending::Finished(score) => {
            written?;
            say_result(&run, score, options)?;
        }
        Ending::Stopped(score) => {
            // Whether or not it can be told: who called has to know that this is not the end.
            let _ = say_result(&run, score, options);
            return Err(how_to_go_on(run.folder()));
        }
        Ending::Abandoned => return Err(abandon(run).map_err(failure)?),
    }
    Ok(())
}

fn say_result(run: &Run, score: Score, options: &TrainOptions<'_>) -> io::Result<()> {
    if options.objective {
        return writeln!(printing::stdout(), "{}", score.mean_reward);
    }
    let learner = run.learner();
    let result = if run.policy_path().exists() { run.policy_path() } else { run.folder().to_owned() };
    if options.json {
        return Ok(());
    }
    writeln!(
        printing::stdout(),
        "{}: mean {} {:.4} on held-out layouts after {} shots",
        result.display(),
        learner.plan().reward,
        score.mean_reward,
        learner.shots()
    )
}

/// Removes a run that was given up, which is not finished.
fn abandon(run: Run) -> Result<Failure, RunError> {
    let folder = run.folder().to_owned();
    // It holds the lock.
    drop(run);
    discard(&folder)?;
    Ok(Failure::unfinished(format_args!("{}: given up and removed, as was asked", folder.display())))
}

fn how_to_go_on(folder: &Path) -> Failure {
    let folder = shell_word(&folder.to_string_lossy());
    Failure::unfinished(format_args!("stopped early; go on with: carom train --resume {folder}"))
}

fn failure(error: RunError) -> Failure {
    match error {
        RunError::Agent(_) | RunError::Origin { .. } | RunError::Start(StartError::Settings(_)) => {
            Failure::wrong_input(error)
        }
        RunError::Policy(error) => error.into(),
        _ => Failure::failed(error),
    }
}
