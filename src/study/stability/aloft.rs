//! What must hold in a shot in which balls fly: the same as on the cloth, in space.
//!
//! Between two landings a centre's course is a parabola in space, so that the least distances are bounded as on the cloth.

use glam::DVec3;

use super::{
    figures::Figures,
    invariants::PRECISION,
    polynomial::{MAX_DEGREE, least},
    shot::Shot,
    trace::{Piece, Trace},
};
use crate::{
    physics::{Cushions, Motion},
    simulation::{Constants, EventKind, Rail},
    table::{BALLS, PAIRS, Table},
};

/// Landings of one course that are looked at: after so many the hops of the liveliest cloth are lower than an atom.
const MOST_LANDINGS: u32 = 4000;

/// A part of a course that is one polynomial.
struct Stretch {
    begin: f64,
    end: f64,
    /// Coefficients of the place about the beginning, m.
    place: [DVec3; 6],
    motion: Motion,
}

impl Stretch {
    fn at(&self, time: f64) -> DVec3 {
        let t = time - self.begin;
        self.place.iter().rev().fold(DVec3::ZERO, |sum, c| sum * t + *c)
    }

    /// Coefficients about another time.
    fn about(&self, time: f64) -> [DVec3; 6] {
        let (mut c, shift) = (self.place, time - self.begin);
        for low in 0..5 {
            for power in (low..5).rev() {
                let above = c[power + 1];
                c[power] += shift * above;
            }
        }
        c
    }
}

fn stretches(table: &Table, pieces: &[Piece]) -> Vec<Stretch> {
    let mut found = Vec::new();
    for Piece { segment, end } in pieces {
        let motion = segment.motion;
        let Some(hops) = segment.hops() else {
            let place = segment.coefficients().map(|c| c.extend(0.0));
            found.push(Stretch { begin: segment.start, end: *end, place, motion });
            continue;
        };
        for landings in 0..MOST_LANDINGS {
            let arc = hops.arc(landings);
            let begin = segment.start + arc.begin;
            if begin >= *end {
                break;
            }
            let end = end.min(segment.start + arc.end);
            let fall = DVec3::new(0.0, 0.0, -0.5 * table.gravity);
            let place = [arc.position, arc.velocity, fall, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO];
            found.push(Stretch { begin, end, place, motion });
        }
    }
    found
}

/// Measures a shot in which a ball has flown; what needs no space has been measured.
pub(super) fn measure(table: &Table, shot: &Shot, trace: &Trace, figures: &mut Figures) {
    let balls: [Vec<Stretch>; BALLS] = std::array::from_fn(|ball| stretches(table, &trace.pieces[ball]));
    for (ball, stretches) in balls.iter().enumerate() {
        let mut last = shot.layout.balls[ball].extend(0.0);
        for stretch in stretches {
            // A ball that has left the table is where it did, seen from above.
            let off = stretch.motion == Motion::OffTable;
            let begins = if off { stretch.place[0].with_z(last.z) } else { stretch.place[0] };
            figures.jump.note(last.distance(begins), stretch.begin);
            last = stretch.at(stretch.end);
            outside(table, &trace.constants, stretch, figures);
        }
    }
    for (first, second) in PAIRS {
        overlaps(table, &balls[first], &balls[second], figures);
    }
    contacts(table, trace, &balls, figures);
}

/// How far a stretch leads into a cushion: on the cloth beyond the ball's reach, in the air nearer to the nose than a radius.
fn outside(table: &Table, constants: &Constants, stretch: &Stretch, figures: &mut Figures) {
    if stretch.motion == Motion::OffTable {
        return;
    }
    let cushions = Cushions::of(table);
    for rail in Rail::ALL {
        let n = rail.normal();
        let [sine, cosine] = cushions.at(rail).nose().map(|share| share * table.radius);
        let mut inwards = stretch.place.map(|c| c.truncate().dot(n));
        inwards[0] += n.abs().dot(constants.reach);
        let lasts = stretch.end - stretch.begin;
        if stretch.motion != Motion::Flying {
            let found = least(&inwards, lasts, PRECISION);
            figures.outside.note(-found.value, stretch.begin + found.at);
            continue;
        }
        // From the nose to the centre: how far in, how far up.
        let [x, v, _, ..] = inwards;
        let [z, w, k, ..] = stretch.place.map(|c| c.z);
        let (x, z) = (x + cosine, z - sine);
        let gap = [
            x * x + z * z - table.radius * table.radius,
            2.0 * (x * v + z * w),
            v * v + w * w + 2.0 * z * k,
            2.0 * w * k,
            k * k,
        ];
        let found = least(&gap, lasts, 2.0 * table.radius * PRECISION);
        if x + v * found.at > 0.0 {
            figures.outside.note(-found.value / (2.0 * table.radius), stretch.begin + found.at);
        }
    }
}

/// How deep two balls overlap.
fn overlaps(table: &Table, first: &[Stretch], second: &[Stretch], figures: &mut Figures) {
    let diameter = 2.0 * table.radius;
    let (mut i, mut j) = (0, 0);
    while let (Some(one), Some(other)) = (first.get(i), second.get(j)) {
        let (from, until) = (one.begin.max(other.begin), one.end.min(other.end));
        let still = one.motion == Motion::Stationary && other.motion == Motion::Stationary;
        let off = one.motion == Motion::OffTable || other.motion == Motion::OffTable;
        if until > from && !off && !(still && from > 0.0) {
            let (c1, c2) = (one.about(from), other.about(from));
            let d: [DVec3; 6] = std::array::from_fn(|power| c1[power] - c2[power]);
            let time = until - from;
            let reach = d[1..].iter().rev().fold(0.0, |sum, c| (sum + c.length()) * time);
            if d[0].length() - diameter <= reach {
                let mut gap = [0.0; MAX_DEGREE + 1];
                for (i, a) in d.iter().enumerate() {
                    for (j, b) in d.iter().enumerate() {
                        gap[i + j] += a.dot(*b);
                    }
                }
                gap[0] = (d[0].length() - diameter) * (d[0].length() + diameter);
                let found = least(&gap, time, 2.0 * diameter * PRECISION);
                figures.overlap.note(-found.value / (2.0 * diameter), from + found.at);
            }
        }
        if one.end <= other.end {
            i += 1;
        }
        if other.end <= one.end {
            j += 1;
        }
    }
}

/// What is told to collide touches.
fn contacts(table: &Table, trace: &Trace, balls: &[Vec<Stretch>; BALLS], figures: &mut Figures) {
    let cushions = Cushions::of(table);
    let place = |ball: usize, time: f64| {
        let list = &balls[ball];
        let index = list.partition_point(|stretch| stretch.end < time);
        list.get(index).map_or(trace.end.balls[ball].position.extend(0.0), |stretch| stretch.at(time))
    };
    for event in trace.events.iter().filter(|event| event.time < trace.kept_until) {
        let apart = match event.kind {
            EventKind::BallBall(first, second) => {
                place(first, event.time).distance(place(second, event.time)) - 2.0 * table.radius
            }
            EventKind::BallRail(ball, rail) => {
                let [sine, cosine] = cushions.at(rail).nose().map(|share| share * table.radius);
                let (n, centre) = (rail.normal(), place(ball, event.time));
                let inwards = n.abs().dot(trace.constants.reach) + centre.truncate().dot(n) + cosine;
                inwards.hypot(centre.z - sine) - table.radius
            }
            _ => continue,
        };
        figures.apart.note(apart.abs(), event.time);
    }
}
