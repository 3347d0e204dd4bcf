//! What an agent can do: where to pass the first ball and how fast, and the cue inputs that do it.

use crate::{learning::view::View, physics::CueInputs, table::Table};

/// Numbers in an action; each lies within -1 to 1.
pub const ACTIONS: usize = 2;

/// An aim and a speed, as a network gives them: both from -1 to 1.
pub type Action = [f32; ACTIONS];

/// What -1 and 1 stand for in the first action: the aiming line passes the first ball's centre on the left at this many
/// ball diameters. 0 is a full hit, 1 a hair's breadth. A little beyond 0, so that a full hit is no edge.
const OFFSETS: [f64; 2] = [-0.1, 1.0];

/// What -1 and 1 stand for in the second action: cue speed, m/s. The upper end is the thesis' (chapter 4.1); below the
/// lower one a ball hardly reaches another.
const SPEEDS: [f64; 2] = [0.3, 6.0];

/// Elevation of the cue, rad: the thesis' 10°, with the tip at the ball's centre (a = b = 0).
const ELEVATION: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// These choices in words, for the note in a policy's file: weights fit one meaning of the actions only.
pub const ACTION_SPACE: &str = "phi from offset -0.1 to 1 diameters, V 0.3 to 6 m/s, a = b = 0, theta = 10 degrees";

/// Ball diameters between the aiming line and the first ball's centre, for the first action.
pub fn offset(action: f32) -> f64 {
    scaled(OFFSETS, action)
}

/// The first action that gives `offset`.
pub fn aim_at(offset: f64) -> f32 {
    (2.0 * (offset - OFFSETS[0]) / (OFFSETS[1] - OFFSETS[0]) - 1.0) as f32
}

/// Change of the offset per unit of the first action.
pub const OFFSET_SLOPE: f64 = 0.5 * (OFFSETS[1] - OFFSETS[0]);

fn scaled([low, high]: [f64; 2], action: f32) -> f64 {
    // An action that is not a number becomes the middle, so that a broken network still gives cue inputs.
    let action = if action.is_nan() { 0.0 } else { f64::from(action.clamp(-1.0, 1.0)) };
    low + 0.5 * (high - low) * (action + 1.0)
}

/// The stroke that carries out `action` in `view`.
pub fn cue_inputs(table: &Table, view: &View, action: Action) -> CueInputs {
    let line = view.lines(table).to_first;
    let turn = (2.0 * table.radius * offset(action[0]) / line.distance).clamp(-1.0, 1.0).asin();
    let direction = glam::DVec2::from_angle(turn).rotate(line.direction);
    CueInputs {
        a: 0.0,
        b: 0.0,
        theta: ELEVATION,
        phi: view.angle_on_table(direction),
        speed: scaled(SPEEDS, action[1]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Layout;
    use glam::DVec2;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_aiming_line_passes_the_first_ball_at_the_offset_on_the_side_of_the_view() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            for (index, view) in View::all(&layout).iter().enumerate() {
                let action = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)];
                let cue = cue_inputs(&table, view, action);
                cue.validate().unwrap();
                let to_ball = layout.balls[1 + (index & 1)] - layout.balls[0];
                // Positive where the ball's centre lies on the right of the aiming line.
                let passed = -DVec2::from_angle(cue.phi).perp_dot(to_ball) / (2.0 * table.radius);
                let side = if index & 2 == 0 { 1.0 } else { -1.0 };
                assert!((passed * side - offset(action[0])).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn actions_that_are_not_numbers_or_out_of_range_still_give_a_stroke() {
        let table = Table::default();
        let view = View::new(&Layout::opening(&table), 0);
        for wrong in [f32::NAN, f32::INFINITY, -7.0] {
            cue_inputs(&table, &view, [wrong, wrong]).validate().unwrap();
        }
    }

    #[test]
    fn offsets_and_actions_are_inverse() {
        for value in [-0.1, 0.0, 0.5, 1.0] {
            assert!((offset(aim_at(value)) - value).abs() < 1e-7);
        }
    }
}
