//! `carom accuracy`: measures the error of the simulator against its run time.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use super::{
    Failure,
    input::{parse_seed, table_by_name, whole_number},
    output::{check_writable, plural, print_note},
};
use crate::{
    printing::{self, ProgressLine},
    storage::write_atomic,
    study::{self, MaxElevation, Method, Plan, Study, filmed, random_shots, stability},
    table::{THESIS_PRESETS, Table},
};

/// Measure the accuracy and the run time of the simulator.
///
/// The engine, other root finders, single precision and fixed time steps are compared with the reference engine, which plays the same shots
/// with 32 digits and counts as the truth. All of them are compared with reference shots of 50 digits. This takes minutes, with --quick
/// seconds. Without --quick, --shots and --table, the stability table follows.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Args {
    /// Few shots and no time steps below 1e-4 s: seconds instead of minutes.
    #[arg(long)]
    quick: bool,
    /// Number of random shots on each table. Default: 1000, or 96 with --quick; with --stability 100000, or 10000 with --quick
    #[arg(long, value_parser = whole_number(1..=1_000_000_000_u32))]
    shots: Option<u32>,
    /// Seed of the shots. Default: 2026, or 1 for the stability table
    #[arg(long, value_parser = parse_seed)]
    seed: Option<u64>,
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file. If its balls can leave the cloth,
    /// strokes of up to 60 degrees are studied, too. Default: textbook and thesis, and such strokes on match
    #[arg(long, value_name = "NAME")]
    table: Option<String>,
    /// Play only the stability table: a hundred thousand random, ten thousand adversarial and a thousand shots of each stiff or extreme
    /// case on each table, or a tenth of them with --quick. --shots sets the number of random shots.
    #[arg(long, conflicts_with = "table")]
    stability: bool,
    /// Replay filmed shots of real balls instead, on several models of the table, and report how far each model is from the film. A --table
    /// must have the length, width and balls of the filmed one.
    #[arg(long, conflicts_with_all = ["stability", "shots", "seed", "quick"])]
    filmed: bool,
    /// With --filmed, fit the constants of cloth and rails to the film. Then fit them to each half of it and test them on the other half.
    #[arg(long, requires = "filmed", conflicts_with_all = ["stability", "shots", "quick", "out"])]
    fit: bool,
    /// Write files into this folder: accuracy.csv, error-vs-time.svg and error-vs-condition.svg, and stability.md if the stability table is
    /// played; with --filmed: filmed.csv and filmed.svg.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON instead of text: one object for each reference file, table, method, row or model.
    #[arg(long)]
    json: bool,
}

/// Default seed of the studied shots.
const SEED: u64 = 2026;

/// Maximum number of shots that are studied with every method: all of them are kept in memory.
const MAX_STUDIED: u32 = 1_000_000;

/// File name of the stability table.
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
        check_writable(folder, &folder.join(first))?;
    }
    if args.filmed {
        return if args.fit { fit_film(args) } else { replay_film(args) };
    }
    if args.stability {
        let plan = if args.quick { stability::Plan::QUICK } else { stability::Plan::REPORT };
        let random = args.shots.map_or(plan.random, u64::from);
        return play_stability(args, &stability::Plan { random, ..plan });
    }
    if let Some(shots) = args.shots.filter(|shots| *shots > MAX_STUDIED) {
        return Err(Failure::wrong_input(format_args!(
            "--shots {shots} is more than can be studied; accepted are 1 to {MAX_STUDIED}, and more with --stability"
        )));
    }
    let tables = args.table.as_ref().map_or_else(default_tables, |name| table_by_name(name).map(with_flights))?;
    let references = study::check_references();
    let measured = tables.into_iter().map(|(table, max_elevation)| measure(args, table, max_elevation));
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
    // The stability table has its own tables and numbers of shots.
    if args.quick || args.shots.is_some() || args.table.is_some() {
        print_note("The stability table was not played: --stability plays it, in minutes; with --quick a tenth of it.");
        return Ok(());
    }
    play_stability(args, &stability::Plan::REPORT)
}

/// Returns the table called `name` if it has the size of the filmed one.
fn filmed_table(name: &str) -> Result<Table, Failure> {
    let table = table_by_name(name)?;
    filmed::check_size(&table).map_err(Failure::wrong_input)?;
    Ok(table)
}

