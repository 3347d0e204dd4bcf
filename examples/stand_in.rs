//! Success of the coach's shots on a table that differs slightly from the coach's.
//!
//! `cargo run --release --example stand_in -- 46 three-cushion expert full 0` asks the coach for a shot on `match` from every other layout
//! of the filmed shots, starting with the first. It plays the shot with an expert's errors on stand-in tables whose rails follow other
//! models, fitted to the same film. The predicted and the observed success rates should agree. With `1` at the end it uses the other
//! layouts.

use std::{env, error::Error, time::Duration};

use carom::{
    coach::{Coach, Doubt, Request, Skill, make_probability},
    game::Rule,
    study::filmed::{bundled, models},
    table::Table,
};

/// Number of simulations for each shot: about a quarter of a second on two cores.
const SIMULATIONS: u64 = 60_000;

/// Number of attempts at every shot.
const ATTEMPTS: usize = 400;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = env::args().skip(1);
    let count: usize =
        words.next().ok_or("say how many layouts: stand_in 40 [RULE] [SKILL] [DOUBT] [FIRST]")?.parse()?;
    let rule: Rule = words.next().map_or(Ok(Rule::ThreeCushion), |word| word.parse())?;
    let skill: Skill = words.next().map_or(Ok(Skill::EXPERT), |word| word.parse())?;
    let doubt: Doubt = words.next().map_or(Ok(Doubt::FULL), |word| word.parse())?;
    let first: usize = words.next().map_or(Ok(0), |word| word.parse())?;
    let advised = Table::default();
    let coach = Coach::new(advised.clone());
    let stand_ins = models().into_iter().filter(|(_, table)| *table != advised).collect::<Vec<_>>();
    let mut claimed = 0.0;
    let mut made = vec![0.0; stand_ins.len()];
    let mut asked = 0;
    for shot in bundled().iter().skip(first).step_by(2).take(count) {
        let layout = shot.layout(&advised);
        if layout.validate(&advised).is_err() {
            continue;
        }
        let budget = Duration::MAX;
        let request = Request { rule, skill, doubt, budget, simulations: SIMULATIONS, ..Request::default() };
        let advice = coach.recommend(&layout, &request)?;
        asked += 1;
        claimed += advice.make_probability.map_or(0.0, |made| made.rate);
        for ((_, table), made) in stand_ins.iter().zip(&mut made) {
            *made += make_probability(skill, rule, table, &layout, &advice.cue, ATTEMPTS, 2026).rate;
        }
    }
    let share = |sum: f64| sum / f64::from(asked);
    println!("{rule}, skill {skill}, doubt {doubt}, {asked} layouts of the film: claimed {:.3}", share(claimed));
    for ((name, _), made) in stand_ins.iter().zip(made) {
        println!("  made on {name}: {:.3}", share(made));
    }
    Ok(())
}
