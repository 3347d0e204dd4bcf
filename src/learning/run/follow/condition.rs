//! The condition of a run as seen from outside, by its files and its lock.

use std::{fmt, time::Duration};

use serde::{Serialize, Serializer};

use crate::learning::run::status::Phase;

/// Time without a heartbeat after which a run that trains or is paused counts as stalled; a heartbeat is due every second.
const HEARTBEAT_TIMEOUT: Duration = Duration::from_secs(15);

/// The same timeout while the run plays the held-out layouts, which may be many.
const MEASURING_TIMEOUT: Duration = Duration::from_secs(600);

/// Grace period in which the lock and `state.json` may disagree, because a run changes them in two steps.
const FRESH: Duration = Duration::from_secs(2);

/// The condition of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Condition {
    /// Nothing is known yet.
    #[default]
    Unknown,
    /// There is no run in the folder yet.
    Missing,
    /// The run's own status is right.
    InPhase(Phase),
    /// Its process exists and has written nothing for this time, in whole seconds.
    Stalled(Duration),
    /// Its process ended without writing a final status: it was killed, or the machine stopped.
    Died,
    /// It is not finished and no process works on it. It is unknown how it ended; it is displayed as stopped.
    Interrupted,
    /// Its folder has been removed.
    Removed,
}

impl Condition {
    /// Whether both conditions are the same, apart from the time for which a run has been stalled.
    pub fn is_like(self, other: Self) -> bool {
        self == other || matches!((self, other), (Self::Stalled(_), Self::Stalled(_)))
    }

    /// Returns the condition in one word, for lists and for programs.
    pub const fn word(self) -> &'static str {
        match self {
            Self::InPhase(Phase::Training | Phase::Measuring | Phase::Stopping) => "running",
            Self::InPhase(phase) => phase.name(),
            Self::Stalled(_) => "stalled",
            Self::Died => "died",
            Self::Unknown | Self::Missing | Self::Interrupted | Self::Removed => "stopped",
        }
    }

    /// Whether a process works on the run.
    pub const fn is_at_work(self) -> bool {
        match self {
            Self::InPhase(phase) => !phase.is_over(),
            Self::Stalled(_) => true,
            _ => false,
        }
    }

    /// Whether the run has ended and will write nothing more unless it is resumed.
    pub const fn is_over(self) -> bool {
        match self {
            Self::InPhase(phase) => phase.is_over(),
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
            Self::InPhase(phase) => out.write_str(phase.name()),
            Self::Stalled(since) => write!(out, "stalled for {} s", since.as_secs()),
            Self::Died => out.write_str("died"),
            Self::Interrupted => out.write_str("stopped"),
            Self::Removed => out.write_str("removed"),
        }
    }
}

impl Serialize for Condition {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.word())
    }
}

/// Observations of a run from outside.
#[derive(Clone, Debug, Default)]
pub struct RunSigns {
    /// Whether its folder exists.
    pub is_there: bool,
    /// Whether its folder existed at any earlier look.
    pub was_there: bool,
    /// Whether the folder contains a checkpoint.
    pub is_run: bool,
    /// Whether a process holds its lock; `None` if the system does not tell.
    pub is_locked: Option<bool>,
    /// Phase in its status file.
    pub phase: Option<Phase>,
    /// Time since its status file last changed.
    pub silent: Duration,
    /// Shots played at its last line of metrics.
    pub shots: Option<u64>,
    /// Shots planned.
    pub planned: Option<u64>,
}

