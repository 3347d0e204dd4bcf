//! `carom doctor`: reports the version, what it finds on this machine, and whether the program computes correctly.

mod screen;
mod stored_data;
mod text;

use serde::Serialize;

use self::{
    screen::Screen,
    stored_data::{FolderReport, StoredData},
};
use super::{Failure, output::json_line};
use crate::{
    printing::{self, COMMIT, TARGET, VERSION},
    storage::DataPaths,
    study::{self_test::SelfTest, throughput::Machine},
    terminal::Settings,
};

/// Check this installation without changing anything.
///
/// The check covers version, folders, terminal, settings, tables and runs, and one second of computing.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// The program itself.
#[derive(Serialize)]
struct Program {
    version: &'static str,
    /// `None` if it was built without git.
    source: Option<&'static str>,
    target: &'static str,
    machine: Machine,
}

/// The whole report.
#[derive(Serialize)]
struct Report {
    program: Program,
    places: Vec<FolderReport>,
    screen: Screen,
    #[serde(flatten)]
    kept: StoredData,
    self_test: SelfTest,
    /// A sentence for each problem.
    problems: Vec<String>,
}

impl Report {
    fn of_this_machine() -> Self {
        let paths = DataPaths::of_this_user();
        let (settings, mistakes) = Settings::load(&paths.settings);
        let mut report = Self {
            program: Program { version: VERSION, source: COMMIT, target: TARGET, machine: Machine::this() },
            places: stored_data::folders(&paths),
            screen: Screen::detect(&settings),
            kept: StoredData::inspect(&paths, &mistakes),
            self_test: SelfTest::run(),
            problems: Vec::new(),
        };
        let Self { places, screen, kept, self_test, .. } = &report;
        let problems = places.iter().filter_map(FolderReport::problem).chain(screen.problem());
        report.problems = problems.chain(kept.problems()).chain(self_test.problems()).collect();
        report
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let report = Report::of_this_machine();
    if args.json {
        json_line(&report)?;
    } else {
        text::write(&mut printing::stdout(), &report)?;
    }
    match report.problems.len() {
        0 => Ok(()),
        1 => Err(Failure::failed("1 thing is wrong; docs/troubleshooting.md may help")),
        count => Err(Failure::failed(format_args!("{count} things are wrong; docs/troubleshooting.md may help"))),
    }
}
