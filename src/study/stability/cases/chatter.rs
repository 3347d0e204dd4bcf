//! Chatter of lively contacts: a ball whose spin presses it against a cushion or another ball. Its bounces lose so little
//! energy that hundreds are needed before they become negligible.

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, with_restitution};
use crate::{
    physics::CueDegrees,
    simulation::{Event, EventKind, Rail},
    study::stability::{Shot, Trace, draw},
    table::{Layout, Table},
};

pub const CASES: &[Case] = &[
    Case::new("a ball spinning against a cushion, e = 0.95", || with_restitution(0.95), at_cushion)
        .checked(HOLDS, few_events),
    Case::new("a ball spinning against a cushion, e = 0.99", || with_restitution(0.99), at_cushion)
        .checked(HOLDS, few_events),
    Case::new("a ball spinning against another, e = 0.95", || with_restitution(0.95), at_ball)
        .checked(HOLDS, few_events),
    Case::new("a ball spinning against another, e = 0.99", || with_restitution(0.99), at_ball)
        .checked(HOLDS, few_events),
];

/// Maximum number of events of one chatter, from the first impact to the end of the resulting contact. After that the balls may
/// meet again and start another chatter.
const MAX_EVENTS: usize = 60;

/// A flight longer than the longest before by this factor starts another chatter.
const LONGER: f64 = 2.0;

/// Maximum number of chatters of a shot.
const MAX_CHATTERS: usize = 12;

const HOLDS: &str = "at most 60 events a chatter, regardless of its bounces, and 12 chatters; a flight twice as long as those before begins another";

/// Draws a stroke so steep that the spin by far outlasts the speed: the ball leaves, comes back, and is pressed for a long
/// time.
fn masse(phi_deg: f64, rng: &mut Xoshiro256PlusPlus) -> CueDegrees {
    let (a, b) = (rng.random_range(-0.1..0.1), rng.random_range(-0.3..0.3));
    let theta_deg = 90.0 - draw::log_uniform(rng, 0.02, 5.0);
    CueDegrees { a, b, theta_deg, phi_deg, speed: draw::log_uniform(rng, 0.3, 6.0) }
}

/// Position of the third ball, out of the way.
fn aside(table: &Table) -> DVec2 {
    0.9 * table.reach()
}

fn at_cushion(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let n = Rail::Bottom.normal();
    let x = 0.3 * table.half_length() * rng.random_range(-1.0..1.0);
    let back = if rng.random_bool(0.5) { 0.0 } else { draw::log_uniform(rng, 1e-9, 1e-3) };
    let from = DVec2::new(x, -table.reach().y) + back * n;
    let away = DVec2::from_angle(rng.random_range(-0.5..0.5)).rotate(n);
    let others = aside(table);
    let layout = Layout::new([from, others, others * DVec2::new(-1.0, 1.0)]);
    Shot { layout, cue: masse(away.to_angle().to_degrees(), rng) }
}

fn at_ball(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let from = DVec2::new(-0.5 * table.half_length(), 0.0);
    let apart = 2.0 * table.radius + if rng.random_bool(0.5) { 0.0 } else { draw::log_uniform(rng, 1e-9, 1e-3) };
    let turn = draw::one_of(rng, &[0.0, 0.01, 0.1]) * rng.random_range(-1.0..1.0_f64);
    let layout = Layout::new([from, from + DVec2::new(apart, 0.0), aside(table)]);
    Shot { layout, cue: masse(180.0 + turn.to_degrees(), rng) }
}

/// Splits the events into chatters. A chatter ends with its contact, or before the first flight that is much longer than those
/// before: the flights of one chatter become ever shorter.
fn chatters(events: &[Event]) -> Vec<&[Event]> {
    let (mut all, mut begin) = (Vec::new(), 0);
    let (mut last, mut longest) = (f64::NAN, 0.0_f64);
    for (index, event) in events.iter().enumerate() {
        if event.kind == EventKind::ContactEnds(0) {
            all.push(&events[begin..index]);
            (begin, last, longest) = (index + 1, f64::NAN, 0.0);
        } else if event.kind.is_contact() {
            let flight = event.time - last;
            if longest > 0.0 && flight > LONGER * longest {
                all.push(&events[begin..index]);
                (begin, longest) = (index, 0.0);
            } else {
                longest = longest.max(flight);
            }
            last = event.time;
        }
    }
    all.push(&events[begin..]);
    all
}

fn few_events(_: &Table, _: &Shot, trace: &Trace) -> Result<(), String> {
    let one = |chatter: &[Event]| {
        let begins = |event: &Event| event.kind == EventKind::ContactBegins(0);
        let (before, after) = chatter.split_at(chatter.iter().position(begins).unwrap_or(chatter.len()));
        // The trace also stores bounces: impacts within the contact, which are no events.
        before.len() + after.iter().filter(|event| !event.kind.is_contact()).count()
    };
    let chatters: Vec<usize> = chatters(&trace.events).into_iter().map(one).collect();
    if let Some(most) = chatters.iter().find(|events| **events > MAX_EVENTS) {
        return Err(format!("one chatter takes {most} events"));
    }
    if chatters.len() <= MAX_CHATTERS { Ok(()) } else { Err(format!("it chatters {} times", chatters.len())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_much_longer_flight_begins_another_chatter() {
        let mut time = 0.0;
        let events = [0.0, 0.1, 0.09, 0.08, 0.3, 0.2, 0.19].map(|flight| {
            time += flight;
            Event { time, kind: EventKind::BallBall(0, 1) }
        });
        assert_eq!(chatters(&events).iter().map(|chatter| chatter.len()).collect::<Vec<_>>(), [4, 3]);
        let (before, after) = events.split_at(2);
        let ends = Event { time: before[1].time, kind: EventKind::ContactEnds(0) };
        let events = [before, &[ends], after].concat();
        assert_eq!(chatters(&events).iter().map(|chatter| chatter.len()).collect::<Vec<_>>(), [2, 2, 3]);
    }
}
