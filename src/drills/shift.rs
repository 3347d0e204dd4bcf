//! Variations of a position: repetitions with the balls shifted by half a ball.

use std::f64::consts::TAU;

use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::table::{BALLS, Layout, PAIRS, Table};

/// Maximum gap between balls that count as touching, m: what a player places as touching.
const TOUCHING_GAP: f64 = 1e-4;

/// Maximum number of random directions tried. Three touching balls in a corner find room in about one of 30.
const TRIES: usize = 10_000;

/// Returns the layout of a repetition. Number 0 is exact; in each later one every ball is shifted by half a ball, one radius,
/// in a random direction. Touching balls are moved together. If no shift leaves enough room, the layout is unchanged.
///
/// The same seed and repetition give the same layout.
pub fn shifted(layout: &Layout, table: &Table, seed: u64, repetition: u32) -> Layout {
    if repetition == 0 {
        return *layout;
    }
    // Multiplying by the golden ratio keeps consecutive seeds from sharing repetitions.
    let stream = seed ^ u64::from(repetition).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(stream);
    let leaders = leaders(layout, table.radius);
    let mut attempt = || {
        let steps: [DVec2; BALLS] =
            std::array::from_fn(|_| table.radius * DVec2::from_angle(rng.random_range(0.0..TAU)));
        Layout::new(std::array::from_fn(|ball| layout.balls[ball] + steps[leaders[ball]]))
    };
    (0..TRIES).map(|_| attempt()).find(|moved| moved.validate(table).is_ok()).unwrap_or(*layout)
}

/// Returns the ball with which each ball is moved: the first one of a touching group.
fn leaders(layout: &Layout, radius: f64) -> [usize; BALLS] {
    let mut leaders: [usize; BALLS] = std::array::from_fn(|ball| ball);
    for (first, second) in PAIRS {
        if layout.balls[first].distance(layout.balls[second]) <= 2.0 * radius + TOUCHING_GAP {
            let (keep, join) = (leaders[first].min(leaders[second]), leaders[first].max(leaders[second]));
            leaders = leaders.map(|leader| if leader == join { keep } else { leader });
        }
    }
    leaders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repetitions_are_valid_distinct_half_ball_shifts() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for seed in 0..200 {
            let layout = Layout::random(&table, &mut rng);
            assert_eq!(shifted(&layout, &table, seed, 0), layout);
            let mut seen = Vec::new();
            for repetition in 1..20 {
                let moved = shifted(&layout, &table, seed, repetition);
                moved.validate(&table).unwrap();
                for (from, to) in layout.balls.iter().zip(moved.balls) {
                    assert!((from.distance(to) - table.radius).abs() < 1e-12);
                }
                assert!(!seen.contains(&moved));
                seen.push(moved);
                assert_eq!(shifted(&layout, &table, seed, repetition), moved);
            }
        }
    }

    #[test]
    fn touching_balls_in_a_corner_move_together() {
        let table = Table::default();
        let corner = table.reach();
        let apart = 2.0 * table.radius;
        let layout = Layout::new([corner - DVec2::new(apart, 0.0), corner, corner - DVec2::new(0.0, apart)]);
        for repetition in 1..50 {
            let moved = shifted(&layout, &table, 1, repetition);
            moved.validate(&table).unwrap();
            assert!((moved.balls[0].distance(moved.balls[1]) - apart).abs() < 1e-12);
            assert!((moved.balls[1].distance(moved.balls[2]) - apart).abs() < 1e-12);
            assert_ne!(moved, layout);
        }
    }
}
