//! What must hold in every shot, checked on its whole course and not on samples of it.
//!
//! Between two changes a ball's centre follows a polynomial of the time, and so does the square of the distance of two
//! balls: its least value on the interval is bounded by its Bernstein coefficients ([`super::polynomial`]).

use glam::DVec2;

use crate::{
    physics::Motion,
    simulation::{Constants, EventKind, Segment},
    table::{BALLS, PAIRS, Table},
};

use super::{
    aloft,
    audit::audit,
    figures::Figures,
    polynomial::{MAX_DEGREE, least},
    shot::Shot,
    trace::{Piece, Trace},
};

/// To which the least distance is worked out, m: a thousandth of what counts.
pub(super) const PRECISION: f64 = 1e-12;

/// Plays `shot` and measures everything that must hold.
pub fn examine(table: &Table, shot: &Shot, trace: &mut Trace) -> Figures {
    trace.play(table, shot);
    measure(table, shot, trace)
}

/// Measures a shot that has been played.
fn measure(table: &Table, shot: &Shot, trace: &Trace) -> Figures {
    let mut figures = Figures {
        shots: 1,
        events: trace.event_count,
        steps: trace.steps,
        seconds: trace.seconds,
        unfinished: u64::from(!(trace.finished && trace.end.balls.iter().all(|ball| ball.velocity == DVec2::ZERO))),
        ..Figures::default()
    };
    if !is_finite(trace) {
        figures.not_finite = 1;
        return figures;
    }
    order(trace, &mut figures);
    if trace.has_flights() {
        aloft::measure(table, shot, trace, &mut figures);
        audit(table, trace, &mut figures);
        return figures;
    }
    jumps(shot, trace, &mut figures);
    for pieces in &trace.pieces {
        for piece in pieces {
            outside(&trace.constants, piece, &mut figures);
        }
    }
    for (first, second) in PAIRS {
        overlaps(&trace.constants, &trace.pieces[first], &trace.pieces[second], &mut figures);
    }
    contacts(trace, &mut figures);
    audit(table, trace, &mut figures);
    figures
}

fn is_finite(trace: &Trace) -> bool {
    let piece_is_finite = |piece: &Piece| {
        let segment = &piece.segment;
        segment.start.is_finite()
            && piece.end.is_finite()
            && segment.spin.is_finite()
            && segment.coefficients().iter().all(|c| c.is_finite())
            && segment.curve().is_none_or(|curve| curve.spin.iter().all(|c| c.is_finite()))
    };
    trace.pieces.iter().flatten().all(piece_is_finite)
        && trace.events.iter().all(|event| event.time.is_finite())
        && trace.end.balls.iter().all(|ball| ball.position.is_finite() && ball.spin.is_finite())
}

/// Events and pieces follow each other in time.
fn order(trace: &Trace, figures: &mut Figures) {
    for pair in trace.events.windows(2) {
        figures.backwards.note(pair[0].time - pair[1].time, pair[1].time);
    }
    for piece in trace.pieces.iter().flatten() {
        figures.backwards.note(piece.segment.start - piece.end, piece.end);
    }
    for pair in trace.pieces.iter().flat_map(|pieces| pieces.windows(2)) {
        figures.backwards.note((pair[1].segment.start - pair[0].end).abs(), pair[0].end);
    }
}

/// Every piece begins where the last one ended.
fn jumps(shot: &Shot, trace: &Trace, figures: &mut Figures) {
    for (ball, pieces) in trace.pieces.iter().enumerate() {
        let mut last = shot.layout.balls[ball];
        for Piece { segment, end } in pieces {
            figures.jump.note(last.distance(segment.position), segment.start);
            last = segment.position_after(end - segment.start);
        }
        if trace.kept_until == f64::INFINITY {
            figures.jump.note(last.distance(trace.end.balls[ball].position), trace.end.time);
        }
    }
}

/// How far a piece leads beyond the cushions.
fn outside(constants: &Constants, piece: &Piece, figures: &mut Figures) {
    let Piece { segment, end } = piece;
    let course = segment.coefficients();
    let count = if segment.curve().is_some() { 6 } else { 3 };
    let time = end - segment.start;
    for axis in 0..2 {
        let reach = constants.reach[axis];
        for side in [1.0, -1.0] {
            let mut room = [0.0; 6];
            for (room, c) in room.iter_mut().zip(course) {
                *room = side * c[axis];
            }
            room[0] += reach;
            if room[0] > time * (room[1].abs() + time * room[2].abs()) && segment.curve().is_none() {
                continue;
            }
            let found = least(&room[..count], time, PRECISION);
            figures.outside.note(-found.value, segment.start + found.at);
        }
    }
}

