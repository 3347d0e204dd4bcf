//! The cue ball's path to the first ball by a cushion, in closed form: it slides and rolls to the cushion, the cushion's law changes its
//! course and spin, and it slides and rolls on.

use glam::DVec2;

use super::{
    action::DecodedAction,
    dual::{Dual, DualVector},
    first_contact::{Approach, FirstContact, RAIL_FEATURES, TYPICAL_SPEED},
    observation::Observation,
};
use crate::{
    physics::{BallState, CueInputs, Cushion, Impulse, Motion, squirt, strike},
    simulation::{Constants, Segment},
    table::{Rail, Table},
};

/// Limit on the segments of a path between changes of motion; more than any path has.
const MAX_SEGMENTS: usize = 64;

/// Limits of the secant method for the aim: iterations, largest step, rad, and tolerance of the passing distance, m.
const MAX_ITERATIONS: usize = 6;
const MAX_STEP: f64 = 1.0;
const TOLERANCE: f64 = 1e-6;

/// Lower bound of the speed by which spins are divided, m/s, as in [`FirstContact`].
const MIN_SPEED: f64 = 0.05;

/// Parameters of a stroke on which the path depends: the direction in which the ball leaves the cue, rad on the table; cue speed, m/s;
/// tip to the left and up in the observation's frame, units of R; elevation, rad.
type Parameters = [f64; 5];

/// Steps of the finite differences along these parameters, each in its own unit.
const STEPS: Parameters = [1e-6, 1e-5, 1e-6, 1e-6, 1e-6];

/// Length of [`RailPath::numbers`].
const NUMBERS: usize = 9 + RAIL_FEATURES - 1;

/// The path of one stroke.
#[derive(Clone, Copy, Debug)]
struct RailPath {
    /// Distance at which the course passes the first ball's centre on the left, as seen in the observation, m.
    passed: f64,
    /// Numbers for the networks' features. Speed, roll, side and massé spin just after the cushion, defined as those just after a stroke in
    /// [`FirstContact`]; roll and speed on arrival; direction of the course on arrival; its turn since the cushion; then the features of a
    /// path by a cushion except the first.
    numbers: [f64; NUMBERS],
}

/// The paths by a cushion in an observation.
#[derive(Clone, Debug)]
pub struct RailFirstPaths<'a> {
    table: &'a Table,
    observation: &'a Observation,
    constants: Constants,
    cushion: Cushion,
    rail: Rail,
    /// The cue ball and the first ball on the table, m.
    balls: [DVec2; 2],
}

impl<'a> RailFirstPaths<'a> {
    /// Creates the paths by the cushion of an observation; `None` if its path is straight.
    pub fn of(table: &'a Table, observation: &'a Observation) -> Option<Self> {
        // Returns early, because most observations have no cushion.
        let rail = Rail::with_normal(observation.mirror * observation.rail?.normal());
        Some(Self {
            table,
            observation,
            constants: Constants::of(table),
            cushion: Cushion::of(table, rail),
            rail,
            balls: [observation.mirror * observation.cue, observation.mirror * observation.first],
        })
    }

    /// Returns the direction in which the ball must leave the cue, rad on the table, so that its course passes the first ball at the
    /// action's offset. If none is found, returns the direction for a cushion that reflects like a mirror.
    pub fn direction(&self, action: &DecodedAction) -> f64 {
        self.aim(action).map_or_else(|| self.mirror_direction(), |(parameters, _)| parameters[0])
    }

