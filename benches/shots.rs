//! Shots per second on one core: `cargo bench --bench shots`.
//!
//! Random layouts and random strokes at the centre of the ball (phi over the whole circle, V 0.5 to 6 m/s), scored under
//! r3 as in training, and recorded in full. Numbers are of this machine at this moment; compare two builds in one run.

use std::{f64::consts::PI, time::Instant};

use carom::{
    coach::{Coach, Request},
    game::Reward,
    physics::CueInputs,
    simulation::Recording,
    table::{Layout, PRESETS, Table},
};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

const SHOTS: usize = 50_000;

fn main() {
    for name in PRESETS {
        let table = Table::preset(name).expect("presets are valid");
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        let shots: Vec<(Layout, CueInputs)> = (0..SHOTS)
            .map(|_| {
                let layout = Layout::random(&table, &mut rng);
                let (phi, speed) = (rng.random_range(-PI..PI), rng.random_range(0.5..6.0));
                (layout, CueInputs { a: 0.0, b: 0.0, theta: 10_f64.to_radians(), phi, speed })
            })
            .collect();
        let mut points = 0.0;
        let scored = rate(SHOTS, || {
            points = shots.iter().map(|(layout, cue)| Reward::R3.of(&table, layout, cue)).sum::<f64>();
        });
        let share = 100.0 * points / SHOTS as f64;
        println!("{name}: {scored:.0} scored shots/s, of which {share:.2} % make a point");
        let recorded = rate(SHOTS, || {
            for (layout, cue) in &shots {
                std::hint::black_box(Recording::new(&table, layout, cue).map(|recording| recording.duration()).ok());
            }
        });
        println!("{name}: {recorded:.0} recorded shots/s");
    }
    let coach = Coach::new(Table::default()).expect("the bundled policy is valid");
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
    let layouts: Vec<Layout> = (0..2000).map(|_| Layout::random(coach.table(), &mut rng)).collect();
    let advised = rate(layouts.len(), || {
        for layout in &layouts {
            std::hint::black_box(coach.recommend(layout, &Request::default()).is_ok());
        }
    });
    println!("match: {advised:.0} recommendations/s");
}

/// How many of `count` things a second `work` does.
fn rate(count: usize, work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    count as f64 / start.elapsed().as_secs_f64()
}
