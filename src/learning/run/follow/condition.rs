//! How a run is, as far as one can see from outside.

use std::{fmt, time::Duration};

use crate::learning::run::standing::Phase;

/// How a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Condition {
    /// Nothing is known yet.
    #[default]
    Unknown,
    /// There is no run in the folder yet.
    Missing,
    /// As it says itself.
    Is(Phase),
    /// Its process is there and has written nothing for so long, in whole seconds.
    Stalled(Duration),
    /// Its process is gone without having said so: it was killed, or the machine stopped.
    Died,
    /// It is not finished and nobody works on it; how it ended is not known.
    Interrupted,
    /// Its folder has been removed.
    Removed,
}

impl Condition {
    /// Whether nothing more will come unless somebody goes on with the run.
    pub const fn is_over(self) -> bool {
        match self {
            Self::Is(phase) => phase.is_over(),
            Self::Died | Self::Interrupted | Self::Removed => true,
            Self::Unknown | Self::Missing | Self::Stalled(_) => false,
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => out.write_str("looking"),
            Self::Missing => out.write_str("not started"),
            Self::Is(phase) => out.write_str(phase.name()),
            Self::Stalled(since) => write!(out, "stalled for {} s", since.as_secs()),
            Self::Died => out.write_str("died"),
            Self::Interrupted => out.write_str("interrupted"),
            Self::Removed => out.write_str("removed"),
        }
    }
}
