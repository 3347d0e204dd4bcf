//! The stroke of an action: its cue inputs, and what it makes of the cue ball until that meets the first ball, in closed
//! form and with slopes.

use super::{
    action::{Action, Meaning},
    dual::Dual,
    observation::Observation,
    rail_first::ByRail,
};
use crate::{
    physics::{CueInputs, NoRoom, squirt, with_room},
    table::{Layout, Table},
};

/// The cue ball on its way to a ball at a known distance. Speeds along the line of aim, sideways to its left.
#[derive(Clone, Copy, Debug)]
pub struct FirstContact {
    /// Speed just after the stroke, m/s.
    pub speed: Dual,
    /// Rolling speed of the spin about the axis across the line of aim, as a share of the speed: 1 is natural roll, less
    /// than 0 is draw. Just after the stroke.
    pub roll: Dual,
    /// The same when the ball arrives.
    pub roll_on_arrival: Dual,
    /// Sidespin about the vertical as a surface speed, as a share of the speed.
    pub side: Dual,
    /// Spin about the line of aim as a surface speed, as a share of the speed: it swerves the ball.
    pub masse: Dual,
    /// How far the ball has swerved to the left on arrival, m.
    pub swerve: Dual,
    /// Sideways speed on arrival as a share of the speed: the angle by which its course has turned, rad.
    pub turn: Dual,
    /// Speed on arrival, m/s.
    pub speed_on_arrival: Dual,
}

impl FirstContact {
    /// The stroke of an action over `distance`, m. The ball's speed is taken as that of the stroke until it arrives, and the
    /// friction's direction as that of the first slip: good to a few percent for the shots that matter.
    pub fn of(table: &Table, action: &Meaning, distance: f64) -> Self {
        let Meaning { speed, tip: [a, b], theta, .. } = *action;
        // Thesis equations 9, 15 and 16, as in `physics::strike`.
        let c = (-(a * a) - b * b + 1.0).at_least(1e-6).sqrt();
        let (sin, cos) = theta.sin_cos();
        let lever = b * cos - c * sin;
        let force = speed * 2.0 * ((a * a + lever * lever) * 2.5 + (1.0 + table.ball_mass / table.cue_mass)).recip();
        let start = force * cos;
        let per_speed = (cos).recip() * 2.5;
        let (roll, side, masse) = (lever * per_speed, -a * 2.5, -(a * sin) * per_speed);

        // The slip at the cloth (5), as shares of the speed: along the aim 1 - roll, and sideways the spin about the aim.
        let (along, across) = (-roll + 1.0, masse);
        let slip = (along * along + across * across + 1e-9).sqrt();
        let friction = table.sliding_friction * table.gravity;
        let sliding = start * slip * (2.0 / (7.0 * friction));
        let way = start.recip() * distance;
        let time = way.min(sliding);
        let share = slip.recip();
        let push = -(across * share) * friction;
        let sideways = push * time;
        // Friction turns slip into roll: the slip falls at 7/2 of the friction, 5/2 of it by the spin.
        let slowed = start - along * share * friction * time;
        let rolled = roll * start + along * share * time * (2.5 * friction);
        let swerve = push * time * time * 0.5 + sideways * (way - time);
        let arrival = slowed.at_least(0.05);
        Self {
            speed: start,
            roll,
            roll_on_arrival: rolled * arrival.recip(),
            side,
            masse,
            swerve,
            turn: sideways * arrival.recip(),
            speed_on_arrival: arrival,
        }
    }
}

/// The stroke that carries out `action` in `observation`.
pub fn cue_inputs(table: &Table, observation: &Observation, action: Action) -> CueInputs {
    let meaning = Meaning::of(table, action);
    let direction = ByRail::of(table, observation).map_or_else(
        || observation.angle_on_table(straight(table, observation, &meaning)),
        |ways| ways.direction(&meaning),
    );
    let [left, up] = meaning.tip;
    let a = observation.side_on_table(left.value);
    CueInputs {
        // Adding nought makes a negative nought positive, which people read better.
        a: a + 0.0,
        b: up.value,
        theta: meaning.theta.value,
        phi: direction - squirt(table, a),
        speed: meaning.speed.value,
    }
}

/// The direction of the course, in the observation, that goes straight to the first ball and passes it at the action's offset.
fn straight(table: &Table, observation: &Observation, action: &Meaning) -> glam::DVec2 {
    let line = observation.lines(table).to_first;
    let swerve = FirstContact::of(table, action, line.distance).swerve.value;
    let aside = 2.0 * table.radius * action.offset.value - swerve;
    let turn = (aside / line.distance).clamp(-1.0, 1.0).asin();
    glam::DVec2::from_angle(turn).rotate(line.direction)
}

