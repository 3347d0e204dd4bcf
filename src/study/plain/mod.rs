//! A plain event-driven engine in any precision, with any root finder: written straight from the equations, with no
//! savings at all, and apart from `physics` and `simulation`, so that a slip in one is not in the other.
//!
//! In double-double it is the truth that everything else is measured by. Only names are shared: of events and cushions.

mod complementarity;
mod contact;
mod course;
mod cue;
mod double_double;
mod engine;
mod extrapolation;
mod impact;
mod laws;
mod linear;
mod meeting;
mod moment;
mod motion;
mod piece;
mod real;
mod rest;
mod roots;
mod rounds;
mod rows;
mod table;
mod tolerance;
mod vector;

#[cfg(test)]
mod tests;

pub use cue::{Stroke, strike};
pub use double_double::DoubleDouble;
pub use engine::{Shot, Unjudged, play};
pub use impact::{balls_collide, rail_collides};
pub use motion::{Ball, Motion};
pub use real::Real;
pub use roots::{Finder, algorithm_1010, by_extrema, closed_form};
pub use table::{Numbers, normal as rail_normal};
pub use vector::Vector;
