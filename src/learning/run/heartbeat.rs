//! The heartbeat of a run that is training: about once a second it tells what it is doing, and it listens to what it is asked.

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
pub const BEAT: Duration = Duration::from_secs(1);

/// Time between two looks for a request.
const EAR: Duration = Duration::from_millis(200);

/// Beats over which speeds are taken.
const SPEED_BEATS: usize = 6;

/// Status for watchers of a run. Nothing of it is needed to resume, so a failure to write it is ignored.
#[derive(Debug)]
pub struct Heartbeat {
    folder: PathBuf,
    /// What is told with the next beat.
    pub status: RunStatus,
    beaten: Option<Instant>,
    listened: Instant,
    /// Seconds of training, shots and updates at the last beats, for the speeds.
    track: VecDeque<(f64, u64, u64)>,
}

impl Heartbeat {
    /// That of the run in `folder`, which begins to work now: an earlier request was not meant for it.
    pub fn new(folder: &Path) -> Self {
        Request::clear(folder);
        let status = RunStatus { process: std::process::id(), ..RunStatus::default() };
        let track = VecDeque::with_capacity(SPEED_BEATS);
        Self { folder: folder.to_owned(), status, beaten: None, listened: Instant::now(), track }
    }

    /// Tells what the run is doing, `seconds` into its training, if a second has passed or it does something else now.
    pub fn beat(&mut self, phase: Phase, learner: &dyn Learner, seconds: f64) {
        let is_due = self.beaten.is_none_or(|beaten| beaten.elapsed() >= BEAT);
        if is_due || phase != self.status.phase {
            self.tell(phase, learner, seconds);
        }
    }

    /// Tells how the run has ended.
    pub fn end(&mut self, phase: Phase, learner: &dyn Learner, seconds: f64, reason: Option<String>) {
        self.status.reason = reason;
        Request::clear(&self.folder);
        self.tell(phase, learner, seconds);
    }

    /// What the run is asked to do, or a sentence about what is not understood.
    pub fn request(&mut self) -> Option<Result<Request, String>> {
        if self.listened.elapsed() < EAR {
            return None;
        }
        self.listened = Instant::now();
        Request::take(&self.folder)
    }

    fn tell(&mut self, phase: Phase, learner: &dyn Learner, seconds: f64) {
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
            // A measurement is no part of the speed: it is measured again from its end.
            self.track.clear();
        }
        self.status.phase = phase;
        (self.status.shots, self.status.updates, self.status.seconds) = (shots, updates, seconds);
        (self.status.exploration, self.status.replay_fill) = (exploration, replay_fill);
        // Nobody has to watch: a full disk stops checkpoints, and says so, but not this.
        let _ = self.status.write(&self.folder);
        self.beaten = Some(Instant::now());
    }
}
