//! Fits the weights with which the coach estimates the difficulty of layouts (`src/coach/difficulty`), and reports the quality of the fit.
//!
//! `cargo run --release --example ease -- 1600` plays innings on `match` until it has 1,600 layouts for each rule. For each layout it
//! estimates how often a weak and a strong player miss it with the shot of a short search. It fits one half of the layouts and measures the
//! fit on the other half. The searches are limited by simulations, so that the weights are the same on every machine whose networks round
//! alike.

use std::{
    env,
    error::Error,
    time::{Duration, Instant},
};

use carom::{
    coach::{Coach, DifficultySample, Doubt, Inning, LayoutDifficulty, Request, Skill, inning},
    game::Rule,
    learning::evaluation::held_out_layouts,
    table::{Layout, Table},
};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

/// Another seed than that of the coach's measurements, so that layouts and errors differ.
const SEED: u64 = 20_261;

/// Number of simulations of a search: a tenth of a second.
const SIMULATIONS: u64 = 20_000;

/// Points after which an inning is stopped, so that a long run of easy layouts does not fill the sample.
const MOST_POINTS: u32 = 12;

/// A time limit that is never reached.
const YEAR: Duration = Duration::from_secs(365 * 24 * 3600);

fn main() -> Result<(), Box<dyn Error>> {
    let count: usize = env::args().nth(1).ok_or("say how many layouts a rule: ease 1600")?.parse()?;
    let coach = Coach::new(Table::default());
    for rule in Rule::ALL {
        let layouts = gather(&coach, rule, count)?;
        let samples = layouts.iter().map(|layout| sample(&coach, layout, rule)).collect::<Result<Vec<_>, _>>()?;
        let (ours, others) = samples.split_at(samples.len() / 2);
        let fit = LayoutDifficulty::fit(coach.table(), ours);
        println!(
            "{rule}: weights {:?}, power {:.2}",
            fit.weights.map(|weight| (1e4 * weight).round() / 1e4),
            fit.power
        );
        for (name, difficulty) in [("fitted", fit), ("in use", LayoutDifficulty::for_rule(rule))] {
            println!("  {name}");
            report(coach.table(), difficulty, others);
        }
    }
    Ok(())
}

/// Collects layouts as a strong player meets them: initial layouts of innings, and those that the shots leave.
fn gather(coach: &Coach, rule: Rule, count: usize) -> Result<Vec<Layout>, Box<dyn Error>> {
    let request = Request { rule, plan: true, ..request(LayoutDifficulty::STRONG) };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(SEED);
    let mut layouts = Vec::new();
    for first in held_out_layouts(coach.table(), count, SEED) {
        layouts.push(first);
        let mut note = |_: &Inning, layout: &Layout| layouts.push(*layout);
        inning(coach, &first, &request, MOST_POINTS, Instant::now() + YEAR, &mut rng, &mut note)?;
        eprint!("\r{rule}: {} of {count} layouts", layouts.len().min(count));
        if layouts.len() >= count {
            break;
        }
    }
    eprintln!();
    layouts.truncate(count);
    Ok(layouts)
}

/// Estimates how often a layout is missed with the best shot of a short search.
fn sample(coach: &Coach, layout: &Layout, rule: Rule) -> Result<DifficultySample, Box<dyn Error>> {
    let missed = |skill| -> Result<f64, Box<dyn Error>> {
        let advice = coach.recommend(layout, &Request { rule, ..request(skill) })?;
        Ok(1.0 - advice.make_probability.map_or(0.0, |rate| rate.rate))
    };
    let (missed, missed_by_strong) = (missed(LayoutDifficulty::WEAK)?, missed(LayoutDifficulty::STRONG)?);
    Ok(DifficultySample { layout: *layout, missed, missed_by_strong })
}

fn request(skill: Skill) -> Request {
    Request { skill, doubt: Doubt::FULL, budget: YEAR, simulations: SIMULATIONS, seed: SEED, ..Request::default() }
}

/// Prints the misses of layouts by estimated difficulty: fifths of the estimate, the easiest first.
fn report(table: &Table, difficulty: LayoutDifficulty, samples: &[DifficultySample]) {
    let mut sorted = samples.to_vec();
    sorted.sort_by(|one, other| {
        difficulty.miss_rate(table, &one.layout).total_cmp(&difficulty.miss_rate(table, &other.layout))
    });
    println!("  misses %       strong, estimated  simulated  weak, estimated  simulated");
    for fifth in sorted.chunks(samples.len().div_ceil(5).max(1)) {
        let mean = |value: &dyn Fn(&DifficultySample) -> f64| {
            100.0 * fifth.iter().map(value).sum::<f64>() / fifth.len() as f64
        };
        println!(
            "  {:>32.2} {:>10.2} {:>16.2} {:>10.2}",
            mean(&|sample| 1.0 - difficulty.probability(table, &sample.layout, LayoutDifficulty::STRONG)),
            mean(&|sample| sample.missed_by_strong),
            mean(&|sample| difficulty.miss_rate(table, &sample.layout)),
            mean(&|sample| sample.missed),
        );
    }
}
