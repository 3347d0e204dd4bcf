//! The forward model of the calibration: simulates a stroke of a test and measures its marks like a player with a stopwatch.

use std::{borrow::Cow, ops::ControlFlow};

use glam::DVec2;

use super::protocol::{Moment, Quantity, Test};
use crate::{
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Rail, Segment, watch},
    table::{BALLS, Layout, Table},
};

/// Number of values that describe the difference of a stroke from the requested one.
pub const STROKE_PARAMETERS: usize = 6;

/// Standard deviations of a player's strokes from the requested ones, and of the ball placement, for a player who has never seen the
/// table. They are wide assumptions: the fit infers the actual strokes from the marks, as far as these determine them.
#[derive(Clone, Copy, Debug)]
pub struct StrokeSpread {
    /// Deviation of the speed, as a share.
    pub speed: f64,
    /// Deviation of the direction, rad.
    pub direction: f64,
    /// Deviation of the tip position to the side and in height, ball radii.
    pub tip: f64,
    /// Deviation of the elevation, rad.
    pub elevation: f64,
    /// Deviation of the line of a frozen pair, or of the direction in which an object ball was placed, rad.
    pub line: f64,
}

impl StrokeSpread {
    /// The deviations assumed for every player.
    pub const ASSUMED: Self = Self {
        speed: 0.2,
        direction: 0.3_f64.to_radians(),
        tip: 0.04,
        elevation: 1.0_f64.to_radians(),
        line: 0.4_f64.to_radians(),
    };

    /// Returns the stroke and the layout that differ from those of the test by `off`, in these deviations.
    pub fn stroke(&self, table: &Table, test: &Test, off: &[f64; STROKE_PARAMETERS]) -> (CueInputs, Layout) {
        let [a, b, theta, phi, speed] = test.cue;
        let cue = CueInputs {
            a: a + self.tip * off[2],
            b: b + self.tip * off[3],
            theta: theta.to_radians() + self.elevation * off[4],
            phi: phi.to_radians() + self.direction * off[1],
            speed: speed * (self.speed * off[0]).exp(),
        };
        (cue, test.layout(table, self.line * off[5]))
    }

    /// Returns the marks of `test` after such a stroke, played from the far end if `is_turned`; `None` for a mark to which the ball never
    /// gets.
    pub fn simulate_marks(
        &self,
        table: &Table,
        test: &Test,
        is_turned: bool,
        off: &[f64; STROKE_PARAMETERS],
    ) -> Vec<Option<f64>> {
        let table = if is_turned { Cow::Owned(table.seen_from_other_end()) } else { Cow::Borrowed(table) };
        let (cue, layout) = self.stroke(&table, test, off);
        marks(&table, test, &cue, &layout)
    }
}

/// The part of a shot that a player can observe.
#[derive(Clone, Debug)]
pub struct Observed {
    /// Rail contacts of each ball: time, s, and position of the ball's centre, m.
    rails: [Vec<(f64, DVec2)>; BALLS],
    /// Number of contacts with short rails.
    short: [usize; BALLS],
    /// Current and finally last positions, m.
    positions: [DVec2; BALLS],
    /// Times at which the balls stop, s.
    stops: [f64; BALLS],
}

impl Observed {
    /// Creates the observation of a shot that begins in `layout`.
    pub fn new(layout: &Layout) -> Self {
        Self { rails: Default::default(), short: [0; BALLS], positions: layout.balls, stops: [0.0; BALLS] }
    }

    /// Returns the position of the marked ball's centre, m; `None` for a time, or if the ball never gets there.
    pub fn position(&self, quantity: Quantity) -> Option<DVec2> {
        match quantity {
            Quantity::StopAlong(ball) | Quantity::StopAcross(ball) => Some(self.positions[ball]),
            Quantity::RailAlong(ball, number) | Quantity::RailAcross(ball, number) => {
                self.rails[ball].get(number - 1).map(|(_, position)| *position)
            }
            Quantity::Time(..) => None,
        }
    }
}

impl Observer for Observed {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        match event.kind {
            EventKind::BallRail(ball, rail) => {
                self.rails[ball].push((event.time, self.positions[ball]));
                self.short[ball] += usize::from(matches!(rail, Rail::Left | Rail::Right));
            }
            EventKind::RollingStationary(ball) => self.stops[ball] = event.time,
            _ => {}
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        self.positions[ball] = segment.position_after(end - segment.start);
    }
}

/// Returns the marks of `test` after this stroke, in their units; `None` for a mark to which the ball never gets.
fn marks(table: &Table, test: &Test, cue: &CueInputs, layout: &Layout) -> Vec<Option<f64>> {
    let mut observed = Observed::new(layout);
    watch(table, layout, &strike(table, cue), &mut observed);
    let moment = |moment: Moment| match moment {
        Moment::Stroke => Some(0.0),
        Moment::Rail(ball, number) => observed.rails[ball].get(number - 1).map(|(time, _)| *time),
        Moment::Stop(ball) => Some(observed.stops[ball]),
    };
    let diamonds = |quantity: Quantity| observed.position(quantity).map(|position| table.to_diamonds(position));
    let value = |quantity: Quantity| match quantity {
        Quantity::StopAlong(ball) => Some(test.travel(table, observed.short[ball], diamonds(quantity)?.x)),
        Quantity::RailAlong(..) => Some(diamonds(quantity)?.x),
        Quantity::StopAcross(_) | Quantity::RailAcross(..) => Some(diamonds(quantity)?.y),
        Quantity::Time(from, to) => Some(moment(to)? - moment(from)?),
    };
    test.marks.iter().map(|mark| value(mark.quantity)).collect()
}
