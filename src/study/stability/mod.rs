//! Stability study: invariants of every shot, and shots made to break them.

pub mod adversarial;
mod audit;
mod cases;
mod draw;
mod figures;
mod finding;
mod invariants;
mod places;
mod polynomial;
pub mod random;
mod report;
mod shot;
mod sweep;
mod trace;

pub use audit::{Account, account};
pub use cases::{Case, Size, all as cases};
pub use figures::{Figures, Limits, Violation, Worst};
pub use finding::Finding;
pub use invariants::examine;
pub use report::{Plan, Row, heads, markdown, page, rows};
pub use shot::Shot;
pub use sweep::{Check, Generator, Progress, Sweep, Swept};
pub use trace::Trace;
