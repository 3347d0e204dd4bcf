//! Scratch: slow shots.
use carom::{
    physics::CueInputs,
    simulation::Recording,
    table::{Layout, Table},
};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let name = &args[1];
    let n: u64 = args[2].parse().unwrap();
    let seed: u64 = args[3].parse().unwrap();
    let only: Option<u64> = args.get(4).map(|s| s.parse().unwrap());
    let table = Table::preset(name).unwrap();
    let mut rows = vec![];
    let mut total = 0.0;
    for i in 0..n {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed * 1_000_000_007 + i);
        let layout = Layout::random(&table, &mut rng);
        let share: f64 = rng.random_range(0.0..1.0f64).sqrt() * 0.999;
        let around: f64 = rng.random_range(-3.2..3.2);
        let extreme: f64 = rng.random_range(0.0..1.0);
        let theta = if extreme < 0.3 { rng.random_range(0.3..1.5) } else { rng.random_range(0.0..0.3) };
        let phi = rng.random_range(-3.2..3.2);
        let e2: f64 = rng.random_range(0.0..1.0);
        let speed = if e2 < 0.1 {
            rng.random_range(1e-4..0.3)
        } else if e2 < 0.2 {
            rng.random_range(7.0..40.0)
        } else {
            rng.random_range(0.3..7.0)
        };
        let cue = CueInputs { a: share * around.cos(), b: share * around.sin(), theta, phi, speed };
        if only.is_some_and(|o| o != i) {
            continue;
        }
        if std::env::var("V").is_ok() {
            eprintln!("{i}");
        }
        let t = Instant::now();
        let r = Recording::new(&table, &layout, &cue).unwrap();
        let dt = t.elapsed().as_secs_f64();
        total += dt;
        let segs: usize = (0..3).map(|b| r.segments(b).len()).sum();
        rows.push((dt, i, r.events().len(), segs));
        if only.is_some() {
            if std::env::var("SEG").is_ok() {
                for b in 0..3 {
                    for (k, s) in r.segments(b).iter().enumerate() {
                        let next = r.segments(b).get(k + 1).map_or(0.0, |n| n.start - s.start);
                        let u = carom::physics::slip(table.radius, s.velocity, s.spin);
                        println!(
                            "S {} {:.9} {:.3e} {:?} v {:.3e},{:.3e} u {:.3e},{:.3e} w {:.3e},{:.3e},{:.3e} p {:.4},{:.4}",
                            b,
                            s.start,
                            next,
                            s.motion,
                            s.velocity.x,
                            s.velocity.y,
                            u.x,
                            u.y,
                            s.spin.x * table.radius,
                            s.spin.y * table.radius,
                            s.spin.z * table.radius,
                            s.position.x,
                            s.position.y
                        );
                    }
                }
            }
            for e in r.events() {
                println!("{:.12} {:?}", e.time, e.kind);
            }
        }
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("total {total:.3} s, {:.0}/s", n as f64 / total);
    for q in [0.5, 0.9, 0.99, 0.999] {
        let k = ((1.0 - q) * n as f64) as usize;
        println!("q{q}: {:.1} us", rows[k.min(rows.len() - 1)].0 * 1e6);
    }
    for r in rows.iter().take(12) {
        println!("{:.3} ms shot {} events {} segments {}", r.0 * 1e3, r.1, r.2, r.3);
    }
    rows.sort_by_key(|r| std::cmp::Reverse(r.2));
    for r in rows.iter().take(5) {
        println!("most events: {:.3} ms shot {} events {} segments {}", r.0 * 1e3, r.1, r.2, r.3);
    }
}
