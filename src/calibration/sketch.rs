//! A sketch of a test: the paths of its balls after the requested stroke, and the positions of the marks.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{
    forward::{Observed, STROKE_PARAMETERS, StrokeSpread},
    protocol::Test,
};
use crate::{
    physics::{CueInputs, strike},
    simulation::{Event, Observer, Segment, watch},
    table::{BALLS, Layout, Table},
};

/// Time step of the sampling of a path, s.
const TIME_STEP: f64 = 0.002;

/// A sketch of a test on a table, simulated with the table's constants.
#[derive(Clone, Debug)]
pub struct Sketch {
    /// Initial positions of the balls; those not in use are far away.
    pub layout: Layout,
    /// The requested stroke.
    pub cue: CueInputs,
    /// Points along the paths of the balls, m.
    pub paths: [Vec<DVec2>; BALLS],
    /// Position of the marked ball's centre for each mark, m; `None` for times, and for marks to which no ball gets.
    pub mark_positions: Vec<Option<DVec2>>,
}

impl Sketch {
    /// Distance between two points of a path, m.
    pub const SPACING: f64 = 0.02;

    /// Simulates `test` on `table`.
    pub fn of(table: &Table, test: &Test) -> Self {
        let (cue, layout) = StrokeSpread::ASSUMED.stroke(table, test, &[0.0; STROKE_PARAMETERS]);
        let paths = layout.balls.map(|ball| vec![ball]);
        let mut drawn = Drawn { observed: Observed::new(&layout), paths };
        watch(table, &layout, &strike(table, &cue), &mut drawn);
        let mark_positions = test.marks.iter().map(|mark| drawn.observed.position(mark.quantity)).collect();
        Self { layout, cue, paths: drawn.paths, mark_positions }
    }
}

struct Drawn {
    observed: Observed,
    paths: [Vec<DVec2>; BALLS],
}

impl Observer for Drawn {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.observed.event(event)
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        let path = &mut self.paths[ball];
        for step in 1..=((end - segment.start) / TIME_STEP) as u32 {
            let point = segment.position_after(TIME_STEP * f64::from(step));
            if path.last().is_none_or(|last| last.distance(point) >= Sketch::SPACING) {
                path.push(point);
            }
        }
        self.observed.segment(ball, segment, end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::{PROTOCOL, Quantity};

    #[test]
    fn every_test_has_positions_for_its_marks() {
        let table = Table::default();
        for test in PROTOCOL {
            let sketch = Sketch::of(&table, test);
            for (mark, place) in test.marks.iter().zip(&sketch.mark_positions) {
                let is_time = matches!(mark.quantity, Quantity::Time(..));
                assert_eq!(place.is_none(), is_time, "{} {}", test.name, mark.name);
                assert!(place.is_none_or(|place| place.abs().cmple(table.reach() + 1e-6).all()), "{}", test.name);
            }
            assert!(sketch.paths[0].len() > 10, "{}", test.name);
            let gaps = sketch.paths[0].windows(2).map(|pair| pair[0].distance(pair[1]));
            assert!(gaps.fold(0.0, f64::max) < 0.05, "{}", test.name);
        }
    }
}
