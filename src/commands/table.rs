//! `carom table`: the tables that there are, and whether a file describes one.

use std::{io::Write, path::PathBuf};

use clap::Subcommand;

use super::{Failure, input::table_named};
use crate::{
    printing, storage,
    table::{PRESETS, Table},
};

/// List and show tables, and check a file that describes one.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    order: Option<Order>,
    /// Print one JSON object a line.
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum Order {
    /// List the bundled tables (the default).
    List,
    /// Show a table as TOML, which is also the way to begin a file of one's own.
    Show {
        /// "match", "textbook", "thesis" or the path of a TOML file.
        #[arg(default_value = "match")]
        table: String,
    },
    /// Read a table file and say what is wrong with it.
    Check {
        /// The TOML file.
        file: PathBuf,
    },
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut out = printing::stdout();
    match args.order.as_ref().unwrap_or(&Order::List) {
        Order::List => {
            for name in PRESETS {
                let table = Table::preset(name).map_err(Failure::failed)?;
                if args.json {
                    printing::json_line(&mut out, &table)?;
                } else {
                    writeln!(out, "{}", line(&table))?;
                }
            }
        }
        Order::Show { table } => {
            let table = table_named(table)?;
            if args.json {
                printing::json_line(&mut out, &table)?;
            } else {
                write!(out, "{}", toml::to_string(&table).map_err(Failure::failed)?)?;
            }
        }
        Order::Check { file } => {
            let text = storage::read_text(file, storage::SMALL)
                .map_err(|error| Failure::failed(format_args!("{} cannot be read: {error}", file.display())))?;
            let table = Table::from_toml(&text)
                .map_err(|error| Failure::wrong_input(format_args!("{}: {error}", file.display())))?;
            if args.json {
                printing::json_line(&mut out, &table)?;
            } else {
                writeln!(out, "{} can be played on: {}", file.display(), line(&table))?;
            }
        }
    }
    Ok(())
}

/// The table in a few words.
fn line(table: &Table) -> String {
    let Table { name, length, width, radius, rolling_friction, rail_restitution, .. } = table;
    format!(
        "{name}: {length} x {width} m between the noses, balls of {} mm, rolling friction {rolling_friction}, cushions {rail_restitution}",
        2e3 * radius
    )
}
