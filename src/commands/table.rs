//! `carom table`: lists and displays tables, and checks table files.

use std::{io::Write, path::PathBuf};

use clap::Subcommand;

use super::{
    Failure,
    input::{load_table, table_by_name},
    output::print_note,
};
use crate::{
    printing,
    storage::DataPaths,
    table::{PRESETS, Table},
};

/// List and show tables, and check a file that describes one.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Option<TableCommand>,
    /// Print one JSON object a line.
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum TableCommand {
    /// List the bundled tables and your own (the default).
    List,
    /// Show a table as TOML, which can be the start of your own table file.
    Show {
        /// "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file.
        #[arg(default_value = "match")]
        table: String,
    },
    /// Check a table file and report what is wrong with it.
    Check {
        /// The TOML file.
        file: PathBuf,
    },
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut out = printing::stdout().exact(args.json || matches!(args.command, Some(TableCommand::Show { .. })));
    match args.command.as_ref().unwrap_or(&TableCommand::List) {
        TableCommand::List => {
            let bundled = PRESETS.iter().map(|name| Table::preset(name).map_err(Failure::failed));
            let own = DataPaths::of_this_user().own_tables();
            // Listed by file name, because tables are looked up by that.
            let named = |file: &PathBuf| {
                let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                if PRESETS.contains(&name.as_str()) {
                    return Err(Failure::failed(format_args!(
                        "{} is not found by its name, which is that of a bundled table; rename it",
                        file.display()
                    )));
                }
                load_table(file).map(|table| Table { name, ..table })
            };
            for table in bundled.chain(own.iter().map(named)) {
                let noted = table.inspect_err(|failure| print_note(format_args!("note: {failure}")));
                let Ok(table) = noted else { continue };
                if args.json {
                    printing::json_line(&mut out, &table)?;
                } else {
                    writeln!(out, "{}", summary_line(&table))?;
                }
            }
        }
        TableCommand::Show { table } => {
            let table = table_by_name(table)?;
            if args.json {
                printing::json_line(&mut out, &table)?;
            } else {
                write!(out, "{}", toml::to_string(&table).map_err(Failure::failed)?)?;
            }
        }
        TableCommand::Check { file } => {
            let table = load_table(file)?;
            for [key, models] in table.rail.unused() {
                print_note(format_args!(
                    "note: rail.{key} has no effect here: only rails of the model {models} use it"
                ));
            }
            if args.json {
                printing::json_line(&mut out, &table)?;
            } else {
                writeln!(out, "{} is a valid table: {}", file.display(), summary_line(&table))?;
            }
        }
    }
    Ok(())
}

/// Describes the table in one line.
fn summary_line(table: &Table) -> String {
    let Table { name, length, width, radius, .. } = table;
    // A calibration has more digits than its accuracy.
    let [rolling, rails] = [table.rolling_friction, table.rail_restitution].map(|value| (1e4 * value).round() / 1e4);
    format!(
        "{name}: {length} x {width} m between the noses, balls of {} mm, rolling friction {rolling}, cushions {rails}",
        2e3 * radius
    )
}
