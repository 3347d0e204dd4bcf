//! scratch
use carom::{
    game::Referee,
    learning::{evaluation::held_out_layouts, view::View},
    physics::{CueInputs, strike},
    simulation::*,
    table::*,
};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::ops::ControlFlow;
struct W {
    r: Referee,
    n: usize,
    max: usize,
}
impl Observer for W {
    const ENDS: bool = false;
    fn event(&mut self, e: Event) -> ControlFlow<()> {
        self.r.event(e)
    }
    fn contact_step(&mut self) -> ControlFlow<()> {
        self.n += 1;
        if self.n > self.max { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
fn main() {
    let max: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let table = Table::preset("thesis").unwrap();
    let layouts = held_out_layouts(&table, 4000, 5);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut times = vec![];
    for layout in &layouts {
        for _ in 0..3 {
            let speed = rng.random_range(0.3..6.0);
            let view = View::new(layout, rng.random_range(0..4));
            let to = view.first - view.cue;
            let d = to.length();
            let off: f64 = rng.random_range(-0.1..1.0);
            let turn = (2.0 * table.radius * off / d).clamp(-1.0, 1.0).asin();
            let phi = view.angle_on_table(DVec2::from_angle(turn).rotate(to / d));
            let cue = CueInputs { a: 0.0, b: 0.0, theta: 10f64.to_radians(), phi, speed };
            let t = std::time::Instant::now();
            let mut w = W { r: Referee::default(), n: 0, max };
            simulate(&table, layout, &strike(&table, &cue), &mut w);
            let s = (w.r.tally.met_both(), w.n);
            times.push((t.elapsed().as_secs_f64() * 1e6, off, speed, s));
        }
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = times.iter().map(|t| t.0).sum();
    let n = times.len();
    println!("score {}", times.iter().filter(|t| t.3.0).count() as f64 / times.len() as f64);
    println!("mean {:.0} us", total / n as f64);
    let mut acc = 0.0;
    for (i, t) in times.iter().enumerate() {
        acc += t.0;
        if [
            n / 4,
            n / 2,
            n * 3 / 4,
            n * 9 / 10,
            n * 95 / 100,
            n * 98 / 100,
            n * 99 / 100,
            n * 995 / 1000,
            n * 999 / 1000,
            n - 1,
        ]
        .contains(&i)
        {
            println!("{:.4}: {:?} cum {:.3}", i as f64 / n as f64, t, acc / total);
        }
    }
}