    /// Computes the cue ball's arrival, with slopes only if `slopes`; `None` if no direction is found.
    pub fn approach(&self, action: &DecodedAction, slopes: bool) -> Option<Approach> {
        let (parameters, path) = self.aim(action)?;
        let DecodedAction { speed, tip: [left, up], theta, offset } = *action;
        let numbers = if slopes {
            let partial = |index: usize| {
                let mut moved = parameters;
                moved[index] += STEPS[index];
                let moved_path = self.follow(&self.impulse(&moved), moved[0])?;
                let slope = |to: f64, from: f64| (to - from) / STEPS[index];
                let numbers = std::array::from_fn::<_, NUMBERS, _>(|n| slope(moved_path.numbers[n], path.numbers[n]));
                Some((slope(moved_path.passed, path.passed), numbers))
            };
            let [turned, rest @ ..] = [partial(0)?, partial(1)?, partial(2)?, partial(3)?, partial(4)?];
            // The slopes of the direction follow from those of the offset and the other parameters (implicit function theorem).
            let others = [speed, left, up, theta];
            let sum = |slopes: [f64; 4]| {
                let terms = others.into_iter().zip(slopes).map(|(along, slope)| along * slope);
                terms.fold(Dual::constant(0.0), |sum, term| sum + term)
            };
            let direction =
                (offset * (2.0 * self.table.radius) - sum(rest.map(|(passed, _)| passed))) * turned.0.recip();
            std::array::from_fn(|n| Dual {
                value: path.numbers[n],
                ..direction * turned.1[n] + sum(rest.map(|(_, numbers)| numbers[n]))
            })
        } else {
            path.numbers.map(Dual::constant)
        };
        let [speed, roll, side, masse, roll_on_arrival, speed_on_arrival, x, y, turn, features @ ..] = numbers;
        let (swerve, speed_on_arrival) = (Dual::constant(0.0), speed_on_arrival.at_least(MIN_SPEED));
        let contact = FirstContact { speed, roll, roll_on_arrival, side, masse, swerve, turn, speed_on_arrival };
        let mut by_rail = [Dual::constant(1.0); RAIL_FEATURES];
        by_rail[1..].copy_from_slice(&features);
        Some(Approach { contact, course: DualVector { x, y }, by_rail })
    }

    /// Returns the direction to the first ball's image in the cushion, rad.
    fn mirror_direction(&self) -> f64 {
        let [cue, first] = self.balls;
        (self.rail.image(self.constants.reach, first) - cue).to_angle()
    }

    /// Finds the stroke that passes the first ball at the action's offset, and its path, by the secant method from the mirror's direction.
    fn aim(&self, action: &DecodedAction) -> Option<(Parameters, RailPath)> {
        let DecodedAction { speed, tip: [left, up], theta, offset } = action;
        let at = |direction| [direction, speed.value, left.value, up.value, theta.value];
        let target = 2.0 * self.table.radius * offset.value;
        let impulse = self.impulse(&at(0.0));
        let mut direction = self.mirror_direction();
        let mut last: Option<(f64, f64)> = None;
        for _ in 0..MAX_ITERATIONS {
            let path = self.follow(&impulse, direction)?;
            let residual = path.passed - target;
            if residual.abs() < TOLERANCE {
                return Some((at(direction), path));
            }
            // The first slope has the opposite sign of that without a cushion, because the cushion reflects the change of direction.
            let slope = match last {
                Some((last_direction, last_residual)) => (residual - last_residual) / (direction - last_direction),
                None => -self.observation.side_on_table(self.observation.lines(self.table).to_first.distance),
            };
            last = Some((direction, residual));
            let step = residual / slope;
            if step.is_nan() || step.abs() > MAX_STEP {
                return None;
            }
            direction -= step;
        }
        None
    }

    /// Returns the stroke's impulse on a ball that leaves the cue along the x axis.
    fn impulse(&self, &[_, speed, left, up, theta]: &Parameters) -> Impulse {
        let a = self.observation.side_on_table(left);
        strike(self.table, &CueInputs { a, b: up, theta, phi: -squirt(self.table, a), speed })
    }

