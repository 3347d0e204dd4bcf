//! Input features of the networks: those of an observation for both networks, and those of an action for the critic.

use std::{f64::consts::PI, ops::Range};

use glam::DVec2;

use super::{
    action::{Action, DecodedAction},
    dual::{Dual, DualVector},
    first_contact::{Approach, FirstContact, TYPICAL_SPEED},
    observation::{Line, Observation, free_path},
    paths::Paths,
};
use crate::table::Table;

/// Number of features of an observation.
pub const STATE_FEATURES: usize = 38;

/// Number of features of an action in an observation.
pub const ACTION_FEATURES: usize = 58;

/// Indices of the action features without slopes: the cue ball's free path, which jumps in the corners.
#[cfg(test)]
pub const FREE_PATHS: [usize; 2] = [29, 57];

/// Indices of the action features that describe only the action and none of its consequences.
const ACTION_ONLY: [Range<usize>; 2] = [0..8, 30..37];

/// Appends [`STATE_FEATURES`] numbers of the order of one: the positions of the balls, their relative positions, the free paths of the
/// first ball to the cushions along the line of aim and to both sides, and the second ball's images in the cushions as seen from the first.
pub fn push_state_features(table: &Table, observation: &Observation, out: &mut Vec<f32>) {
    let mut push = |value: f64| out.push(value as f32);
    let (reach, length, diameter) = (table.reach(), table.length, 2.0 * table.radius);
    for ball in [observation.cue, observation.first, observation.second] {
        push(ball.x / reach.x);
        push(ball.y / reach.y);
    }
    let lines = observation.lines(table);
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
    // Distance of the second object ball from the line through cue ball and first ball, in diameters, squashed to -1 to 1.
    let side_distance = aim.perp_dot(lines.onward.direction) * lines.onward.distance / diameter;
    push(side_distance / (1.0 + side_distance.abs()));
    for direction in [aim, aim.perp(), -aim.perp()] {
        push(free_path(table, observation.first, direction) / length);
    }
    for image in observation.images(table) {
        let span = image - observation.first;
        let distance = span.length().max(diameter);
        push(aim.dot(span) / distance);
        push(aim.perp_dot(span) / distance);
        push(distance / length);
    }
}

/// Appends the features of a shot with their slopes along the action: [`ACTION_FEATURES`] numbers, then
/// [`RAIL_FEATURES`](super::first_contact::RAIL_FEATURES) about a path by a cushion. The slopes of a path by a cushion are computed only
/// if `slopes`.
///
/// At the impact, the line of centres and the tangent at the first ball determine the cue ball's further course. So the features describe
/// the second ball and its images in that frame, from the cue ball's position at the impact: a network would need many units to learn this
/// rotation, and an error of a degree misses the point. The second such frame is the final direction, into which the spin finally turns
/// the cue ball.
pub fn push_action_features(paths: &Paths<'_>, action: Action, slopes: bool, out: &mut Vec<Dual>) {
    let Paths { table, observation, lines, .. } = *paths;
    let decoded = DecodedAction::of(table, action);
    let Approach { contact: stroke, course, by_rail } = paths.approach(&decoded, slopes);
    let offset = decoded.offset;
    let speed = Dual::action(1, f64::from(action[1]));
    out.extend([offset, offset * offset]);
    for wave in [PI, 2.0 * PI] {
        let (sin, cos) = (offset * wave).sin_cos();
        out.extend([sin, cos]);
    }
    out.extend([speed, speed * speed]);

    let diameter = 2.0 * table.radius;
    // The line of centres is turned to the right of the course by the cut angle.
    let cos_cut = offset.cosine();
    let normal = DualVector { x: course.x * cos_cut + course.y * offset, y: course.y * cos_cut - course.x * offset };
    out.extend([cos_cut, normal.x, normal.y]);
    // Direction of the first ball relative to the second one: a kiss spoils the shot.
    let onward = DualVector::constant(lines.onward.direction);
    out.extend([normal.dot(onward), normal.perp_dot(onward)]);
    let contact = DualVector::constant(observation.first) - normal * diameter;
    let mut targets = [DualVector::constant(DVec2::ZERO); 5];
    for (index, target) in std::iter::once(observation.second).chain(observation.images(table)).enumerate() {
        let span = DualVector::constant(target) - contact;
        // A tenth of a millimetre keeps the slopes finite if the balls touch.
        let distance = (span.dot(span) + 1e-8).sqrt();
        let nearness = distance.recip();
        let towards = DualVector { x: span.x * nearness, y: span.y * nearness };
        out.extend([normal.dot(towards), normal.perp_dot(towards), distance * (1.0 / table.length)]);
        if index == 0 {
            out.push((distance * (1.0 / diameter) + 1.0).recip());
        }
        targets[index] = towards;
    }
    // The cue ball's free path along the tangent, without its slope.
    let tangent = DVec2::new(-normal.y.value, normal.x.value);
    out.push(Dual::constant(free_path(table, observation.first, tangent) / table.length));
    let [left, up, elevation] = [2, 3, 4].map(|index| Dual::action(index, f64::from(action[index])));
    out.extend([left, up, elevation, left * left, up * up, left * up, left * elevation]);
    out.extend([stroke.speed, stroke.speed_on_arrival].map(|speed| speed * (1.0 / TYPICAL_SPEED)));
    out.extend([stroke.roll, stroke.roll_on_arrival, stroke.side, stroke.masse, stroke.turn].map(|x| x * 0.5));
    let end = final_course(table, &stroke, course, normal, offset, cos_cut);
    let size = (end.dot(end) + 1e-4).sqrt();
    let heading = DualVector { x: end.x * size.recip(), y: end.y * size.recip() };
    out.extend([size, heading.x, heading.y]);
    for towards in targets {
        out.extend([heading.dot(towards), heading.perp_dot(towards)]);
    }
    let DualVector { x, y } = heading;
    out.push(Dual::constant(free_path(table, observation.first, DVec2::new(x.value, y.value)) / table.length));
    out.extend(by_rail);
}

