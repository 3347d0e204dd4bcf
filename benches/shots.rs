//! Shots per second on one core: `cargo bench --bench shots`.
//!
//! Random layouts and random strokes at the centre of the ball (phi over the whole circle, V 0.5 to 6 m/s) are scored under r3 as in
//! training, or recorded in full. Recommendations are measured, too. The numbers depend on the machine and its load: compare them with a
//! baseline that criterion stores (`-- --save-baseline NAME`, `-- --baseline NAME`), or compare two builds in one run.

use std::{f64::consts::PI, hint::black_box, time::Duration};

use carom::{
    coach::{Coach, Request},
    game::Reward,
    physics::CueInputs,
    simulation::Recording,
    table::{Layout, Table},
};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

fn random_shots(table: &Table, count: usize) -> Vec<(Layout, CueInputs)> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    (0..count)
        .map(|_| {
            let layout = Layout::random(table, &mut rng);
            let (phi, speed) = (rng.random_range(-PI..PI), rng.random_range(0.5..6.0));
            (layout, CueInputs { a: 0.0, b: 0.0, theta: 10_f64.to_radians(), phi, speed })
        })
        .collect()
}

/// One iteration plays all shots, so that every measurement has the same mixture.
fn shots(criterion: &mut Criterion) {
    for (name, count) in [("textbook", 20_000), ("thesis", 400)] {
        let table = Table::preset(name).expect("presets are valid");
        let shots = random_shots(&table, count);
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function("scored", |bencher| {
            bencher.iter(|| shots.iter().map(|(layout, cue)| Reward::R3.of(&table, layout, cue)).sum::<f64>());
        });
        group.bench_function("recorded", |bencher| {
            bencher.iter(|| {
                for (layout, cue) in &shots {
                    let recording = Recording::new(&table, layout, cue).expect("random shots are possible");
                    black_box(recording.duration());
                }
            });
        });
        group.finish();
    }
}

fn recommendations(criterion: &mut Criterion) {
    let coach = Coach::new(Table::default());
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
    let layouts: Vec<Layout> = (0..200).map(|_| Layout::random(coach.table(), &mut rng)).collect();
    let mut group = criterion.benchmark_group("match");
    group.throughput(Throughput::Elements(layouts.len() as u64));
    group.bench_function("recommended", |bencher| {
        bencher.iter(|| layouts.iter().filter(|layout| coach.recommend(layout, &Request::default()).is_ok()).count());
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(5));
    targets = shots, recommendations
}
criterion_main!(benches);
