//! `carom drill save`, `share`, `add` and `remove`: the user's own positions.

use super::Workspace;
use crate::{
    commands::{Failure, input::bundled_table, output::print_line, typed_stroke::TypedStroke},
    drills::{
        Exercise, LibraryError, MAX_POINT_BYTES, MAX_TITLE_BYTES, bare_tag, check, decode, encode, store::StoreError,
    },
    game::{Rule, scores},
    physics::{has_room, least_elevation},
    table::{CueBall, Layout},
};

/// Save a position of your own.
#[derive(Debug, clap::Args)]
pub struct SaveArgs {
    /// Name of the position: letters, digits, '-', '_' and '.'.
    name: String,
    /// The balls, cue ball first: "x,y x,y x,y" in metres from the centre, or in diamonds from the lower left corner
    /// ("2d,2d 6d,2d 2d,2.5d").
    #[arg(long, allow_hyphen_values = true)]
    layout: String,
    /// What counts as a point: straight, one-cushion or three-cushion.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// Title of the position. Default: its name.
    #[arg(long)]
    title: Option<String>,
    /// What to learn from the position.
    #[arg(long, default_value = "")]
    point: String,
    /// A word to find it by, with or without #. Can be repeated.
    #[arg(long = "tag", value_parser = tag)]
    tags: Vec<String>,
    /// A shot that makes the point: "a,b,theta,phi,V", or in words.
    #[arg(long, allow_hyphen_values = true)]
    shot: Option<String>,
    /// The table: "match", "textbook" or "thesis".
    #[arg(long, default_value = "match")]
    table: String,
    /// Overwrite an existing position of this name.
    #[arg(long)]
    replace: bool,
}

/// Print an exercise as one line that can be pasted into a chat.
#[derive(Debug, clap::Args)]
pub struct ShareArgs {
    /// The exercise: its name, its title, or the beginning of either.
    name: String,
}

/// Add a position from a share code.
#[derive(Debug, clap::Args)]
pub struct AddArgs {
    /// The share code; line breaks and spaces in it do not matter.
    #[arg(required = true)]
    code: Vec<String>,
    /// Another name for the position.
    #[arg(long)]
    name: Option<String>,
    /// Overwrite an existing position of this name.
    #[arg(long)]
    replace: bool,
}

/// Remove a position of your own.
///
/// Its practice sessions stay in the history.
#[derive(Debug, clap::Args)]
pub struct RemoveArgs {
    /// The position: its name or its title.
    name: String,
}

/// Parses a tag, which is displayed with `#` and stored without.
pub fn tag(text: &str) -> Result<String, String> {
    let word = bare_tag(text.trim());
    if word.is_empty() || word.contains(char::is_whitespace) || word.len() > MAX_TITLE_BYTES {
        return Err(format!("accepted is one word of up to {MAX_TITLE_BYTES} bytes, with or without # before it"));
    }
    Ok(word.to_owned())
}

pub fn save(args: &SaveArgs) -> Result<(), Failure> {
    let table = bundled_table(&args.table)?;
    let layout = Layout::parse(&args.layout, &table).map_err(Failure::wrong_input)?;
    let typed = args.shot.as_deref().map(TypedStroke::parse).transpose()?;
    let shot = typed.map(|typed| typed.resolve(&table, &layout, CueBall::White)).transpose()?;
    shot.as_ref().map_or(Ok(()), |cue| check(&table, cue)).map_err(Failure::wrong_input)?;
    let position = Exercise::new_own(&args.name, args.rule, &table.name, layout);
    let typed = args.title.as_deref().map(str::trim).filter(|title| !title.is_empty());
    let title = typed.map_or(position.title, str::to_owned);
    for (words, text, longest) in [("title", &title, MAX_TITLE_BYTES), ("point", &args.point, MAX_POINT_BYTES)] {
        if text.len() > longest {
            return Err(Failure::wrong_input(format_args!(
                "the {words} has {} bytes; accepted are up to {longest}",
                text.len()
            )));
        }
    }
    if let Some(cue) = &shot {
        let refused = |why| Failure::wrong_input(format_args!("not a model shot: {why}; give another, or none"));
        if !has_room(&table, &layout, cue) {
            let why = least_elevation(&table, &layout, cue).map_or_else(
                |blocked| blocked.to_string(),
                |least| format!("the cue has no room below {:.2} degrees", least.theta.to_degrees()),
            );
            return Err(refused(why));
        }
        if !scores(args.rule, &table, &layout, cue) {
            return Err(refused(format!("it makes no point under the rule {}", args.rule)));
        }
    }
    save_position(
        &Exercise { title, point: args.point.clone(), tags: args.tags.clone(), shot, ..position },
        args.replace,
    )
}

pub fn share(args: &ShareArgs) -> Result<(), Failure> {
    let workspace = Workspace::open();
    print_line(encode(workspace.exercise(&args.name)?).map_err(Failure::failed)?)
}

pub fn add(args: &AddArgs) -> Result<(), Failure> {
    let mut position = decode(&args.code.concat()).map_err(Failure::wrong_input)?;
    if let Some(name) = &args.name {
        if position.title == position.name {
            position.title.clone_from(name);
        }
        position.name.clone_from(name);
    }
    save_position(&position, args.replace)
}

pub fn remove(args: &RemoveArgs) -> Result<(), Failure> {
    let workspace = Workspace::open();
    // An unreadable position is not in the library; its file is removed by name.
    let name = match workspace.library.find_exact(&args.name) {
        Ok(exercise) => &exercise.name,
        Err(error @ LibraryError::Ambiguous { .. }) => return Err(Failure::failed(error)),
        Err(_) => &args.name,
    };
    if workspace.library.is_bundled(name) {
        return Err(Failure::failed(format_args!("\"{name}\" is bundled and cannot be removed")));
    }
    workspace.store.remove_position(name).map_err(failure)?;
    print_line(format_args!("removed {name}"))
}

fn save_position(position: &Exercise, replaces: bool) -> Result<(), Failure> {
    let workspace = Workspace::open();
    workspace.store.save_position(position, replaces).map_err(failure)?;
    print_line(format_args!("saved {}", position.name))
}

fn failure(error: StoreError) -> Failure {
    match error {
        StoreError::Exercise(error) => Failure::wrong_input(error),
        StoreError::NameTaken(name) => Failure::failed(format_args!(
            "there is a position \"{name}\" already; use --replace to overwrite it, or another name"
        )),
        error => Failure::failed(error),
    }
}