/// Infers the condition of a run from the observations.
pub fn condition(signs: &RunSigns) -> Condition {
    let RunSigns { is_there, was_there, is_run, is_locked, phase, silent, shots, planned } = *signs;
    let locked = is_locked == Some(true);
    match phase {
        _ if !is_there && was_there => Condition::Removed,
        _ if !is_there => Condition::Missing,
        // Another process has resumed the run and has not written its status yet.
        Some(phase) if phase.is_over() && locked && silent >= FRESH => Condition::InPhase(Phase::Training),
        Some(phase) if phase.is_over() => Condition::InPhase(phase),
        Some(phase) => {
            let is_measured = matches!(phase, Phase::Measuring | Phase::Stopping);
            let timeout = if is_measured { MEASURING_TIMEOUT } else { HEARTBEAT_TIMEOUT };
            // A run in the phase Stopping is already saved, so a second signal that ends it at once has merely stopped it.
            let gone = if phase == Phase::Stopping { Condition::InPhase(Phase::Stopped) } else { Condition::Died };
            match is_locked {
                // In whole seconds, so that a condition changes once a second, and not with every look.
                Some(true) if silent >= timeout => Condition::Stalled(Duration::from_secs(silent.as_secs())),
                Some(false) if silent >= FRESH => gone,
                // Without locks, only the silence shows that the process is gone.
                None if silent >= timeout => gone,
                _ => Condition::InPhase(phase),
            }
        }
        // A run that has just begun, or one of an early version without a status file.
        None if locked => Condition::InPhase(Phase::Training),
        None if shots.is_some_and(|shots| planned.is_some_and(|planned| shots >= planned)) => {
            Condition::InPhase(Phase::Finished)
        }
        None if is_run || planned.is_some() || shots.is_some() => Condition::Interrupted,
        None => Condition::Missing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signs(phase: Option<Phase>, is_locked: Option<bool>, silent: u64) -> RunSigns {
        let silent = Duration::from_millis(1000 * silent + 300);
        RunSigns { is_there: true, was_there: true, is_run: true, is_locked, phase, silent, ..RunSigns::default() }
    }

    #[test]
    fn the_status_is_valid_while_its_process_lives() {
        let at = |phase, is_locked, silent| condition(&signs(Some(phase), is_locked, silent));
        let (locked, free) = (Some(true), Some(false));
        for phase in [Phase::Training, Phase::Paused, Phase::Measuring] {
            assert_eq!(at(phase, locked, 5), Condition::InPhase(phase));
            assert_eq!(at(phase, free, 5), Condition::Died);
            assert_eq!(at(phase, free, 1), Condition::InPhase(phase), "it has just taken the lock");
        }
        assert_eq!(at(Phase::Stopping, locked, 40), Condition::InPhase(Phase::Stopping), "the evaluation takes long");
        assert_eq!(at(Phase::Stopping, free, 5), Condition::InPhase(Phase::Stopped), "a second signal has ended it");
        assert_eq!(at(Phase::Training, locked, 40), Condition::Stalled(Duration::from_secs(40)));
        assert_eq!(at(Phase::Measuring, locked, 40), Condition::InPhase(Phase::Measuring));
        assert_eq!(at(Phase::Measuring, locked, 700), Condition::Stalled(Duration::from_secs(700)));
        assert_eq!(at(Phase::Stopped, free, 9999), Condition::InPhase(Phase::Stopped));
        assert_eq!(
            at(Phase::Stopped, locked, 0),
            Condition::InPhase(Phase::Stopped),
            "it is about to release the lock"
        );
        assert_eq!(at(Phase::Stopped, locked, 9), Condition::InPhase(Phase::Training), "it has been resumed");
    }

    #[test]
    fn without_locks_a_silent_process_counts_as_ended() {
        let at = |phase, silent| condition(&signs(Some(phase), None, silent));
        assert_eq!(at(Phase::Training, 5), Condition::InPhase(Phase::Training));
        assert_eq!(at(Phase::Training, 20), Condition::Died);
        assert_eq!(at(Phase::Measuring, 60), Condition::InPhase(Phase::Measuring));
    }

    #[test]
    fn without_a_status_file_lock_and_lines_decide() {
        assert_eq!(condition(&signs(None, Some(true), 0)), Condition::InPhase(Phase::Training));
        let with = |shots, planned| condition(&RunSigns { shots, planned, ..signs(None, Some(false), 0) });
        assert_eq!(with(Some(10), Some(10)), Condition::InPhase(Phase::Finished));
        assert_eq!(with(Some(9), Some(10)), Condition::Interrupted);
        assert_eq!(with(None, None), Condition::Interrupted, "only a checkpoint");
        let empty = RunSigns { is_run: false, ..signs(None, None, 0) };
        assert_eq!(condition(&empty), Condition::Missing);
        assert_eq!(condition(&RunSigns::default()), Condition::Missing);
        assert_eq!(condition(&RunSigns { was_there: true, ..RunSigns::default() }), Condition::Removed);
    }
}
