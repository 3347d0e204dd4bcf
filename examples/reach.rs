//! scratch
use carom::{
    game::{Referee, Rule},
    learning::{evaluation::held_out_layouts, view::View},
    physics::{CueInputs, strike},
    simulation::*,
    table::*,
};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::*;
use std::ops::ControlFlow;
struct W {
    r: Referee,
    n: usize,
}
impl Observer for W {
    const ENDS: bool = false;
    fn event(&mut self, e: Event) -> ControlFlow<()> {
        self.r.event(e)
    }
    fn contact_step(&mut self) -> ControlFlow<()> {
        self.n += 1;
        if self.n > 16 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
fn scores(rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    let mut w = W { r: Referee::default(), n: 0 };
    watch(table, layout, &strike(table, cue), &mut w);
    w.r.tally.is_point(rule)
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let table = Table::preset(&args[1]).unwrap();
    let rule: Rule = args[2].parse().unwrap();
    let n: usize = args[3].parse().unwrap();
    let shots: usize = args[4].parse().unwrap();
    let layouts = held_out_layouts(&table, n, 5);
    for mode in ["uniform", "direct", "direct+b", "direct+ab", "full", "bank"] {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let t = std::time::Instant::now();
        let mut hits = vec![0usize; n];
        for (i, layout) in layouts.iter().enumerate() {
            for _ in 0..shots {
                let speed = rng.random_range(0.3..6.0);
                let mut phi = rng.random_range(-PI..PI);
                let (mut a, mut b, mut theta) = (0.0, 0.0, 10f64.to_radians());
                if mode != "uniform" {
                    let view = View::new(layout, rng.random_range(0..4));
                    let mut to = view.first - view.cue;
                    if mode == "bank" {
                        // image in a random cushion
                        let e = 2.0 * table.reach();
                        let f = view.first;
                        let im = [
                            DVec2::new(e.x - f.x, f.y),
                            DVec2::new(-e.x - f.x, f.y),
                            DVec2::new(f.x, e.y - f.y),
                            DVec2::new(f.x, -e.y - f.y),
                        ][rng.random_range(0..4)];
                        to = im - view.cue;
                    }
                    let d = to.length();
                    let off = if mode == "bank" { rng.random_range(-6.0..6.0) } else { rng.random_range(-0.1..1.0) };
                    let turn = (2.0 * table.radius * off / d).clamp(-1.0, 1.0).asin();
                    phi = view.angle_on_table(DVec2::from_angle(turn).rotate(to / d));
                    let m = table.miscue_limit.sqrt() * 0.98;
                    match mode {
                        "direct+b" => b = rng.random_range(-m..m),
                        "direct+ab" | "full" => {
                            let r = m * rng.random::<f64>().sqrt();
                            let t = rng.random_range(0.0..TAU);
                            a = r * t.cos();
                            b = r * t.sin();
                            if mode == "full" {
                                theta = rng.random_range(0.0..0.5);
                            }
                        }
                        _ => {}
                    }
                }
                if scores(rule, &table, layout, &CueInputs { a, b, theta, phi, speed }) {
                    hits[i] += 1;
                }
            }
        }
        let total: usize = hits.iter().sum();
        let reach = |k: usize| hits.iter().filter(|h| **h >= k).count() as f64 / n as f64;
        let p100 = hits.iter().map(|h| 1.0 - (1.0 - *h as f64 / shots as f64).powi(100)).sum::<f64>() / n as f64;
        println!(
            "{mode:10} per shot {:.4}  >=1 {:.3} >=3 {:.3} >=1% {:.3} >=0.3% {:.3}  p100 {:.3} ({:.0}s)",
            total as f64 / (n * shots) as f64,
            reach(1),
            reach(3),
            reach(shots / 100),
            reach(shots * 3 / 1000),
            p100,
            t.elapsed().as_secs_f64()
        );
    }
}
