//! `carom play`: innings, in which each stroke starts where the previous one left the balls.

use super::{
    Failure,
    drill::{MAX_STROKES, PlayOptions, Workspace, play, size_words, strokes},
    input::{table_by_name, whole_number},
    lookup::skill_by_name,
};
use crate::{
    coach::Skill,
    drills::{Exercise, Goal},
    game::Rule,
    table::{CueBall, Layout, PRESETS, Side, Table},
};

/// Name of a game in the list of exercises.
const GAME: &str = "game";

/// Number of innings if neither innings nor points are given.
const DEFAULT_INNINGS: u32 = 10;

/// Play innings from the opening position.
///
/// A miss ends an inning, and the next one starts where the balls stopped. With --both or --against-coach, the other side then plays with
/// the other ball. Strokes are read line by line from the standard input: words like "red 1/2 right, 1.5 left, 3 lengths",
/// "a,b,theta,phi,V", or the words coach and quit. At the end, average and high run are printed.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What counts as a point: straight, one-cushion or three-cushion.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// Number of innings. Default: 10, or no limit with --points
    #[arg(long, value_parser = whole_number(1..=10_000_u32))]
    innings: Option<u32>,
    /// Number of points that wins a match. If the side that began reaches it, the other one has the equalising inning, from the first
    /// position.
    #[arg(long, value_parser = whole_number(1..=10_000_u32))]
    points: Option<u32>,
    /// Maximum number of strokes; if innings are left then, a note says so.
    #[arg(long, default_value_t = 1000, value_parser = whole_number(1..=MAX_STROKES))]
    strokes: u32,
    /// Initial positions of the balls, cue ball first: "x,y x,y x,y" in metres from the centre, or in diamonds from the lower left corner
    /// ("2d,2d 6d,2d 2d,2.5d"). Default: the opening position.
    #[arg(long, allow_hyphen_values = true)]
    layout: Option<String>,
    /// Initial side of the cue ball next to the opponent's ball, on tables where the player may choose: left or right. Default: left
    #[arg(long, conflicts_with = "layout")]
    side: Option<Side>,
    /// The ball that you play with: white or yellow.
    #[arg(long, default_value = "white")]
    ball: CueBall,
    /// Play a match of two sides: after a miss, the other side continues with the other ball from where the balls stopped.
    #[arg(long)]
    both: bool,
    /// Like --both, and the coach plays the other side.
    #[arg(long, conflicts_with = "coach")]
    against_coach: bool,
    /// The coach's skill in a match against it, like --skill. Default: that of --skill
    #[arg(long, requires = "against_coach", value_parser = skill_by_name)]
    coach_skill: Option<Skill>,
    /// Let the coach play.
    #[arg(long)]
    coach: bool,
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file. It must have the size of a bundled
    /// table.
    #[arg(long, default_value = PRESETS[0])]
    table: String,
    #[command(flatten)]
    options: PlayOptions,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let (table, bundled) = tables(&args.table)?;
    let layout = match &args.layout {
        None => opening(&table, args.side)?,
        Some(text) => Layout::parse(text, &table).map_err(Failure::wrong_input)?,
    };
    layout.validate(&table).map_err(Failure::wrong_input)?;
    let game = Exercise::new_own(GAME, args.rule, bundled, layout);
    let mut session = args.options.session(goal(args)?, vec![game], Some(&args.table))?;
    session.coach_skill = args.coach_skill;
    session.cue_ball = args.ball;
    let workspace = Workspace::open();
    play(&workspace.store, session, &args.options, strokes(args.coach), args.strokes as usize)
}

/// Returns the end of the game or match.
fn goal(args: &Args) -> Result<Goal, Failure> {
    let &Args { points, against_coach, .. } = args;
    let innings = args.innings.unwrap_or(if points.is_some() { 0 } else { DEFAULT_INNINGS });
    match (points, args.both || against_coach) {
        (points, true) => Ok(Goal::Match { innings, points: points.unwrap_or(0), against_coach }),
        (None, false) => Ok(Goal::Game { innings }),
        (Some(points), false) => Err(Failure::wrong_input(format_args!(
            "--points {points} is the distance of a match; add --both or --against-coach"
        ))),
    }
}

/// Returns the opening position with the cue ball on this side.
fn opening(table: &Table, side: Option<Side>) -> Result<Layout, Failure> {
    let layout = Layout::opening_on(table, side.unwrap_or_default());
    match side {
        Some(side) if layout == Layout::opening_on(table, side.other()) => Err(Failure::wrong_input(format_args!(
            "--side {} has no effect on \"{}\", where the cue ball has one place at the opening; leave it out",
            side.name(),
            table.name
        ))),
        _ => Ok(layout),
    }
}

/// Returns the table called `name` and a bundled table of the same size, on which positions are the same. A bundled table is its own
/// counterpart.
fn tables(name: &str) -> Result<(Table, &'static str), Failure> {
    let table = table_by_name(name)?;
    let itself = PRESETS.into_iter().find(|preset| *preset == table.name);
    let of_its_size = |preset: &&str| Table::preset(preset).is_ok_and(|preset| preset.has_size_of(&table));
    match itself.or_else(|| PRESETS.into_iter().find(of_its_size)) {
        Some(bundled) => Ok((table, bundled)),
        None => Err(Failure::wrong_input(format_args!(
            "games need a table of the size of a bundled one, and \"{}\" is {}; accepted are {}",
            table.name,
            size_words(&table),
            PRESETS.map(|name| format!("\"{name}\"")).join(", ")
        ))),
    }
}
