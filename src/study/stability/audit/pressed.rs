//! What the frictions take from balls that are pressed against cushions or each other, from their recorded courses.
//!
//! The accelerations tell the normal forces, and with them and the slips every friction's power is known. Its integral is
//! taken by five points of Gauss and Legendre on each stretch, exact to degree nine.

use super::{
    laws::friction,
    least_squares::{Column, dot, fit},
    motion::{Contact, about_vertical, centre, motion, on_cloth},
    on_cushion::OnCushion,
};
use crate::{
    physics::BallState,
    simulation::{Constants, Segment},
    table::{BALLS, Table},
};

/// Slips and speeds below this at a stretch's start count as none, m/s: what sticks there sticks on the way. It is ten times
/// what the states are right to...
const NO_SLIP: f64 = 1e-9;

/// ... unless it is faster than this at the end, m/s, where the course's interpolation may be off.
const DEPARTED: f64 = 1e-5;

/// Share to which the work is known where it is taken from the recorded courses: their spins are cubics between the ends
/// of a piece, in which a slip may fall to a tenth.
const INTERPOLATED: f64 = 1e-3;

/// Places on `[-1, 1]` and weights of Gauss' and Legendre's rule.
const POINTS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Between which bounds the work of the frictions lies, m²/s²: they are one where the forces are unique.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    pub least: f64,
    pub most: f64,
}

/// The work on the balls that have a resting course, from time `from` to `until`, s; contacts are closed where the gap is
/// less than `gap`, m.
pub fn work(
    table: &Table,
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
    let ends = [from, until].map(|now| motion(table.radius, &states(now)));
    let half = 0.5 * (until - from);
    let mut contacts = Contact::all(table.radius, constants.reach, &states(from + half), gap);
    contacts.retain(|contact| members[contact.first] && contact.second.is_none_or(|second| members[second]));
    let mut sum = Work::default();
    for (ball, (member, state)) in members.iter_mut().zip(states(from)).enumerate() {
        let loss = member.then(|| on_one_cushion(table, ball, &contacts, &state, &ends, until - from));
        if let Some(loss) = loss.flatten() {
            (sum.least, sum.most) = (sum.least + loss, sum.most + loss);
            *member = false;
            contacts.retain(|contact| contact.first != ball);
        }
    }
    if members == [false; BALLS] {
        return sum;
    }
    for (place, weight) in POINTS {
        let now = from + half * (1.0 + place);
        let states = states(now);
        let rates = std::array::from_fn(|ball| match courses[ball] {
            Some(course) => rate(course, now - course.start),
            None => states[ball],
        });
        let contacts: Vec<Contact> = contacts.iter().map(|contact| contact.at(&states)).collect();
        let speeds = motion(table.radius, &states);
        let scene = Scene { table, members, speeds, ends };
        let power = scene.power(&motion(table.radius, &rates), &contacts);
        sum.least += half * weight * (1.0 - INTERPOLATED) * power.least;
        sum.most += half * weight * (1.0 + INTERPOLATED) * power.most;
    }
    sum
}

/// The work on a ball that slips on the cloth and is pressed against one cushion and nothing else.
fn on_one_cushion(
    table: &Table,
    ball: usize,
    contacts: &[Contact],
    state: &BallState,
    ends: &[Column; 2],
    time: f64,
) -> Option<f64> {
    let mut own = contacts.iter().filter(|contact| contact.first == ball || contact.second == Some(ball));
    let (Some(contact @ Contact { second: None, normal, .. }), None) = (own.next(), own.next()) else { return None };
    let [_, along, up] = contact.directions();
    let (slides, rubs) = (slips(ends, &on_cloth(ball)), slips(ends, &[along, up]));
    // Where a spin ends, rounding leaves the other sign; where it begins, it has none yet.
    let spin = about_vertical(ball);
    let turning = if slips(ends, &[spin]) { (dot(&spin, &ends[0]) + dot(&spin, &ends[1])).signum() } else { 0.0 };
    let course = OnCushion { table, normal: *normal, slips: rubs, turning };
    (slides && (rubs || turning != 0.0)).then(|| course.loss(state, time))
}

