//! The cue ball's way to the first ball by a cushion, in closed form: it slides and rolls to the cushion, the cushion's law gives it
//! another course and spin, and it slides and rolls on.

use glam::DVec2;

use super::{
    action::Meaning,
    dual::{Dual, DualVector},
    first_contact::{Approach, FirstContact, RAIL_FEATURES, TYPICAL_SPEED},
    observation::Observation,
};
use crate::{
    physics::{BallState, CueInputs, Cushions, Impulse, Motion, squirt, strike},
    simulation::{Constants, Segment},
    table::{Rail, Table},
};

/// Stretches between changes of motion after which a way is given up: more than any has.
const MOST_STRETCHES: usize = 64;

/// Turns of the aim that are tried at most, how far one may go, rad, and how near the course must pass, m.
const MOST_TURNS: usize = 6;
const FURTHEST_TURN: f64 = 1.0;
const NEAR_ENOUGH: f64 = 1e-6;

/// Speed below which shares of it are those of this one, m/s, as in [`FirstContact`].
const SLOWEST: f64 = 0.05;

/// What a way depends on: the direction in which the ball leaves the cue, rad on the table; cue speed, m/s; tip to the left and up in
/// the observation's frame, units of R; elevation, rad.
type Chosen = [f64; 5];

/// Steps by which the slopes along these are found, each in its own unit.
const STEPS: Chosen = [1e-6, 1e-5, 1e-6, 1e-6, 1e-6];

/// What a way comes to; [`Way::numbers`] and their slopes are what networks are told.
const NUMBERS: usize = 9 + RAIL_FEATURES - 1;

/// The way of one stroke.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// How far the course passes the first ball's centre on the left, as seen in the observation, m.
    passed: f64,
    /// Speed, roll, side and massé spin just after the cushion as those just after a stroke in [`FirstContact`], roll and speed on
    /// arrival, direction of the course on arrival, its turn since the cushion; then the features of the way by a cushion but the first.
    numbers: [f64; NUMBERS],
}

/// Ways by a cushion in an observation.
#[derive(Clone, Debug)]
pub struct ByRail<'a> {
    table: &'a Table,
    observation: &'a Observation,
    constants: Constants,
    cushions: Cushions,
    rail: Rail,
    /// The cue ball and the first ball on the table, m.
    balls: [DVec2; 2],
}

impl<'a> ByRail<'a> {
    /// Ways by the cushion of an observation, if it has one.
    pub fn of(table: &'a Table, observation: &'a Observation) -> Option<Self> {
        // Most observations have none: nothing is worked out for them.
        let rail = Rail::with_normal(observation.mirror * observation.rail?.normal());
        Some(Self {
            table,
            observation,
            constants: Constants::of(table),
            cushions: Cushions::of(table),
            rail,
            balls: [observation.mirror * observation.cue, observation.mirror * observation.first],
        })
    }

    /// The direction in which the ball leaves the cue, rad on the table, so that its course passes the first ball at the action's
    /// offset; where none is found, the one in which it would if the cushion were a mirror.
    pub fn direction(&self, action: &Meaning) -> f64 {
        self.aim(action).map_or_else(|| self.mirrored(), |(chosen, _)| chosen[0])
    }

    /// How the cue ball arrives, with slopes only where they are asked for; `None` where no direction is found.
    pub fn approach(&self, action: &Meaning, slopes: bool) -> Option<Approach> {
        let (chosen, way) = self.aim(action)?;
        let Meaning { speed, tip: [left, up], theta, offset } = *action;
        let numbers = if slopes {
            let partial = |index: usize| {
                let mut moved = chosen;
                moved[index] += STEPS[index];
                let there = self.follow(&self.impulse(&moved), moved[0])?;
                let slope = |to: f64, from: f64| (to - from) / STEPS[index];
                let numbers = std::array::from_fn::<_, NUMBERS, _>(|n| slope(there.numbers[n], way.numbers[n]));
                Some((slope(there.passed, way.passed), numbers))
            };
            let [turned, rest @ ..] = [partial(0)?, partial(1)?, partial(2)?, partial(3)?, partial(4)?];
            // The direction follows from the offset and the others (implicit function theorem).
            let others = [speed, left, up, theta];
            let sum = |slopes: [f64; 4]| {
                let terms = others.into_iter().zip(slopes).map(|(along, slope)| along * slope);
                terms.fold(Dual::constant(0.0), |sum, term| sum + term)
            };
            let direction =
                (offset * (2.0 * self.table.radius) - sum(rest.map(|(passed, _)| passed))) * turned.0.recip();
            std::array::from_fn(|n| Dual {
                value: way.numbers[n],
                ..direction * turned.1[n] + sum(rest.map(|(_, numbers)| numbers[n]))
            })
        } else {
            way.numbers.map(Dual::constant)
        };
        let [speed, roll, side, masse, roll_on_arrival, speed_on_arrival, x, y, turn, told @ ..] = numbers;
        let (swerve, speed_on_arrival) = (Dual::constant(0.0), speed_on_arrival.at_least(SLOWEST));
        let contact = FirstContact { speed, roll, roll_on_arrival, side, masse, swerve, turn, speed_on_arrival };
        let mut by_rail = [Dual::constant(1.0); RAIL_FEATURES];
        by_rail[1..].copy_from_slice(&told);
        Some(Approach { contact, course: DualVector { x, y }, by_rail })
    }

