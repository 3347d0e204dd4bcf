//! Termination guards: limits on the computational work of a shot.
//!
//! Work is counted in multiplications, not in time, so that a shot is the same on every machine; 10⁹ multiplications take about half a
//! second. Of 10⁵ random shots on "thesis", fewer than ten exceed the budget of resting contacts, as a test here verifies.

/// Multiplications for the contact forces of a known active set, per square of the number of contacts.
pub const KNOWN_SET_COST: u64 = 700;

/// Multiplications for everything else in a step of a resting contact, including the root finding of its predictions.
pub const STEP_COST: u64 = 14_000;

/// Budget of a step of a resting contact, in multiplications. When it is spent, all resting contacts of the shot are given up. Most steps
/// take about a hundredth of it.
pub const STEP_BUDGET: u64 = 6_000_000;

/// Budget of resting contacts and chatters, in multiplications; when it is spent, resting contacts are disabled: see
/// [`super::micro_collisions`].
pub const RESTING_BUDGET: u64 = 36_000_000;

/// Budget after resting contacts are disabled, in multiplications (including impacts in the air). When it is spent, the shot is ended,
/// which is not physics: a ball in another contact stands still from then on, and the energy audit of the stability table shows the missing
/// energy.
pub const BUDGET_WITHOUT_REST: u64 = 64_000_000;

/// Budget of impacts in the air alone, in multiplications, which micro-collisions would not reduce.
pub const AIR_BUDGET: u64 = 85_000_000;

/// Multiplications for the bounce of a chatter. If bounces lose nothing, a pressed ball bounces until its spin has decayed; these bounces
/// and their iterations of the general loop must fit into the budget of resting contacts.
pub const BOUNCE_COST: u64 = 1600;

/// Multiplications for an impact in the air.
pub const AIR_IMPACT_COST: u64 = 3300;

/// Iterations of the event loops after which a shot ends where it is: ends of motion phases, impacts, and unreported bounces and steps of
/// resting contacts. This is a guard, not physics, for motion in the air that repeats without end. A shot takes about ten iterations, one
/// with a chatter about a hundred. A bounce takes up to five: its own, and the ends of sliding and of rolling of two balls. A smaller limit
/// would end shots before resting contacts are disabled.
pub const MAX_ITERATIONS: u32 = 120_000;
const _: () = assert!(MAX_ITERATIONS as u64 > 5 * RESTING_BUDGET / BOUNCE_COST);

/// The same limit after resting contacts are disabled.
pub const MAX_ITERATIONS_WITHOUT_REST: u32 = 250_000;
const _: () = assert!(MAX_ITERATIONS_WITHOUT_REST as u64 > 5 * BUDGET_WITHOUT_REST / BOUNCE_COST);

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use crate::{
        physics::{CueInputs, strike},
        simulation::{Event, Observer, engine::Engine, savings::AllSavings},
        table::{Layout, Table},
    };

    /// An observer that accepts and ignores everything.
    struct Nobody;

    impl Observer for Nobody {
        fn event(&mut self, _: Event) -> ControlFlow<()> {
            ControlFlow::Continue(())
        }
    }

    /// `cargo test --profile quick --lib fewer_than_ten -- --nocapture`
    #[test]
    fn fewer_than_ten_of_100_000_shots_disable_resting_contacts() {
        let table = Table::preset("thesis").unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut of_these = 0;
        for _ in 0..100_000 {
            let layout = Layout::random(&table, &mut rng);
            let (a, b) = (rng.random_range(-0.35..0.35), rng.random_range(-0.35..0.35));
            let (theta, phi) = (rng.random_range(0.0..0.35), rng.random_range(0.0..std::f64::consts::TAU));
            let cue = CueInputs { a, b, theta, phi, speed: rng.random_range(0.5..6.0) };
            let mut nobody = Nobody;
            let mut engine = Engine::<AllSavings, _>::new(&table, &layout, &mut nobody);
            engine.run(&strike(&table, &cue));
            of_these += u32::from(engine.micro_collisions.is_some() || engine.is_exhausted());
        }
        println!("{of_these} of 100,000");
        assert!(of_these < 10, "{of_these}");
    }
}
