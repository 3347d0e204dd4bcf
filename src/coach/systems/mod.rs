//! Diamond systems: what players count on for three cushions, and by how much the simulation corrects it.
//!
//! A [`System`] has numbers at the diamonds: where the line of aim comes from, where it leads, and where the ball arrives on
//! the third cushion. [`guide`] says which of them describes a shot. Where none does, [`Shift`] counts from a line beside it.
//!
//! Numbers are those of `tests/data/filmed/systems.json`, with its source.

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
pub use lines::{BEHIND, Line, Mirror, SIZE, diamonds, metres};
pub use natural::Natural;
pub use shift::Shift;
pub use system::{Labels, Numbers, System};
pub use words::number;
