//! Input features of the networks: of an observation for both, and of an observation and an action for the critic.

use std::{f64::consts::PI, ops::Range};

use glam::DVec2;

use super::{
    action::{Action, Meaning},
    dual::{Dual, DualVector},
    first_contact::{Approach, FirstContact, TYPICAL_SPEED},
    observation::{Line, Observation, free_path},
    ways::Ways,
};
use crate::table::Table;

/// Numbers about an observation.
pub const STATE_FEATURES: usize = 38;

/// Numbers about an observation and an action.
pub const ACTION_FEATURES: usize = 58;

/// Those among them whose slopes are left out: how far the cue ball can go jumps in the corners.
#[cfg(test)]
pub const FREE_PATHS: [usize; 2] = [29, 57];

/// Those among them that tell the action and nothing that follows from it.
const CHOSEN: [Range<usize>; 2] = [0..8, 30..37];

/// Appends [`STATE_FEATURES`] numbers of the order of one: where the balls lie, how they lie to each other, the cushions
/// behind the first ball, and the second ball's images in the cushions as seen from the first.
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
    // How far beside the line through the first two balls the third one lies, in diameters, squashed.
    let beside = aim.perp_dot(lines.onward.direction) * lines.onward.distance / diameter;
    push(beside / (1.0 + beside.abs()));
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

