//! Diamond systems: the arithmetic that players use for three cushions, and its correction by the simulation.
//!
//! A [`System`] assigns numbers to the diamonds: to the start of the line of aim, to its end, and to the arrival on the
//! third cushion. [`guide`] selects the system that describes a shot. If none does, [`ParallelShift`] counts from a
//! neighbouring line.
//!
//! The numbers are those of `tests/data/filmed/systems.json`, which names their source.

mod guide;
mod leg;
mod lines;
mod natural;
mod plus;
mod scale;
mod shift;
mod system;
mod words;

pub use guide::{Applied, Guide, guide};
pub use lines::{DIAMOND_SETBACK, Line, Mirror, SIZE, diamonds, metres};
pub use natural::NaturalStroke;
pub use shift::ParallelShift;
pub use system::{Labels, Numbers, System};
pub use words::number;
