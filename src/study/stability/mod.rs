//! Stability study: invariants of every shot, and shots made to break them.

pub mod adversarial;
mod audit;
mod cases;
mod draw;
mod figures;
mod finding;
mod invariants;
mod polynomial;
mod positions;
pub mod random;
mod report;
mod shot;
mod sweep;
mod trace;

pub use audit::{Account, account};
pub use cases::{Case, CaseKind, all as cases};
pub use figures::{Figures, Limits, Violation, Worst};
pub use finding::Finding;
pub use invariants::examine;
pub use report::{Plan, Row, headings, markdown, page, rows};
pub use shot::Shot;
pub use sweep::{Check, Generator, Progress, Sweep, SweepResult};
pub use trace::Trace;
