//! How a run is, as far as one can see from outside.

use std::{fmt, time::Duration};

use serde::{Serialize, Serializer};

use crate::learning::run::status::Phase;

/// Silence after which a run that trains or waits is stalled: it should have said something each second.
const HEARTBEAT_TIMEOUT: Duration = Duration::from_secs(15);

/// The same while it plays the held-out layouts, which may be many.
const MEASURING_TIMEOUT: Duration = Duration::from_secs(600);

/// Locking and writing `state.json` are two steps; for so long their disagreement means nothing.
const FRESH: Duration = Duration::from_secs(2);

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
    /// It is not finished and no process works on it; how it ended is not known, and it is called stopped.
    Interrupted,
    /// Its folder has been removed.
    Removed,
}

impl Condition {
    /// Whether the other one is the same, however long a run has been stalled.
    pub fn is_like(self, other: Self) -> bool {
        self == other || matches!((self, other), (Self::Stalled(_), Self::Stalled(_)))
    }

    /// In a word, for lists and for programs.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Is(Phase::Training | Phase::Measuring | Phase::Stopping) => "running",
            Self::Is(phase) => phase.name(),
            Self::Stalled(_) => "stalled",
            Self::Died => "died",
            Self::Unknown | Self::Missing | Self::Interrupted | Self::Removed => "stopped",
        }
    }

    /// Whether a process works on it.
    pub const fn is_at_work(self) -> bool {
        match self {
            Self::Is(phase) => !phase.is_over(),
            Self::Stalled(_) => true,
            _ => false,
        }
    }

    /// Whether nothing more will come unless the run is resumed.
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

/// What is seen of a run from outside.
#[derive(Clone, Debug, Default)]
pub struct Signs {
    /// Whether its folder is there.
    pub is_there: bool,
    /// Whether it has been.
    pub was_there: bool,
    /// Whether there is anything to go on from.
    pub is_run: bool,
    /// Whether a process holds its lock, if that can be known.
    pub is_held: Option<bool>,
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
    let Signs { is_there, was_there, is_run, is_held, phase, silent, shots, planned } = *signs;
    let held = is_held == Some(true);
    match phase {
        _ if !is_there && was_there => Condition::Removed,
        _ if !is_there => Condition::Missing,
        // Somebody has taken it up again and has not said anything yet.
        Some(phase) if phase.is_over() && held && silent >= FRESH => Condition::Is(Phase::Training),
        Some(phase) if phase.is_over() => Condition::Is(phase),
        Some(phase) => {
            let is_measured = matches!(phase, Phase::Measuring | Phase::Stopping);
            let timeout = if is_measured { MEASURING_TIMEOUT } else { HEARTBEAT_TIMEOUT };
            // One that is told to stop saves before it is measured: a second signal, which ends it at once, has stopped it.
            let gone = if phase == Phase::Stopping { Condition::Is(Phase::Stopped) } else { Condition::Died };
            match is_held {
                // In whole seconds, so that a condition changes once a second, and not with every look.
                Some(true) if silent >= timeout => Condition::Stalled(Duration::from_secs(silent.as_secs())),
                Some(false) if silent >= FRESH => gone,
                // Where there are no locks, silence is all there is to tell by.
                None if silent >= timeout => gone,
                _ => Condition::Is(phase),
            }
        }
        // A run that has just begun, or of a carom that said nothing of itself.
        None if held => Condition::Is(Phase::Training),
        None if shots.is_some_and(|shots| planned.is_some_and(|planned| shots >= planned)) => {
            Condition::Is(Phase::Finished)
        }
        None if is_run || planned.is_some() || shots.is_some() => Condition::Interrupted,
        None => Condition::Missing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signs(phase: Option<Phase>, is_held: Option<bool>, silent: u64) -> Signs {
        let silent = Duration::from_millis(1000 * silent + 300);
        Signs { is_there: true, was_there: true, is_run: true, is_held, phase, silent, ..Signs::default() }
    }

    #[test]
    fn a_run_is_as_it_says_until_it_is_silent_or_its_process_is_gone() {
        let at = |phase, is_held, silent| condition(&signs(Some(phase), is_held, silent));
        let (held, free) = (Some(true), Some(false));
        for phase in [Phase::Training, Phase::Paused, Phase::Measuring] {
            assert_eq!(at(phase, held, 5), Condition::Is(phase));
            assert_eq!(at(phase, free, 5), Condition::Died);
            assert_eq!(at(phase, free, 1), Condition::Is(phase), "it has just begun to hold the lock");
        }
        assert_eq!(at(Phase::Stopping, held, 40), Condition::Is(Phase::Stopping), "it is measured");
        assert_eq!(at(Phase::Stopping, free, 5), Condition::Is(Phase::Stopped), "a second signal has ended it");
        assert_eq!(at(Phase::Training, held, 40), Condition::Stalled(Duration::from_secs(40)));
        assert_eq!(at(Phase::Measuring, held, 40), Condition::Is(Phase::Measuring));
        assert_eq!(at(Phase::Measuring, held, 700), Condition::Stalled(Duration::from_secs(700)));
        assert_eq!(at(Phase::Stopped, free, 9999), Condition::Is(Phase::Stopped));
        assert_eq!(at(Phase::Stopped, held, 0), Condition::Is(Phase::Stopped), "it is about to let go of the lock");
        assert_eq!(at(Phase::Stopped, held, 9), Condition::Is(Phase::Training), "it has been taken up again");
    }

    #[test]
    fn without_locks_silence_tells() {
        let at = |phase, silent| condition(&signs(Some(phase), None, silent));
        assert_eq!(at(Phase::Training, 5), Condition::Is(Phase::Training));
        assert_eq!(at(Phase::Training, 20), Condition::Died);
        assert_eq!(at(Phase::Measuring, 60), Condition::Is(Phase::Measuring));
    }

    #[test]
    fn runs_that_say_nothing_of_themselves_are_judged_by_their_lock_and_their_lines() {
        assert_eq!(condition(&signs(None, Some(true), 0)), Condition::Is(Phase::Training));
        let with = |shots, planned| condition(&Signs { shots, planned, ..signs(None, Some(false), 0) });
        assert_eq!(with(Some(10), Some(10)), Condition::Is(Phase::Finished));
        assert_eq!(with(Some(9), Some(10)), Condition::Interrupted);
        assert_eq!(with(None, None), Condition::Interrupted, "nothing but a checkpoint");
        let empty = Signs { is_run: false, ..signs(None, None, 0) };
        assert_eq!(condition(&empty), Condition::Missing);
        assert_eq!(condition(&Signs::default()), Condition::Missing);
        assert_eq!(condition(&Signs { was_there: true, ..Signs::default() }), Condition::Removed);
    }
}
