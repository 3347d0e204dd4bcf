//! Search for a shot that shows what an exercise teaches and that players make often.

use std::f64::consts::PI;

use carom::{
    coach::{Skill, Technique, make_probability},
    drills::{Category, Exercise, MAX_GATHERED_DISTANCE, flaws},
    game::scores,
    physics::{CueInputs, raise_to_clear},
    statistics::normal_pair,
    table::{Layout, Table},
};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Number of strokes (tip position and speed) that are tried from a layout in every direction.
const STROKES: usize = 1500;
/// Number of strokes for each moved layout.
const STROKES_MOVED: usize = 200;
/// Number of moved layouts that are tried.
const PLACES: usize = 80;
/// Number of attempts per player to compare shots.
const ATTEMPTS: usize = 300;
/// Number of shots that are refined.
const LEADERS: usize = 6;
/// Speed up to which a shot has no penalty, m/s, and the penalty of each m/s more, in success rate.
const SOFT: f64 = 2.5;
const POWER: f64 = 0.03;
/// Resolution of the files: tip positions per ball radius, directions per degree, and speeds per 1 m/s.
const TIP: f64 = 20.0;
const DEGREE: f64 = 10.0;
const SPEED: f64 = 10.0;

/// A shot that was found, with its layout.
pub struct Found {
    /// The layout.
    pub layout: Layout,
    /// The shot.
    pub shot: CueInputs,
    /// Mean success rate of beginner, club player and expert, minus the penalty.
    pub worth: f64,
}

/// Returns the mean success rate of this shot for beginner, club player and expert, with [`ATTEMPTS`] each, minus the penalty for its
/// speed; 0 if it does not show what the exercise teaches. In `gather`, the rate at which an expert gathers the balls is an upper bound.
pub fn worth(exercise: &Exercise, shot: &CueInputs) -> f64 {
    worth_of(exercise, shot, ATTEMPTS)
}

fn worth_of(exercise: &Exercise, shot: &CueInputs, attempts: usize) -> f64 {
    let shown = Exercise { shot: Some(*shot), ..exercise.clone() };
    let (Ok([]), Ok(table)) = (flaws(&shown).as_deref(), exercise.table()) else { return 0.0 };
    let shares = [Skill::BEGINNER, Skill::CLUB, Skill::EXPERT]
        .map(|skill| make_probability(skill, exercise.rule, &table, &exercise.layout, shot, attempts, 1).rate);
    // Of shots with equal success, prefer to teach the softer one.
    let mean = shares.iter().sum::<f64>() / 3.0 - cost(shot);
    if exercise.category == Category::Gather {
        let gathered = gathered(exercise, &table, shot, attempts / 2);
        // Nine of ten attempts are enough; beyond that, only the success rate counts.
        if gathered < 0.65 { 0.0 } else { mean.min(gathered / 0.9) }
    } else {
        mean
    }
}

/// Returns the penalty for the speed of a shot, in success rate.
pub fn cost(shot: &CueInputs) -> f64 {
    POWER * (shot.speed - SOFT).max(0.0)
}

/// Returns the share of an expert's attempts that make the point and gather the balls.
fn gathered(exercise: &Exercise, table: &Table, shot: &CueInputs, attempts: usize) -> f64 {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut is_gathered = || {
        let [[a, b], [theta, phi], [speed, _]] = std::array::from_fn(|_| normal_pair(&mut rng));
        let stroke = Skill::EXPERT.stroke(table.radius, shot, &[a, b, theta, phi, speed]);
        Technique::of(table, &exercise.layout, &stroke)
            .is_ok_and(|technique| technique.tally.is_point(exercise.rule) && technique.spread <= MAX_GATHERED_DISTANCE)
    };
    (0..attempts).filter(|_| is_gathered()).count() as f64 / attempts as f64
}

/// Returns the best shot from the exercise's layout.
pub fn best(exercise: &Exercise, rng: &mut impl RngExt) -> Option<Found> {
    let mut leaders = candidates(exercise, STROKES, rng);
    leaders.truncate(LEADERS);
    let refined = leaders.into_iter().map(|(_, shot)| refine(exercise, shot));
    let (worth, shot) = refined.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Found { layout: exercise.layout, shot, worth })
}

