//! Checks the positions of balls on their whole courses, not at samples.
//!
//! Between two changes or two landings, a ball's centre follows a polynomial in time, and so does the squared distance of two
//! balls. Its minimum on the interval is bounded by its Bernstein coefficients ([`super::polynomial`]).

use glam::DVec3;

use super::{
    figures::Figures,
    finding::Shot,
    polynomial::{MAX_DEGREE, least},
    trace::{Piece, Trace},
};
use crate::{
    physics::{ImpactLaw, Motion},
    simulation::{Constants, EventKind, Rail},
    table::{BALLS, PAIRS, Table},
};

/// Precision of the smallest distance, m: a thousandth of the limit.
const PRECISION: f64 = 1e-12;

/// Maximum number of checked landings of one course: after as many, the hops on the liveliest cloth are lower than an atom.
const MAX_LANDINGS: u32 = 4000;

/// A part of a course with one polynomial.
struct Stretch {
    begin: f64,
    end: f64,
    /// Coefficients of the position about the beginning, m.
    place: [DVec3; 6],
    /// Number of non-zero coefficients.
    terms: usize,
    motion: Motion,
}

impl Stretch {
    fn at(&self, time: f64) -> DVec3 {
        let t = time - self.begin;
        self.place.iter().rev().fold(DVec3::ZERO, |sum, c| sum * t + *c)
    }

