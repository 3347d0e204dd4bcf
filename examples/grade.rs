//! Measures the difficulty of the exercises in a folder and writes it into their files.
//!
//! `cargo run --release --example grade -- saves/` plays every shot 10,000 times with the errors of a beginner, a club player and a
//! world-class player, rewrites par and grade, and sorts the exercises by grade. With `--check` it writes nothing; it fails if a file
//! differs from what it would write, or if a shot does not show what its category teaches.

use std::{
    env,
    error::Error,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use carom::{
    drills::{LibraryFile, Par, flaws},
    storage::write_atomic,
};

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let (options, folders): (Vec<String>, Vec<String>) = env::args().skip(1).partition(|word| word.starts_with("--"));
    let check = match options.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => false,
        ["--check"] => true,
        _ => return Err("the only option is --check".into()),
    };
    let [folder] = &folders[..] else { return Err("say where the files are: grade [--check] saves/".into()) };
    let mut is_well = true;
    for path in files(Path::new(folder))? {
        is_well &= grade(&path, check)?;
    }
    Ok(if is_well { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Returns the JSON files of a folder, sorted by name.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, std::io::Error>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    paths.sort();
    Ok(paths)
}

/// Measures the exercises of a file; returns `false` if a shot does not show what its category teaches, or if a check finds a different
/// text.
fn grade(path: &Path, check: bool) -> Result<bool, Box<dyn Error>> {
    let named = |error: &dyn Error| format!("{}: {error}", path.display());
    let text = fs::read_to_string(path).map_err(|error| named(&error))?;
    let mut file = LibraryFile::parse(&text).map_err(|error| named(&error))?;
    let mut is_well = true;
    for exercise in &mut file.exercises {
        for flaw in flaws(exercise).map_err(|error| named(&error))? {
            println!("{}: not so: {flaw}", exercise.name);
            is_well = false;
        }
        exercise.par = Par::measure(exercise)?;
        exercise.grade = exercise.par.map_or(0, |par| par.grade());
        if let Some(Par { beginner, club, world_class }) = exercise.par {
            let (category, name, grade) = (exercise.category, &exercise.name, exercise.grade);
            println!("{category:14} {name:26} grade {grade}  {beginner:.3} {club:.3} {world_class:.3}");
        }
    }
    file.exercises.sort_by_key(|exercise| exercise.grade);
    let measured = file.to_text()?;
    if measured != text && check {
        println!("{}: not as measured", path.display());
    } else if measured != text {
        write_atomic(path, measured.as_bytes())?;
    }
    Ok(is_well && (measured == text || !check))
}
