//! The cue ball's impacts on balls and cushions in the film, in order, and whether the shot scores by them.

use super::film::{FilmedShot, Sample, first_moved};
use crate::{
    game::{Rule, Tally},
    simulation::{Event, EventKind},
    table::{BALLS, Rail, Table},
};

/// Two balls may have touched if their filmed centres come closer than their diameter plus this, m. Between two samples a fast
/// ball may turn, where the film has a straight line.
const NEAR: f64 = 0.02;
/// The same if both balls move, m; such balls may have passed without touching.
const NEAR_MOVING: f64 = 0.006;
/// Time step of the search for a contact, s, and its extent beyond the samples, s.
const STEP: f64 = 0.002;
const BEYOND: f64 = 0.02;
/// A ball that reverses closer to a cushion than this has hit it, m: a fast ball may do so between two samples.
const AT_RAIL: f64 = 0.03;

impl FilmedShot {
    /// Returns the impacts of the cue ball in order of time: the first on each object ball, and all on cushions.
    pub fn meetings(&self, table: &Table) -> Vec<Event> {
        let balls = (1..BALLS).filter_map(|ball| {
            let time = self.first_contact(table, ball)?;
            Some(Event { time, kind: EventKind::BallBall(0, ball) })
        });
        let rails = Rail::ALL.into_iter().flat_map(|rail| {
            let times = turns(table, &self.balls[0], rail);
            times.into_iter().map(move |time| Event { time, kind: EventKind::BallRail(0, rail) })
        });
        let mut events: Vec<Event> = balls.chain(rails).collect();
        events.sort_by(|one, other| one.time.total_cmp(&other.time));
        events
    }

    /// Whether the filmed shot scores a point.
    pub fn is_point(&self, table: &Table, rule: Rule) -> bool {
        let mut tally = Tally::default();
        self.meetings(table).iter().for_each(|event| tally.count(event));
        tally.is_point(rule)
    }

    /// Returns the time of the cue ball's first impact on an object ball, s of the film.
    fn first_contact(&self, table: &Table, ball: usize) -> Option<f64> {
        let (track, diameter) = (&self.balls[ball], 2.0 * table.radius);
        let moved = first_moved(track)?;
        let distance = |time: f64| self.position(0, time).distance(self.position(ball, time));
        // While the object ball is at rest: the time at which the cue ball is nearest to it, between the two samples around the
        // start of its motion.
        let (from, to) = (track[moved - 1].time - BEYOND, track[moved].time + BEYOND);
        let lying = |time: f64| self.position(0, time).distance(track[0].position);
        let nearest = sample_times(from, to).min_by(|one, other| lying(*one).total_cmp(&lying(*other)))?;
        if lying(nearest) < diameter + NEAR {
            return Some(nearest);
        }
        // Otherwise, the other object ball has moved it.
        sample_times(to, self.balls[0].last()?.time).find(|time| distance(*time) < diameter + NEAR_MOVING)
    }
}

/// Returns equidistant times between two times, s.
fn sample_times(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let count = ((to - from) / STEP).max(0.0) as u32;
    (0..=count).map(move |n| from + STEP * f64::from(n))
}

/// Returns the times at which a ball reverses at a cushion, s. A ball that stays there for a while counts once.
fn turns(table: &Table, track: &[Sample], rail: Rail) -> Vec<f64> {
    let gaps: Vec<f64> = track.iter().map(|sample| rail.gap(table.reach(), sample.position)).collect();
    let (mut times, mut is_there) = (Vec::new(), false);
    for (n, gap) in gaps.windows(3).enumerate() {
        let is_turn = gap[1] <= gap[0] && gap[1] < gap[2] && gap[1] < AT_RAIL;
        if is_turn && !is_there {
            times.push(track[n + 1].time);
        }
        is_there = gap[1] < AT_RAIL && (is_there || is_turn);
    }
    times
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::filmed::film::bundled;

    #[test]
    fn the_share_of_points_is_that_of_the_whole_match() {
        // 39 of 173 shots of the match are points; this half of it has 21 of 91.
        let table = Table::default();
        let film = bundled();
        let points: Vec<u32> =
            film.iter().filter(|shot| shot.is_point(&table, Rule::ThreeCushion)).map(|shot| shot.number).collect();
        assert_eq!(points.len(), 21, "{points:?}");
    }

    #[test]
    fn a_filmed_point_has_its_three_cushions_before_the_second_ball() {
        let table = Table::default();
        let film = bundled();
        let shot = film.iter().find(|shot| shot.number == 90).unwrap();
        let meetings = shot.meetings(&table);
        let second = meetings.iter().position(|event| event.kind == EventKind::BallBall(0, 1)).unwrap();
        assert_eq!(meetings[0].kind, EventKind::BallBall(0, 2));
        assert_eq!(second, 4, "three cushions between: {meetings:?}");
        assert!((meetings[second].time - 3.1).abs() < 0.05, "{meetings:?}");
    }
}
