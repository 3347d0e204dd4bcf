//! Energy that the frictions dissipate on balls pressed against cushions or each other, from their recorded courses.
//!
//! The accelerations determine the normal forces, and these and the slips the power of every friction. Its integral is computed
//! with five-point Gauss-Legendre quadrature on each stretch, exact to degree nine.

use super::{
    least_squares::{Column, Fit, SIZE, fit},
    motion::{about_vertical, centre, closed_contacts, directions, motion, on_cloth, reference_balls},
    on_cushion::OnCushion,
    uncertainty::RESTING_SPEED,
};
use crate::{
    physics::BallState,
    simulation::{Constants, Segment},
    statistics::dot,
    study::reference_engine::{Ball, Contact, Numbers},
    table::{BALLS, Table},
};

/// Slips and speeds below this at a stretch's start count as zero, m/s: a contact that sticks there sticks on the whole
/// stretch. It is the accuracy of the states...
const NO_SLIP: f64 = RESTING_SPEED;

/// ... unless the speed at the end exceeds this, m/s, where the interpolation of the course may be inaccurate.
const DEPARTED: f64 = 1e-5;

/// A rolling ball with a slip below this, as a share of `√(g R)`, may be at the edge of sliding: 1e-5 m/s on tables of usual
/// size.
const CREEPING: f64 = 2e-5;

/// If the unexplained share of the accelerations is at most this, no other explanation is tried: with one more resistance it is
/// not unique.
const EXPLAINED: f64 = 1e-4;

/// Relative accuracy of a friction at its limit, if the accelerations come from a recorded course.
const EDGE: f64 = 0.05;

/// Relative accuracy of the work from recorded courses: their spins are cubics between the ends of a piece, in which a slip may
/// decrease to a tenth. If the course obeys the laws at its ends but less well between them, the accuracy is the share of the
/// accelerations that no forces explain there, up to the second of these values.
const INTERPOLATED: [f64; 2] = [1e-3, 1e-2];

/// Nodes on `[-1, 1]` and weights of Gauss-Legendre quadrature.
const POINTS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Bounds of the work of the frictions, m²/s²; they are equal if the forces are unique.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    pub least: f64,
    pub most: f64,
}

/// Returns the work on the balls with a resting course, from time `from` to `until`, s. A contact is closed if its gap at both
/// ends is less than `gap`, m.
pub fn work(
    table: &Table,
    numbers: &Numbers<f64>,
    constants: &Constants,
    courses: &[Option<&Segment>; BALLS],
    (from, until): (f64, f64),
    gap: f64,
) -> Work {
    let mut members = courses.map(|course| course.is_some());
    let states = |now: f64| -> [BallState; BALLS] {
        std::array::from_fn(|ball| match courses[ball] {
            Some(course) => course.state_after(constants, now - course.start),
            None => BallState::at_rest(glam::DVec2::ZERO),
        })
    };
    let at_ends = [from, until].map(states);
    let ends = at_ends.map(|balls| motion(table.radius, &balls));
    let half = 0.5 * (until - from);
    // Between the ends a polynomial may deviate by as much as the gap of a closed contact.
    let at_ends = at_ends.map(|balls| reference_balls(&balls));
    let [mut contacts, stay] = at_ends.map(|balls| closed_contacts(numbers, &balls, gap));
    contacts.retain(|contact| contact.is_among(members) && stay.contains(contact));
    let mut sum = Work::default();
    for (ball, (member, state)) in members.iter_mut().zip(states(from)).enumerate() {
        let loss = member.then(|| on_one_cushion(table, numbers, ball, &contacts, &state, &ends, until - from));
        if let Some(loss) = loss.flatten() {
            (sum.least, sum.most) = (sum.least + loss, sum.most + loss);
            *member = false;
            contacts.retain(|contact| !contact.involves(ball));
        }
    }
    if members == [false; BALLS] {
        return sum;
    }
    // Two balls rotate about each other: the slip at an end depends on the normal there.
    let slip_at = |contact: &Contact, end: usize| {
        let [_, along_t, up] = directions(numbers, *contact, &at_ends[end]);
        size(&along(&[along_t, up], &ends[end]))
    };
    let slips = |contact: &Contact| (*contact, is_slip(slip_at(contact, 0), slip_at(contact, 1)));
    let contacts: Vec<(Contact, bool)> = contacts.iter().map(slips).collect();
    let power_at = |place: f64| {
        let now = from + half * (1.0 + place);
        let states = states(now);
        let rates = std::array::from_fn(|ball| match courses[ball].filter(|_| members[ball]) {
            Some(course) => rate(course, now - course.start),
            None => BallState::at_rest(glam::DVec2::ZERO),
        });
        let scene = Scene {
            table,
            numbers,
            members,
            balls: reference_balls(&states),
            speeds: motion(table.radius, &states),
            ends,
        };
        scene.power(&motion(table.radius, &rates), &contacts)
    };
    // The polynomials match the accelerations at the ends of a piece: wrong forces are wrong there as well.
    let [known, doubtful] = INTERPOLATED;
    let farthest = if [-1.0, 1.0].iter().all(|end| power_at(*end).defect <= EXPLAINED) { doubtful } else { known };
    for (place, weight) in POINTS {
        let power = power_at(place);
        let share = power.defect.clamp(known, farthest);
        sum.least += half * weight * (1.0 - share) * power.least;
        sum.most += half * weight * (1.0 + share) * power.most;
    }
    sum
}

