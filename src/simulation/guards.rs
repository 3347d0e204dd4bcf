//! Guards: how much work a shot may take.
//!
//! Work is counted in multiplications of numbers, not in time, so that a shot is the same on every machine; 10⁹ of them take about half a
//! second. Of 10⁵ random shots on "thesis" fewer than ten take so much that nothing rests any more, as a test here counts.

/// Multiplications for the forces on contacts where it is known what holds, times the square of their number.
pub const HELD: u64 = 700;

/// Multiplications in what else a step of a resting contact does, the roots of its predictions among them.
pub const STEP: u64 = 14_000;

/// Multiplications after which a step of a resting contact is given up, and with it all resting contacts of the shot: some hundred times
/// as many as most steps take.
pub const MOST_STEP: u64 = 6_000_000;

/// Multiplications after which nothing rests any more: see [`super::micro_collisions`].
pub const MOST_RESTING: u64 = 36_000_000;

/// Budget, in multiplications, once nothing rests (impacts in the air included); when it is spent the shot is ended, which is not physics:
/// what takes part in another contact stands still from then on, and the audit of the stability table misses the energy.
pub const MOST_WITHOUT_REST: u64 = 64_000_000;

/// The same for impacts in the air alone, which micro-collisions would not spare.
pub const MOST_IN_THE_AIR: u64 = 85_000_000;

/// Multiplications in the bounce of a chatter. Where bounces lose nothing, a ball that is pressed bounces until its spin has died down;
/// they and the turns of the general loop that they take must fit into the work of resting contacts.
pub const BOUNCE: u64 = 1600;

/// Multiplications in an impact in the air.
pub const IMPACT_IN_THE_AIR: u64 = 3300;

/// Turns of the loops after which a shot ends where it is: ends of motions, impacts, and bounces and steps of resting contacts that
/// are not told as events. This is a guard, not physics, for what repeats in the air without end; a shot takes some ten turns, and one
/// with a chatter some hundred. A bounce takes up to five: its own, and the ends of sliding and of rolling of two balls. Fewer would end
/// shots before nothing rests any more.
pub const MOST_TURNS: u32 = 120_000;
const _: () = assert!(MOST_TURNS as u64 > 5 * MOST_RESTING / BOUNCE);

/// The same once nothing rests any more.
pub const MOST_TURNS_WITHOUT_REST: u32 = 250_000;
const _: () = assert!(MOST_TURNS_WITHOUT_REST as u64 > 5 * MOST_WITHOUT_REST / BOUNCE);

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use crate::{
        physics::{CueInputs, strike},
        simulation::{Event, Observer, engine::Engine, savings::All},
        table::{Layout, Table},
    };

    /// Hears of everything and minds nothing.
    struct Nobody;

    impl Observer for Nobody {
        fn event(&mut self, _: Event) -> ControlFlow<()> {
            ControlFlow::Continue(())
        }
    }

    /// `cargo test --profile quick --lib fewer_than_ten -- --nocapture`
    #[test]
    fn of_a_hundred_thousand_random_shots_fewer_than_ten_let_nothing_rest() {
        let table = Table::preset("thesis").unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut of_these = 0;
        for _ in 0..100_000 {
            let layout = Layout::random(&table, &mut rng);
            let (a, b) = (rng.random_range(-0.35..0.35), rng.random_range(-0.35..0.35));
            let (theta, phi) = (rng.random_range(0.0..0.35), rng.random_range(0.0..std::f64::consts::TAU));
            let cue = CueInputs { a, b, theta, phi, speed: rng.random_range(0.5..6.0) };
            let mut nobody = Nobody;
            let mut engine = Engine::<All, _>::new(&table, &layout, &mut nobody);
            engine.run(&strike(&table, &cue));
            of_these += u32::from(engine.micro_collisions.is_some() || engine.is_exhausted());
        }
        println!("{of_these} of 100,000");
        assert!(of_these < 10, "{of_these}");
    }
}
