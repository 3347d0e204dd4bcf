//! The bits of many shots in one number: two programs that tell the same number play the same shots.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    physics::Impulse,
    simulation::{All, Event, Observer, Savings, simulate_with},
    table::{BALLS, Layout, Table},
};

/// What [`hash`] finds on `textbook` for balls that stay on the cloth, on every machine. It changes where results change on purpose.
pub const TEXTBOOK: u64 = 0x714d_1dc1_8e09_286c;

/// Shots whose bits the number is made of.
pub const SHOTS: usize = 2000;

/// Their seed.
const SEED: u64 = 2;

/// All that happens in a shot, bit by bit.
#[derive(Default, Debug, PartialEq, Eq)]
pub struct Trace {
    /// Times, kinds and places of the events, and where the balls stop.
    pub bits: Vec<u64>,
}

impl Observer for Trace {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        let (first, second) = event.kind.balls();
        let rail = event.kind.rail().map_or(9, |rail| rail as usize);
        let kind: u64 = event.kind.name().bytes().map(u64::from).sum();
        let place = first * 100 + second.unwrap_or(BALLS) * 10 + rail;
        self.bits.extend([event.time.to_bits(), kind, place as u64]);
        ControlFlow::Continue(())
    }
}

/// What happens in one shot.
pub fn trace<S: Savings>(table: &Table, layout: &Layout, impulse: &Impulse) -> Trace {
    let mut trace = Trace::default();
    let end = simulate_with::<S, _>(table, layout, impulse, &mut trace);
    for ball in end.balls {
        trace.bits.extend([ball.position.x.to_bits(), ball.position.y.to_bits()]);
    }
    trace
}

/// Random shots that take nothing but sums and products to make: sines differ in the last bit from machine to machine.
pub fn shots(table: &Table, seed: u64, count: usize) -> Vec<(Layout, Impulse)> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut draw = |limit: f64| rng.random_range(-limit..limit);
    let impulses: Vec<Impulse> = (0..count)
        .map(|_| {
            let velocity = DVec2::new(draw(5.0), draw(5.0));
            Impulse::on_cloth(velocity, DVec3::new(draw(120.0), draw(120.0), draw(80.0)))
        })
        .collect();
    impulses.into_iter().map(|impulse| (Layout::random(table, &mut rng), impulse)).collect()
}

/// The number of [`SHOTS`] shots on a table: FNV-1a of 64 bits (Fowler, Noll and Vo). The cue ball leaves the cloth with up to `lift`
/// m/s, a little faster from shot to shot.
pub fn hash(table: &Table, lift: f64) -> u64 {
    let mut shots = shots(table, SEED, SHOTS);
    for (number, (_, impulse)) in shots.iter_mut().enumerate() {
        impulse.lift = lift * (number as f64 / SHOTS as f64);
    }
    shots
        .iter()
        .flat_map(|(layout, impulse)| trace::<All>(table, layout, impulse).bits)
        .flat_map(u64::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
