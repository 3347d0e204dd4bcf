//! What can happen during a shot, and the observer that is told of it.

use std::ops::ControlFlow;

use serde::{Serialize, Serializer, ser::SerializeStruct};

use crate::table::{BALLS, Rail};

/// What happens at one moment of a shot.
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
    /// A ball begins to rest against a cushion or another ball, or to chatter. Until the contact ends its slow bounces are not told,
    /// nor that it rolls or stands still between two of them, or is thrown up by one and down again by another at the same moment.
    ContactBegins(usize),
    /// A ball is free again: it rests no more, and nothing can make it bounce before its chatter is over.
    ContactEnds(usize),
    /// A ball leaves the cloth.
    Jumps(usize),
    /// A ball that was in the air stays on the cloth from now on: its hops have ended.
    Lands(usize),
    /// A ball has come down on the rail or beyond it, and is out of play.
    LeavesTable(usize),
}

impl EventKind {
    /// The name used in JSON and on the screen.
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

    /// The balls that take part, the second only in a collision of two.
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

    /// Whether a ball meets another or a cushion.
    pub const fn is_contact(self) -> bool {
        matches!(self, Self::BallBall(..) | Self::BallRail(..))
    }

    /// The cushion that takes part.
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
    /// What happens.
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

/// Steps of resting contacts that an observer is ready to follow: a stiff contact takes thousands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepBudget(pub u32);

impl StepBudget {
    /// Takes one step's worth of it, for [`Observer::contact_step`]; `Break` where none is left.
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

/// What a scene wants to know of a shot; the engine computes nothing else.
pub trait Observer {
    /// Whether [`Observer::segment`] wants to be called: the same throughout a shot.
    fn wants_segments(&self) -> bool {
        false
    }

    /// Whether it matters that and where balls come to rest. If not, the simulation may end when nothing else is left. It is
    /// the same throughout a shot.
    fn wants_ends(&self) -> bool {
        true
    }

    /// The object balls, 1 and 2, whose first meeting with the cue ball is all that still matters; `None` where more does.
    fn awaited(&self) -> Option<[bool; BALLS - 1]> {
        None
    }

    /// An event has happened. `Break` ends the simulation: the outcome is decided.
    fn event(&mut self, event: Event) -> ControlFlow<()>;

    /// A bounce of a chatter, which is told as an event only at its beginning: for whoever keeps accounts of every impact.
    fn bounce(&mut self, _bounce: Event) {}

    /// A resting contact is about to be followed for another step, or a chatter has bounced. `Break` gives the shot up.
    fn contact_step(&mut self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// A ball has moved along `segment` until time `end`, s. Called only where [`Observer::wants_segments`] says so.
    fn segment(&mut self, _ball: usize, _segment: &super::Segment, _end: f64) {}
}
