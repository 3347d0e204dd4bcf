//! How easy a layout is for the shot that comes next, at a glance: no shot is simulated.

use crate::{
    game::Rule,
    table::{Layout, Table},
};

/// Numbers about a layout: a constant, distances and an angle.
const NUMBERS: usize = 8;

/// What [`missed`] weighs the numbers with, by least squares. It was fitted to one to four thousand layouts a rule
/// from self-play on `match`; the layouts that it calls the easiest tenth were missed by an expert 0.4 % of the time in
/// straight rail, 5 % under the cushion rules, those that it calls the hardest 17 %, 24 % and 37 %, with the shots of a short
/// search.
const fn weights(rule: Rule) -> [f64; NUMBERS] {
    match rule {
        Rule::StraightRail => [-0.119, 0.2905, 0.2187, -0.0812, -0.051, 0.0249, -0.0636, 0.0698],
        Rule::OneCushion => [-0.0514, 0.3514, 0.2859, -0.1012, -0.0618, 0.0046, 0.022, 0.0466],
        Rule::ThreeCushion => [0.2143, 0.3793, 0.0917, -0.1, -0.0229, -0.0049, 0.0388, 0.0333],
    }
}

/// The share of misses was fitted for a player of two and a half times an expert's errors: that tells easy layouts from
/// very easy ones. An expert's own share goes with this power of it, from 0.2 to 40 %.
const POWER: f64 = 2.75;

/// The share stays in this range, wherever the fit leads: no layout is quite safe.
const RANGE: (f64, f64) = (0.02, 1.0);

/// Probability of the point from `layout`, for an expert who plays a good shot: a rough estimate for ranking.
pub fn ease(rule: Rule, table: &Table, layout: &Layout) -> f64 {
    let share: f64 = weights(rule).iter().zip(numbers(table, layout)).map(|(weight, number)| weight * number).sum();
    1.0 - share.clamp(RANGE.0, RANGE.1).powf(POWER)
}

/// What the estimate rests on. Distances are those on a table as long as `match`.
fn numbers(table: &Table, layout: &Layout) -> [f64; NUMBERS] {
    let [cue, mut near, mut far] = layout.balls.map(|ball| ball * (2.84 / table.length));
    if cue.distance_squared(near) > cue.distance_squared(far) {
        std::mem::swap(&mut near, &mut far);
    }
    let (to_near, onward) = (near - cue, far - near);
    let (a, c) = (to_near.length(), onward.length());
    // How straight the way goes on from the nearer object ball to the other.
    let straight = to_near.normalize_or_zero().dot(onward.normalize_or_zero());
    [1.0, a, c, a * a, c * c, a * c, straight, straight * straight]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn gathered_balls_are_easier_than_scattered_ones_under_every_rule() {
        let table = Table::default();
        let gathered = Layout::new([DVec2::new(0.0, 0.0), DVec2::new(0.1, 0.05), DVec2::new(0.15, -0.1)]);
        let scattered = Layout::new([DVec2::new(-1.2, 0.0), DVec2::new(0.2, 0.6), DVec2::new(1.3, -0.6)]);
        for rule in Rule::ALL {
            let [easy, hard] = [&gathered, &scattered].map(|layout| ease(rule, &table, layout));
            assert!(hard + 0.05 < easy && easy < 1.0, "{rule}: {easy} {hard}");
        }
    }

    #[test]
    fn the_names_of_the_object_balls_and_the_side_of_the_table_do_not_matter() {
        let table = Table::default();
        let [a, b, c] = [DVec2::new(-0.3, 0.2), DVec2::new(0.4, 0.1), DVec2::new(0.2, -0.5)];
        for rule in Rule::ALL {
            let ease = |balls| ease(rule, &table, &Layout::new(balls));
            assert!((ease([a, b, c]) - ease([-a, -c, -b])).abs() < 1e-12);
        }
    }
}
