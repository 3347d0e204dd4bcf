//! Termination guards: limits on the computational work of a shot.
//!
//! The work is an estimate of the computing time, not a measurement, so that a shot is the same on every machine. The costs, in nanoseconds
//! of a core of an AMD EPYC, follow from the times of 5,700 slow shots of the stability cases (least squares, then raised where it
//! underestimated the slowest shots; 2026-11-30). For nine in ten of these shots the estimate is 0.9 to 2 times the time, and at least 0.6
//! times for shots of more than 20 ms. Searches for roots are not counted separately.

/// Cost of an iteration of the event loops, ns: the end of a motion phase, an impact, or a step of resting contacts.
pub const ITERATION_COST: u64 = 100;

/// Additional costs of a bounce of a chatter, ns: at a cushion, and between two balls, whose next collision is a root of a quartic.
pub const RAIL_BOUNCE_COST: u64 = 100;
pub const BALL_BOUNCE_COST: u64 = 600;

/// Additional cost of an impact in the air, ns.
pub const AIR_IMPACT_COST: u64 = 850;

/// Cost of a step of a resting contact without its forces, ns.
pub const STEP_COST: u64 = 1500;

/// Returns the cost of the forces of a known active set, ns.
pub const fn known_set_cost(contacts: usize) -> u64 {
    100 + 120 * (contacts * contacts) as u64
}

/// Budget of a step of a resting contact, ns. When it is spent, all resting contacts of the shot are given up. Most steps take about a
/// hundredth of it.
pub const STEP_BUDGET: u64 = 4_000_000;

/// Budget of resting contacts and chatters, ns. When it is spent, resting contacts are disabled: see [`super::micro_collisions`]. Of 10⁵
/// random shots on "thesis", fewer than ten exceed it, as a test here verifies.
pub const RESTING_BUDGET: u64 = 15_000_000;

/// Budget after resting contacts are disabled, ns (including impacts in the air). When it is spent, the shot is ended, which is not
/// physics: a ball in another contact stands still from then on, and the energy audit of the stability table shows the missing energy.
pub const BUDGET_WITHOUT_REST: u64 = 32_000_000;

/// Budget of impacts in the air alone, ns, which micro-collisions would not reduce.
pub const AIR_BUDGET: u64 = 20_000_000;

/// Effort, including impacts in the air, at which a shot ends where it is, ns: a last resort for a ball that bounces on another without end.
/// Giving up resting contacts counts as [`RESTING_BUDGET`] and must not reach it.
pub const LAST_RESORT: u64 = 60_000_000;
const _: () = assert!(LAST_RESORT > 2 * RESTING_BUDGET + STEP_BUDGET + AIR_BUDGET);

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