/// Returns the work on a ball that slips on the cloth and is pressed against one cushion and nothing else; `None` for other
/// balls.
fn on_one_cushion(
    table: &Table,
    numbers: &Numbers<f64>,
    ball: usize,
    contacts: &[Contact],
    state: &BallState,
    ends: &[Column; 2],
    time: f64,
) -> Option<f64> {
    let mut own = contacts.iter().filter(|contact| contact.involves(ball));
    let (Some(contact @ Contact::Rail(_, rail)), None) = (own.next(), own.next()) else { return None };
    let [_, along, up] = directions(numbers, *contact, &reference_balls(&[*state; BALLS]));
    let (slides, rubs) = (slips(ends, &on_cloth(numbers, ball)), slips(ends, &[along, up]));
    // At the end of a spin, rounding leaves the other sign; at its beginning, there is no sign yet.
    let spin = about_vertical(numbers, ball);
    let spin_sign = if slips(ends, &[spin]) { (dot(&spin, &ends[0]) + dot(&spin, &ends[1])).signum() } else { 0.0 };
    let course = OnCushion { table, rail: *rail, slips: rubs, spin_sign };
    (slides && (rubs || spin_sign != 0.0)).then(|| course.loss(state, time))
}

/// Whether there is a speed along some directions, by its size at a stretch's start and end.
fn slips(ends: &[Column; 2], directions: &[Column]) -> bool {
    let [start, end] = [0, 1].map(|end: usize| size(&along(directions, &ends[end])));
    is_slip(start, end)
}

/// Whether speeds of these sizes at a stretch's start and end are a slip.
fn is_slip(start: f64, end: f64) -> bool {
    start > NO_SLIP || end > DEPARTED
}

/// Returns the speeds along some directions.
fn along(directions: &[Column], speeds: &Column) -> Vec<f64> {
    directions.iter().map(|direction| dot(direction, speeds)).collect()
}

fn size(along: &[f64]) -> f64 {
    along.iter().map(|along| along * along).sum::<f64>().sqrt()
}

/// Returns the rates of change of a state: velocity and accelerations.
fn rate(course: &Segment, t: f64) -> BallState {
    let ([p3, p4, p5], [s1, s2, s3]) =
        course.curve().map_or_else(Default::default, |curve| (curve.position, curve.spin));
    BallState {
        position: course.velocity_after(t),
        velocity: 2.0 * course.half_acceleration + t * (6.0 * p3 + t * (12.0 * p4 + 20.0 * t * p5)),
        spin: s1 + t * (2.0 * s2 + 3.0 * t * s3),
    }
}

/// Bounds of the power of the frictions at one time, m²/s³.
struct Power {
    least: f64,
    most: f64,
    /// The share of the accelerations that no forces explain.
    defect: f64,
    /// Whether every rolling resistance is between zero and its limit, and the friction of every ball at the edge of sliding is
    /// at its limit.
    is_possible: bool,
    /// Whether the solution is unique.
    is_unique: bool,
}

/// The balls at one time of a stretch.
struct Scene<'a> {
    table: &'a Table,
    numbers: &'a Numbers<f64>,
    members: [bool; BALLS],
    balls: [Ball<f64>; BALLS],
    speeds: Column,
    /// Speeds at the stretch's start and end.
    ends: [Column; 2],
}