    /// Follows a ball that leaves the cue in this direction; `None` if it does not reach the first ball by the cushion.
    fn follow(&self, impulse: &Impulse, direction: f64) -> Option<RailPath> {
        let Self { constants, observation, balls: [cue, first], .. } = self;
        let n = self.rail.normal();
        let ahead = DVec2::from_angle(direction);
        let spin = ahead.rotate(impulse.spin.truncate()).extend(impulse.spin.z);
        let start = BallState { position: *cue, velocity: ahead.rotate(impulse.velocity), spin };
        let mut ball = self.advance_until(&start, |segment, duration| self.rail_contact(segment, duration))?;
        let (point, incoming) = (ball.position, ball.velocity);
        if n.perp().dot(point).abs() > n.perp().abs().dot(constants.reach) {
            return None;
        }
        self.cushion.resolve(constants.radius, n, &mut ball);
        let leaving = Moving::of(constants.radius, &ball)?;
        let ball = self.advance_until(&ball, |segment, duration| closest_approach(segment, duration, *first))?;
        let arriving = Moving::of(constants.radius, &ball)?;

        let mirror = |vector: DVec2| observation.mirror * vector;
        let handed = observation.side_on_table(1.0);
        let course = mirror(arriving.along);
        let rail_point = mirror(point) / constants.reach;
        let second = observation.mirror * observation.second;
        let free = |from: DVec2, to: DVec2, ball: DVec2| {
            let gap = distance_to(from, to, ball) / constants.diameter - 1.0;
            gap / (1.0 + gap.abs())
        };
        Some(RailPath {
            passed: handed * arriving.along.perp_dot(ball.position - *first),
            numbers: [
                leaving.speed,
                leaving.roll,
                handed * leaving.side,
                handed * leaving.masse,
                arriving.roll,
                arriving.speed,
                course.x,
                course.y,
                handed * leaving.along.perp_dot(arriving.along),
                handed * n.perp().dot(incoming.normalize_or_zero()),
                incoming.length() / TYPICAL_SPEED,
                rail_point.x,
                rail_point.y,
                free(*cue, point, *first),
                free(*cue, point, second),
                free(point, ball.position, second),
            ],
        })
    }

    /// Advances the ball until `end` returns a time within a segment, s, given the segment and its duration, s. `None` if the ball stops
    /// before.
    fn advance_until(&self, start: &BallState, end: impl Fn(&Segment, f64) -> Option<f64>) -> Option<BallState> {
        let (mut segment, mut duration) = Segment::free(&self.constants, 0.0, start);
        for _ in 0..MAX_SEGMENTS {
            if segment.motion == Motion::Stationary {
                return None;
            }
            if let Some(time) = end(&segment, duration) {
                return Some(segment.state_after(&self.constants, time));
            }
            (segment, duration) = segment.successor(&self.constants, duration);
        }
        None
    }

    /// Returns the time at which a segment reaches the cushion, s.
    fn rail_contact(&self, segment: &Segment, duration: f64) -> Option<f64> {
        let n = self.rail.normal();
        let gap = self.rail.gap(self.constants.reach, segment.position).max(0.0);
        let (approach, bend) = (-n.dot(segment.velocity), -n.dot(segment.half_acceleration));
        // The smallest non-negative root of gap = approach t + bend t².
        let discriminant = approach * approach + 4.0 * bend * gap;
        let root = approach + discriminant.max(0.0).sqrt();
        let time = 2.0 * gap / root;
        (discriminant >= 0.0 && root > 0.0 && time <= duration).then_some(time)
    }
}

/// Returns the time at which a ball on this segment is nearest to `point`, s; `None` if it still approaches `point` at the segment's end.
fn closest_approach(segment: &Segment, duration: f64, point: DVec2) -> Option<f64> {
    let ahead = |time: f64| (point - segment.position_after(time)).dot(segment.velocity_after(time));
    if ahead(duration) > 0.0 {
        return None;
    }
    let mut time = 0.0;
    for _ in 0..4 {
        let velocity = segment.velocity_after(time);
        let bend = 2.0 * segment.half_acceleration.dot(point - segment.position_after(time));
        time = (time + ahead(time) / (velocity.length_squared() - bend).max(1e-9)).clamp(0.0, duration);
    }
    Some(time)
}

/// A moving ball's direction, speed and spins; spins are surface speeds as shares of the speed.
struct Moving {
    along: DVec2,
    speed: f64,
    roll: f64,
    side: f64,
    masse: f64,
}

