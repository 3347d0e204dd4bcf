//! The reference engine: an event-driven simulation in any precision and with any root finder. It is written directly from the
//! equations, without optimizations, and independently of `physics` and `simulation`, so that an error in one is not repeated
//! in the other.
//!
//! With 32 digits it computes the truth against which everything else is measured. Both engines share the names of events and
//! cushions, and the one law that is chosen rather than derived: the speed at which balls begin to bounce if no forces hold
//! them together.
//!
//! Free balls move on parabolas from event to event (`motion`, `meeting`), balls in the air from landing to landing (`flight`).
//! Contacts that close at the same time are solved together (`rounds`); the table defines the laws of its parts (`table`,
//! `rails`, `impact`). Bounces that shrink without end become a resting contact (`moment`). Its forces follow from the laws by
//! complementarity (`rest`, `laws`, `system`, `complementarity`) and are integrated from one change of the laws to the next
//! (`piece`, `extrapolation`).

mod complementarity;
mod contact;
mod course;
mod cue;
mod double_double;
mod engine;
mod extrapolation;
mod flight;
mod impact;
mod laws;
mod linear;
mod meeting;
mod moment;
mod motion;
mod piece;
mod rails;
mod real;
mod rest;
mod roots;
mod rounds;
mod rows;
mod system;
mod table;
mod tolerance;
mod vector;

#[cfg(test)]
mod tests;

pub use contact::Contact;
pub use cue::{Stroke, strike};
pub use double_double::DoubleDouble;
pub use engine::{Shot, Unjudged, play};
pub use flight::{collide as collide_aloft, opening_aloft, settle};
pub use impact::{balls_collide, rail_collides};
pub use motion::{Ball, Motion};
pub use rails::RailLaw;
pub use real::Real;
pub use roots::{Finder, algorithm_1010, by_extrema, closed_form};
pub use rounds::collide_simultaneously;
pub use rows::Row;
pub use table::{Numbers, normal as rail_normal};
pub use vector::Vector;
