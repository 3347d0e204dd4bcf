//! The reference engine: event-driven, in any precision, with any root finder: written straight from the equations, with no
//! savings at all, and apart from `physics` and `simulation`, so that a slip in one is not in the other.
//!
//! With 32 digits it computes the truth, by which everything else is measured. What is shared: the names of events and cushions, and the
//! one law that is chosen and not derived, the speed at which balls begin to bounce where no forces hold them together.
//!
//! Free balls go along parabolas from event to event (`motion`, `meeting`), those in the air from landing to landing
//! (`flight`). Contacts that close at one moment collide together (`rounds`); tables give the laws of their parts (`table`,
//! `rails`, `impact`). Bounces that shrink without end become a resting contact (`moment`), whose forces follow from the
//! laws by complementarity (`rest`, `laws`, `system`, `complementarity`) and are integrated from one change of the laws to
//! the next (`piece`, `extrapolation`).

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
pub use flight::{Met, collide as collide_aloft, opening_aloft, settle};
pub use impact::{balls_collide, rail_collides};
pub use motion::{Ball, Motion};
pub use rails::{Cushion, Meeting};
pub use real::Real;
pub use roots::{Finder, algorithm_1010, by_extrema, closed_form};
pub use rounds::at_once as collide_at_once;
pub use rows::Row;
pub use table::{Numbers, normal as rail_normal};
pub use vector::Vector;