/// Returns the best shot if ball 1 and ball 2 may be moved, smaller moves first; stops at the first shot that reaches `enough`.
pub fn best_of_places(exercise: &Exercise, enough: f64, rng: &mut impl RngExt) -> Option<Found> {
    let table = exercise.table().ok()?;
    let mut leaders: Vec<(f64, Exercise)> = Vec::new();
    for place in 0..PLACES {
        // Small moves first.
        let reach = 3 + 12 * place / PLACES;
        let mut layout = exercise.layout;
        for ball in &mut layout.balls[1..] {
            let mut step = || f64::from(rng.random_range(0..=2 * reach as u32)) - reach as f64;
            let mut moved = |at: f64| ((at * 100.0 + step()) * 10.0).round() / 1000.0;
            (ball.x, ball.y) = (moved(ball.x), moved(ball.y));
        }
        let changed = Exercise { layout, ..exercise.clone() };
        if layout.validate(&table).is_ok()
            && let Some((worth, _)) = candidates(&changed, STROKES_MOVED, rng).first()
        {
            leaders.push((*worth, changed));
        }
    }
    leaders.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut most: Option<Found> = None;
    for (_, changed) in leaders.iter().take(LEADERS) {
        let found = best(changed, rng);
        if found.as_ref().map_or(0.0, |found| found.worth) > most.as_ref().map_or(0.0, |found| found.worth) {
            most = found;
        }
        if most.as_ref().is_some_and(|found| found.worth >= enough) {
            break;
        }
    }
    most
}

/// Returns shots that show what the exercise teaches, the most successful first.
fn candidates(exercise: &Exercise, strokes: usize, rng: &mut impl RngExt) -> Vec<(f64, CueInputs)> {
    let Ok(table) = exercise.table() else { return Vec::new() };
    let [cue_ball, first, _] = exercise.layout.balls;
    let way = first - cue_ball;
    // Shots with cushions before ball 1 may start in any direction, others only in directions that meet the ball directly.
    let banks = exercise
        .tags
        .iter()
        .any(|tag| ["rail-first", "ticky", "umbrella", "bank", "cushion-first"].contains(&tag.as_str()));
    let (half, step) = if exercise.category == Category::JumpAndMasse {
        (1.2, 0.5_f64)
    } else if banks {
        (PI, 0.5)
    } else {
        ((2.0 * table.radius / way.length()).min(1.0).asin() + 0.02, 0.2)
    };
    let middle = way.y.atan2(way.x).to_degrees();
    let mut found = Vec::new();
    for number in 0..strokes {
        // Every other stroke is a variation of the present one, which was chosen for what it teaches.
        let present = exercise.shot.filter(|_| number % 2 == 0);
        let stroke = match present {
            Some(shot) => variation_of(&shot, rng),
            None => random_stroke(exercise, rng),
        };
        let mut run: Vec<f64> = Vec::new();
        let directions = (2.0 * half.to_degrees() / step) as usize;
        for turn in 0..=directions {
            let phi = middle - half.to_degrees() + step * turn as f64;
            let makes = with_raised_cue(exercise, &table, &CueInputs { phi: phi.to_radians(), ..stroke })
                .is_some_and(|shot| scores(exercise.rule, &table, &exercise.layout, &shot));
            if makes && turn < directions {
                run.push(phi);
            } else if !run.is_empty() {
                let phi = (run[run.len() / 2] * DEGREE).round() / DEGREE;
                let phi = (phi + 180.0).rem_euclid(360.0) - 180.0;
                found.push((run.len(), CueInputs { phi: phi.to_radians(), ..stroke }));
                run.clear();
            }
        }
    }
    found.sort_by_key(|(width, _)| std::cmp::Reverse(*width));
    let shots = found.iter().filter_map(|(_, shot)| with_raised_cue(exercise, &table, shot));
    let mut judged: Vec<(f64, CueInputs)> =
        shots.map(|shot| (worth_of(exercise, &shot, 40), shot)).filter(|(worth, _)| *worth > 0.0).take(60).collect();
    judged.sort_by(|a, b| b.0.total_cmp(&a.0));
    judged
}

/// Returns the shot with the cue raised as far as necessary, rounded up to a tenth of a degree. `None` if it has no room at 20 degrees, or
/// at 85 degrees for a jump or a massé.
fn with_raised_cue(exercise: &Exercise, table: &Table, shot: &CueInputs) -> Option<CueInputs> {
    let raised = raise_to_clear(table, &exercise.layout, shot).ok()?;
    let theta = (raised.theta.to_degrees() * DEGREE - 1e-9).ceil() / DEGREE;
    let most = if exercise.category == Category::JumpAndMasse { 85.0 } else { 20.0 };
    (theta <= most).then(|| CueInputs { theta: theta.to_radians(), ..raised })
}

/// Draws a tip position and a speed that suit the category.
fn random_stroke(exercise: &Exercise, rng: &mut impl RngExt) -> CueInputs {
    if exercise.category == Category::JumpAndMasse {
        return raised_stroke(exercise, rng);
    }
    let mut step = |least: i32, most: i32, unit: f64| f64::from(rng.random_range(least..=most)) / unit;
    let (a, b) = match exercise.category {
        Category::FirstCaroms => (0.0, step(-4, 6, TIP)),
        Category::Draw => (0.0, step(-9, -5, TIP)),
        Category::Follow => (0.0, step(5, 8, TIP)),
        Category::Side => (step(6, 8, TIP) * (step(0, 1, 0.5) - 1.0), step(-4, 6, TIP)),
        Category::OneCushion
        | Category::Gather
        | Category::ThreeCushion
        | Category::Systems
        | Category::JumpAndMasse
        | Category::Own => (step(-8, 8, TIP), step(-9, 7, TIP)),
    };
    CueInputs { a, b, theta: 3.0_f64.to_radians(), phi: 0.0, speed: step(9, 56, SPEED) }
}