    /// Returns the coefficients about another time.
    fn about(&self, time: f64) -> [DVec3; 6] {
        let (mut c, shift) = (self.place, time - self.begin);
        if shift != 0.0 {
            // Repeated synthetic division.
            for low in 0..self.terms - 1 {
                for power in (low..self.terms - 1).rev() {
                    let above = c[power + 1];
                    c[power] += shift * above;
                }
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
            let terms = if segment.curve().is_some() { 6 } else { 3 };
            found.push(Stretch { begin: segment.start, end: *end, place, terms, motion });
            continue;
        };
        for landings in 0..MAX_LANDINGS {
            let arc = hops.arc(landings);
            let begin = segment.start + arc.begin;
            if begin >= *end {
                break;
            }
            let end = end.min(segment.start + arc.end);
            let fall = DVec3::new(0.0, 0.0, -0.5 * table.gravity);
            let place = [arc.position, arc.velocity, fall, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO];
            found.push(Stretch { begin, end, place, terms: 3, motion });
        }
    }
    found
}

/// Measures jumps of the balls of a shot, and their overlaps with each other and with cushions.
pub(super) fn measure(table: &Table, shot: &Shot, trace: &Trace, figures: &mut Figures) {
    let law = ImpactLaw::of(table);
    let balls: [Vec<Stretch>; BALLS] = std::array::from_fn(|ball| stretches(table, &trace.pieces[ball]));
    for (ball, stretches) in balls.iter().enumerate() {
        let mut last = shot.layout.balls[ball].extend(0.0);
        for stretch in stretches {
            // A ball that has left the table is at the point where it left, seen from above.
            let off = stretch.motion == Motion::OffTable;
            let begins = if off { stretch.place[0].with_z(last.z) } else { stretch.place[0] };
            figures.jump.record(last.distance(begins), stretch.begin);
            last = stretch.at(stretch.end);
            measure_outside(&law, &trace.constants, stretch, figures);
        }
        if trace.kept_until == f64::INFINITY {
            figures.jump.record(last.truncate().distance(trace.end.balls[ball].position), trace.end.time);
        }
    }
    for (first, second) in PAIRS {
        measure_overlaps(&trace.constants, &balls[first], &balls[second], figures);
    }
    measure_contact_gaps(&law, trace, &balls, figures);
}

/// Measures how far a stretch penetrates a cushion: on the cloth beyond the ball's reach, in the air closer to the nose than a
/// radius.
fn measure_outside(law: &ImpactLaw, constants: &Constants, stretch: &Stretch, figures: &mut Figures) {
    if stretch.motion == Motion::OffTable {
        return;
    }
    for rail in Rail::ALL {
        let n = rail.normal();
        let [sine, cosine] = law.cushion(rail).nose.map(|share| share * constants.radius);
        let mut inwards = stretch.place.map(|c| c.truncate().dot(n));
        inwards[0] += n.abs().dot(constants.reach);
        let lasts = stretch.end - stretch.begin;
        if stretch.motion != Motion::Flying {
            // Most stretches are too far from a cushion to reach it.
            if inwards[0] > max_displacement(&inwards.map(f64::abs), stretch.terms, lasts) {
                continue;
            }
            let found = least(&inwards[..stretch.terms], lasts, PRECISION);
            figures.outside.record(-found.value, stretch.begin + found.at);
            continue;
        }
        // From the nose to the ball's centre: inwards and upwards.
        let [x, v, _, ..] = inwards;
        let [z, w, k, ..] = stretch.place.map(|c| c.z);
        let (x, z) = (x + cosine, z - sine);
        let gap = [
            x * x + z * z - constants.radius * constants.radius,
            2.0 * (x * v + z * w),
            v * v + w * w + 2.0 * z * k,
            2.0 * w * k,
            k * k,
        ];
        let found = least(&gap, lasts, 2.0 * constants.radius * PRECISION);
        if x + v * found.at > 0.0 {
            figures.outside.record(-found.value / (2.0 * constants.radius), stretch.begin + found.at);
        }
    }
}

/// Upper bound of the displacement within `time` on a course whose coefficients have these magnitudes.
fn max_displacement(sizes: &[f64; 6], terms: usize, time: f64) -> f64 {
    sizes[1..terms].iter().rev().fold(0.0, |sum, size| (sum + size) * time)
}

/// Measures the overlap of two balls on their courses, which cover the same times.
fn measure_overlaps(constants: &Constants, first: &[Stretch], second: &[Stretch], figures: &mut Figures) {
    let diameter = 2.0 * constants.radius;
    let (mut i, mut j) = (0, 0);
    while let (Some(one), Some(other)) = (first.get(i), second.get(j)) {
        let (from, until) = (one.begin.max(other.begin), one.end.min(other.end));
        let still = one.motion == Motion::Stationary && other.motion == Motion::Stationary;
        let off = one.motion == Motion::OffTable || other.motion == Motion::OffTable;
        if until > from && !off && !(still && from > 0.0) {
            let (c1, c2) = (one.about(from), other.about(from));
            let d: [DVec3; 6] = std::array::from_fn(|power| c1[power] - c2[power]);
            let time = until - from;
            let terms = one.terms.max(other.terms);
            if d[0].length() - diameter <= max_displacement(&d.map(DVec3::length), terms, time) {
                let mut gap = [0.0; MAX_DEGREE + 1];
                for (i, a) in d[..terms].iter().enumerate() {
                    for (j, b) in d[..terms].iter().enumerate() {
                        gap[i + j] += a.dot(*b);
                    }
                }
                // (|d| - 2R)(|d| + 2R): the first factor is the gap, so that rounding stays small.
                gap[0] = (d[0].length() - diameter) * (d[0].length() + diameter);
                let found = least(&gap[..2 * terms - 1], time, 2.0 * diameter * PRECISION);
                let depth = -found.value / (diameter + (found.value + diameter * diameter).max(0.0).sqrt());
                figures.overlap.record(depth, from + found.at);
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

/// Measures the gaps between reported collision partners.
fn measure_contact_gaps(law: &ImpactLaw, trace: &Trace, balls: &[Vec<Stretch>; BALLS], figures: &mut Figures) {
    let constants = &trace.constants;
    let place = |ball: usize, time: f64| {
        let list = &balls[ball];
        let index = list.partition_point(|stretch| stretch.end < time);
        list.get(index).map_or(trace.end.balls[ball].position.extend(0.0), |stretch| stretch.at(time))
    };
    for event in trace.events.iter().filter(|event| event.time < trace.kept_until) {
        let apart = match event.kind {
            EventKind::BallBall(first, second) => {
                place(first, event.time).distance(place(second, event.time)) - 2.0 * constants.radius
            }
            EventKind::BallRail(ball, rail) => {
                let [sine, cosine] = law.cushion(rail).nose.map(|share| share * constants.radius);
                let centre = place(ball, event.time);
                let inwards = rail.gap(constants.reach, centre.truncate());
                if centre.z == 0.0 { inwards } else { (inwards + cosine).hypot(centre.z - sine) - constants.radius }
            }
            _ => continue,
        };
        figures.contact_gap.record(apart.abs(), event.time);
    }
}
