//! `carom accuracy`: error against run time, measured by the program itself.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use super::{
    Failure,
    input::{seed, table_named, whole},
    output::{check_place, plural, tell},
};
use crate::{
    printing::{self, ProgressLine},
    storage::write_atomic,
    study::{self, Method, Plan, Steepest, Study, filmed, random_shots, stability},
    table::{JUDGED, Table},
};

/// Measure how exact the simulator is and what that costs.
///
/// The engine, other root finders, single precision and fixed time steps are set against what the reference engine makes of the same
/// shots with 32 digits, the truth, and all against reference shots of 50 digits. It takes minutes; with --quick it takes seconds. Where neither --quick nor --shots
/// nor --table is given, the stability table follows.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Args {
    /// Few shots and no time steps below 1e-4 s: seconds instead of minutes.
    #[arg(long)]
    quick: bool,
    /// Number of random shots on each table. Default: 1000, or 96 with --quick; with --stability 100000, or 10000
    #[arg(long, value_parser = whole(1..=1_000_000_000_u32))]
    shots: Option<u32>,
    /// Seed of the shots. Default: 2026, or 1 in the stability table
    #[arg(long, value_parser = seed)]
    seed: Option<u64>,
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file; where balls leave its cloth, strokes of up to 60
    /// degrees are studied too. Default: textbook and thesis, and such strokes on match
    #[arg(long, value_name = "NAME")]
    table: Option<String>,
    /// Play the stability table only: a hundred thousand random, ten thousand adversarial and a thousand shots of each
    /// stiff or extreme case on each table, or a tenth of them with --quick. --shots sets the random ones.
    #[arg(long, conflicts_with = "table")]
    stability: bool,
    /// Replay filmed shots of real balls instead, on several models of the table: how far each is from the film. A --table must have
    /// the filmed one's length, width and balls.
    #[arg(long, conflicts_with_all = ["stability", "shots", "seed", "quick"])]
    filmed: bool,
    /// With --filmed, fit the constants of cloth and rails to the film, and to each half of it to judge them on the other.
    #[arg(long, requires = "filmed", conflicts_with_all = ["stability", "shots", "quick", "out"])]
    fit: bool,
    /// Write files into this folder: accuracy.csv, error-vs-time.svg and error-vs-condition.svg, and stability.md where that table is
    /// played; with --filmed filmed.csv and filmed.svg.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object for each reference file, each table and each method instead of the text.
    #[arg(long)]
    json: bool,
}

/// Seed of the shots that are studied where none is given.
const SEED: u64 = 2026;

/// Most shots whose every method is studied: all of them are kept.
const MOST_STUDIED: u32 = 1_000_000;

/// The page of the stability table.
const STABILITY: &str = "stability.md";

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(folder) = &args.out {
        let first = if args.filmed {
            "filmed.csv"
        } else if args.stability {
            STABILITY
        } else {
            "accuracy.csv"
        };
        check_place(folder, &folder.join(first))?;
    }
    if args.filmed {
        return if args.fit { fit_film(args) } else { replay_film(args) };
    }
    if args.stability {
        let plan = if args.quick { stability::Plan::QUICK } else { stability::Plan::REPORT };
        let random = args.shots.map_or(plan.random, u64::from);
        return play_stability(args, &stability::Plan { random, ..plan });
    }
    if let Some(shots) = args.shots.filter(|shots| *shots > MOST_STUDIED) {
        return Err(Failure::wrong_input(format_args!(
            "--shots {shots} is more than can be studied; accepted are 1 to {MOST_STUDIED}, and more with --stability"
        )));
    }
    let tables = args.table.as_ref().map_or_else(judged, |name| table_named(name).map(with_flights))?;
    let references = study::check_references();
    let measured = tables.into_iter().map(|(table, steepest)| measure(args, table, steepest));
    let studies = measured.collect::<Result<Vec<_>, _>>()?;
    if let Some(folder) = &args.out {
        write_files(folder, &studies)?;
    }
    let mut out = printing::stdout().exact(args.json);
    if args.json {
        for row in &references {
            printing::json_line(&mut out, row)?;
        }
        for study in &studies {
            printing::json_line(&mut out, &study.summary)?;
            for row in &study.rows {
                printing::json_line(&mut out, row)?;
            }
        }
    } else {
        out.write_all(study::text(&references, &studies).as_bytes())?;
        writeln!(out)?;
    }
    out.flush()?;
    drop(out);
    // The stability table has tables and numbers of shots of its own.
    if args.quick || args.shots.is_some() || args.table.is_some() {
        tell("The stability table was not played: --stability plays it, in minutes; with --quick a tenth of it.");
        return Ok(());
    }
    play_stability(args, &stability::Plan::REPORT)
}

/// A table of the size of the filmed one.
fn filmed_table(name: &str) -> Result<Table, Failure> {
    let table = table_named(name)?;
    filmed::check_size(&table).map_err(Failure::wrong_input)?;
    Ok(table)
}

/// What models of the table reach on the film.
fn replay_film(args: &Args) -> Result<(), Failure> {
    let film = filmed::bundled();
    let models = match &args.table {
        Some(name) => filmed_table(name).map(|table| vec![(table.name.clone(), table)])?,
        None => filmed::models(),
    };
    let judged = |(name, table): &(String, Table)| {
        tell(format_args!("playing the film on {name} ..."));
        filmed::judge(name, table, &film)
    };
    let rows: Vec<_> = models.iter().map(judged).collect();
    if let Some(folder) = &args.out {
        write_file(folder, "filmed.csv", &filmed::csv(&rows))?;
        if let Some((_, table)) = models.last() {
            write_file(folder, "filmed.svg", &filmed::paths(table, &film)?)?;
        }
    }
    let mut out = printing::stdout().exact(args.json);
    if args.json {
        rows.iter().try_for_each(|row| printing::json_line(&mut out, row))?;
    } else {
        out.write_all(filmed::text(&rows).as_bytes())?;
    }
    Ok(())
}