/// Draws a stroke with the cue raised for a jump, a massé, or a rail. Its line passes the centre of the ball by less than half of the
/// radius.
fn raised_stroke(exercise: &Exercise, rng: &mut impl RngExt) -> CueInputs {
    let mut step = |least: i32, most: i32, unit: f64| f64::from(rng.random_range(least..=most)) / unit;
    let (theta, a, lever, speed) = match () {
        () if exercise.has_tag("jump") => (step(20, 60, 1.0), step(-4, 4, TIP), step(-8, 8, TIP), step(20, 60, SPEED)),
        () if exercise.has_tag("full") => (step(63, 80, 1.0), step(-9, 9, TIP), step(-9, 2, TIP), step(10, 50, SPEED)),
        () if exercise.has_tag("masse") => (step(30, 62, 1.0), step(-9, 9, TIP), step(-9, 2, TIP), step(10, 50, SPEED)),
        () => (0.0, step(-6, 6, TIP), step(4, 9, TIP), step(9, 56, SPEED)),
    };
    let theta = theta.to_radians();
    let b = (TIP * (theta + lever.asin()).min(1.4).sin()).round() / TIP;
    CueInputs { a, b: b.min((1.0 - a * a).sqrt() - 1.0 / TIP), theta, phi: 0.0, speed }
}

/// Draws a tip position and a speed near those of this shot.
fn variation_of(shot: &CueInputs, rng: &mut impl RngExt) -> CueInputs {
    let mut near =
        |value: f64, unit: f64, most: i32| ((value * unit).round() + f64::from(rng.random_range(-most..=most))) / unit;
    let a = if shot.a == 0.0 { 0.0 } else { near(shot.a, TIP, 3) };
    CueInputs {
        a,
        b: near(shot.b, TIP, 3),
        speed: near(shot.speed, SPEED, 10).max(0.5),
        theta: if shot.theta > 0.5 { shot.theta } else { 3.0_f64.to_radians() },
        phi: 0.0,
    }
}

/// Hill climbing from this shot, by single steps of the resolution of the files.
fn refine(exercise: &Exercise, mut shot: CueInputs) -> (f64, CueInputs) {
    let mut worth = worth_of(exercise, &shot, ATTEMPTS);
    let rounded = |value: f64, unit: f64| (value * unit).round() / unit;
    loop {
        let mut better = None;
        let raising = if exercise.category == Category::JumpAndMasse { 1.0 } else { 0.0 };
        for (a, b, phi, speed, theta) in [
            (0.0, 0.0, 0.0, 0.0, raising),
            (0.0, 0.0, 1.0, 0.0, raising),
            (1.0, 0.0, 0.0, 0.0, 0.0),
            (0.0, 1.0, 0.0, 0.0, 0.0),
            (0.0, 0.0, 1.0, 0.0, 0.0),
            (0.0, 0.0, 3.0, 0.0, 0.0),
            (0.0, 0.0, 0.0, 1.0, 0.0),
            (0.0, 0.0, 0.0, 3.0, 0.0),
            (1.0, 0.0, 3.0, 0.0, 0.0),
            (1.0, 0.0, -3.0, 0.0, 0.0),
        ] {
            for sign in [-1.0, 1.0] {
                let sideways = if matches!(exercise.category, Category::FirstCaroms | Category::Draw | Category::Follow)
                {
                    0.0
                } else {
                    a
                };
                let next = CueInputs {
                    theta: if theta > 0.0 {
                        (shot.theta.to_degrees() + sign * theta).round().max(0.0).to_radians()
                    } else {
                        shot.theta
                    },
                    a: rounded(shot.a + sign * sideways / TIP, TIP),
                    b: rounded(shot.b + sign * b / TIP, TIP),
                    phi: rounded(shot.phi.to_degrees() + sign * phi / DEGREE, DEGREE).to_radians(),
                    speed: rounded(shot.speed + sign * speed / SPEED, SPEED),
                };
                let Some(next) = exercise.table().ok().and_then(|table| with_raised_cue(exercise, &table, &next))
                else {
                    continue;
                };
                let reached = worth_of(exercise, &next, ATTEMPTS);
                if reached > worth + 1e-9 && better.as_ref().is_none_or(|(best, _)| reached > *best) {
                    better = Some((reached, next));
                }
            }
        }
        match better {
            Some((reached, next)) => (worth, shot) = (reached, next),
            None => return (worth, shot),
        }
    }
}