/// Keeps the action features that describe the action itself and sets the others to zero.
pub fn keep_action_only(features: &mut [Dual]) {
    let is_consequence = |index: &usize| !ACTION_ONLY.iter().any(|indices| indices.contains(index));
    for index in (0..features.len()).filter(is_consequence) {
        features[index] = Dual::constant(0.0);
    }
}

/// Returns the velocity of the cue ball once it rolls after the impact with the first ball, as a share of its speed on arrival. The
/// collision (equations 17 to 20) leaves a part along the line of centres and most of it along the tangent. Then five sevenths of that
/// and two sevenths of the roll before the impact remain (25). The effect of sidespin on the tangential impulse is neglected; the network
/// has the sidespin as an input.
fn final_course(
    table: &Table,
    stroke: &FirstContact,
    course: DualVector,
    normal: DualVector,
    offset: Dual,
    cos_cut: Dual,
) -> DualVector {
    let normal_speed = cos_cut * (0.5 * (1.0 - table.ball_restitution));
    let friction = match table.ball_friction {
        None => Dual::constant(1.0 / 7.0),
        Some(friction) => {
            let slip =
                (offset * offset + stroke.roll_on_arrival * stroke.roll_on_arrival * cos_cut * cos_cut + 1e-3).sqrt();
            (cos_cut * slip.recip() * (0.5 * friction * (1.0 + table.ball_restitution))).at_most(1.0 / 7.0)
        }
    };
    let tangential_speed = offset * (-friction + 1.0);
    let roll = stroke.roll_on_arrival * (2.0 / 7.0);
    DualVector {
        x: (normal.x * normal_speed - normal.y * tangential_speed) * (5.0 / 7.0) + course.x * roll,
        y: (normal.y * normal_speed + normal.x * tangential_speed) * (5.0 / 7.0) + course.y * roll,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::{action::ACTIONS, first_contact::RAIL_FEATURES},
        table::{Layout, Rail},
    };
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    fn features(table: &Table, observation: &Observation, action: Action) -> Vec<Dual> {
        let mut out = Vec::new();
        push_action_features(&Paths::of(table, observation), action, true, &mut out);
        assert_eq!(out.len(), ACTION_FEATURES + RAIL_FEATURES);
        out
    }

    /// An observation with a straight path for even cases, and one by a cushion for odd cases.
    fn observation(table: &Table, case: usize, rng: &mut Xoshiro256PlusPlus) -> Observation {
        let straight = Observation::new(&Layout::random(table, rng), case % 4);
        let rail = (case % 2 == 1).then_some(Rail::ALL[case / 2 % 4]);
        Observation { rail, ..straight }
    }

    fn random(rng: &mut Xoshiro256PlusPlus, limit: f32) -> Action {
        std::array::from_fn(|_| rng.random_range(-limit..=limit))
    }

    #[test]
    fn features_are_finite_and_of_order_one() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            for case in 0..800 {
                let observation = observation(&table, case, &mut rng);
                let mut state = Vec::new();
                push_state_features(&table, &observation, &mut state);
                assert_eq!(state.len(), STATE_FEATURES);
                assert!(state.iter().all(|x| x.abs() <= 4.0), "{state:?}");
                let action = random(&mut rng, 1.0);
                for (index, feature) in features(&table, &observation, action).iter().enumerate() {
                    assert!(feature.value.abs() <= 8.0, "{index}: {feature:?}");
                    assert!(feature.slope.iter().all(|slope| slope.abs() < 200.0), "{index}: {feature:?}");
                }
            }
        }
    }

    #[test]
    fn action_only_features_are_independent_of_table_and_layout() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(12);
        let action = random(&mut rng, 0.9);
        let mut chosen = |name, action| {
            let table = Table::preset(name).unwrap();
            let mut features = features(&table, &Observation::new(&Layout::random(&table, &mut rng), 0), action);
            keep_action_only(&mut features);
            features.iter().map(|feature| (feature.value, feature.slope)).collect::<Vec<_>>()
        };
        let features = chosen("match", action);
        assert_eq!(features, chosen("thesis", action));
        for number in 0..ACTIONS {
            let mut other = action;
            other[number] += 0.01;
            assert_ne!(features, chosen("match", other), "no feature depends on number {number} of the action");
        }
    }

    #[test]
    fn touching_balls_give_finite_features() {
        let table = Table::default();
        let diameter = 2.0 * table.radius;
        let layout = Layout::new([DVec2::ZERO, DVec2::new(diameter, 0.0), DVec2::new(0.0, -diameter)]);
        for observation in Observation::all_straight(&layout) {
            for action in [[-1.0, 0.0, 1.0, 1.0, 1.0], [1.0; ACTIONS], [0.0, 1.0, -1.0, 0.0, -1.0]] {
                let features = features(&table, &observation, action);
                assert!(features.iter().all(|f| f.value.is_finite() && f.slope.iter().all(|s| s.is_finite())));
            }
        }
    }

    #[test]
    fn slopes_agree_with_finite_differences() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(9);
        let mut by_rail = 0;
        for case in 0..100 {
            let observation = observation(&table, case, &mut rng);
            let action = random(&mut rng, 0.8);
            let here = features(&table, &observation, action);
            for along in 0..ACTIONS {
                let moved = |step: f32| {
                    let mut action = action;
                    action[along] += step;
                    (features(&table, &observation, action), f64::from(action[along]))
                };
                let ((after, x1), (before, x0)) = (moved(1e-3), moved(-1e-3));
                // If one of the paths by a cushion is not found, there is nothing to compare.
                if [&before, &after]
                    .into_iter()
                    .any(|there| there[ACTION_FEATURES].value != here[ACTION_FEATURES].value)
                {
                    continue;
                }
                by_rail += usize::from(here[ACTION_FEATURES].value == 1.0);
                for index in (0..here.len()).filter(|index| !FREE_PATHS.contains(index)) {
                    let difference = (after[index].value - before[index].value) / (x1 - x0);
                    let slope = here[index].slope[along];
                    let close = (difference - slope).abs() < 4e-3 * (1.0 + slope.abs());
                    // The slope jumps if the cue ball starts to roll just on arrival.
                    let kink =
                        (before[index].slope[along] - after[index].slope[along]).abs() > 1e-2 * (1.0 + slope.abs());
                    assert!(close || kink, "{case} {index} along {along}: {difference} {slope}");
                }
            }
        }
        assert!(by_rail > 20 * ACTIONS, "{by_rail}");
    }
}
