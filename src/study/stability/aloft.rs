//! What must hold in a shot in which balls fly: the same as on the cloth, in space.
//!
//! Between two landings a centre's course is a parabola in space, so that the least distances are bounded as on the cloth. Of
//! the energy it is checked that it never grows, that what slides and rolls between takes what friction takes, and that each
//! landing obeys the cloth's law, worked out here from the speeds before and after it.

use glam::{DVec2, DVec3};

use super::{
    audit::{Doubt, free_loss},
    figures::Figures,
    invariants::{PAIRS, PRECISION},
    polynomial::{MAX_DEGREE, least},
    shot::Shot,
    trace::{Piece, Trace},
};
use crate::{
    physics::{Cushions, Motion, SpatialState, slip},
    simulation::{Constants, EventKind, Rail},
    table::{BALLS, Table},
};

/// Rounding of an energy, as a share of it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Landings of one course that are looked at: after so many the hops of the liveliest cloth are lower than an atom.
const MOST_LANDINGS: u32 = 4000;

/// A part of a course that is one polynomial.
struct Stretch {
    begin: f64,
    end: f64,
    /// Coefficients of the place about the beginning, m.
    place: [DVec3; 6],
    /// Spin at the beginning and at the end, rad/s.
    spin: [DVec3; 2],
    motion: Motion,
}

impl Stretch {
    fn at(&self, time: f64) -> DVec3 {
        let t = time - self.begin;
        self.place.iter().rev().fold(DVec3::ZERO, |sum, c| sum * t + *c)
    }

    fn velocity(&self, time: f64) -> DVec3 {
        let t = time - self.begin;
        (1..6).rev().fold(DVec3::ZERO, |sum, power| sum * t + power as f64 * self.place[power])
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

    /// Energy per mass at the beginning or the end, m²/s².
    fn energy(&self, table: &Table, at_end: bool) -> f64 {
        let time = if at_end { self.end } else { self.begin };
        let spin = self.spin[usize::from(at_end)];
        SpatialState { position: self.at(time), velocity: self.velocity(time), spin }
            .specific_energy(table.radius, table.gravity)
    }
}

fn stretches(table: &Table, constants: &Constants, pieces: &[Piece]) -> Vec<Stretch> {
    let mut found = Vec::new();
    for Piece { segment, end } in pieces {
        let motion = segment.motion;
        let Some(hops) = segment.hops() else {
            let lasts = end - segment.start;
            let [c3, c4, c5] = segment.curve().map_or([DVec2::ZERO; 3], |curve| curve.position);
            let place = [segment.position, segment.velocity, segment.half_acceleration, c3, c4, c5];
            found.push(Stretch {
                begin: segment.start,
                end: *end,
                place: place.map(|c| c.extend(0.0)),
                spin: [0.0, lasts].map(|t| segment.spin_after(constants, t)),
                motion,
            });
            continue;
        };
        for landings in 0..MOST_LANDINGS {
            let arc = hops.arc(landings);
            let begin = segment.start + arc.begin;
            if begin >= *end {
                break;
            }
            let end = end.min(segment.start + arc.end);
            let middle = hops.state_after(0.5 * (begin + end) - segment.start);
            let fall = DVec3::new(0.0, 0.0, -0.5 * table.gravity);
            let place = [arc.position, arc.velocity, fall, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO];
            found.push(Stretch { begin, end, place, spin: [middle.spin; 2], motion });
        }
    }
    found
}

/// Measures a shot in which a ball has flown; what needs no space has been measured.
pub(super) fn measure(table: &Table, shot: &Shot, trace: &Trace, figures: &mut Figures) {
    let balls: [Vec<Stretch>; BALLS] =
        std::array::from_fn(|ball| stretches(table, &trace.constants, &trace.pieces[ball]));
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
        energy(table, stretches, figures);
    }
    for (first, second) in PAIRS {
        overlaps(table, &balls[first], &balls[second], figures);
    }
    contacts(table, trace, &balls, figures);
    gains(table, &balls, figures);
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

/// Along the stretches of one ball and at its landings friction takes what its laws say.
fn energy(table: &Table, stretches: &[Stretch], figures: &mut Figures) {
    let mut note = |lost: f64, taken: f64, energy: f64, time: f64| {
        // Friction works while a time is rounded.
        let allowed = ROUNDING * energy + 8.0 * f64::EPSILON * time * (1.0 + energy);
        figures.unexplained.note((lost - taken).abs() / allowed.max(f64::MIN_POSITIVE), time);
        figures.missing.note((lost - taken).abs(), time);
    };
    for stretch in stretches.iter().filter(|stretch| stretch.motion != Motion::Resting) {
        let (before, after) = (stretch.energy(table, false), stretch.energy(table, true));
        let state = crate::physics::BallState {
            position: stretch.place[0].truncate(),
            velocity: stretch.place[1].truncate(),
            spin: stretch.spin[0],
        };
        let taken = free_loss(table, &state, stretch.motion, stretch.end - stretch.begin);
        note(before - after, taken, before, stretch.end);
    }
    let Some(flight) = table.flight else { return };
    let friction = flight.friction.unwrap_or(table.sliding_friction);
    for pair in stretches.windows(2) {
        let [one, next] = pair else { continue };
        let lands = one.motion == Motion::Flying && next.motion == Motion::Flying && next.place[0].z == 0.0;
        let (before, after) = (one.velocity(one.end), next.place[1]);
        // One that follows another on the same course: nothing else has happened.
        if !lands || one.end != next.begin || before.z >= -1e-6 {
            continue;
        }
        let expected = -flight.restitution * before.z;
        if (after.z - expected).abs() > 1e-9 * (1.0 + expected) {
            // Struck at the moment of its landing, or an impact that put it there.
            continue;
        }
        let push = -(1.0 + flight.restitution) * before.z;
        let size = slip(table.radius, before.truncate(), one.spin[1]).length();
        let rub = (friction * push).min(2.0 / 7.0 * size);
        // Of the slip's energy 1/7 u² a friction J takes J u - 7/4 J².
        let by_friction = rub * (size - 1.75 * rub);
        let by_cloth = 0.5 * before.z * before.z * (1.0 - flight.restitution * flight.restitution);
        let (was, is) = (one.energy(table, true), next.energy(table, false));
        note(was - is, by_friction + by_cloth, was + before.z * before.z, next.begin);
    }
}

/// The energy of all balls never grows, at no change of any of them.
fn gains(table: &Table, balls: &[Vec<Stretch>; BALLS], figures: &mut Figures) {
    let mut times: Vec<f64> = balls.iter().flatten().map(|stretch| stretch.begin).filter(|time| *time > 0.0).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut at = [0; BALLS];
    for time in times {
        let (mut before, mut after) = (0.0, 0.0);
        for (ball, stretches) in balls.iter().enumerate() {
            // Several arcs may begin at once: the last hops are shorter than time can tell.
            let next = stretches.partition_point(|stretch| stretch.begin <= time) - 1;
            if next > at[ball] && stretches[next].motion != Motion::OffTable {
                before += stretches[next - 1].energy(table, true);
                after += stretches[next].energy(table, false);
            }
            at[ball] = next;
        }
        figures.gained.note(after - before, time);
        let rests = balls.iter().flatten().any(|stretch| stretch.motion == Motion::Resting);
        let allowed = Doubt { energy: 2.0 * before, time, rests, ..Doubt::default() }.of_a_gain(table);
        figures.energy.note((after - before).max(0.0) / allowed.max(f64::MIN_POSITIVE), time);
    }
}