/// Constants that come nearest to the film: all of it, and each half judged on the other.
fn fit_film(args: &Args) -> Result<(), Failure> {
    let film = filmed::bundled();
    let table = args.table.as_deref().map_or_else(|| Ok(Table::default()), filmed_table)?;
    let model = table.rail.model;
    let half =
        |rest: usize| film.iter().enumerate().filter(move |(index, _)| index % 2 == rest).map(|(_, shot)| shot.clone());
    let (even, odd): (Vec<_>, Vec<_>) = (half(0).collect(), half(1).collect());
    let parts = [("the whole film", &film, &film), ("every other shot", &even, &odd), ("the other shots", &odd, &even)];
    let mut out = printing::stdout().exact(args.json);
    for (used, fit_on, judge_on) in parts {
        tell(format_args!("fitting {used} ..."));
        let fitted = filmed::fit_constants(&table, model, fit_on);
        let name = format!("fitted to {used}");
        let row = filmed::judge(&name, &fitted.table, judge_on);
        if args.json {
            printing::json_line(&mut out, &fitted)?;
            printing::json_line(&mut out, &row)?;
        } else {
            let judged = if std::ptr::eq(fit_on, judge_on) { "the same shots" } else { "the shots that were not used" };
            writeln!(out, "{}Judged on {judged}:\n{}", filmed::fit_text(&fitted, used), filmed::text(&[row]))?;
        }
    }
    Ok(())
}

/// The stability table, which tells of each stiff or extreme case how many shots fail and why.
fn play_stability(args: &Args, plan: &stability::Plan) -> Result<(), Failure> {
    let plan = stability::Plan { seed: args.seed.unwrap_or(plan.seed), ..*plan };
    let mut out = printing::stdout().exact(args.json);
    if !args.json {
        writeln!(out, "{}", stability::heads())?;
    }
    let mut rows = Vec::new();
    for row in stability::rows(&plan) {
        if args.json {
            printing::json_line(&mut out, &row)?;
        } else {
            writeln!(out, "{}", row.line())?;
        }
        // What is interrupted has told what it found.
        out.flush()?;
        rows.push(row);
    }
    if let Some(folder) = &args.out {
        write_file(folder, STABILITY, &stability::page(&plan, &rows))?;
    }
    match rows.iter().filter(|row| row.failed > 0).count() {
        0 => Ok(()),
        failing => Err(Failure::failed(format_args!("{} of the stability table failed", plural(failing, "row")))),
    }
}

/// The tables that are judged where none is named: two with usual strokes, and one with steep ones whose balls fly.
fn judged() -> Result<Vec<(Table, Steepest)>, Failure> {
    let flat = JUDGED.into_iter().map(|name| Ok((table_named(name)?, Steepest::USUAL)));
    flat.chain([Ok((Table::default(), Steepest::FLIGHTS))]).collect()
}

/// A table with usual strokes, and with steep ones where balls leave its cloth.
fn with_flights(table: Table) -> Vec<(Table, Steepest)> {
    let flying = table.flight.is_some().then(|| (table.clone(), Steepest::FLIGHTS));
    [(table, Steepest::USUAL)].into_iter().chain(flying).collect()
}

/// Every method on one table.
///
/// # Errors
/// Where the truth of no shot is known, by which methods could be judged.
fn measure(args: &Args, table: Table, steepest: Steepest) -> Result<Study, Failure> {
    let (shots, finest, rounds, steps) = if args.quick { (96, 1e-4, 2, 1.5e6) } else { (1000, 1e-6, 3, 4e7) };
    let shots = args.shots.map_or(shots, |shots| shots as usize);
    let shots = random_shots(&table, shots, args.seed.unwrap_or(SEED), steepest);
    let (name, all, mut line) = (table.name.clone(), shots.len(), ProgressLine::default());
    let found_by = args.table.clone().unwrap_or_else(|| name.clone());
    let plan = Plan { table, found_by, steepest, shots, methods: Method::all(finest), rounds, steps };
    let study = plan.run(|done| line.show(format_args!("every method on {name}: {done} of {all} shots")));
    line.clear();
    if study.summary.judged.count == 0 {
        return Err(Failure::failed(format_args!(
            "none of the {all} shots on \"{}\" can be judged: {}; a level table whose rails have another model than \"mathavan\" would do",
            study.summary.table,
            study.why_unjudged()
        )));
    }
    Ok(study)
}

/// Whole files or none, at the very end: an interruption before leaves nothing half written.
fn write_files(folder: &Path, studies: &[Study]) -> Result<(), Failure> {
    let files = [
        ("accuracy.csv", study::csv(studies)),
        ("error-vs-time.svg", study::error_against_time(studies)?),
        ("error-vs-condition.svg", study::error_against_condition(studies)?),
    ];
    files.into_iter().try_for_each(|(name, text)| write_file(folder, name, &text))
}

fn write_file(folder: &Path, name: &str, text: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    write_atomic(&path, text.as_bytes())
        .map_err(|error| Failure::failed(format_args!("{} cannot be written: {error}", path.display())))?;
    tell(format_args!("wrote {}", path.display()));
    Ok(())
}
