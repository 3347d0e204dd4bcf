//! `carom play`: innings, each stroke from where the one before left the balls.

use super::{
    Failure,
    drill::{PlayOptions, Workspace, play, strokes},
};
use crate::{
    drills::{Exercise, Goal},
    game::Rule,
    table::{Layout, Table},
};

/// What a game is called among exercises.
const GAME: &str = "game";

/// Play innings from the opening position.
///
/// A miss ends an inning, and the next begins where the balls lie. Strokes are read line by line from the standard input:
/// "a,b,theta,phi,V", or the word coach. At the end average and high run are told.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What counts as a point: straight, one-cushion or three-cushion.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// Innings.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    innings: u32,
    /// Strokes after which it ends in any case.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    strokes: u32,
    /// Where the balls lie at first, cue ball first: "x,y x,y x,y" in metres from the centre, or in diamonds from the lower
    /// left corner ("2d,2d 6d,2d 2d,2.5d"). Default: the opening position.
    #[arg(long, allow_hyphen_values = true)]
    layout: Option<String>,
    /// The table: "match", "textbook" or "thesis".
    #[arg(long, default_value = "match")]
    table: String,
    /// Have the coach play.
    #[arg(long)]
    coach: bool,
    #[command(flatten)]
    options: PlayOptions,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let table = Table::preset(&args.table).map_err(Failure::wrong_input)?;
    let layout = match &args.layout {
        None => Layout::opening(&table),
        Some(text) => Layout::parse(text, &table).map_err(Failure::wrong_input)?,
    };
    layout.validate(&table).map_err(Failure::wrong_input)?;
    let game = Exercise::own(GAME, args.rule, &table.name, layout);
    let session = args.options.session(Goal::Game { innings: args.innings }, vec![game]);
    let workspace = Workspace::open()?;
    play(&workspace.store, session, &args.options, strokes(args.coach), args.strokes as usize)
}
