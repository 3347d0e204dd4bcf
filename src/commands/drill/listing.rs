//! `carom drill list` and `carom drill show`: the available exercises.

use serde::Serialize;

use super::{
    Workspace,
    history::high_run,
    positions::tag,
    score::{Score, words},
};
use crate::{
    coach::ShotWords,
    commands::{
        Failure,
        input::whole_number,
        output::{json_line, print_line, print_note, print_table, shot_text, units},
    },
    drills::{Category, Exercise, Filter, Record, encode},
    table::{BALL_NAMES, CueBall},
};

/// List the exercises, with the player's record.
#[derive(Debug, clap::Args)]
pub struct ListArgs {
    /// Only this category: first-caroms, draw, follow, side, one-cushion, gather, three-cushion, systems, jump-and-masse or own.
    #[arg(long, value_parser = parse_category)]
    category: Option<Category>,
    /// Only this grade, 1 (easy) to 5; 0 for exercises without a grade.
    #[arg(long, value_parser = whole_number(0..=5_u8))]
    grade: Option<u8>,
    /// Only those with this tag, with or without #.
    #[arg(long, value_parser = tag)]
    tag: Option<String>,
    /// Print JSON: one object for each exercise.
    #[arg(long)]
    json: bool,
}

/// Show an exercise: balls, what to learn, the shot, its share code and the player's record.
#[derive(Debug, clap::Args)]
pub struct ShowArgs {
    /// The exercise: its name, its title, or the beginning of either.
    name: String,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// An exercise in JSON.
#[derive(Serialize)]
struct Entry<'a> {
    #[serde(flatten)]
    exercise: &'a Exercise,
    /// Positions of the balls in diamonds from the lower left corner.
    #[serde(skip_serializing_if = "Option::is_none")]
    diamonds: Option<[[f64; 2]; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    code: Option<String>,
    record: Score,
}

pub(super) fn parse_category(name: &str) -> Result<Category, String> {
    Category::ALL.into_iter().find(|category| category.name() == name).ok_or_else(|| {
        let names = Category::ALL.map(Category::name).join(", ");
        format!("there is no category \"{name}\"; use one of {names}")
    })
}

pub fn list(args: &ListArgs) -> Result<(), Failure> {
    let workspace = Workspace::open();
    let sessions = workspace.sessions();
    let ListArgs { category, grade, tag, .. } = args;
    let filter = Filter { category: *category, grade: *grade, tag: tag.clone(), text: None };
    let mut rows = Vec::new();
    for exercise in workspace.library.find(&filter) {
        let record = Record::of_exercise(&sessions, &exercise.name);
        if args.json {
            json_line(&Entry { exercise, diamonds: None, code: None, record: record.into() })?;
        }
        let number = |number: usize| if record.tried > 0 { number.to_string() } else { "-".to_owned() };
        rows.push([
            exercise.name.clone(),
            exercise.category.to_string(),
            if exercise.grade > 0 { exercise.grade.to_string() } else { "-".to_owned() },
            exercise.rule.to_string(),
            number(record.made),
            number(record.tried),
            high_run(&record),
            exercise.title.clone(),
        ]);
    }
    if rows.is_empty() {
        print_note("there are no such exercises; carom drill list without a filter shows all");
    } else if !args.json {
        let heads = ["name", "category", "grade", "rule", "made", "tried", "high run", "title"];
        print_table(heads, rows, &[2, 4, 5, 6])?;
    }
    Ok(())
}

pub fn show(args: &ShowArgs) -> Result<(), Failure> {
    let workspace = Workspace::open();
    let exercise = workspace.exercise(&args.name)?;
    let table = exercise.table().map_err(Failure::failed)?;
    let code = encode(exercise).map_err(Failure::failed)?;
    let sessions = workspace.sessions();
    let record = Record::of_exercise(&sessions, &exercise.name);
    let diamonds = exercise.layout.balls.map(|ball| table.to_diamonds(ball).to_array());
    if args.json {
        let entry = Entry { exercise, diamonds: Some(diamonds), code: Some(code), record: record.into() };
        return Ok(json_line(&entry)?);
    }
    let Exercise { name, title, category, grade, rule, point, tags, shot, par, .. } = exercise;
    print_line(format_args!("{name}: {title}"))?;
    let grade = if *grade > 0 { format!("grade {grade}") } else { "not graded".to_owned() };
    let tags = if tags.is_empty() { String::new() } else { format!("; {}", tags.join(", ")) };
    print_line(format_args!("{}, {rule}, {grade}, table {}{tags}", category.title(), table.name))?;
    if !point.is_empty() {
        print_line(point)?;
    }
    for ((ball, name), diamonds) in exercise.layout.balls.iter().zip(BALL_NAMES).zip(diamonds) {
        let [x, y] = [1000.0 * ball.x, 1000.0 * ball.y];
        let [across, up] = diamonds;
        print_line(format_args!("{name:<6} {x:>8.1} {y:>7.1} mm from the centre   {across:.2} {up:.2} diamonds"))?;
    }
    if let Some(shot) = shot {
        if let Ok(words) = ShotWords::of(&table, &exercise.layout, shot) {
            print_line(words.sentence(CueBall::White, units()))?;
        }
        print_line(format_args!("shot    {} (a, b in radii, theta, phi in degrees, V in m/s)", shot_text(shot)))?;
    }
    if let Some(par) = par {
        let [beginner, club, best] = [par.beginner, par.club, par.world_class].map(|share| 100.0 * share);
        print_line(format_args!("typical beginner {beginner:.0} %, club {club:.0} %, world-class {best:.0} %"))?;
    }
    if record.tried == 0 {
        print_line(format_args!("record  {}", words(&record)))?;
    }
    for (venue, record) in Record::by_venue(&sessions, |sessions| Record::of_exercise(sessions, name)) {
        print_line(format_args!("{:<7} {}", venue.word(), words(&record)))?;
    }
    print_line(format_args!("code    {code}"))
}
