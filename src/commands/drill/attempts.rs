//! `carom drill try`, `run` and `exam`: exercises that are played in the simulator.

use super::{
    PlayOptions, Workspace,
    listing::parse_category,
    options::StrokeInput,
    strokes::{MAX_STROKES, Strokes, play},
};
use crate::{
    commands::{Failure, input::whole_number},
    drills::{
        Category, Goal,
        exam::{HIGHEST_LEVEL, LENGTH, draw},
    },
};

/// Play a stroke at an exercise with the player's errors, and compare it with the model shot, or with the coach's shot if there is none.
///
/// Every attempt is logged.
#[derive(Debug, clap::Args)]
pub struct TryArgs {
    /// The exercise: its name, its title, or the beginning of either.
    name: String,
    /// The intended stroke: "a,b,theta,phi,V" in radii, degrees and m/s, words like "red 1/2 right, 1.5 left, 3 lengths", or "coach".
    #[arg(long, allow_hyphen_values = true)]
    shot: String,
    /// Number of attempts.
    #[arg(long, default_value_t = 1, value_parser = whole_number(1..=1_000_u32))]
    repeat: u32,
    /// Shift the balls by half a ball at each repetition except the first.
    #[arg(long)]
    shifted: bool,
    /// The table to play on: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file. It must have the size
    /// of the exercise's table. Default: the exercise's table
    #[arg(long)]
    table: Option<String>,
    #[command(flatten)]
    options: PlayOptions,
}

/// Play an exercise until it was made a given number of times in a row.
///
/// Strokes are read line by line from the standard input: words like "red 1/2 right, 1.5 left, 3 lengths", "a,b,theta,phi,V", or the
/// words coach and quit.
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    /// The exercise: its name, its title, or the beginning of either.
    name: String,
    /// Points in a row that end the session.
    #[arg(long, value_parser = whole_number(1..=10_000_u32))]
    goal: u32,
    /// Shift the balls by half a ball at each repetition except the first.
    #[arg(long)]
    shifted: bool,
    /// Let the coach play.
    #[arg(long)]
    coach: bool,
    /// Maximum number of attempts.
    #[arg(long, default_value_t = 1000, value_parser = whole_number(1..=MAX_STROKES))]
    strokes: u32,
    /// The table to play on: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file. It must have the size
    /// of the exercise's table. Default: the exercise's table
    #[arg(long)]
    table: Option<String>,
    #[command(flatten)]
    options: PlayOptions,
}

/// Take an exam: twenty exercises, or those of one category, one attempt each.
///
/// Strokes are read line by line from the standard input: words like "red 1/2 right, 1.5 left, 3 lengths", "a,b,theta,phi,V", or the
/// words coach and quit.
#[derive(Debug, clap::Args)]
pub struct ExamArgs {
    /// Difficulty: 1, 2 or 3.
    #[arg(long, default_value_t = 1, value_parser = whole_number(1..=HIGHEST_LEVEL))]
    level: u8,
    /// Only this category: first-caroms, draw, follow, side, one-cushion, gather, three-cushion, systems or jump-and-masse. It may have
    /// fewer than twenty exercises.
    #[arg(long, value_parser = parse_category)]
    category: Option<Category>,
    /// Let the coach play.
    #[arg(long)]
    coach: bool,
    #[command(flatten)]
    options: PlayOptions,
}

pub fn try_stroke(args: &TryArgs) -> Result<(), Failure> {
    let stroke: StrokeInput = args.shot.parse()?;
    let workspace = Workspace::open();
    let exercise = workspace.exercise(&args.name)?.clone();
    let mut session = args.options.session(Goal::Free, vec![exercise], args.table.as_deref())?;
    session.shifted = args.shifted;
    play(&workspace.store, session, &args.options, Strokes::Same(stroke), args.repeat as usize)
}

pub fn run(args: &RunArgs) -> Result<(), Failure> {
    let workspace = Workspace::open();
    let exercise = workspace.exercise(&args.name)?.clone();
    let mut session = args.options.session(Goal::Run(args.goal), vec![exercise], args.table.as_deref())?;
    session.shifted = args.shifted;
    play(&workspace.store, session, &args.options, strokes(args.coach), args.strokes as usize)
}

pub fn exam(args: &ExamArgs) -> Result<(), Failure> {
    let workspace = Workspace::open();
    // On the tables of its exercises, for which its averages are known.
    let mut session = args.options.session(Goal::Exam, Vec::new(), None)?;
    // The same seed determines the exam and the errors in it.
    session.exercises =
        draw(workspace.library.exercises(), args.level, args.category, session.seed).map_err(Failure::failed)?;
    play(&workspace.store, session, &args.options, strokes(args.coach), LENGTH)
}

/// Returns the source of the strokes: the coach or the standard input.
pub const fn strokes(coach: bool) -> Strokes {
    if coach { Strokes::Coach } else { Strokes::Input }
}
