//! A hash of the bits of many shots: two builds with the same hash compute the same shots.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    physics::Impulse,
    simulation::{AllSavings, Event, Observer, Savings, simulate_with},
    table::{BALLS, Layout, Table},
};

/// The value of [`hash`] on `textbook` for balls that stay on the cloth, on every machine. It changes only when results change
/// on purpose.
pub const TEXTBOOK: u64 = 0x34ca_8917_75e9_e94b;

/// Number of shots in the hash.
pub const SHOTS: usize = 2000;

/// Seed of these shots.
const SEED: u64 = 2;

/// The complete course of a shot, bit by bit.
#[derive(Default, Debug, PartialEq, Eq)]
pub struct Trace {
    /// Times, kinds and participants of the events, and the final positions.
    pub bits: Vec<u64>,
}

impl Observer for Trace {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        let (first, second) = event.kind.balls();
        let rail = event.kind.rail().map_or(9, |rail| rail as usize);
        let kind: u64 = event.kind.name().bytes().map(u64::from).sum();
        let participants = first * 100 + second.unwrap_or(BALLS) * 10 + rail;
        self.bits.extend([event.time.to_bits(), kind, participants as u64]);
        ControlFlow::Continue(())
    }
}

/// Records one shot.
pub fn trace<S: Savings>(table: &Table, layout: &Layout, impulse: &Impulse) -> Trace {
    let mut trace = Trace::default();
    let end = simulate_with::<S, _>(table, layout, impulse, &mut trace);
    for ball in end.balls {
        trace.bits.extend([ball.position.x.to_bits(), ball.position.y.to_bits()]);
    }
    trace
}

/// Draws random shots using only sums and products: sines differ in the last bit from machine to machine.
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

/// Hashes [`SHOTS`] shots on a table: 64-bit FNV-1a (Fowler, Noll and Vo). The cue ball's initial vertical speed rises from 0
/// to `lift`, m/s, over the shots.
pub fn hash(table: &Table, lift: f64) -> u64 {
    let mut shots = shots(table, SEED, SHOTS);
    for (number, (_, impulse)) in shots.iter_mut().enumerate() {
        impulse.lift = lift * (number as f64 / SHOTS as f64);
    }
    shots
        .iter()
        .flat_map(|(layout, impulse)| trace::<AllSavings>(table, layout, impulse).bits)
        .flat_map(u64::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