/// Whether there is a speed along some directions, by its size at a stretch's start and end.
fn slips(ends: &[Column; 2], directions: &[Column]) -> bool {
    let [start, end] = [0, 1].map(|end: usize| size(&along(directions, &ends[end])));
    start > NO_SLIP || end > DEPARTED
}

/// The speeds along some directions.
fn along(directions: &[Column], speeds: &Column) -> Vec<f64> {
    directions.iter().map(|direction| dot(direction, speeds)).collect()
}

fn size(along: &[f64]) -> f64 {
    along.iter().map(|along| along * along).sum::<f64>().sqrt()
}

/// Accelerations as if they were velocities.
fn rate(course: &Segment, t: f64) -> BallState {
    let ([p3, p4, p5], [s1, s2, s3]) =
        course.curve().map_or_else(Default::default, |curve| (curve.position, curve.spin));
    BallState {
        position: course.velocity_after(t),
        velocity: 2.0 * course.half_acceleration + t * (6.0 * p3 + t * (12.0 * p4 + 20.0 * t * p5)),
        spin: s1 + t * (2.0 * s2 + 3.0 * t * s3),
    }
}

/// The balls at one moment of a stretch.
struct Scene<'a> {
    table: &'a Table,
    members: [bool; BALLS],
    speeds: Column,
    /// Speeds at the stretch's start and end.
    ends: [Column; 2],
}

impl Scene<'_> {
    /// The speeds along some directions and their size, unless they vanish on the whole stretch.
    fn slip(&self, directions: &[Column]) -> Option<(Vec<f64>, f64)> {
        let now = along(directions, &self.speeds);
        let speed = size(&now);
        (speed > 0.0 && slips(&self.ends, directions)).then_some((now, speed))
    }

    /// The power of all frictions.
    fn power(&self, accelerations: &Column, contacts: &[Contact]) -> Work {
        let g = self.table.gravity;
        let mut taken = 0.0;
        // What the known frictions leave of the accelerations, and what unknown forces there are.
        let mut rest = *accelerations;
        let mut unknown: Vec<Column> = Vec::with_capacity(24);
        let mut cloth = |directions: &[Column], force: f64| {
            let Some((along, speed)) = self.slip(directions) else {
                unknown.extend_from_slice(directions);
                return false;
            };
            directions
                .iter()
                .zip(along)
                .for_each(|(direction, along)| add(&mut rest, force * along / speed, direction));
            taken += force * speed;
            true
        };
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            if !cloth(&on_cloth(ball), self.table.sliding_friction * g) {
                cloth(&centre(ball), self.table.rolling_friction * g);
            }
            cloth(&[about_vertical(ball)], self.table.spinning_friction * g);
        }
        // The normal forces come first, each with what a unit of it takes.
        let mut columns = Vec::with_capacity(3 * contacts.len() + unknown.len());
        let mut prices = Vec::with_capacity(contacts.len());
        for contact in contacts {
            let [mut push, along, up] = contact.directions();
            let mut price = 0.0;
            match (friction(self.table, contact), self.slip(&[along, up])) {
                (Some(mu), Some((slip, speed))) => {
                    slip.iter().zip([along, up]).for_each(|(slip, along)| add(&mut push, -mu * slip / speed, &along));
                    price = mu * speed;
                }
                _ => unknown.extend([along, up]),
            }
            prices.push(price);
            columns.push(push);
        }
        if prices.iter().all(|price| *price == 0.0) {
            return Work { least: taken, most: taken };
        }
        columns.extend(unknown);
        if let Some(forces) = fit(&columns, &rest).factors {
            let rubbed: f64 = forces.iter().zip(&prices).map(|(force, price)| force.max(0.0) * price).sum();
            return Work { least: taken + rubbed, most: taken + rubbed };
        }
        // Forces that hold each other: none is larger than what all accelerations and the cloth under all balls ask for.
        let largest = dot(&rest, &rest).sqrt() + BALLS as f64 * self.table.sliding_friction * g;
        Work { least: taken, most: taken + largest * prices.iter().sum::<f64>() }
    }
}

fn add(to: &mut Column, factor: f64, direction: &Column) {
    to.iter_mut().zip(direction).for_each(|(to, direction)| *to += factor * direction);
}
