//! `carom train`: trains agents without a screen.

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
pub(super) use self::{listing::print as print_runs, progress::format_record};
use super::{
    Failure,
    input::{parse_minutes, parse_seed, whole_number, whole_number_from},
    lookup::{LATEST, existing_run},
    output::print_note,
};
use crate::{
    game::Reward,
    learning::{
        agents::AGENTS,
        ddpg::trainer::MIN_ACTOR_LEARNING_RATE,
        evaluation::Score,
        learner::StartError,
        run::{Ending, Limits, Run, RunError, contains_run, discard, seeds::is_group},
    },
    platform::{UNFINISHED, ignore_hang_up, limit_threads, stop_on_signal},
    printing::{self, shell_word},
};

/// Train an agent without a screen.
///
/// The run's folder contains its configuration (config.json), its metrics as JSON Lines (metrics.jsonl), the last two checkpoints and the
/// policy. Ctrl-C saves and stops; a second Ctrl-C stops at once. --resume continues without any difference, even after a crash: to the
/// same weights, bit for bit.
#[derive(Debug, clap::Args)]
#[command(override_usage = "carom train [OPTIONS]\n       carom train --list [DIR] [--json]")]
#[expect(clippy::option_option, reason = "clap's way to tell a flag that is missing from one without a value")]
pub struct Args {
    #[arg(long, help = agents())]
    agent: Option<String>,
    #[arg(long, help = rewards())]
    reward: Option<Reward>,
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file. Default: that of --from, or
    /// "match".
    #[arg(long)]
    table: Option<String>,
    /// Seed of all random numbers: the same seed gives the same weights.
    #[arg(long, default_value_t = 1, value_parser = parse_seed)]
    seed: u64,
    /// Number of shots to play. The learning rates decay to zero over them. The agent ddpg plays rollouts, of 192 shots by default: its run
    /// ends with the first rollout that reaches this number.
    #[arg(long, value_name = "SHOTS", default_value_t = 5_000_000, value_parser = whole_number_from(1_u64))]
    steps: u64,
    /// A TOML file with settings of the agent that differ from its defaults, or from those of --from.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// A single setting, which takes precedence over the file: --set actions=full, --set ranking=0.5, --set heads=8. Can be repeated.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Start with the weights of another run (its folder or its name), of a checkpoint or policy file, or of a saved or bundled policy (its
    /// name): same networks, new optimiser, new replay buffer, new schedule.
    #[arg(long, value_name = "RUN|FILE|NAME")]
    from: Option<PathBuf>,
    /// Number of shots between two measurements on held-out layouts. Default: a fiftieth of the shots, or 10,000 if that is more.
    #[arg(long, value_name = "SHOTS", value_parser = whole_number_from(1_u64))]
    evaluate_every: Option<u64>,
    /// Number of held-out layouts of a measurement.
    // The default is enough for a standard error of half a percent near 0.95.
    #[arg(long, value_name = "N", default_value_t = 2_000, value_parser = whole_number(1..=10_000_000_u32))]
    evaluation_layouts: u32,
    /// The run's folder. Default: a new one among the user's runs, named after the start time and what is trained, with -2, -3 and so on
    /// appended if that name exists.
    #[arg(long, value_name = "DIR")]
    run: Option<PathBuf>,
    /// Resume the run in the folder of --run if it contains one, otherwise start it: repeating the same command completes a run.
    #[arg(long, requires = "run")]
    r#continue: bool,
    /// Train this many seeds, from --seed on, each in a subfolder of the run's folder, and write their spread to seeds.csv.
    #[arg(long, value_name = "N", value_parser = whole_number(1..=1000_u64))]
    seeds: Option<u64>,
    /// Resume this run or these seeds (a folder, a name among the user's runs, or "latest"), with their original settings.
    #[arg(long, value_name = "RUN", conflicts_with_all = [
        "agent", "reward", "table", "seed", "steps", "config", "set", "from", "evaluate_every", "evaluation_layouts", "run",
        "seeds", "continue",
    ])]
    resume: Option<PathBuf>,
    /// Number of seeds that are trained at the same time, one thread each.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_number(1..=256_u32))]
    jobs: u32,
    /// Number of threads that the searches of a run may use (setting searched). Default: one on each processor
    #[arg(long, value_name = "N", value_parser = whole_number(1..=1024_u16))]
    threads: Option<u16>,
    /// Stop after this many minutes, finished or not.
    #[arg(long)]
    minutes: Option<f64>,
    /// List the runs in this folder, by default the user's runs, and train nothing.
    #[arg(long, value_name = "DIR", num_args = 0..=1, conflicts_with_all = [
        "agent", "reward", "table", "seed", "steps", "config", "set", "from", "evaluate_every", "evaluation_layouts", "run",
        "continue", "seeds", "resume", "jobs", "threads", "minutes",
    ])]
    list: Option<Option<PathBuf>>,
    /// Print the metrics, or the list, as JSON Lines on standard output.
    #[arg(long)]
    json: bool,
    /// Print on standard output only the objective to maximise, at the end: the mean reward on the held-out layouts. For several seeds it
    /// is their mean, once all of them have played their last shot.
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

