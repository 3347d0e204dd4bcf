//! What a test looks like on the table: the ways of its balls after the stroke that is asked for, and where the marks are.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{
    forward::{Hand, STROKE},
    protocol::{Quantity, Test},
};
use crate::{
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Segment, watch},
    table::{BALLS, Layout, Table},
};

/// Time between two looks at a way, s.
const LOOK: f64 = 0.002;

/// A test on a table. What it shows is what the table's constants let expect.
#[derive(Clone, Debug)]
pub struct Sketch {
    /// Where the balls lie; those that take no part are far away.
    pub layout: Layout,
    /// The stroke that is asked for.
    pub cue: CueInputs,
    /// Places along the ways of the balls, m.
    pub ways: [Vec<DVec2>; BALLS],
    /// Where a ball's centre is that is marked, mark by mark, m; none of times, and of marks that no ball comes to.
    pub places: Vec<Option<DVec2>>,
}

impl Sketch {
    /// Distance of two places of a way, m.
    pub const SPACING: f64 = 0.02;

    /// That of `test` on `table`.
    pub fn of(table: &Table, test: &Test) -> Self {
        let (cue, layout) = Hand::ASSUMED.stroke(table, test, &[0.0; STROKE]);
        let ways = layout.balls.map(|ball| vec![ball]);
        let mut seen = Seen { ways, now: layout.balls, rails: Default::default() };
        watch(table, &layout, &strike(table, &cue), &mut seen);
        let place = |quantity: Quantity| match quantity {
            Quantity::StopAlong(ball) | Quantity::StopAcross(ball) => Some(seen.now[ball]),
            Quantity::RailAlong(ball, number) | Quantity::RailAcross(ball, number) => {
                seen.rails[ball].get(number - 1).copied()
            }
            Quantity::Time(..) => None,
        };
        let places = test.marks.iter().map(|mark| place(mark.quantity)).collect();
        Self { layout, cue, ways: seen.ways, places }
    }
}

struct Seen {
    ways: [Vec<DVec2>; BALLS],
    now: [DVec2; BALLS],
    rails: [Vec<DVec2>; BALLS],
}

impl Observer for Seen {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if let EventKind::BallRail(ball, _) = event.kind {
            self.rails[ball].push(self.now[ball]);
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        let way = &mut self.ways[ball];
        for look in 1..=((end - segment.start) / LOOK) as u32 {
            let place = segment.position_after(LOOK * f64::from(look));
            if way.last().is_none_or(|last| last.distance(place) >= Sketch::SPACING) {
                way.push(place);
            }
        }
        self.now[ball] = segment.position_after(end - segment.start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::PROTOCOL;

    #[test]
    fn every_test_shows_where_its_places_are_marked() {
        let table = Table::default();
        for test in PROTOCOL {
            let sketch = Sketch::of(&table, test);
            for (mark, place) in test.marks.iter().zip(&sketch.places) {
                let is_time = matches!(mark.quantity, Quantity::Time(..));
                assert_eq!(place.is_none(), is_time, "{} {}", test.name, mark.name);
                assert!(place.is_none_or(|place| place.abs().cmple(table.reach() + 1e-6).all()), "{}", test.name);
            }
            assert!(sketch.ways[0].len() > 10, "{}", test.name);
            let gaps = sketch.ways[0].windows(2).map(|pair| pair[0].distance(pair[1]));
            assert!(gaps.fold(0.0, f64::max) < 0.05, "{}", test.name);
        }
    }
}