/// The stroke that carries out `action` in a `observation` of `layout`, with the cue raised as far as rails and balls make it.
///
/// # Errors
/// Where the cue has no room at any elevation.
pub fn playable(
    table: &Table,
    layout: &Layout,
    observation: &Observation,
    action: Action,
) -> Result<CueInputs, NoRoom> {
    with_room(table, layout, &cue_inputs(table, observation, action))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{learning::ddpg::action::ACTIONS, physics::strike, simulation::Recording, table::Layout};
    use glam::DVec2;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// How far the closed form is from the simulator on arrival: place in ball diameters, speed and roll as shares of the
    /// speed.
    fn errors(table: &Table, case: usize, rng: &mut Xoshiro256PlusPlus) -> Option<[f64; 3]> {
        let cue_ball = DVec2::new(-0.2, 0.1);
        let first = DVec2::new(rng.random_range(0.3..1.0), rng.random_range(-0.3..0.3));
        let observation = Observation::new(&Layout::new([cue_ball, first, DVec2::new(-1.0, -0.5)]), 2 * (case % 2));
        let mut action: [f32; 5] = std::array::from_fn(|_| rng.random_range(-0.7..0.7));
        action[1] = rng.random_range(0.0..1.0);
        let meaning = Meaning::of(table, action);
        let stroke = FirstContact::of(table, &meaning, first.distance(cue_ball));
        let cue = cue_inputs(table, &observation, action);
        assert!((strike(table, &cue).velocity.length() - stroke.speed.value).abs() < 1e-9);

        // The cue ball runs on where the first ball would lie.
        let alone = Layout::new([cue_ball, DVec2::new(-1.0, 0.6), DVec2::new(-1.0, -0.6)]);
        let recording = Recording::new(table, &alone, &cue).unwrap();
        let line = (first - cue_ball).normalize();
        let arrived = |time: f64| (recording.positions(time)[0] - first).dot(line) >= 0.0;
        let time = (1..4000).map(|tick| f64::from(tick) * 1e-3).find(|time| arrived(*time))?;
        let ball = recording.state(0, time);
        let mirrored = observation.side_on_table(1.0);
        let passed = mirrored * line.perp_dot(ball.position - first) / (2.0 * table.radius);
        let speed = ball.velocity.length();
        let aim = DVec2::from_angle(cue.phi);
        let roll = table.radius * (aim.x * ball.spin.y - aim.y * ball.spin.x) / speed;
        Some([
            (passed - meaning.offset.value).abs(),
            (speed / stroke.speed_on_arrival.value - 1.0).abs(),
            (roll - stroke.roll_on_arrival.value).abs(),
        ])
    }

    #[test]
    fn the_cue_ball_arrives_as_the_simulator_says() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            let mut all: Vec<_> = (0..400).filter_map(|case| errors(&table, case, &mut rng)).collect();
            assert!(all.len() > 300);
            for (index, (what, limit)) in [("place", 0.02), ("speed", 0.1), ("roll", 0.1)].into_iter().enumerate() {
                all.sort_by(|a, b| a[index].total_cmp(&b[index]));
                let typical = all[all.len() / 2][index];
                assert!(typical < limit, "{name}: the {what} is typically {typical} off");
            }
        }
    }

    #[test]
    fn the_aiming_line_passes_the_first_ball_at_the_offset_on_the_side_of_the_view() {
        // Where balls fly, the thesis' fixed elevation would make them hop.
        let table = Table { flight: None, ..Table::default() };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            for (index, observation) in Observation::all(&layout).iter().enumerate() {
                let action = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), 0.0, 0.0, 0.0];
                let cue = cue_inputs(&table, observation, action);
                cue.validate().unwrap();
                assert_eq!((cue.a, cue.b, cue.theta), (0.0, 0.0, 10_f64.to_radians()));
                let to_ball = layout.balls[1 + (index & 1)] - layout.balls[0];
                // Positive where the ball's centre lies on the right of the aiming line.
                let passed = -DVec2::from_angle(cue.phi).perp_dot(to_ball) / (2.0 * table.radius);
                let side = if index & 2 == 0 { 1.0 } else { -1.0 };
                assert!((passed * side - Meaning::of(&table, action).offset.value).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn no_action_oversteps_the_miscue_limit_and_what_is_no_number_still_gives_a_stroke() {
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
    fn a_mirrored_view_gets_the_mirrored_stroke() {
        let table = Table::default();
        let layout = Layout::new([DVec2::new(0.3, 0.1), DVec2::new(-0.5, 0.3), DVec2::new(0.2, -0.4)]);
        let mirrored = Layout::new(layout.balls.map(|ball| DVec2::new(ball.x, -ball.y)));
        let action = [0.2, 0.5, 0.6, -0.3, 0.4];
        let [one, other] = [(layout, 0), (mirrored, 2)].map(|(layout, observation)| {
            let cue = cue_inputs(&table, &Observation::new(&layout, observation), action);
            (cue.a, cue.phi, cue.b, cue.theta, cue.speed)
        });
        assert!((one.1 + other.1).abs() < 1e-12 && one.0 > 0.2);
        assert_eq!((one.0, one.2, one.3, one.4), (-other.0, other.2, other.3, other.4));
    }
}
