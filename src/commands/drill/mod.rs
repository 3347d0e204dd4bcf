//! `carom drill`: exercises, practice sessions, scores.

mod attempts;
mod history;
mod listing;
mod log;
mod options;
mod positions;
mod score;
mod skill;
mod stroke_by_stroke;
mod strokes;
mod transfer;
mod workspace;

use clap::Subcommand;

pub use self::{
    attempts::strokes,
    options::{PlayOptions, size_words},
    strokes::{MAX_STROKES, play},
    workspace::Workspace,
};
use super::Failure;

/// Practise: exercises, played here or logged from a real table, exams and scores.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    drill: Drill,
}

#[derive(Debug, Subcommand)]
enum Drill {
    List(listing::ListArgs),
    Show(listing::ShowArgs),
    Try(attempts::TryArgs),
    Run(attempts::RunArgs),
    Exam(attempts::ExamArgs),
    Log(log::Args),
    History(history::Args),
    Skill(skill::Args),
    Save(positions::SaveArgs),
    Share(positions::ShareArgs),
    Add(positions::AddArgs),
    Remove(positions::RemoveArgs),
    Export(transfer::ExportArgs),
    Import(transfer::ImportArgs),
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    match &args.drill {
        Drill::List(args) => listing::list(args),
        Drill::Show(args) => listing::show(args),
        Drill::Try(args) => attempts::try_stroke(args),
        Drill::Run(args) => attempts::run(args),
        Drill::Exam(args) => attempts::exam(args),
        Drill::Log(args) => log::run(args),
        Drill::History(args) => history::run(args),
        Drill::Skill(args) => skill::run(args),
        Drill::Save(args) => positions::save(args),
        Drill::Share(args) => positions::share(args),
        Drill::Add(args) => positions::add(args),
        Drill::Remove(args) => positions::remove(args),
        Drill::Export(args) => transfer::export(args),
        Drill::Import(args) => transfer::import(args),
    }
}
