//! Searches new model shots for the exercises, by simulation on each exercise's own table.
//!
//! `cargo run --release --example model_shots -- saves/*.json` treats every exercise whose shot does not show what its category teaches, or
//! that players make less often than its par. Names after the files restrict it to these exercises. If the best shot from the present
//! layout is below the par, ball 1 and ball 2 are moved by up to 0.15 m. Run the example `grade` afterwards: it writes `par` and `grade`.

use std::{env, error::Error, fs, path::Path};

use carom::{
    drills::{Exercise, LibraryFile, Par},
    storage::write_atomic,
};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use search::{Found, best, best_of_places, cost, worth};

mod search;

/// How far the mean success of the three players may be below the par before the balls are moved.
const SHORTFALL: f64 = 0.05;

fn main() -> Result<(), Box<dyn Error>> {
    let (paths, names): (Vec<String>, Vec<String>) =
        env::args().skip(1).partition(|word| Path::new(word).extension().is_some());
    if paths.is_empty() {
        return Err("say which files: model_shots saves/*.json [NAME ...]".into());
    }
    for path in paths {
        let text = fs::read_to_string(&path)?;
        let mut file = LibraryFile::parse(&text)?;
        for exercise in &mut file.exercises {
            if names.is_empty() || names.contains(&exercise.name) {
                renew(exercise);
            }
        }
        let renewed = file.to_text()?;
        if renewed != text {
            write_atomic(Path::new(&path), renewed.as_bytes())?;
        }
    }
    Ok(())
}

/// Gives the exercise the best shot that was found, and prints the change.
fn renew(exercise: &mut Exercise) {
    let wanted = exercise.par.map_or(0.0, mean) - exercise.shot.map_or(0.0, |shot| cost(&shot));
    let present = exercise.shot.map_or(0.0, |shot| worth(exercise, &shot));
    if exercise.shot.is_some() && present >= wanted - SHORTFALL / 5.0 {
        return;
    }
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2026);
    let mut found = best(exercise, &mut rng).filter(|found| found.worth > present);
    if found.as_ref().map_or(present, |found| found.worth) < wanted - SHORTFALL {
        let moved = best_of_places(exercise, wanted, &mut rng);
        let before = found.as_ref().map_or(present, |found| found.worth);
        found = moved.filter(|moved| moved.worth > before + SHORTFALL).or(found);
    }
    let name = &exercise.name;
    match found {
        Some(Found { layout, shot, worth }) => {
            let places = if layout == exercise.layout { "" } else { ", balls moved" };
            println!("{name}: {present:.3} -> {worth:.3} of {wanted:.3}{places}");
            (exercise.layout, exercise.shot) = (layout, Some(shot));
        }
        None => println!("{name}: {present:.3} of {wanted:.3} stays"),
    }
}

/// Returns the mean success of the three players.
fn mean(Par { beginner, club, world_class }: Par) -> f64 {
    (beginner + club + world_class) / 3.0
}
