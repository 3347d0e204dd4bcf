//! What the networks are told: numbers about a view for both, and about a view and an action for the critic.

use std::f64::consts::PI;

use glam::DVec2;

use super::{
    action::{Action, OFFSET_SLOPE, offset},
    dual::{Dual, DualVector},
    view::{Line, View, free_path},
};
use crate::table::Table;

/// Changes whenever the features or the meaning of the actions change: weights fit one version only.
pub const FEATURE_VERSION: &str = "contact-frame-1";

/// Numbers about a view.
pub const STATE_FEATURES: usize = 38;

/// Numbers about a view and an action.
pub const ACTION_FEATURES: usize = 30;

/// Appends [`STATE_FEATURES`] numbers of the order of one: where the balls lie, how they lie to each other, the cushions
/// behind the first ball, and the second ball's images in the cushions as seen from the first.
pub fn push_state_features(table: &Table, view: &View, out: &mut Vec<f32>) {
    let mut push = |value: f64| out.push(value as f32);
    let (reach, length, diameter) = (table.reach(), table.length, 2.0 * table.radius);
    for ball in [view.cue, view.first, view.second] {
        push(ball.x / reach.x);
        push(ball.y / reach.y);
    }
    let lines = view.lines(table);
    for Line { distance, direction } in [lines.to_first, lines.to_second, lines.onward] {
        push(direction.x);
        push(direction.y);
        push(2.0 * distance / length);
        push(diameter / distance);
    }
    let aim = lines.to_first.direction;
    for direction in [lines.to_second.direction, lines.onward.direction] {
        push(aim.dot(direction));
        push(aim.perp_dot(direction));
    }
    // How far beside the line through the first two balls the third one lies, in diameters, squashed.
    let beside = aim.perp_dot(lines.onward.direction) * lines.onward.distance / diameter;
    push(beside / (1.0 + beside.abs()));
    for direction in [aim, aim.perp(), -aim.perp()] {
        push(free_path(table, view.first, direction) / length);
    }
    for image in view.images(table) {
        let span = image - view.first;
        let distance = span.length().max(diameter);
        push(aim.dot(span) / distance);
        push(aim.perp_dot(span) / distance);
        push(distance / length);
    }
}

/// [`ACTION_FEATURES`] numbers about a shot, with their slopes along the action.
///
/// At the moment of contact the line of centres and the tangent at the first ball decide where the cue ball goes. So
/// the second ball and its images are given in that frame, as seen from where the cue ball then stands: a network
/// would need many units to find this rotation by itself, and points are missed by a degree.
pub fn action_features(table: &Table, view: &View, action: Action) -> [Dual; ACTION_FEATURES] {
    let mut features = [Dual::constant(0.0); ACTION_FEATURES];
    let mut filled = 0;
    let mut push = |feature: Dual| {
        features[filled] = feature;
        filled += 1;
    };

    let offset = Dual { value: offset(action[0]), slope: [OFFSET_SLOPE, 0.0] };
    let speed = Dual::action(1, f64::from(action[1]));
    push(offset);
    push(offset * offset);
    for wave in [PI, 2.0 * PI] {
        let (sin, cos) = (offset * wave).sin_cos();
        push(sin);
        push(cos);
    }
    push(speed);
    push(speed * speed);

    let diameter = 2.0 * table.radius;
    let lines = view.lines(table);
    // The aim turns left of the line to the first ball, the line of centres right of the aim by the cut angle.
    let sin_turn = offset * (diameter / lines.to_first.distance);
    let (cos_turn, cos_cut) = (cosine(sin_turn), cosine(offset));
    let normal = DualVector { x: cos_turn * cos_cut + sin_turn * offset, y: sin_turn * cos_cut - cos_turn * offset }
        .rotated(lines.to_first.direction);
    push(cos_cut);
    push(normal.x);
    push(normal.y);
    // Where the first ball goes, against where the second one lies: a kiss spoils the shot.
    push(normal.dot(DualVector::constant(lines.onward.direction)));
    push(normal.perp_dot(DualVector::constant(lines.onward.direction)));
    let contact = DualVector::constant(view.first) - normal * diameter;
    for target in std::iter::once(view.second).chain(view.images(table)) {
        let span = DualVector::constant(target) - contact;
        // A tenth of a millimetre keeps the slopes finite where the balls touch.
        let distance = (span.dot(span) + 1e-8).sqrt();
        let nearness = distance.recip();
        push(normal.dot(span) * nearness);
        push(normal.perp_dot(span) * nearness);
        push(distance * (1.0 / table.length));
        if target == view.second {
            push((distance * (1.0 / diameter) + 1.0).recip());
        }
    }
    // How far the cue ball can go along the tangent; its slope is left out, for it jumps in the corners.
    let tangent = DVec2::new(-normal.y.value, normal.x.value);
    push(Dual::constant(free_path(table, view.first, tangent) / table.length));
    debug_assert_eq!(filled, ACTION_FEATURES);
    features
}

/// The cosine that belongs to a sine, kept off zero where its slope is infinite.
fn cosine(sine: Dual) -> Dual {
    (-(sine * sine).at_most(0.998) + 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Layout;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn features_are_finite_of_order_one_and_as_many_as_promised() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        for _ in 0..500 {
            for view in View::all(&Layout::random(&table, &mut rng)) {
                let mut state = Vec::new();
                push_state_features(&table, &view, &mut state);
                assert_eq!(state.len(), STATE_FEATURES);
                assert!(state.iter().all(|x| x.abs() <= 4.0), "{state:?}");
                let action = [rng.random_range(-1.0..=1.0), rng.random_range(-1.0..=1.0)];
                for (index, feature) in action_features(&table, &view, action).iter().enumerate() {
                    assert!(feature.value.abs() <= 4.0, "{index}: {feature:?}");
                    assert!(feature.slope.iter().all(|slope| slope.abs() < 100.0), "{index}: {feature:?}");
                }
            }
        }
    }

    #[test]
    fn balls_that_touch_give_finite_features() {
        let table = Table::default();
        let diameter = 2.0 * table.radius;
        let layout = Layout::new([DVec2::ZERO, DVec2::new(diameter, 0.0), DVec2::new(0.0, -diameter)]);
        for view in View::all(&layout) {
            for action in [[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]] {
                let features = action_features(&table, &view, action);
                assert!(features.iter().all(|f| f.value.is_finite() && f.slope.iter().all(|s| s.is_finite())));
            }
        }
    }

    #[test]
    fn slopes_agree_with_finite_differences() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(9);
        for _ in 0..50 {
            let view = View::new(&Layout::random(&table, &mut rng), 1);
            let action = [rng.random_range(-0.9..=0.8), rng.random_range(-0.9..=0.9)];
            let here = action_features(&table, &view, action);
            for along in 0..2 {
                let moved = |step: f32| {
                    let mut action = action;
                    action[along] += step;
                    (action_features(&table, &view, action), f64::from(action[along]))
                };
                let ((after, x1), (before, x0)) = (moved(1e-3), moved(-1e-3));
                // The last feature's slope is left out on purpose.
                for index in 0..ACTION_FEATURES - 1 {
                    let difference = (after[index].value - before[index].value) / (x1 - x0);
                    let slope = here[index].slope[along];
                    assert!((difference - slope).abs() < 2e-3 * (1.0 + slope.abs()), "{index}: {difference} {slope}");
                }
            }
        }
    }
}