/// How deep two balls overlap on their courses, which share every moment.
fn overlaps(constants: &Constants, first: &[Piece], second: &[Piece], figures: &mut Figures) {
    let diameter = 2.0 * constants.radius;
    let (mut i, mut j) = (0, 0);
    while let (Some(one), Some(other)) = (first.get(i), second.get(j)) {
        let from = one.segment.start.max(other.segment.start);
        let until = one.end.min(other.end);
        if until > from
            && !(one.segment.motion == Motion::Stationary && other.segment.motion == Motion::Stationary && from > 0.0)
        {
            let (c1, c2) = (shifted(&one.segment, from), shifted(&other.segment, from));
            let mut d = [DVec2::ZERO; 6];
            for (d, (c1, c2)) in d.iter_mut().zip(c1.iter().zip(c2)) {
                *d = *c1 - c2;
            }
            let time = until - from;
            let curved = one.segment.curve().is_some() || other.segment.curve().is_some();
            if curved || d[0].length() - diameter <= time * (d[1].length() + time * d[2].length()) {
                let terms = if curved { 6 } else { 3 };
                let mut gap = [0.0; MAX_DEGREE + 1];
                for (i, a) in d[..terms].iter().enumerate() {
                    for (j, b) in d[..terms].iter().enumerate() {
                        gap[i + j] += a.dot(*b);
                    }
                }
                // (|d| - 2R)(|d| + 2R), whose first factor is the gap and whose rounding stays small.
                gap[0] = (d[0].length() - diameter) * (d[0].length() + diameter);
                let found = least(&gap[..2 * terms - 1], time, 2.0 * diameter * PRECISION);
                let depth = -found.value / (diameter + (found.value + diameter * diameter).max(0.0).sqrt());
                figures.overlap.note(depth, from + found.at);
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
fn contacts(trace: &Trace, figures: &mut Figures) {
    let mut cursor = [0; BALLS];
    let mut place = |ball: usize, time: f64| {
        let pieces = &trace.pieces[ball];
        while pieces.get(cursor[ball]).is_some_and(|piece| piece.end < time) {
            cursor[ball] += 1;
        }
        match pieces.get(cursor[ball]) {
            Some(piece) => piece.segment.position_after(time - piece.segment.start),
            None => trace.end.balls[ball].position,
        }
    };
    for event in trace.events.iter().filter(|event| event.time < trace.kept_until) {
        let apart = match event.kind {
            EventKind::BallBall(first, second) => {
                place(first, event.time).distance(place(second, event.time)) - 2.0 * trace.constants.radius
            }
            EventKind::BallRail(ball, rail) => {
                let n = rail.normal();
                n.abs().dot(trace.constants.reach) + place(ball, event.time).dot(n)
            }
            _ => continue,
        };
        figures.apart.note(apart.abs(), event.time);
    }
}

/// A course's coefficients about the time `now`.
fn shifted(segment: &Segment, now: f64) -> [DVec2; 6] {
    let mut c = segment.coefficients();
    let shift = now - segment.start;
    let highest = if segment.curve().is_some() { 5 } else { 2 };
    if shift != 0.0 {
        // Repeated synthetic division.
        for low in 0..highest {
            for power in (low..highest).rev() {
                let above = c[power + 1];
                c[power] += shift * above;
            }
        }
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::CueDegrees,
        study::stability::{Limits, Violation},
        table::Layout,
    };

    /// A shot that meets a ball and cushions, and what the checks say after it has been tampered with.
    fn violations(tamper: impl Fn(&mut Trace)) -> Vec<Violation> {
        let table = Table::preset("textbook").unwrap();
        let layout = Layout::new([DVec2::new(-0.5, 0.01), DVec2::ZERO, DVec2::new(1.0, 0.5)]);
        let shot = Shot { layout, cue: CueDegrees { b: 0.3, ..CueDegrees::centre(0.0, 4.0) } };
        let mut trace = Trace::new(&table);
        trace.play(&table, &shot);
        tamper(&mut trace);
        measure(&table, &shot, &trace).violations(&Limits::STRICT)
    }

    /// Where sliding becomes rolling, the cue ball gains a billionth of its spin.
    fn spin_faster(trace: &mut Trace) {
        let rolling = |piece: &&mut Piece| piece.segment.motion == Motion::Rolling;
        trace.pieces[0].iter_mut().rfind(rolling).unwrap().segment.spin *= 1.0 + 1e-9;
    }

    #[test]
    fn an_ordinary_shot_breaks_nothing() {
        assert_eq!(violations(|_| {}), []);
    }

    #[test]
    fn every_kind_of_tampering_is_seen() {
        type Tamper = fn(&mut Trace);
        type Kind = fn(&Violation) -> bool;
        let cases: [(Tamper, Kind); 8] = [
            (|trace| trace.pieces[0][1].segment.position.x += 2e-9, |v| matches!(v, Violation::Jump(_))),
            (|trace| trace.end.balls[1].position.y += 2e-9, |v| matches!(v, Violation::Jump(_))),
            (spin_faster, |v| matches!(v, Violation::Energy(_))),
            (|trace| trace.pieces[2][0].segment.spin.x = f64::NAN, |v| matches!(v, Violation::NotFinite)),
            (|trace| trace.constants.radius += 1e-8, |v| matches!(v, Violation::Overlap(_))),
            (|trace| trace.constants.reach.x -= 2e-9, |v| matches!(v, Violation::Outside(_))),
            (|trace| trace.constants.reach.x += 2e-9, |v| matches!(v, Violation::Apart(_))),
            (|trace| trace.events.swap(0, 1), |v| matches!(v, Violation::Backwards(_))),
        ];
        for (index, (tamper, kind)) in cases.into_iter().enumerate() {
            let found = violations(tamper);
            assert!(found.iter().any(kind), "tampering {index} gives {found:?}");
        }
        assert_eq!(violations(|trace| trace.finished = false), [Violation::Unfinished]);
        assert_eq!(violations(|trace| trace.event_count = 501), [Violation::Events(501)]);
    }
}
