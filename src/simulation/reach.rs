//! Early end of a shot: checks whether the remaining energy can still bring the cue ball to a ball that it must hit.
//!
//! Balls in resting contact have lost most of their speed, and their simulation costs more than everything before. A rolling ball loses the
//! energy `mu_r g` (per mass) per metre. A sliding ball may lose less for a while, but only after an impact or while it is pressed, which
//! cost energy, too. This is not a proof. Among three million shots on random tables, slow and in corners, the balls together moved at most
//! 1.85 times as far as by rolling, and 1.44 times on the `thesis` table; [`MARGIN`] is more than twice that.

use super::{Constants, Observer, engine::Engine, savings::Savings};
use crate::{physics::BallState, table::BALLS};

/// Assumed bound of the balls' total path length, in units of the path by rolling.
const MARGIN: f64 = 4.0;

/// Additional path length in ball radii: when nearly no energy is left, the zero tolerances have a comparable effect.
const SLACK: f64 = 1e-4;

/// Least ratio of sliding to rolling deceleration for which the margin is known to be sufficient.
const SLIDING_OVER_ROLLING: f64 = 2.0;

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Whether the cue ball can no longer hit any of the balls for which the observer waits, given the `state` of each ball.
    pub(super) fn is_out_of_reach(&self, state: impl Fn(usize) -> BallState) -> bool {
        let Constants { level, sliding, rolling, diameter, radius, .. } = &self.constants;
        // A ball in the air loses no energy along its path, and one on a slope may gain.
        let applies = self.cloth.is_none() && *level && *sliding >= SLIDING_OVER_ROLLING * rolling.least;
        if !S::OUT_OF_REACH || !applies {
            return false;
        }
        let Some(awaited) = self.observer.awaited() else { return false };
        let states = std::array::from_fn(state);
        let reach = diameter + SLACK * radius + MARGIN * path_by_rolling(&self.constants, &states);
        let [cue_ball, objects @ ..] = states;
        objects
            .iter()
            .zip(awaited)
            .filter(|(_, awaited)| *awaited)
            .all(|(object, _)| object.position.distance(cue_ball.position) > reach)
    }
}

/// Returns the total path length of the balls if all energy is spent on rolling, m.
fn path_by_rolling(constants: &Constants, states: &[BallState; BALLS]) -> f64 {
    let Constants { radius, rolling, .. } = constants;
    let energy = |ball: &BallState| 0.5 * ball.velocity.length_squared() + 0.2 * (radius * ball.spin).length_squared();
    states.iter().map(energy).sum::<f64>() / (1.4 * rolling.least)
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::{
        physics::Impulse,
        simulation::{Recording, Start},
        table::{Layout, Table},
    };

    /// Returns a level table on which balls stay on the cloth, with random friction and restitution.
    fn any_table(rng: &mut Xoshiro256PlusPlus) -> Table {
        let mut between = |low: f64, high: f64| rng.random_range(low..high);
        Table {
            sliding_friction: between(0.1, 0.5),
            rolling_friction: between(0.002, 0.07),
            ball_restitution: between(0.0, 1.0),
            rail_restitution: between(0.0, 1.0),
            rail_friction: between(0.0, 0.5),
            ball_friction: (between(0.0, 1.0) < 0.5).then_some(between(0.0, 0.5)),
            ..Table::preset("thesis").unwrap()
        }
    }

    /// Returns the largest ratio of the remaining path length to that by rolling, over all events of a shot.
    fn farthest(table: &Table, layout: &Layout, impulse: &Impulse) -> f64 {
        const PIECES: u32 = 16;
        let shot = Recording::started(table, layout, Start::Motion(impulse)).unwrap();
        let constants = Constants::of(table);
        let (mut path, mut end, mut largest) = (0.0, shot.duration(), 0.0_f64);
        for start in shot.events().iter().rev().map(|event| event.time).chain([0.0]) {
            let mut before = shot.positions(start);
            for piece in 1..=PIECES {
                let time = start + (end - start) * f64::from(piece) / f64::from(PIECES);
                // Just before the end, because an impact at the end may move a ball.
                let after = shot.positions(time.min(end.next_down()));
                path += (0..BALLS).map(|ball| after[ball].distance(before[ball])).sum::<f64>();
                before = after;
            }
            let states = std::array::from_fn(|ball| shot.state(ball, start));
            largest = largest.max((path - SLACK * table.radius) / path_by_rolling(&constants, &states));
            end = start;
        }
        largest
    }

    fn largest_of(shots: u32, draw: impl Fn(&mut Xoshiro256PlusPlus) -> Table) -> f64 {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        (0..shots).fold(0.0, |largest, _| {
            let table = draw(&mut rng);
            // In a corner, where balls tend to press each other, or anywhere.
            let layout = loop {
                let mut layout = Layout::random(&table, &mut rng);
                let narrow = rng.random_range(0.05..1.0);
                layout.balls = layout.balls.map(|ball| table.reach() - (table.reach() - ball) * narrow);
                if layout.validate(&table).is_ok() {
                    break layout;
                }
            };
            let mut any = |most: f64| rng.random_range(-most..most);
            let speed = any(1.0).abs().powi(2) * 3.0;
            let velocity = DVec2::new(any(speed), any(speed));
            let spin = speed * DVec3::new(any(50.0), any(50.0), any(50.0));
            let aimed = layout.balls[1] - layout.balls[0];
            let velocity = if any(1.0) > 0.0 { velocity } else { velocity.length() * aimed.normalize() };
            largest.max(farthest(&table, &layout, &Impulse::on_cloth(velocity, spin)))
        })
    }

    #[test]
    fn paths_hardly_exceed_the_rolling_path() {
        let largest = largest_of(10_000, any_table);
        assert!((1.0..0.5 * MARGIN).contains(&largest), "{largest}");
    }

    /// `cargo test --release --lib paths_hardly_exceed -- --ignored`
    #[test]
    #[ignore = "takes four minutes"]
    fn paths_hardly_exceed_the_rolling_path_in_many_shots() {
        let largest = largest_of(3_000_000, any_table);
        let on_thesis = largest_of(3_000_000, |_| Table::preset("thesis").unwrap());
        println!("{largest}, on thesis {on_thesis}");
        assert!((1.0..0.5 * MARGIN).contains(&largest) && on_thesis < largest, "{largest}, {on_thesis}");
    }
}
