//! Reproduction of the thesis' learning curves (its figures 21 to 30) by training the agents again.

mod curves;
mod figures;
mod picture;
mod session;

pub use figures::{FIGURES, Figure, Measure, UnknownFigure};
pub use picture::picture;
pub use session::{ReproducedFigure, Session, SessionError, csv, summary};
