//! Reproduction of the thesis' learning curves (its figures 21 to 30) by training the agents again.

mod curves;
mod figures;
mod picture;
mod session;

pub use curves::{Curve, EVALUATION_LAYOUTS, INTERVAL, Point, Training, random_play};
pub use figures::{Change, FIGURES, Figure, Measure, UnknownFigure, VARIANTS, Variant};
pub use picture::picture;
pub use session::{ReproducedFigure, Session, SessionError, csv, summary};
