//! Timing.
use carom::{game::*, physics::*, simulation::*, table::*};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
fn main() {
    for name in PRESETS {
        let table = Table::preset(name).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        let n = 200_000;
        let shots: Vec<_> = (0..n)
            .map(|_| {
                (
                    Layout::random(&table, &mut rng),
                    CueInputs {
                        a: 0.0,
                        b: 0.0,
                        theta: 10f64.to_radians(),
                        phi: rng.random_range(-3.15..3.15),
                        speed: rng.random_range(0.5..6.0),
                    },
                )
            })
            .collect();
        for reward in [Reward::R1, Reward::R3, Reward::R4] {
            let t = std::time::Instant::now();
            let s: f64 = shots.iter().map(|(l, c)| reward.of(&table, l, c)).sum();
            println!("{name} {reward}: mean {:.4}, {:.0} shots/s", s / n as f64, n as f64 / t.elapsed().as_secs_f64());
        }
        let t = std::time::Instant::now();
        let mut most = 0;
        let mut ev = 0;
        let mut nan = 0;
        let mut kinds = std::collections::BTreeMap::new();
        let mut overlap = 0.0f64;
        for (l, c) in &shots[..50_000] {
            let r = Recording::new(&table, l, c).unwrap();
            most = most.max(r.events().len());
            ev += r.events().len();
            for e in r.events() {
                *kinds.entry(e.kind.name()).or_insert(0) += 1;
            }
            let f = r.final_layout();
            if f.balls.iter().any(|b| !b.is_finite()) {
                nan += 1;
            }
            for e in r.events() {
                let p = r.positions(e.time);
                for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                    overlap = overlap.max(2.0 * table.radius - p[i].distance(p[j]));
                }
                for q in p {
                    overlap = overlap.max((q.abs() - table.reach()).max_element());
                }
            }
        }
        println!(
            "{name} record {:.0}/s, events mean {:.1} most {most}, nan {nan}, overlap {overlap:e} {kinds:?}",
            50_000.0 / t.elapsed().as_secs_f64(),
            ev as f64 / 50000.0
        );
    }
}