/// Numbers about a shot: [`ACTION_FEATURES`] of them, and then [`RAIL_FEATURES`](super::first_contact::RAIL_FEATURES) about a way by a
/// cushion, with their slopes along the action. Those of a way by a cushion are found only where `slopes` are asked for.
///
/// At the moment of contact the line of centres and the tangent at the first ball decide where the cue ball goes. So
/// the second ball and its images are given in that frame, as seen from where the cue ball then stands: a network
/// would need many units to find this rotation by itself, and points are missed by a degree. Where the spin takes the
/// cue ball from there in the end, its final direction, is the second such frame.
pub fn push_action_features(ways: &Ways<'_>, action: Action, slopes: bool, out: &mut Vec<Dual>) {
    let Ways { table, observation, lines, .. } = *ways;
    let meaning = Meaning::of(table, action);
    let Approach { contact: stroke, course, by_rail } = ways.approach(&meaning, slopes);
    let offset = meaning.offset;
    let speed = Dual::action(1, f64::from(action[1]));
    out.extend([offset, offset * offset]);
    for wave in [PI, 2.0 * PI] {
        let (sin, cos) = (offset * wave).sin_cos();
        out.extend([sin, cos]);
    }
    out.extend([speed, speed * speed]);

    let diameter = 2.0 * table.radius;
    // The line of centres lies right of the course by the cut angle.
    let cos_cut = offset.cosine();
    let normal = DualVector { x: course.x * cos_cut + course.y * offset, y: course.y * cos_cut - course.x * offset };
    out.extend([cos_cut, normal.x, normal.y]);
    // Where the first ball goes, against where the second one lies: a kiss spoils the shot.
    let onward = DualVector::constant(lines.onward.direction);
    out.extend([normal.dot(onward), normal.perp_dot(onward)]);
    let contact = DualVector::constant(observation.first) - normal * diameter;
    let mut targets = [DualVector::constant(DVec2::ZERO); 5];
    for (place, target) in std::iter::once(observation.second).chain(observation.images(table)).enumerate() {
        let span = DualVector::constant(target) - contact;
        // A tenth of a millimetre keeps the slopes finite where the balls touch.
        let distance = (span.dot(span) + 1e-8).sqrt();
        let nearness = distance.recip();
        let towards = DualVector { x: span.x * nearness, y: span.y * nearness };
        out.extend([normal.dot(towards), normal.perp_dot(towards), distance * (1.0 / table.length)]);
        if place == 0 {
            out.push((distance * (1.0 / diameter) + 1.0).recip());
        }
        targets[place] = towards;
    }
    // How far the cue ball can go along the tangent, without its slope.
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

/// Leaves of the action features those that tell the action itself; the others become nought.
pub fn leave_chosen(features: &mut [Dual]) {
    let follows = |index: &usize| !CHOSEN.iter().any(|chosen| chosen.contains(index));
    for index in (0..features.len()).filter(follows) {
        features[index] = Dual::constant(0.0);
    }
}

/// Velocity of the cue ball once it rolls after meeting the first ball, as a share of its speed on arrival: the collision
/// (17 to 20) leaves part of it along the line of centres and most of it along the tangent; then five sevenths of that
/// and two sevenths of the roll that it brought along remain (25). Sidespin, which drags the tangential part of the impulse, is
/// left out; the network knows the sidespin itself.
fn final_course(
    table: &Table,
    stroke: &FirstContact,
    course: DualVector,
    normal: DualVector,
    offset: Dual,
    cos_cut: Dual,
) -> DualVector {
    let along = cos_cut * (0.5 * (1.0 - table.ball_restitution));
    let friction = match table.ball_friction {
        None => Dual::constant(1.0 / 7.0),
        Some(friction) => {
            let rubbing =
                (offset * offset + stroke.roll_on_arrival * stroke.roll_on_arrival * cos_cut * cos_cut + 1e-3).sqrt();
            (cos_cut * rubbing.recip() * (0.5 * friction * (1.0 + table.ball_restitution))).at_most(1.0 / 7.0)
        }
    };
    let aside = offset * (-friction + 1.0);
    let roll = stroke.roll_on_arrival * (2.0 / 7.0);
    DualVector {
        x: (normal.x * along - normal.y * aside) * (5.0 / 7.0) + course.x * roll,
        y: (normal.y * along + normal.x * aside) * (5.0 / 7.0) + course.y * roll,
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
        push_action_features(&Ways::of(table, observation), action, true, &mut out);
        assert_eq!(out.len(), ACTION_FEATURES + RAIL_FEATURES);
        out
    }

    /// A straight one, and one by a cushion, in turn.
    fn observation(table: &Table, case: usize, rng: &mut Xoshiro256PlusPlus) -> Observation {
        let straight = Observation::new(&Layout::random(table, rng), case % 4);
        let rail = (case % 2 == 1).then_some(Rail::ALL[case / 2 % 4]);
        Observation { rail, ..straight }
    }

    fn random(rng: &mut Xoshiro256PlusPlus, limit: f32) -> Action {
        std::array::from_fn(|_| rng.random_range(-limit..=limit))
    }

    #[test]
    fn features_are_finite_of_order_one_and_as_many_as_promised() {
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
    fn without_the_closed_form_the_features_of_a_stroke_are_the_same_on_any_table_and_layout() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(12);
        let action = random(&mut rng, 0.9);
        let mut chosen = |name, action| {
            let table = Table::preset(name).unwrap();
            let mut features = features(&table, &Observation::new(&Layout::random(&table, &mut rng), 0), action);
            leave_chosen(&mut features);
            features.iter().map(|feature| (feature.value, feature.slope)).collect::<Vec<_>>()
        };
        let told = chosen("match", action);
        assert_eq!(told, chosen("thesis", action));
        for number in 0..ACTIONS {
            let mut other = action;
            other[number] += 0.01;
            assert_ne!(told, chosen("match", other), "number {number} of the action is not told");
        }
    }

    #[test]
    fn balls_that_touch_give_finite_features() {
        let table = Table::default();
        let diameter = 2.0 * table.radius;
        let layout = Layout::new([DVec2::ZERO, DVec2::new(diameter, 0.0), DVec2::new(0.0, -diameter)]);
        for observation in Observation::all(&layout) {
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
                // Where one of the directions by a cushion is not found, there is nothing to compare.
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
                    // Where the cue ball begins to roll just on arrival the slope jumps.
                    let kink =
                        (before[index].slope[along] - after[index].slope[along]).abs() > 1e-2 * (1.0 + slope.abs());
                    assert!(close || kink, "{case} {index} along {along}: {difference} {slope}");
                }
            }
        }
        assert!(by_rail > 20 * ACTIONS, "{by_rail}");
    }
}
