//! Cushion contacts as a referee counts them: bounces too small to see belong to the contact before.

use super::{Event, EventKind, Rail};

/// Longest time between two bounces on a cushion that look like one contact, s. A cloth with a coefficient of friction
/// of 0.2 pulls a ball back within this time if it is 0.9 mm from the cushion at most.
const LONGEST_UNSEEN_HOP: f64 = 0.06;

/// The contacts of one ball, followed from event to event.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CushionContacts {
    /// The cushion that the ball has hit last, and when, s; `None` if it has hit a ball since.
    last: Option<(Rail, f64)>,
}

impl CushionContacts {
    /// Follows an event. Returns the cushion if the event is a new cushion contact of `ball`: not one of the small bounces of a ball that is
    /// pressed on a cushion by its spin.
    #[inline]
    pub fn follow(&mut self, ball: usize, event: &Event) -> Option<Rail> {
        match event.kind {
            EventKind::BallRail(hit, rail) if hit == ball => {
                let is_seen = |(last, time): (Rail, f64)| last != rail || event.time - time > LONGEST_UNSEEN_HOP;
                let is_new = self.last.is_none_or(is_seen);
                self.last = Some((rail, event.time));
                is_new.then_some(rail)
            }
            EventKind::BallBall(first, second) if first == ball || second == ball => {
                self.last = None;
                None
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_bounces_on_one_cushion_are_one_contact() {
        let rail = |rail| EventKind::BallRail(0, rail);
        let counted = |events: &[(f64, EventKind)]| {
            let mut contacts = CushionContacts::default();
            let new = events.iter().filter_map(|&(time, kind)| contacts.follow(0, &Event { time, kind }));
            new.count()
        };
        let (top, left) = (rail(Rail::Top), rail(Rail::Left));
        // Bounces that follow each other closely are one contact, however long they last together.
        assert_eq!(counted(&[(1.0, top), (1.05, top), (1.1, top), (1.15, top)]), 1);
        assert_eq!(counted(&[(1.0, top), (1.07, top)]), 2);
        assert_eq!(counted(&[(1.0, top), (1.01, left), (1.02, top)]), 3);
        assert_eq!(counted(&[(1.0, top), (1.01, EventKind::BallBall(0, 2)), (1.02, top)]), 2);
        // Other balls change nothing.
        let others = [EventKind::BallBall(1, 2), EventKind::BallRail(1, Rail::Left), EventKind::SlidingRolling(0)];
        for other in others {
            assert_eq!(counted(&[(1.0, top), (1.01, other), (1.02, top)]), 1);
        }
    }
}
