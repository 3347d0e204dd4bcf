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
mod sweep;
mod trace;

pub use audit::account;
pub use cases::{Case, CaseKind, all as cases};
pub use figures::{Figures, Limits, Violation};
pub use finding::{Finding, Shot};
pub use invariants::examine;
pub use report::{Plan, Row, headings, page, rows};
pub use sweep::{Check, Generator, Progress, Sweep, SweepResult};
pub use trace::Trace;
