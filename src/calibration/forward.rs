//! What a stroke of a test leads to on a table: the simulation as a player with a stopwatch sees it.

use std::{borrow::Cow, ops::ControlFlow};

use glam::DVec2;

use super::protocol::{Moment, Quantity, Test};
use crate::{
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Rail, Segment, watch},
    table::{BALLS, Layout, Table},
};

/// How many numbers say how a stroke differed from what the test asks for.
pub const STROKE: usize = 6;

/// By how much strokes differ from what a test asks for, and how far balls are put beside their places: standard
/// deviations of a player who has never seen the table. They are assumptions, and wide ones: what was really struck is
/// found from the marks, as far as they say it.
#[derive(Clone, Copy, Debug)]
pub struct Hand {
    /// Of the speed, as a share.
    pub speed: f64,
    /// Of the direction, rad.
    pub direction: f64,
    /// Of the tip's place to the side and in height, ball radii.
    pub tip: f64,
    /// Of the elevation, rad.
    pub elevation: f64,
    /// Of the line of a frozen pair, or of the direction in which an object ball was put, rad.
    pub line: f64,
}

impl Hand {
    /// What is assumed of every player.
    pub const ASSUMED: Self = Self {
        speed: 0.2,
        direction: 0.3_f64.to_radians(),
        tip: 0.04,
        elevation: 1.0_f64.to_radians(),
        line: 0.4_f64.to_radians(),
    };

    /// The stroke that differs from a test's by so many of these deviations, and where the balls lie then.
    pub fn stroke(&self, table: &Table, test: &Test, off: &[f64; STROKE]) -> (CueInputs, Layout) {
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

    /// What the marks of `test` are after such a stroke, played from the far end or not; `None` where the ball never comes to
    /// what is marked.
    pub fn seen(&self, table: &Table, test: &Test, is_turned: bool, off: &[f64; STROKE]) -> Vec<Option<f64>> {
        let table = if is_turned { Cow::Owned(table.turned()) } else { Cow::Borrowed(table) };
        let (cue, layout) = self.stroke(&table, test, off);
        marks(&table, test, &cue, &layout)
    }
}

/// What a player can see of a shot.
#[derive(Clone, Debug)]
struct Seen {
    /// Rails that each ball has met: time, place of its centre.
    rails: [Vec<(f64, DVec2)>; BALLS],
    /// How many of them are short.
    short: [usize; BALLS],
    places: [DVec2; BALLS],
    stops: [f64; BALLS],
}

impl Observer for Seen {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        match event.kind {
            EventKind::BallRail(ball, rail) => {
                self.rails[ball].push((event.time, self.places[ball]));
                self.short[ball] += usize::from(matches!(rail, Rail::Left | Rail::Right));
            }
            EventKind::RollingStationary(ball) => self.stops[ball] = event.time,
            _ => {}
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        self.places[ball] = segment.position_after(end - segment.start);
    }
}

/// What the marks of `test` are after this stroke, in their units; `None` where the ball never comes to what is marked.
fn marks(table: &Table, test: &Test, cue: &CueInputs, layout: &Layout) -> Vec<Option<f64>> {
    let mut seen = Seen { rails: Default::default(), short: [0; BALLS], places: layout.balls, stops: [0.0; BALLS] };
    watch(table, layout, &strike(table, cue), &mut seen);
    let diamonds = |place: DVec2| (place + 0.5 * DVec2::new(table.length, table.width)) / table.diamond();
    let rail = |ball: usize, number: usize| seen.rails[ball].get(number - 1);
    let moment = |moment: Moment| match moment {
        Moment::Stroke => Some(0.0),
        Moment::Rail(ball, number) => rail(ball, number).map(|(time, _)| *time),
        Moment::Stop(ball) => Some(seen.stops[ball]),
    };
    let value = |quantity: Quantity| match quantity {
        Quantity::StopAlong(ball) => Some(test.way(table, seen.short[ball], diamonds(seen.places[ball]).x)),
        Quantity::StopAcross(ball) => Some(diamonds(seen.places[ball]).y),
        Quantity::RailAlong(ball, number) => rail(ball, number).map(|(_, place)| diamonds(*place).x),
        Quantity::RailAcross(ball, number) => rail(ball, number).map(|(_, place)| diamonds(*place).y),
        Quantity::Time(from, to) => Some(moment(to)? - moment(from)?),
    };
    test.marks.iter().map(|mark| value(mark.quantity)).collect()
}
