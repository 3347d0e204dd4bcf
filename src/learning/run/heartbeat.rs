//! The heartbeat of a training run: about once a second it writes the run's status, and it polls for requests.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use super::{
    request::Request,
    status::{Phase, RunStatus},
};
use crate::learning::learner::{Learner, Progress};

/// Time between two beats. A run that misses many of them counts as stalled.
const HEARTBEAT_INTERVAL: Duration = Duration::from_secs(1);

/// Time between two polls for a request.
const REQUEST_INTERVAL: Duration = Duration::from_millis(200);

/// Number of beats over which speeds are averaged.
const SPEED_BEATS: usize = 6;

/// Writer of the status for watchers of a run. Resuming does not need the status, so a failure to write it is ignored.
#[derive(Debug)]
pub struct Heartbeat {
    folder: PathBuf,
    /// The status that the next beat writes.
    pub status: RunStatus,
    last_beat: Option<Instant>,
    last_poll: Instant,
    /// Seconds of training, shots and updates at the last beats, for the speeds.
    track: VecDeque<(f64, u64, u64)>,
}

impl Heartbeat {
    /// Creates the heartbeat of the run in `folder`, which starts now. Removes an earlier request, which was not meant for this process.
    pub fn new(folder: &Path) -> Self {
        Request::clear(folder);
        let status = RunStatus { process: std::process::id(), ..RunStatus::default() };
        Self { folder: folder.to_owned(), status, last_beat: None, last_poll: Instant::now(), track: VecDeque::new() }
    }

    /// Writes the status, `seconds` into the training, if a second has passed since the last beat or the phase has changed.
    pub fn beat(&mut self, phase: Phase, learner: &dyn Learner, seconds: f64) {
        let is_due = self.last_beat.is_none_or(|last| last.elapsed() >= HEARTBEAT_INTERVAL);
        if is_due || phase != self.status.phase {
            self.write_status(phase, learner, seconds);
        }
    }

    /// Writes the final status of the run.
    pub fn end(&mut self, phase: Phase, learner: &dyn Learner, seconds: f64, reason: Option<String>) {
        self.status.reason = reason;
        Request::clear(&self.folder);
        self.write_status(phase, learner, seconds);
    }

    /// Polls for a request. Returns a sentence as an error if the request is not understood.
    pub fn request(&mut self) -> Option<Result<Request, String>> {
        if self.last_poll.elapsed() < REQUEST_INTERVAL {
            return None;
        }
        self.last_poll = Instant::now();
        Request::receive(&self.folder)
    }

    fn write_status(&mut self, phase: Phase, learner: &dyn Learner, seconds: f64) {
        let (shots, Progress { updates, exploration, replay_fill, .. }) = (learner.shots(), learner.progress());
        if phase == Phase::Paused {
            self.track.clear();
            (self.status.shots_per_second, self.status.updates_per_second) = (0.0, 0.0);
        }
        if self.track.len() == SPEED_BEATS {
            self.track.pop_front();
        }
        self.track.push_back((seconds, shots, updates));
        let (first, passed) = (self.track[0], seconds - self.track[0].0);
        if passed > 0.0 {
            self.status.shots_per_second = (shots - first.1) as f64 / passed;
            self.status.updates_per_second = (updates - first.2) as f64 / passed;
        }
        if matches!(phase, Phase::Measuring | Phase::Stopping) {
            // An evaluation does not count for the speeds: they are averaged from its end on.
            self.track.clear();
        }
        self.status.phase = phase;
        (self.status.shots, self.status.updates, self.status.seconds) = (shots, updates, seconds);
        (self.status.exploration, self.status.replay_fill) = (exploration, replay_fill);
        // Errors are ignored, because the status is optional; a full disk is reported when a checkpoint fails.
        let _ = self.status.write(&self.folder);
        self.last_beat = Some(Instant::now());
    }
}