impl Scene<'_> {
    /// Returns the speeds along some directions and their size; `None` if they vanish on the whole stretch.
    ///
    /// A slip in one direction with the same sign at both ends has this sign in between. When it decays, a cubic that fits both
    /// ends may fall below zero, which would reverse the friction.
    fn slip(&self, directions: &[Column]) -> Option<(Vec<f64>, f64)> {
        let mut now = along(directions, &self.speeds);
        if let ([direction], [speed]) = (directions, now.as_mut_slice()) {
            let [start, end] = [0, 1].map(|end: usize| dot(direction, &self.ends[end]));
            if start * end > 0.0 && start * *speed <= 0.0 {
                *speed = 0.5 * (start + end);
            }
        }
        let speed = size(&now);
        (speed > 0.0 && slips(&self.ends, directions)).then_some((now, speed))
    }

    /// Returns the power of all frictions, given for each contact whether it slips.
    fn power(&self, accelerations: &Column, contacts: &[(Contact, bool)]) -> Power {
        let without_edges = self.explained(accelerations, contacts, [false; BALLS], false);
        if without_edges.defect <= EXPLAINED {
            return without_edges;
        }
        let creeping: [bool; BALLS] = std::array::from_fn(|ball| self.members[ball] && self.creeps(ball));
        // Some balls may be at the edge of sliding while others roll.
        let at_edge = (1..1_usize << BALLS)
            .map(|some| -> [bool; BALLS] { std::array::from_fn(|ball| creeping[ball] && some >> ball & 1 == 1) })
            .filter(|balls| *balls != [false; BALLS]);
        let is_better = |at_edge: &Power| {
            at_edge.is_possible
                && 2.0 * at_edge.defect < without_edges.defect
                && (at_edge.is_unique || !without_edges.is_unique)
        };
        // The friction of a slip that has hardly begun acts against the rate of the slip, which may have another direction.
        // This is tried only if no interpolation explains the residual.
        let turns = if without_edges.defect > INTERPOLATED[1] { &[false, true][..] } else { &[false] };
        let ways = turns.iter().flat_map(|turns| at_edge.clone().map(|balls| (balls, *turns)));
        ways.map(|(balls, turns)| self.explained(accelerations, contacts, balls, turns))
            .find(is_better)
            .unwrap_or(without_edges)
    }

    /// Returns the power if all balls slide or roll, or if the balls `at_edge` of sliding have the rolling resistance that
    /// keeps them there. With `turns`, the direction of the cloth's friction on these balls does not depend on the slip.
    fn explained(
        &self,
        accelerations: &Column,
        contacts: &[(Contact, bool)],
        at_edge: [bool; BALLS],
        turns: bool,
    ) -> Power {
        let g = self.table.gravity;
        let numbers = self.numbers;
        let mut dissipated = 0.0;
        // The accelerations that the known frictions do not explain, and the unknown forces.
        let mut rest = *accelerations;
        let mut unknown: Vec<Column> = Vec::with_capacity(24);
        // Returns whether the friction sticks, so that its forces are unknown.
        let mut cloth = |unknown: &mut Vec<Column>, directions: &[Column], force: f64| {
            let Some((along, speed)) = self.slip(directions) else {
                unknown.extend_from_slice(directions);
                return true;
            };
            add(&mut rest, force / speed, &sum(directions, &along));
            dissipated += force * speed;
            false
        };
        let sliding = self.table.sliding_friction * g;
        // Indices of the frictions at their limit on balls at the edge of sliding, and the slips there.
        let mut strained: Vec<(usize, Vec<f64>)> = Vec::new();
        // Rolling resistances between zero and their limit.
        let mut creeping: Vec<Resistance> = Vec::new();
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            let holds = if at_edge[ball] && turns {
                unknown.extend(on_cloth(numbers, ball));
                true
            } else {
                cloth(&mut unknown, &on_cloth(numbers, ball), sliding)
            };
            let centre = centre(numbers, ball);
            let speed = size(&along(&centre, &self.speeds));
            let rolling = 1.4 * numbers.band(speed).deceleration;
            if at_edge[ball] {
                if holds {
                    strained.push((unknown.len() - 2, along(&on_cloth(numbers, ball), &self.speeds)));
                }
                if let Some((velocity, speed)) = self.slip(&centre) {
                    let against: Vec<f64> = velocity.iter().map(|part| -part / speed).collect();
                    creeping.push(Resistance { column: sum(&centre, &against), most: rolling, speed });
                }
            } else if holds {
                cloth(&mut unknown, &centre, rolling);
            }
            cloth(&mut unknown, &[about_vertical(numbers, ball)], self.table.spinning_friction * g);
        }
        let mut pushes: Vec<Push> = contacts.iter().map(|contact| self.push(contact)).collect();
        let size = |column: &Column| dot(column, column).sqrt();
        loop {
            // The normal forces come first, then the rolling resistances.
            let mut columns: Vec<Column> = pushes.iter().map(|push| push.column).collect();
            columns.extend(creeping.iter().map(|resistance| resistance.column));
            columns.extend(&unknown);
            columns.extend(pushes.iter().flat_map(|push| &push.sticks));
            let Fit { factors, residual, .. } = fit(&columns, &rest);
            let defect = size(&residual) / size(accelerations).max(f64::MIN_POSITIVE);
            let Some(forces) = factors else {
                // Forces that balance each other: none is larger than all accelerations and the cloth under all balls require.
                let largest = size(&rest) + BALLS as f64 * sliding;
                let prices: f64 = pushes.iter().map(|push| push.price).sum();
                let rolls: f64 = creeping.iter().map(|resistance| resistance.most * resistance.speed).sum();
                let most = dissipated + largest * prices + rolls;
                // The forces are not unique, but their dissipation is: nothing may drive the balls.
                let done: Column = std::array::from_fn(|place| rest[place] - residual[place]);
                let all = dissipated - dot(&self.speeds, &done);
                let crept: f64 = strained.iter().map(|(_, slip)| sliding * slip[0].hypot(slip[1])).sum();
                let is_possible = (1.0 - EDGE) * dissipated <= all && all <= (1.0 + EDGE) * (most + crept);
                return Power { least: dissipated, most, defect, is_possible, is_unique: false };
            };
            // A contact that would have to pull is open.
            let pulls = (0..pushes.len()).min_by(|a, b| forces[*a].total_cmp(&forces[*b]));
            if let Some(index) = pulls.filter(|&index| forces[index] < 0.0) {
                pushes.remove(index);
                continue;
            }
            let rubbed: f64 = pushes.iter().zip(&forces).map(|(push, force)| force * push.price).sum();
            let resistances = &forces[pushes.len()..][..creeping.len()];
            let holding = &forces[pushes.len() + creeping.len()..];
            let possible = |(law, force): (&Resistance, &f64)| (-EDGE..=1.0 + EDGE).contains(&(force / law.most));
            let is_possible = creeping.iter().zip(resistances).all(possible)
                && strained.iter().all(|(at, _)| {
                    let share = holding[*at].hypot(holding[at + 1]) / sliding;
                    (1.0 - EDGE..=1.0 + EDGE).contains(&share)
                });
            let crept: f64 =
                strained.iter().map(|(at, slip)| -(holding[*at] * slip[0] + holding[at + 1] * slip[1])).sum();
            let rolls: f64 =
                creeping.iter().zip(resistances).map(|(law, force)| force.clamp(0.0, law.most) * law.speed).sum();
            let all = dissipated + rubbed + rolls + crept;
            return Power { least: all, most: all, defect, is_possible, is_unique: true };
        }
    }

    /// Whether a ball's slip on the cloth has hardly begun and may not grow. With rolling resistance the friction would not
    /// hold the ball, and it would slip. Without the resistance, which ends with rolling, the friction would hold it. At such
    /// an edge the resistance has the value that keeps the ball there (Filippov).
    fn creeps(&self, ball: usize) -> bool {
        let most = CREEPING * (self.table.gravity * self.table.radius).sqrt();
        self.ends.iter().all(|end| size(&along(&on_cloth(self.numbers, ball), end)) <= most)
    }

    /// Returns the effect and the dissipation of a unit of a contact's normal force.
    fn push(&self, (contact, slips): &(Contact, bool)) -> Push {
        let [mut column, along_t, up] = directions(self.numbers, *contact, &self.balls);
        let slip = along(&[along_t, up], &self.speeds);
        let speed = size(&slip);
        match contact.friction(self.numbers) {
            Some(mu) if *slips && speed > 0.0 => {
                add(&mut column, -mu / speed, &sum(&[along_t, up], &slip));
                Push { column, price: mu * speed, sticks: Vec::new() }
            }
            _ => Push { column, price: 0.0, sticks: vec![along_t, up] },
        }
    }
}

/// A ball's rolling resistance, between zero and its limit.
struct Resistance {
    /// Effect of a unit of it.
    column: Column,
    /// Its limit, m/s²: 5/7 of it decelerate a ball that rolls.
    most: f64,
    /// The ball's speed, m/s.
    speed: f64,
}

/// A contact with a normal force.
struct Push {
    /// Effect of a unit of its normal force, and the power of the friction that belongs to it.
    column: Column,
    price: f64,
    /// The directions of its friction if it sticks.
    sticks: Vec<Column>,
}

/// Returns the sum of the directions times the speeds along them.
fn sum(directions: &[Column], along: &[f64]) -> Column {
    let mut sum = [0.0; SIZE];
    directions.iter().zip(along).for_each(|(direction, along)| add(&mut sum, *along, direction));
    sum
}

fn add(to: &mut Column, factor: f64, direction: &Column) {
    to.iter_mut().zip(direction).for_each(|(to, direction)| *to += factor * direction);
}
