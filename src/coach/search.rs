//! Shots to try: variations of a good one, and a wide net over all that a player could do.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    physics::CueInputs,
    table::{Layout, Table},
};

/// Fastest stroke that is recommended, m/s: the thesis' limit (its 4.1.3).
const MAX_SPEED: f64 = 6.0;

/// Slowest stroke that is tried, m/s.
const MIN_SPEED: f64 = 0.4;

/// Steepest cue that is tried, rad: 30°, beyond which a stroke is a massé.
const MAX_ELEVATION: f64 = PI / 6.0;

/// Tips are tried up to this share of the miscue limit's radius, so that rounding never oversteps it.
const TIP_SHARE: f64 = 0.98;

/// The thesis' way out where the policy's shot misses (its 5.1): the same direction and speed, another tip position and
/// elevation.
pub fn variation(table: &Table, cue: &CueInputs, rng: &mut Xoshiro256PlusPlus) -> CueInputs {
    let (a, b) = random_tip(table, rng);
    CueInputs { a, b, theta: rng.random_range(0.0..MAX_ELEVATION), ..*cue }
}

/// Any shot: half of them at one of the object balls, thick or thin, the others in any direction.
pub fn anything(table: &Table, layout: &Layout, rng: &mut Xoshiro256PlusPlus) -> CueInputs {
    let [cue_ball, first, second] = layout.balls;
    let phi = if rng.random() {
        let target = if rng.random() { first } else { second };
        let apart = target - cue_ball;
        let widest = (2.0 * table.radius / apart.length()).min(1.0).asin();
        apart.to_angle() + rng.random_range(-widest..=widest)
    } else {
        rng.random_range(-PI..PI)
    };
    let (a, b) = if rng.random() { random_tip(table, rng) } else { (0.0, 0.0) };
    CueInputs { a, b, theta: rng.random_range(0.0..0.2), phi, speed: rng.random_range(MIN_SPEED..MAX_SPEED) }
}

/// A point of the tip's disc, each area alike.
fn random_tip(table: &Table, rng: &mut Xoshiro256PlusPlus) -> (f64, f64) {
    let radius = TIP_SHARE * (table.miscue_limit * rng.random::<f64>()).sqrt();
    let (sin, cos) = rng.random_range(0.0..TAU).sin_cos();
    (radius * cos, radius * sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn nothing_that_is_tried_oversteps_the_miscue_limit() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            for _ in 0..2000 {
                let layout = Layout::random(&table, &mut rng);
                let cue = anything(&table, &layout, &mut rng);
                for cue in [cue, variation(&table, &cue, &mut rng)] {
                    cue.validate().unwrap();
                    cue.validate_tip(table.miscue_limit).unwrap();
                }
            }
        }
    }
}
