//! `carom drill export` and `carom drill import`: all practice data of a player as one JSON file.

use std::{
    io::{self, Read},
    path::{Path, PathBuf},
};

use super::{Workspace, workspace::print_notes};
use crate::{
    commands::{
        Failure,
        input::BYTE_ORDER_MARK,
        output::{check_folder_exists, json_line, plural, print_line, print_note},
    },
    drills::{
        Store,
        store::{Imported, Practice},
    },
    printing::OneLine,
    storage::{self, DataPaths, resolve_symlinks, write_atomic},
};

/// Write all sessions, your own positions and your own skill to one JSON file.
#[derive(Debug, clap::Args)]
pub struct ExportArgs {
    /// The file: a new one in an existing folder, or an earlier export to replace; without one, or for "-", the standard output.
    file: Option<PathBuf>,
}

/// Import a file that `carom drill export` wrote, or a library of exercises.
///
/// No data of this account is lost. If both sides have a session, the longer version is kept. A session that was continued differently on
/// both sides is refused, and so is a position whose name is already used by another.
#[derive(Debug, clap::Args)]
pub struct ImportArgs {
    /// The file; "-" reads the standard input.
    file: PathBuf,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn export(args: &ExportArgs) -> Result<(), Failure> {
    let (practice, notes) = Store::new(&DataPaths::of_this_user()).export();
    print_notes(&notes);
    match args.file.as_deref().filter(|file| *file != Path::new("-")) {
        None => json_line(&practice)?,
        Some(file) => {
            let refuse =
                |error: io::Error| Failure::failed(format_args!("{} cannot be written: {error}", file.display()));
            let target = resolve_symlinks(file);
            check_folder_exists(&target)?;
            let is_export = |text: String| text.is_empty() || Practice::is_export(&text);
            if target.exists() && !storage::read_text(&target, storage::MAX_PRACTICE_FILE).is_ok_and(is_export) {
                let file = file.display();
                return Err(Failure::failed(format_args!(
                    "{file} already exists and is not an export, so it stays as it is; accepted is a new name"
                )));
            }
            if !notes.is_empty() && target.exists() {
                return Err(Failure::failed(format_args!(
                    "{} could not be read, so the earlier export {} stays as it is; accepted is a new name",
                    plural(notes.len(), "file"),
                    file.display()
                )));
            }
            let bytes = serde_json::to_vec(&practice).map_err(|error| refuse(error.into()))?;
            write_atomic(&target, &bytes).map_err(refuse)?;
            let (positions, sessions) = (practice.library.exercises.len(), practice.sessions.len());
            print_note(format_args!(
                "{} and {} written to {}",
                plural(positions, "position"),
                plural(sessions, "session"),
                file.display()
            ));
        }
    }
    if notes.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(format_args!("{} could not be read; the export lacks this data", plural(notes.len(), "file"))))
}

/// Reads a text of at most [`storage::MAX_PRACTICE_FILE`] bytes from a file, or from the standard input for `-`.
fn read(file: &Path) -> io::Result<String> {
    let (mut text, most) = (String::new(), storage::MAX_PRACTICE_FILE);
    if file != Path::new("-") {
        return storage::read_text(file, most);
    }
    if io::stdin().take(most + 1).read_to_string(&mut text)? as u64 > most {
        return Err(io::Error::other(format!("it is longer than {most} bytes, the most that is accepted")));
    }
    Ok(text)
}

pub fn import(args: &ImportArgs) -> Result<(), Failure> {
    let file = args.file.display();
    let text = read(&args.file).map_err(|error| Failure::failed(format_args!("{file} cannot be read: {error}")))?;
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&text);
    let practice = Practice::parse(text).map_err(|error| Failure::wrong_input(format_args!("{file}: {error}")))?;
    let workspace = Workspace::open();
    let imported = workspace.store.import(&practice);
    let Imported { positions, sessions, longer, known, refused } = &imported;
    if args.json {
        json_line(&imported)?;
    } else {
        print_line(format_args!(
            "{} and {} imported, {longer} existing ones replaced by longer ones, {known} already known",
            plural(*positions, "position"),
            plural(*sessions, "session")
        ))?;
    }
    for sentence in refused {
        print_note(format_args!("refused: {}", OneLine(sentence)));
    }
    if refused.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(format_args!("{} of {file} could not be imported", plural(refused.len(), "part"))))
}
