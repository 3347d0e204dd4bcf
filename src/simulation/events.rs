//! Events of a shot, and the observer that receives them.

use std::ops::ControlFlow;

use serde::{Serialize, Serializer, ser::SerializeStruct};

use crate::table::{BALLS, Rail};

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// Two balls collide; the lower index comes first.
    BallBall(usize, usize),
    /// A ball hits a cushion.
    BallRail(usize, Rail),
    /// A ball stops slipping and rolls.
    SlidingRolling(usize),
    /// A ball comes to rest.
    RollingStationary(usize),
    /// A ball begins to rest against a cushion or another ball, or to chatter. Until the contact ends, its slow bounces are not reported,
    /// nor are rolling, rest, or a jump that is undone at the same moment.
    ContactBegins(usize),
    /// A ball is free again: it no longer rests, and nothing can make it bounce before its chatter has ended.
    ContactEnds(usize),
    /// A ball leaves the cloth.
    Jumps(usize),
    /// A ball from the air stays on the cloth: its hops have ended.
    Lands(usize),
    /// A ball lands on the rail or beyond it and is out of play.
    LeavesTable(usize),
}

impl EventKind {
    /// Returns the name used in JSON and on the screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BallBall(..) => "ball-ball",
            Self::BallRail(..) => "ball-rail",
            Self::SlidingRolling(_) => "sliding-rolling",
            Self::RollingStationary(_) => "rolling-stationary",
            Self::ContactBegins(_) => "contact-begins",
            Self::ContactEnds(_) => "contact-ends",
            Self::Jumps(_) => "jumps",
            Self::Lands(_) => "lands",
            Self::LeavesTable(_) => "leaves-table",
        }
    }

    /// Returns the balls that take part; the second only for a collision of two.
    pub const fn balls(self) -> (usize, Option<usize>) {
        match self {
            Self::BallBall(first, second) => (first, Some(second)),
            Self::BallRail(ball, _)
            | Self::SlidingRolling(ball)
            | Self::RollingStationary(ball)
            | Self::ContactBegins(ball)
            | Self::ContactEnds(ball)
            | Self::Jumps(ball)
            | Self::Lands(ball)
            | Self::LeavesTable(ball) => (ball, None),
        }
    }

    /// Whether a ball hits another ball or a cushion.
    pub const fn is_contact(self) -> bool {
        matches!(self, Self::BallBall(..) | Self::BallRail(..))
    }

    /// Returns the cushion that takes part.
    pub const fn rail(self) -> Option<Rail> {
        match self {
            Self::BallRail(_, rail) => Some(rail),
            _ => None,
        }
    }
}

/// An event and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Seconds since the stroke.
    pub time: f64,
    /// Kind of the event.
    pub kind: EventKind,
}

impl Serialize for Event {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rail = self.kind.rail();
        let mut out = serializer.serialize_struct("Event", 3 + usize::from(rail.is_some()))?;
        out.serialize_field("t", &self.time)?;
        out.serialize_field("kind", self.kind.name())?;
        match self.kind.balls() {
            (first, Some(second)) => out.serialize_field("balls", &[first, second])?,
            (ball, None) => out.serialize_field("balls", &[ball])?,
        }
        if let Some(rail) = rail {
            out.serialize_field("rail", &rail)?;
        }
        out.end()
    }
}

/// Number of steps of resting contacts that an observer accepts: a stiff contact takes thousands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepBudget(pub u32);

impl StepBudget {
    /// Consumes one step, for [`Observer::contact_step`]; `Break` if none is left.
    pub const fn step(&mut self) -> ControlFlow<()> {
        match self.0.checked_sub(1) {
            Some(left) => {
                self.0 = left;
                ControlFlow::Continue(())
            }
            None => ControlFlow::Break(()),
        }
    }
}

/// Receiver of a shot's events; its methods tell the engine what it needs, so that the engine computes nothing else.
pub trait Observer {
    /// Whether [`Observer::segment`] must be called; constant during a shot.
    fn wants_segments(&self) -> bool {
        false
    }

    /// Whether it matters that, and where, balls come to rest. If not, the simulation may end when nothing else can happen. Constant during
    /// a shot.
    fn wants_ends(&self) -> bool {
        true
    }

    /// The object balls, 1 and 2, whose first collision with the cue ball is all that still matters; `None` if anything else matters.
    fn awaited(&self) -> Option<[bool; BALLS - 1]> {
        None
    }

    /// Receives an event. `Break` ends the simulation, because the outcome is decided.
    fn event(&mut self, event: Event) -> ControlFlow<()>;

    /// Receives a bounce of a chatter, for observers that count every impact; only the first bounces of a chatter are events.
    fn bounce(&mut self, _bounce: Event) {}

    /// Called after each step of a resting contact and at each bounce of a chatter. `Break` gives up the shot.
    fn contact_step(&mut self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Receives a `segment` that a ball has followed until time `end`, s. Only called if [`Observer::wants_segments`] is true.
    fn segment(&mut self, _ball: usize, _segment: &super::Segment, _end: f64) {}
}
