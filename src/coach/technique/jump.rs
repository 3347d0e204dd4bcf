//! Detects the balls that the cue ball flies over before its first contact.

use crate::{
    simulation::{EventKind, Recording},
    table::{BALLS, Table},
};

/// Sampling interval of a flight, s: a ball at 8 m/s flies 8 mm in it.
const SAMPLING_INTERVAL: f64 = 0.001;

/// Minimum overlap of the balls, seen from above, for one to count as flown over, m.
const INSIDE: f64 = 0.001;

/// Finds the first object ball, or the edge of one, that the cue ball passes in the air before its first contact.
pub fn flown_over(table: &Table, recording: &Recording) -> Option<usize> {
    let is_contact = |kind| matches!(kind, EventKind::BallBall(0, _) | EventKind::BallRail(0, _));
    let first = recording.events().iter().find(|event| is_contact(event.kind));
    let until = first.map_or(recording.duration(), |event| event.time);
    let reach = 2.0 * table.radius - INSIDE;
    let of_cue_ball = recording.jumps().into_iter().filter(|jump| jump.ball == 0 && jump.is_reported());
    of_cue_ball.filter(|jump| jump.start < until).find_map(|jump| {
        let end = jump.end.min(until);
        let samples = ((end - jump.start) / SAMPLING_INTERVAL).ceil() as usize;
        (0..=samples).map(|sample| (jump.start + SAMPLING_INTERVAL * sample as f64).min(end)).find_map(|time| {
            let places = recording.positions(time);
            let is_below = |ball: &usize| places[0].distance(places[*ball]) < reach;
            // A ball on which it lands is not flown over.
            let is_met = |ball: usize| {
                until <= jump.end && first.is_some_and(|event| event.kind == EventKind::BallBall(0, ball))
            };
            (1..BALLS).filter(is_below).find(|&ball| !is_met(ball))
        })
    })
}
