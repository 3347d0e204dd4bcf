//! The invariants of every shot: finite numbers, ordered times, valid positions and conserved energy.

use glam::DVec2;

use crate::table::Table;

use super::{
    audit::audit,
    figures::Figures,
    finding::Shot,
    positions,
    trace::{Piece, Trace},
};

/// Plays `shot` and measures all invariants.
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
        exhausted: u64::from(trace.end.is_exhausted),
        truncated: u64::from(trace.kept_until < f64::INFINITY),
        ..Figures::default()
    };
    if !is_finite(trace) {
        figures.not_finite = 1;
        return figures;
    }
    check_order(trace, &mut figures);
    positions::measure(table, shot, trace, &mut figures);
    // On a slope, the parabolas of free motion are right to the first order of the slope, and so is their energy.
    if table.tilt == DVec2::ZERO {
        audit(table, trace, &mut figures);
    }
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

/// Checks that events and pieces are ordered in time, and that the pieces of a ball cover the whole shot.
fn check_order(trace: &Trace, figures: &mut Figures) {
    for pair in trace.events.windows(2) {
        figures.backwards.record(pair[0].time - pair[1].time, pair[1].time);
    }
    for piece in trace.pieces.iter().flatten() {
        figures.backwards.record(piece.segment.start - piece.end, piece.end);
    }
    for pieces in &trace.pieces {
        let (first, last) = (pieces.first(), pieces.last().filter(|_| trace.kept_until == f64::INFINITY));
        figures.backwards.record(first.map_or(0.0, |piece| piece.segment.start.abs()), 0.0);
        figures.backwards.record(last.map_or(0.0, |piece| (piece.end - trace.end.time).abs()), trace.end.time);
    }
    for pair in trace.pieces.iter().flat_map(|pieces| pieces.windows(2)) {
        figures.backwards.record((pair[1].segment.start - pair[0].end).abs(), pair[0].end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::{CueDegrees, Motion},
        study::stability::{Limits, Violation},
        table::Layout,
    };

    /// Returns the violations of a shot that hits a ball and cushions, after tampering.
    fn violations(tamper: impl Fn(&mut Trace)) -> Vec<Violation> {
        let table = Table::preset("textbook").unwrap();
        let layout = Layout::new([DVec2::new(-0.5, 0.01), DVec2::ZERO, DVec2::new(1.0, 0.5)]);
        let shot = Shot { layout, cue: CueDegrees { b: 0.3, ..CueDegrees::centre(0.0, 4.0) } };
        let mut trace = Trace::of(&table, &shot);
        tamper(&mut trace);
        measure(&table, &shot, &trace).violations(&Limits::STRICT)
    }

    /// At the transition to rolling, the cue ball gains a billionth of its spin.
    fn spin_faster(trace: &mut Trace) {
        let rolling = |piece: &&mut Piece| piece.segment.motion == Motion::Rolling;
        trace.pieces[0].iter_mut().rfind(rolling).unwrap().segment.spin *= 1.0 + 1e-9;
    }

    #[test]
    fn ordinary_shot_violates_no_invariant() {
        assert_eq!(violations(|_| {}), []);
    }

    #[test]
    fn every_kind_of_tampering_is_detected() {
        type Tamper = fn(&mut Trace);
        type Kind = fn(&Violation) -> bool;
        let cases: [(Tamper, Kind); 8] = [
            (|trace| trace.pieces[0][1].segment.position.x += 2e-9, |v| matches!(v, Violation::Jump(_))),
            (|trace| trace.end.balls[1].position.y += 2e-9, |v| matches!(v, Violation::Jump(_))),
            (spin_faster, |v| matches!(v, Violation::Energy(_))),
            (|trace| trace.pieces[2][0].segment.spin.x = f64::NAN, |v| matches!(v, Violation::NotFinite)),
            (|trace| trace.constants.radius += 1e-8, |v| matches!(v, Violation::Overlap(_))),
            (|trace| trace.constants.reach.x -= 2e-9, |v| matches!(v, Violation::Outside(_))),
            (|trace| trace.constants.reach.x += 2e-9, |v| matches!(v, Violation::ContactGap(_))),
            (|trace| trace.events.swap(0, 1), |v| matches!(v, Violation::Backwards(_))),
        ];
        for (index, (tamper, kind)) in cases.into_iter().enumerate() {
            let found = violations(tamper);
            assert!(found.iter().any(kind), "tampering {index} gives {found:?}");
        }
        assert_eq!(violations(|trace| trace.finished = false), [Violation::Unfinished]);
        assert_eq!(violations(|trace| trace.end.is_exhausted = true), [Violation::Exhausted]);
        assert_eq!(violations(|trace| trace.event_count = 501), [Violation::Events(501)]);
    }
}