    /// The direction to the first ball's image in the cushion.
    fn mirrored(&self) -> f64 {
        let [cue, first] = self.balls;
        (self.rail.image(self.constants.reach, first) - cue).to_angle()
    }

    /// The stroke that passes the first ball at the action's offset, and its way, by the secant method from the mirror's direction.
    fn aim(&self, action: &Meaning) -> Option<(Chosen, Way)> {
        let Meaning { speed, tip: [left, up], theta, offset } = action;
        let at = |direction| [direction, speed.value, left.value, up.value, theta.value];
        let wanted = 2.0 * self.table.radius * offset.value;
        let impulse = self.impulse(&at(0.0));
        let mut direction = self.mirrored();
        let mut last: Option<(f64, f64)> = None;
        for _ in 0..MOST_TURNS {
            let way = self.follow(&impulse, direction)?;
            let off = way.passed - wanted;
            if off.abs() < NEAR_ENOUGH {
                return Some((at(direction), way));
            }
            // A course that has met a cushion turns the other way.
            let slope = match last {
                Some((before, was_off)) => (off - was_off) / (direction - before),
                None => -self.observation.side_on_table(self.observation.lines(self.table).to_first.distance),
            };
            last = Some((direction, off));
            let turn = off / slope;
            if turn.is_nan() || turn.abs() > FURTHEST_TURN {
                return None;
            }
            direction -= turn;
        }
        None
    }

    /// The stroke's impulse on a ball that leaves the cue along the x axis.
    fn impulse(&self, &[_, speed, left, up, theta]: &Chosen) -> Impulse {
        let a = self.observation.side_on_table(left);
        strike(self.table, &CueInputs { a, b: up, theta, phi: -squirt(self.table, a), speed })
    }

    /// The way of a ball that leaves the cue in this direction.
    fn follow(&self, impulse: &Impulse, direction: f64) -> Option<Way> {
        let Self { constants, observation, balls: [cue, first], .. } = self;
        let n = self.rail.normal();
        let ahead = DVec2::from_angle(direction);
        let spin = ahead.rotate(impulse.spin.truncate()).extend(impulse.spin.z);
        let start = BallState { position: *cue, velocity: ahead.rotate(impulse.velocity), spin };
        let mut ball = self.until(&start, |segment, lasts| self.meets_rail(segment, lasts))?;
        let (point, incoming) = (ball.position, ball.velocity);
        if n.perp().dot(point).abs() > n.perp().abs().dot(constants.reach) {
            return None;
        }
        self.cushions.at(self.rail).resolve(constants.radius, n, &mut ball);
        let leaving = Moving::of(constants.radius, &ball)?;
        let ball = self.until(&ball, |segment, lasts| comes_by(segment, lasts, *first))?;
        let arriving = Moving::of(constants.radius, &ball)?;

        let mirror = |vector: DVec2| observation.mirror * vector;
        let handed = observation.side_on_table(1.0);
        let course = mirror(arriving.along);
        let place = mirror(point) / constants.reach;
        let second = observation.mirror * observation.second;
        let free = |from: DVec2, to: DVec2, ball: DVec2| {
            let gap = distance_to(from, to, ball) / constants.diameter - 1.0;
            gap / (1.0 + gap.abs())
        };
        Some(Way {
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
                place.x,
                place.y,
                free(*cue, point, *first),
                free(*cue, point, second),
                free(point, ball.position, second),
            ],
        })
    }

    /// The ball's state where `end` says that a stretch of its course is over, given the stretch and how long it can last, s.
    fn until(&self, start: &BallState, end: impl Fn(&Segment, f64) -> Option<f64>) -> Option<BallState> {
        let (mut segment, mut lasts) = Segment::free(&self.constants, 0.0, start);
        for _ in 0..MOST_STRETCHES {
            if segment.motion == Motion::Stationary {
                return None;
            }
            if let Some(time) = end(&segment, lasts) {
                return Some(segment.state_after(&self.constants, time));
            }
            (segment, lasts) = segment.successor(&self.constants, lasts);
        }
        None
    }

    /// When a stretch ends at the cushion, s.
    fn meets_rail(&self, segment: &Segment, lasts: f64) -> Option<f64> {
        let n = self.rail.normal();
        let gap = (n.dot(segment.position) + n.abs().dot(self.constants.reach)).max(0.0);
        let (approach, bend) = (-n.dot(segment.velocity), -n.dot(segment.half_acceleration));
        // gap = approach t + bend t², the first time that is no less than 0.
        let inside = approach * approach + 4.0 * bend * gap;
        let root = approach + inside.max(0.0).sqrt();
        let time = 2.0 * gap / root;
        (inside >= 0.0 && root > 0.0 && time <= lasts).then_some(time)
    }
}

