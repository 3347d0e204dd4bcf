//! The cue ball's state on arrival at the first ball on a straight path, in closed form and with slopes.

use super::{
    action::DecodedAction,
    dual::{Dual, DualVector},
};
use crate::table::Table;

/// Number of features of a path to the first ball by a cushion; all are zero if the path is straight.
pub const RAIL_FEATURES: usize = 8;

/// Typical speed in play, m/s: speeds divided by it are features of the order of one.
pub const TYPICAL_SPEED: f64 = 6.0;

/// The cue ball between the stroke and a ball at a known distance. Speeds are along the line of aim; sideways is to its left.
#[derive(Clone, Copy, Debug)]
pub struct FirstContact {
    /// Speed just after the stroke, m/s.
    pub speed: Dual,
    /// Surface speed of the spin about the axis across the line of aim, just after the stroke, as a share of the speed: 1 is natural
    /// roll, less than 0 is draw.
    pub roll: Dual,
    /// The same on arrival.
    pub roll_on_arrival: Dual,
    /// Sidespin about the vertical as a surface speed, as a share of the speed.
    pub side: Dual,
    /// Spin about the line of aim as a surface speed, as a share of the speed: it makes the ball swerve.
    pub masse: Dual,
    /// Swerve to the left on arrival, m.
    pub swerve: Dual,
    /// Sideways speed on arrival as a share of the speed: the angle by which its course has turned, rad.
    pub turn: Dual,
    /// Speed on arrival, m/s.
    pub speed_on_arrival: Dual,
}

/// The cue ball's arrival at the first ball.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// Motion since the stroke, or since the cushion.
    pub contact: FirstContact,
    /// Direction of the course on arrival, a unit vector in the observation's frame.
    pub course: DualVector,
    /// Features of a path by a cushion.
    pub by_rail: [Dual; RAIL_FEATURES],
}

impl FirstContact {
    /// Computes the arrival after the stroke of an action over `distance`, m. The travel time is that at the initial speed, and the
    /// friction keeps the direction of the initial slip: accurate to a few percent for the shots that matter.
    pub fn of(table: &Table, action: &DecodedAction, distance: f64) -> Self {
        let DecodedAction { speed, tip: [a, b], theta, .. } = *action;
        // Thesis equations 9, 15 and 16, as in `physics::strike`.
        let c = (-(a * a) - b * b + 1.0).at_least(1e-6).sqrt();
        let (sin, cos) = theta.sin_cos();
        let lever = b * cos - c * sin;
        let force = speed * 2.0 * ((a * a + lever * lever) * 2.5 + (1.0 + table.ball_mass / table.cue_mass)).recip();
        let start = force * cos;
        let per_speed = (cos).recip() * 2.5;
        let (roll, side, masse) = (lever * per_speed, -a * 2.5, -(a * sin) * per_speed);

        // The slip velocity at the cloth (5), as a share of the speed: along the aim 1 - roll, sideways the spin about the aim.
        let (along, across) = (-roll + 1.0, masse);
        let slip = (along * along + across * across + 1e-9).sqrt();
        let friction = table.sliding_friction * table.gravity;
        let sliding = start * slip * (2.0 / (7.0 * friction));
        let travel = start.recip() * distance;
        let time = travel.min(sliding);
        let share = slip.recip();
        let push = -(across * share) * friction;
        let sideways = push * time;
        // Friction turns slip into roll: the slip falls at 7/2 of the friction, of which 5/2 are due to the spin.
        let slowed = start - along * share * friction * time;
        let rolled = roll * start + along * share * time * (2.5 * friction);
        let swerve = push * time * time * 0.5 + sideways * (travel - time);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::{observation::Observation, paths::cue_inputs},
        physics::strike,
        simulation::Recording,
        table::Layout,
    };
    use glam::DVec2;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Errors of the closed form against the simulator on arrival: position in ball diameters, speed and roll as shares of the
    /// speed.
    fn errors(table: &Table, case: usize, rng: &mut Xoshiro256PlusPlus) -> Option<[f64; 3]> {
        let cue_ball = DVec2::new(-0.2, 0.1);
        let first = DVec2::new(rng.random_range(0.3..1.0), rng.random_range(-0.3..0.3));
        let observation = Observation::new(&Layout::new([cue_ball, first, DVec2::new(-1.0, -0.5)]), 2 * (case % 2));
        let mut action: [f32; 5] = std::array::from_fn(|_| rng.random_range(-0.7..0.7));
        action[1] = rng.random_range(0.0..1.0);
        let decoded = DecodedAction::of(table, action);
        let stroke = FirstContact::of(table, &decoded, first.distance(cue_ball));
        let cue = cue_inputs(table, &observation, action);
        assert!((strike(table, &cue).velocity.length() - stroke.speed.value).abs() < 1e-9);

        // The first ball is elsewhere, so that the cue ball runs on through its position.
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
            (passed - decoded.offset.value).abs(),
            (speed / stroke.speed_on_arrival.value - 1.0).abs(),
            (roll - stroke.roll_on_arrival.value).abs(),
        ])
    }

    #[test]
    fn the_predicted_arrival_matches_the_simulator() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            let mut all: Vec<_> = (0..400).filter_map(|case| errors(&table, case, &mut rng)).collect();
            assert!(all.len() > 300);
            for (index, (what, limit)) in [("position", 0.02), ("speed", 0.1), ("roll", 0.1)].into_iter().enumerate() {
                all.sort_by(|a, b| a[index].total_cmp(&b[index]));
                let typical = all[all.len() / 2][index];
                assert!(typical < limit, "{name}: the {what} is typically {typical} off");
            }
        }
    }
}
