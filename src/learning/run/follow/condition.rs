//! How a run is, as far as one can see from outside.

use std::{fmt, time::Duration};

use crate::learning::run::standing::Phase;

/// Silence after which a run that trains or waits is stalled: it should have said something each second.
const PATIENCE: Duration = Duration::from_secs(15);

/// The same while it plays the held-out layouts, which may be many.
const MEASURING_PATIENCE: Duration = Duration::from_secs(600);

/// Silence up to which a run is believed to be at work though nobody holds its lock: not every file system has locks.
const FRESH: Duration = Duration::from_secs(3);

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
    /// Whether the other one is the same, however long a run has been stalled.
    pub fn is_like(self, other: Self) -> bool {
        self == other || matches!((self, other), (Self::Stalled(_), Self::Stalled(_)))
    }

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

/// What is seen of a run from outside.
#[derive(Clone, Debug, Default)]
pub struct Signs {
    /// Whether its folder is there.
    pub is_there: bool,
    /// Whether it has been.
    pub was_there: bool,
    /// Whether a process holds its lock.
    pub is_held: bool,
    /// What it says of itself.
    pub phase: Option<Phase>,
    /// How long it has said nothing new.
    pub silent: Duration,
    /// Shots played as of its last line.
    pub shots: Option<u64>,
    /// Shots planned.
    pub planned: Option<u64>,
}

/// What follows from what is seen.
pub fn condition(signs: &Signs) -> Condition {
    let Signs { is_there, was_there, is_held, phase, silent, shots, planned, .. } = *signs;
    match phase {
        _ if !is_there => {
            if was_there {
                Condition::Removed
            } else {
                Condition::Missing
            }
        }
        Some(phase) if phase.is_over() => Condition::Is(phase),
        Some(phase) if is_held || silent < FRESH => {
            let patience = if phase == Phase::Measuring { MEASURING_PATIENCE } else { PATIENCE };
            if silent < patience { Condition::Is(phase) } else { Condition::Stalled(whole_seconds(silent)) }
        }
        Some(_) => Condition::Died,
        // A run that has just begun, or of a carom that said nothing of itself.
        None if is_held => Condition::Is(Phase::Training),
        None if shots.is_some_and(|shots| planned.is_some_and(|planned| shots >= planned)) => {
            Condition::Is(Phase::Finished)
        }
        None if planned.is_none() && shots.is_none() => Condition::Missing,
        None => Condition::Interrupted,
    }
}

/// So that a condition changes once a second, and not with every look.
const fn whole_seconds(duration: Duration) -> Duration {
    Duration::from_secs(duration.as_secs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signs(phase: Option<Phase>, is_held: bool, silent: u64) -> Signs {
        let silent = Duration::from_millis(1000 * silent + 300);
        Signs { is_there: true, was_there: true, is_held, phase, silent, ..Signs::default() }
    }

    #[test]
    fn a_run_is_as_it_says_until_it_is_silent_or_its_process_is_gone() {
        let at = |phase, is_held, silent| condition(&signs(Some(phase), is_held, silent));
        for phase in [Phase::Training, Phase::Paused, Phase::Measuring] {
            assert_eq!(at(phase, true, 5), Condition::Is(phase));
            assert_eq!(at(phase, false, 5), Condition::Died);
            assert_eq!(at(phase, false, 1), Condition::Is(phase), "a file system without locks");
        }
        assert_eq!(at(Phase::Training, true, 40), Condition::Stalled(Duration::from_secs(40)));
        assert_eq!(at(Phase::Measuring, true, 40), Condition::Is(Phase::Measuring));
        assert_eq!(at(Phase::Measuring, true, 700), Condition::Stalled(Duration::from_secs(700)));
        assert_eq!(at(Phase::Stopped, false, 9999), Condition::Is(Phase::Stopped));
    }

    #[test]
    fn runs_that_say_nothing_of_themselves_are_judged_by_their_lock_and_their_lines() {
        assert_eq!(condition(&signs(None, true, 0)), Condition::Is(Phase::Training));
        let with = |shots, planned| condition(&Signs { shots, planned, ..signs(None, false, 0) });
        assert_eq!(with(Some(10), Some(10)), Condition::Is(Phase::Finished));
        assert_eq!(with(Some(9), Some(10)), Condition::Interrupted);
        assert_eq!(with(None, Some(10)), Condition::Interrupted);
        assert_eq!(with(None, None), Condition::Missing);
        assert_eq!(condition(&Signs::default()), Condition::Missing);
        assert_eq!(condition(&Signs { was_there: true, ..Signs::default() }), Condition::Removed);
    }
}
