//! `carom reproduce`: retrains the thesis' agents and draws their learning curves.

use std::{io::Write, path::PathBuf, sync::atomic::Ordering};

use indicatif::{ProgressBar, ProgressStyle};

use super::{
    Failure,
    input::{parse_seed, table_by_name, whole_number, whole_number_from},
    output::{check_writable, print_note},
};
use crate::{
    platform::{stop_on_signal, thread_count},
    printing,
    storage::write_atomic,
    study::reproduction::{FIGURES, Figure, Measure, ReproducedFigure, Session, SessionError, csv, picture, summary},
};

/// Train the thesis' agents again and draw its learning curves.
///
/// These are figures 21 to 25 and 28 to 30, Q-learning, and DDPG with r2. Each is drawn for three meanings of the word "episode": one shot,
/// 20 shots, or until a miss. Two more figures use several seeds. Figure "noise" compares exploration noise of DDPG with three seeds from
/// --seed on. Figure "future-work" covers the thesis' future work, hindsight and demonstrations, with the five seeds after these (4 to 8
/// for --seed 1: seeds 1 to 3 were used to choose its settings).
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only this figure: q-learning, 21, 22, 23, 24, 25, 28, r2, 29, 30, noise or future-work. Can be repeated.
    #[arg(long = "figure", value_name = "NAME")]
    figures: Vec<String>,
    /// Number of shots of a training whose episodes are one shot; games get a quarter of them. Default: 50,000 for q-learning, 200,000 to
    /// 400,000 for the others
    #[arg(long, value_name = "SHOTS", value_parser = whole_number_from(1_u64))]
    episodes: Option<u64>,
    /// Seed of all random numbers: the same seed gives the same curves.
    #[arg(long, default_value_t = 1, value_parser = parse_seed)]
    seed: u64,
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file.
    #[arg(long, default_value = "thesis")]
    table: String,
    /// Number of trainings at the same time. The curves do not depend on it. Default: one on each processor
    #[arg(long, value_parser = whole_number(1..=1024_u16))]
    jobs: Option<u16>,
    /// Folder for a CSV and an SVG file of each figure.
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let named = args.figures.iter().map(|name| Figure::named(name).map_err(Failure::wrong_input));
    let mut figures: Vec<Figure> = named.collect::<Result<_, _>>()?;
    if figures.is_empty() {
        figures = FIGURES.to_vec();
    }
    check_writable(&args.out, &args.out)?;
    let session = Session {
        figures,
        shots: args.episodes,
        seed: args.seed,
        threads: args.jobs.map_or_else(thread_count, usize::from),
        table: table_by_name(&args.table)?,
    };
    let stop = stop_on_signal(Some(1)).map_err(Failure::failed)?;
    let bar = progress(session.shots());
    let mut done = 0;
    let played = |shots| {
        bar.inc(shots);
        !stop.load(Ordering::Relaxed)
    };
    let mut hand_over = |drawn: &ReproducedFigure| {
        done += 1;
        bar.suspend(|| write(args, drawn))
    };
    let result = session.run(&played, &mut hand_over);
    bar.finish_and_clear();
    result.map_err(|error| match error {
        SessionError::Start(error) => Failure::failed(error),
        SessionError::Output(error) => Failure::failed(format_args!("{}: {error}", args.out.display())),
    })?;
    if stop.load(Ordering::Relaxed) {
        let all = session.figures.len();
        return Err(Failure::failed(format_args!(
            "stopped with {done} of {all} figures complete, in {}",
            args.out.display()
        )));
    }
    Ok(())
}

/// Writes the files of a figure and prints the final values of its curves.
fn write(args: &Args, drawn: &ReproducedFigure) -> std::io::Result<()> {
    let curves: Vec<_> = drawn.curves.iter().collect();
    let name = drawn.figure.file_name();
    // Random play has a reward, but neither Q-values nor a loss.
    let random = (drawn.figure.measure == Measure::MeanReward).then_some(drawn.random);
    write_atomic(&args.out.join(format!("{name}.csv")), csv(drawn).as_bytes())?;
    write_atomic(&args.out.join(format!("{name}.svg")), picture(&drawn.figure, &curves, random)?.as_bytes())?;
    let mut out = printing::stdout();
    for line in summary(drawn) {
        // A closed output must not end the training.
        let _ = writeln!(out, "{line}");
    }
    Ok(())
}

fn progress(shots: u64) -> ProgressBar {
    if !printing::is_stderr_terminal() {
        print_note(format_args!("training for {shots} shots"));
        return ProgressBar::hidden();
    }
    let template = "{elapsed_precise} {wide_bar} {human_pos}/{human_len} shots, {eta} left";
    let bar = ProgressBar::new(shots);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}
