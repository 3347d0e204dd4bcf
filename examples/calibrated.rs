//! Value of a calibration: how often a player makes the coach's shots on a table that the coach knows exactly, knows from a calibration, or
//! assumes to be `match`.
//!
//! `cargo run --release --example calibrated -- 40 5 club` draws 40 random tables with the variation of real tables and lets a simulated
//! club player calibrate each. On 5 layouts per table, the coach recommends a three-cushion shot with each of the three states of
//! knowledge. All shots are played on the drawn table with the player's errors. A number after the player is the seed of the first table.

use std::{env, error::Error, time::Duration};

use carom::{
    calibration::simulated_calibration,
    coach::{Coach, Doubt, Request, Shooter, Skill, make_probability},
    game::Rule,
    learning::evaluation::held_out_layouts,
    table::{Table, TableDoubt},
};

/// Number of simulations for each shot.
const SIMULATIONS: u64 = 60_000;

/// Number of attempts at every shot.
const ATTEMPTS: usize = 1000;

/// The coach's knowledge of the table.
const KNOWN: [&str; 3] = ["exactly", "calibrated", "not at all"];

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = env::args().skip(1);
    let mut count = || words.next().ok_or("say how many tables and layouts, like: calibrated 40 5");
    let (tables, layouts): (u64, usize) = (count()?.parse()?, count()?.parse()?);
    let skill: Skill = words.next().map_or(Ok(Skill::CLUB), |word| word.parse())?;
    let first: u64 = words.next().map_or(Ok(0), |word| word.parse())?;
    let rule = Rule::ThreeCushion;
    let base = Table { name: "own".to_owned(), ..Table::default() };
    let certain = Doubt { table: 0.0, ..Doubt::FULL };
    let (mut made, mut predicted) = ([0.0; 3], [0.0; 3]);
    for (count, seed) in (1..=tables).zip(first..) {
        let [truth, own] = simulated_calibration(&base, &TableDoubt::of(&base), seed)?;
        let coaches = [(&truth, certain), (&own, Doubt::FULL), (&base, Doubt::FULL)]
            .map(|(table, doubt)| (Coach::without_policy(table.clone()), doubt));
        for layout in held_out_layouts(&truth, layouts, seed) {
            for (which, (coach, doubt)) in coaches.iter().enumerate() {
                let budget = Duration::MAX;
                let request = Request {
                    rule,
                    skill,
                    doubt: *doubt,
                    budget,
                    simulations: SIMULATIONS,
                    seed,
                    ..Request::default()
                };
                let advice = coach.recommend(&layout, &request)?;
                predicted[which] += advice.make_probability.map_or(0.0, |made| made.rate);
                let shooter = Shooter { skill, doubt: certain };
                made[which] += make_probability(shooter, rule, &truth, &layout, &advice.cue, ATTEMPTS, !seed).rate;
            }
        }
        let asked = count as f64 * layouts as f64;
        let share = |which: usize| {
            format!("{} {:.3} (predicted {:.3})", KNOWN[which], made[which] / asked, predicted[which] / asked)
        };
        println!("{count} tables: made where the table is known {}", [0, 1, 2].map(share).join(", "));
    }
    Ok(())
}