/// Reports how far several models of the table are from the film.
fn replay_film(args: &Args) -> Result<(), Failure> {
    let film = filmed::bundled();
    let models = match &args.table {
        Some(name) => filmed_table(name).map(|table| vec![(table.name.clone(), table)])?,
        None => filmed::models(),
    };
    let judged = |(name, table): &(String, Table)| {
        print_note(format_args!("playing the film on {name} ..."));
        filmed::evaluate_model(name, table, &film)
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

/// Fits constants to the whole film, and to each half of it to test them on the other half.
fn fit_film(args: &Args) -> Result<(), Failure> {
    let film = filmed::bundled();
    let table = args.table.as_deref().map_or_else(|| Ok(Table::default()), filmed_table)?;
    let model = table.rail.model;
    let [even, odd] = [0, 1].map(|first| film.iter().skip(first).step_by(2).cloned().collect());
    let parts = [("the whole film", &film, &film), ("every other shot", &even, &odd), ("the other shots", &odd, &even)];
    let mut out = printing::stdout().exact(args.json);
    for (used, fit_on, judge_on) in parts {
        print_note(format_args!("fitting {used} ..."));
        let fitted = filmed::fit_constants(&table, model, fit_on);
        let name = format!("fitted to {used}");
        let row = filmed::evaluate_model(&name, &fitted.table, judge_on);
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

/// Plays the stability table, which reports for each stiff or extreme case how many shots fail and why.
fn play_stability(args: &Args, plan: &stability::Plan) -> Result<(), Failure> {
    let plan = stability::Plan { seed: args.seed.unwrap_or(plan.seed), ..*plan };
    let mut out = printing::stdout().exact(args.json);
    if !args.json {
        writeln!(out, "{}", stability::headings())?;
    }
    let mut rows = Vec::new();
    for row in stability::rows(&plan) {
        if args.json {
            printing::json_line(&mut out, &row)?;
        } else {
            writeln!(out, "{}", row.line())?;
        }
        // Flush each row, so that an interrupted run has reported its results so far.
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

/// Returns the default tables: two with ordinary strokes, and one with steep strokes that make balls fly.
fn default_tables() -> Result<Vec<(Table, MaxElevation)>, Failure> {
    let flat = THESIS_PRESETS.into_iter().map(|name| Ok((table_by_name(name)?, MaxElevation::USUAL)));
    flat.chain([Ok((Table::default(), MaxElevation::FLIGHTS))]).collect()
}

/// Returns the table with ordinary strokes and, if balls can leave its cloth, again with steep ones.
fn with_flights(table: Table) -> Vec<(Table, MaxElevation)> {
    let flying = table.flight.is_some().then(|| (table.clone(), MaxElevation::FLIGHTS));
    [(table, MaxElevation::USUAL)].into_iter().chain(flying).collect()
}

/// Runs every method on one table.
///
/// # Errors
/// Fails if no shot has a known truth to compare the methods with.
fn measure(args: &Args, table: Table, max_elevation: MaxElevation) -> Result<Study, Failure> {
    let (shots, finest, rounds, steps) = if args.quick { (96, 1e-4, 2, 1.5e6) } else { (1000, 1e-6, 3, 4e7) };
    let shots = args.shots.map_or(shots, |shots| shots as usize);
    let shots = random_shots(&table, shots, args.seed.unwrap_or(SEED), max_elevation);
    let (name, all, mut line) = (table.name.clone(), shots.len(), ProgressLine::default());
    let table_argument = args.table.clone().unwrap_or_else(|| name.clone());
    let plan = Plan { table, table_argument, max_elevation, shots, methods: Method::all(finest), rounds, steps };
    let study = plan.run(|done| line.show(format_args!("every method on {name}: {done} of {all} shots")));
    line.clear();
    if study.summary.judged.count == 0 {
        return Err(Failure::failed(format_args!(
            "none of the {all} shots on \"{}\" can be judged: {}; use a level table whose rail model is not \"mathavan\"",
            study.summary.table,
            study.why_unjudged()
        )));
    }
    Ok(study)
}

/// Writes each file atomically at the very end, so that an earlier interruption leaves no partial files.
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
    print_note(format_args!("wrote {}", path.display()));
    Ok(())
}