/// When a ball on this stretch is as near to `place` as it comes, s.
fn comes_by(segment: &Segment, lasts: f64, place: DVec2) -> Option<f64> {
    let ahead = |time: f64| (place - segment.position_after(time)).dot(segment.velocity_after(time));
    if ahead(lasts) > 0.0 {
        return None;
    }
    let mut time = 0.0;
    for _ in 0..4 {
        let velocity = segment.velocity_after(time);
        let bend = 2.0 * segment.half_acceleration.dot(place - segment.position_after(time));
        time = (time + ahead(time) / (velocity.length_squared() - bend).max(1e-9)).clamp(0.0, lasts);
    }
    Some(time)
}

/// A moving ball's speeds, those of its spin as shares of its own.
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
        let spin = radius / speed.max(SLOWEST) * ball.spin;
        let level = spin.truncate();
        Some(Self { along, speed, roll: along.perp().dot(level), side: spin.z, masse: along.dot(level) })
    }
}

/// Distance of a point from the straight way between two others, m.
fn distance_to(from: DVec2, to: DVec2, point: DVec2) -> f64 {
    let way = to - from;
    let share = ((point - from).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
    point.distance(from + share * way)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::{action::ACTIONS, ways::cue_inputs},
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

    /// How far the simulator's cue ball is on arrival from what is told: place in ball diameters, speed as a share, direction in rad.
    /// `None` where no way is told, or another ball or cushion is met.
    fn errors(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Option<[f64; 3]> {
        let layout = Layout::random(table, rng);
        let observation = Observation::random(table, &layout, true, rng);
        let (ways, action) = (ByRail::of(table, &observation)?, action(rng));
        let meaning = Meaning::of(table, action);
        let Approach { contact, course, .. } = ways.approach(&meaning, false)?;
        // The cue ball runs on where the first ball would lie, the others are out of its way.
        let [cue_ball, first] = ways.balls;
        let corners = [DVec2::ONE, DVec2::new(-1.0, 1.0)].map(|corner| corner * table.reach());
        let alone = Layout::new([cue_ball, corners[0], corners[1]]);
        let recording = Recording::new(table, &alone, &cue_inputs(table, &observation, action)).ok()?;
        let rails = recording.events().iter().filter(|event| !matches!(event.kind, EventKind::SlidingRolling(_)));
        let mut events = rails.map(|event| (event.time, event.kind));
        let (hit, kind) = events.next()?;
        if !matches!(kind, EventKind::BallRail(..)) {
            return None;
        }
        assert_eq!(kind, EventKind::BallRail(0, ways.rail), "{layout:?} {action:?}");
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
            (passed - meaning.offset.value).abs(),
            (ball.velocity.length() / contact.speed_on_arrival.value - 1.0).abs(),
            (observation.mirror * course).angle_to(ball.velocity).abs(),
        ])
    }

    #[test]
    fn the_cue_ball_arrives_by_the_cushion_as_the_simulator_says() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(61);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            let all: Vec<_> = (0..4000).filter_map(|_| errors(&table, &mut rng)).collect();
            assert!(all.len() > 400, "{name}: {}", all.len());
            for (index, (what, limit)) in
                [("place", 1e-3), ("speed", 1e-2), ("direction", 1e-2)].into_iter().enumerate()
            {
                let mut one: Vec<f64> = all.iter().map(|errors| errors[index]).collect();
                one.sort_by(f64::total_cmp);
                let usual = one[one.len() * 98 / 100];
                assert!(usual < limit, "{name}: the {what} of 2 in 100 is more than {usual} off");
            }
        }
    }
}
