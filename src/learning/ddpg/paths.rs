//! The cue ball's paths to the first ball, straight or by a cushion: the stroke of an action on such a path, and the ball's arrival.

use glam::DVec2;

use super::{
    action::{Action, DecodedAction},
    dual::{Dual, DualVector},
    first_contact::{Approach, FirstContact, RAIL_FEATURES},
    observation::{Lines, Observation},
    rail_first::RailFirstPaths,
};
use crate::{
    physics::{CueInputs, NoRoom, raise_to_clear, squirt},
    table::{Layout, Table},
};

/// The paths to the first ball in an observation.
#[derive(Clone, Debug)]
pub struct Paths<'a> {
    pub table: &'a Table,
    pub observation: &'a Observation,
    /// The observation's lines from ball to ball.
    pub lines: Lines,
    by_rail: Option<RailFirstPaths<'a>>,
}

impl<'a> Paths<'a> {
    pub fn of(table: &'a Table, observation: &'a Observation) -> Self {
        Self { table, observation, lines: observation.lines(table), by_rail: RailFirstPaths::of(table, observation) }
    }

    /// Computes the cue ball's arrival after the stroke of an action; slopes of a path by a cushion only if `slopes`. If no path by the
    /// cushion is found, the cushion counts as a mirror.
    pub fn approach(&self, action: &DecodedAction, slopes: bool) -> Approach {
        if let Some(approach) = self.by_rail.as_ref().and_then(|paths| paths.approach(action, slopes)) {
            return approach;
        }
        let (table, line) = (self.table, self.lines.to_first);
        let contact = FirstContact::of(table, action, line.distance);
        // The course turns to the left of the line to the first ball. The correction of the aim for the swerve is neglected here:
        // typically less than a degree, 10 degrees for the strongest massés.
        let sin_turn = action.offset * (2.0 * table.radius / line.distance);
        let course = DualVector { x: sin_turn.cosine(), y: sin_turn + contact.turn }.normalised();
        Approach { contact, course: course.rotated(line.direction), by_rail: [Dual::constant(0.0); RAIL_FEATURES] }
    }

    /// Returns the direction in which the ball leaves the cue in the stroke of an action, rad on the table.
    fn direction(&self, action: &DecodedAction) -> f64 {
        if let Some(paths) = &self.by_rail {
            return paths.direction(action);
        }
        let (table, line) = (self.table, self.lines.to_first);
        let swerve = FirstContact::of(table, action, line.distance).swerve.value;
        let side_distance = 2.0 * table.radius * action.offset.value - swerve;
        let turn = (side_distance / line.distance).clamp(-1.0, 1.0).asin();
        self.observation.angle_on_table(DVec2::from_angle(turn).rotate(line.direction))
    }
}

/// Returns the stroke that carries out `action` in `observation`.
pub fn cue_inputs(table: &Table, observation: &Observation, action: Action) -> CueInputs {
    let decoded = DecodedAction::of(table, action);
    let [left, up] = decoded.tip;
    let a = observation.side_on_table(left.value);
    CueInputs {
        // Adding zero turns a negative zero into a positive one, which is easier to read.
        a: a + 0.0,
        b: up.value,
        theta: decoded.theta.value,
        phi: Paths::of(table, observation).direction(&decoded) - squirt(table, a),
        speed: decoded.speed.value,
    }
}

/// Returns the stroke that carries out `action` in an `observation` of `layout`, with the cue raised as far as rails and balls require.
///
/// # Errors
/// Fails if the cue has no room at any elevation.
pub fn playable(
    table: &Table,
    layout: &Layout,
    observation: &Observation,
    action: Action,
) -> Result<CueInputs, NoRoom> {
    raise_to_clear(table, layout, &cue_inputs(table, observation, action))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{learning::ddpg::action::ACTIONS, table::Rail};
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_aiming_line_passes_the_first_ball_at_the_offset() {
        // Without flight, because the thesis' fixed elevation would make balls hop.
        let table = Table { flight: None, ..Table::default() };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            for (index, observation) in Observation::all_straight(&layout).iter().enumerate() {
                let action = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), 0.0, 0.0, 0.0];
                let cue = cue_inputs(&table, observation, action);
                cue.validate().unwrap();
                assert_eq!((cue.a, cue.b, cue.theta), (0.0, 0.0, 10_f64.to_radians()));
                let to_ball = layout.balls[1 + (index & 1)] - layout.balls[0];
                // Positive if the ball's centre is on the right of the aiming line.
                let passed = -DVec2::from_angle(cue.phi).perp_dot(to_ball) / (2.0 * table.radius);
                let side = if index & 2 == 0 { 1.0 } else { -1.0 };
                assert!((passed * side - DecodedAction::of(&table, action).offset.value).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn all_actions_give_strokes_within_the_miscue_limit() {
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            let observation = Observation::new(&Layout::opening(&table), 0);
            for input in [f32::NAN, f32::INFINITY, -7.0, 1.0, -1.0, 0.3] {
                for action in [[input; ACTIONS], [0.0, 0.0, input, -input, 1.0], [0.0, 0.0, input, 0.0, 0.0]] {
                    let cue = cue_inputs(&table, &observation, action);
                    cue.validate().unwrap();
                    cue.validate_tip(table.miscue_limit).unwrap();
                }
            }
        }
    }

    #[test]
    fn a_mirrored_observation_gets_the_mirrored_stroke_and_path() {
        let table = Table::default();
        let layout = Layout::new([DVec2::new(0.3, 0.1), DVec2::new(-0.5, 0.3), DVec2::new(0.2, -0.4)]);
        let mirrored = Layout::new(layout.balls.map(|ball| DVec2::new(ball.x, -ball.y)));
        for (rail, elevation) in std::iter::once((None, 0.4)).chain(Rail::ALL.map(|rail| (Some(rail), -1.0))) {
            let action = [0.2, 0.5, 0.6, -0.3, elevation];
            let [(one, path), (other, other_path)] = [(layout, 0), (mirrored, 2)].map(|(layout, index)| {
                let observation = Observation { rail, ..Observation::new(&layout, index) };
                let paths = Paths::of(&table, &observation);
                let Approach { contact, course, by_rail } = paths.approach(&DecodedAction::of(&table, action), false);
                let numbers = [contact.side, course.x, course.y].into_iter().chain(by_rail);
                (cue_inputs(&table, &observation, action), numbers.map(|number| number.value).collect::<Vec<_>>())
            });
            assert!((one.phi + other.phi).abs() < if rail.is_some() { 1e-9 } else { 1e-12 } && one.a > 0.2);
            assert_eq!((one.a, one.b, one.theta, one.speed), (-other.a, other.b, other.theta, other.speed));
            let is_same = path.iter().zip(&other_path).all(|(one, other)| (one - other).abs() < 1e-9);
            assert!(is_same, "{rail:?}: {path:?} {other_path:?}");
        }
    }
}