impl Moving {
    fn of(radius: f64, ball: &BallState) -> Option<Self> {
        let speed = ball.velocity.length();
        let along = ball.velocity.try_normalize()?;
        let spin = radius / speed.max(MIN_SPEED) * ball.spin;
        let horizontal = spin.truncate();
        Some(Self { along, speed, roll: along.perp().dot(horizontal), side: spin.z, masse: along.dot(horizontal) })
    }
}

/// Returns the distance of a point from the line segment between two others, m.
fn distance_to(from: DVec2, to: DVec2, point: DVec2) -> f64 {
    let span = to - from;
    let share = ((point - from).dot(span) / span.length_squared().max(1e-12)).clamp(0.0, 1.0);
    point.distance(from + share * span)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::{action::ACTIONS, paths::cue_inputs},
        simulation::{EventKind, Recording},
        table::Layout,
    };
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    fn action(rng: &mut Xoshiro256PlusPlus) -> [f32; ACTIONS] {
        let mut action = std::array::from_fn(|_| rng.random_range(-0.8..0.8));
        action[1] = rng.random_range(-0.4..1.0);
        action
    }

    /// Errors of the closed form against the simulator on arrival: position in ball diameters, speed as a share, direction in rad.
    /// `None` if no path is found, or if the cue ball hits another ball or cushion.
    fn errors(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Option<[f64; 3]> {
        let layout = Layout::random(table, rng);
        let observation = Observation::random(table, &layout, true, rng);
        let (paths, action) = (RailFirstPaths::of(table, &observation)?, action(rng));
        let decoded = DecodedAction::of(table, action);
        let Approach { contact, course, .. } = paths.approach(&decoded, false)?;
        // All other balls are out of the way, so that the cue ball runs on through the first ball's position.
        let [cue_ball, first] = paths.balls;
        let corners = [DVec2::ONE, DVec2::new(-1.0, 1.0)].map(|corner| corner * table.reach());
        let alone = Layout::new([cue_ball, corners[0], corners[1]]);
        let recording = Recording::new(table, &alone, &cue_inputs(table, &observation, action)).ok()?;
        let rails = recording.events().iter().filter(|event| !matches!(event.kind, EventKind::SlidingRolling(_)));
        let mut events = rails.map(|event| (event.time, event.kind));
        let (hit, kind) = events.next()?;
        if !matches!(kind, EventKind::BallRail(..)) {
            return None;
        }
        assert_eq!(kind, EventKind::BallRail(0, paths.rail), "{layout:?} {action:?}");
        let end = events.next().map_or(f64::MAX, |(time, _)| time);
        let time = (1..8000).map(|tick| hit + f64::from(tick) * 1e-3).find(|time| {
            let ball = recording.state(0, *time);
            (first - ball.position).dot(ball.velocity) <= 0.0
        })?;
        if time > end {
            return None;
        }
        let ball = recording.state(0, time);
        let handed = observation.side_on_table(1.0);
        let passed = handed * ball.velocity.normalize().perp_dot(ball.position - first) / (2.0 * table.radius);
        let course = DVec2::new(course.x.value, course.y.value);
        Some([
            (passed - decoded.offset.value).abs(),
            (ball.velocity.length() / contact.speed_on_arrival.value - 1.0).abs(),
            (observation.mirror * course).angle_to(ball.velocity).abs(),
        ])
    }

    #[test]
    fn the_predicted_arrival_by_a_cushion_matches_the_simulator() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(61);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            let all: Vec<_> = (0..4000).filter_map(|_| errors(&table, &mut rng)).collect();
            assert!(all.len() > 400, "{name}: {}", all.len());
            for (index, (what, limit)) in
                [("position", 1e-3), ("speed", 1e-2), ("direction", 1e-2)].into_iter().enumerate()
            {
                let mut one: Vec<f64> = all.iter().map(|errors| errors[index]).collect();
                one.sort_by(f64::total_cmp);
                let percentile = one[one.len() * 98 / 100];
                assert!(percentile < limit, "{name}: the {what} of 2 in 100 is more than {percentile} off");
            }
        }
    }
}