/// How long to train, and how to report.
struct TrainOptions<'a> {
    limit: Option<Duration>,
    stop: &'a (dyn Fn() -> bool + Sync),
    json: bool,
    objective: bool,
}

impl TrainOptions<'_> {
    /// Returns the limits of one run with this time limit.
    fn limits(&self, time: Option<Duration>) -> Limits<'_> {
        Limits { time, stop: self.stop }
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(folder) = &args.list {
        return listing::print(folder.as_deref(), args.json).map(drop);
    }
    let limit = args.minutes.map(parse_minutes).transpose()?;
    if let Some(threads) = args.threads {
        limit_threads(threads.into());
    }
    // The first signal waits for the current iteration and a measurement that is due, then saves and measures. The second signal ends that.
    let stop = stop_on_signal(Some(UNFINISHED)).map_err(Failure::failed)?;
    // After a hang-up, the run can still be watched and stopped from another terminal.
    ignore_hang_up().map_err(Failure::failed)?;
    let options =
        TrainOptions { limit, stop: &|| stop.load(Ordering::Relaxed), json: args.json, objective: args.objective };
    if let Some(name) = &args.resume {
        let found = existing_run(name)?;
        // The latest run may belong to a group of seeds, which are resumed together.
        let group = found.parent().filter(|folder| name == Path::new(LATEST) && is_group(folder));
        return resume(group.unwrap_or(&found), args.jobs, &options);
    }
    let folder = args.run.as_deref().filter(|folder| is_group(folder) || contains_run(folder));
    if let Some(folder) = folder.filter(|_| args.r#continue) {
        spec::check_same_spec(args, folder)?;
        return resume(folder, args.jobs, &options);
    }
    let request = spec::read(args)?;
    let rate = request.spec.settings.get("actor_learning_rate").and_then(Value::as_f64);
    if let Some(rate) = rate.filter(|rate| *rate < MIN_ACTOR_LEARNING_RATE && args.from.is_some()) {
        print_note(format_args!(
            "note: the actor will not change, because actor_learning_rate is {rate:e} (--from may have set it); --set \
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
        return multi_seed::start(&request, seeds, args.jobs, &options);
    }
    check_single_run(args.jobs)?;
    let spec::TrainingRequest { spec, weights, .. } = &request;
    let run = request.begin(|folder| spec.start(folder, spec.plan.seed, weights.as_ref())).map_err(failure)?;
    train(run, &options)
}

/// Refuses --jobs above 1 for a single run.
fn check_single_run(jobs: u32) -> Result<(), Failure> {
    if jobs == 1 {
        return Ok(());
    }
    Err(Failure::wrong_input(format_args!("--jobs {jobs} is for several seeds; give their number with --seeds")))
}

/// Resumes one run or a group of seeds.
fn resume(folder: &Path, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    if is_group(folder) {
        return multi_seed::resume(folder, jobs, options);
    }
    check_single_run(jobs)?;
    let (run, notices) = Run::resume(folder).map_err(failure)?;
    for notice in notices {
        print_note(format_args!("warning: {notice}"));
    }
    train(run, options)
}

/// Trains one run and reports the result.
fn train(mut run: Run, options: &TrainOptions<'_>) -> Result<(), Failure> {
    let learner = run.learner();
    if learner.is_finished() {
        print_note(format_args!(
            "{} is finished: it has played {} shots (requested: {}); to start a new run with its weights, use --from",
            run.folder().display(),
            learner.shots(),
            learner.plan().shots
        ));
    }
    let mut progress = Progress::new(&run, options.json, None);
    progress.repeat_result(&run).map_err(failure)?;
    let ending = run.train(&options.limits(options.limit), &mut |report| progress.report(report));
    let written = progress.close();
    match ending.map_err(failure)? {
        Ending::Finished(score) => {
            written?;
            print_result(&run, score, options)?;
        }
        Ending::Stopped(score) => {
            // Ignore output errors: the caller must learn from the exit code that the run is not complete.
            let _ = print_result(&run, score, options);
            return Err(how_to_resume(run.folder()));
        }
        Ending::Abandoned => return Err(abandon(run).map_err(failure)?),
    }
    Ok(())
}

fn print_result(run: &Run, score: Score, options: &TrainOptions<'_>) -> io::Result<()> {
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

/// Removes the files of an abandoned run and returns the failure to report.
fn abandon(run: Run) -> Result<Failure, RunError> {
    let folder = run.folder().to_owned();
    // The run holds the lock of the folder.
    drop(run);
    discard(&folder)?;
    Ok(Failure::unfinished(format_args!("{}: abandoned and removed, as requested", folder.display())))
}

fn how_to_resume(folder: &Path) -> Failure {
    let folder = shell_word(&folder.to_string_lossy());
    Failure::unfinished(format_args!("stopped early; resume with: carom train --resume {folder}"))
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
