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

#[cfg(test)]
mod tests {
    use std::{thread, time::Duration};

    use super::*;
    use crate::learning::run::{
        Ending, Limits, Run, Watcher, discard,
        examples::{self, Examples},
        follow::{Condition, Followed, Follower},
        metrics::Record,
        tests::{FOREVER, Told, small_run},
    };

    /// Asks the run in `folder` from another thread as soon as it is in `phase`.
    fn ask(folder: &Path, phase: Phase, request: Request) -> thread::JoinHandle<()> {
        let folder = folder.to_owned();
        thread::spawn(move || {
            for _ in 0..4000 {
                if RunStatus::read(&folder).is_ok_and(|status| status.phase == phase) {
                    break;
                }
                thread::sleep(Duration::from_millis(5));
            }
            request.send(&folder).unwrap();
        })
    }

    /// Holds the run up between two iterations, so that it does not end before it is asked.
    const SLOW: Limits<'_> = Limits { time: None, stop: &linger };

    fn linger() -> bool {
        thread::sleep(Duration::from_millis(60));
        false
    }

    #[test]
    fn a_run_waits_goes_on_and_stops_as_it_is_asked_and_ends_in_the_same_place() {
        let folder = tempfile::tempdir().unwrap();
        let mut run = small_run(folder.path());
        // What was asked of an earlier process is not done.
        Request::Abandon.send(folder.path()).unwrap();
        let asking =
            [ask(folder.path(), Phase::Training, Request::Pause), ask(folder.path(), Phase::Paused, Request::Stop)];
        let ending = run.train(&SLOW, &mut Told::default()).unwrap();
        for thread in asking {
            thread.join().unwrap();
        }
        assert!(matches!(ending, Ending::Stopped(_)));
        assert_eq!(RunStatus::read(folder.path()).unwrap().phase, Phase::Stopped);
        drop(run);
        let mut run = Run::resume(folder.path()).unwrap().0;
        let asking =
            [ask(folder.path(), Phase::Training, Request::Pause), ask(folder.path(), Phase::Paused, Request::GoOn)];
        assert!(matches!(run.train(&SLOW, &mut Told::default()).unwrap(), Ending::Finished(_)));
        for thread in asking {
            thread.join().unwrap();
        }
        assert_eq!(Request::take(folder.path()), None);
        let (whole, other) = (folder.path().join("checkpoint.safetensors"), tempfile::tempdir().unwrap());
        small_run(other.path()).train(&FOREVER, &mut Told::default()).unwrap();
        assert!(std::fs::read(whole).unwrap() == std::fs::read(other.path().join("checkpoint.safetensors")).unwrap());
    }

    #[test]
    fn a_run_that_is_given_up_leaves_nothing_but_what_is_not_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let mut run = small_run(path);
        std::fs::write(path.join("notes.txt"), "mine").unwrap();
        let asking = ask(path, Phase::Training, Request::Abandon);
        assert_eq!(run.train(&SLOW, &mut Told::default()).unwrap(), Ending::Abandoned);
        asking.join().unwrap();
        assert!(discard(path).unwrap_err().to_string().contains("another process"));
        drop(run);
        discard(path).unwrap();
        let left: Vec<_> = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["notes.txt"]);
    }

    /// Gives its run up as soon as that has measured itself for the last time.
    struct GivesUp<'a>(&'a Path);

    impl Watcher for GivesUp<'_> {
        fn line(&mut self, record: &Record) {
            if record.shots == 160 {
                Request::Abandon.send(self.0).unwrap();
            }
        }

        fn warn(&mut self, _: &str) {}
    }

    #[test]
    fn a_run_that_is_given_up_during_its_last_measurement_does_not_finish() {
        let folder = tempfile::tempdir().unwrap();
        let ending = small_run(folder.path()).train(&FOREVER, &mut GivesUp(folder.path())).unwrap();
        assert_eq!(ending, Ending::Abandoned);
        assert!(!folder.path().join("result.json").exists());
        assert_eq!(RunStatus::read(folder.path()).unwrap().phase, Phase::Stopped);
    }

    #[test]
    fn whoever_follows_sees_a_run_begin_work_tell_what_it_does_and_end() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        let (mut follower, mut followed) = (Follower::new(&path), Followed::new(&path));
        followed.apply(follower.look().unwrap());
        assert_eq!(followed.condition, Condition::Missing);
        assert!(follower.look().is_none(), "nothing has changed");
        let mut run = small_run(&path);
        run.train(&FOREVER, &mut Told::default()).unwrap();
        let status = RunStatus::read(&path).unwrap();
        assert_eq!((status.phase, status.shots, status.process), (Phase::Finished, 160, std::process::id()));
        assert!(status.updates > 0 && status.replay_fill == Some(1.0) && status.exploration > 0.0, "{status:?}");
        let Examples { after, shots } = Examples::read(&path).unwrap();
        assert_eq!((after, shots.len()), (160, examples::COUNT));
        let (reward, table) = (run.learner().plan().reward, run.learner().table());
        assert!(shots.iter().all(|shot| shot.reward == reward.of(table, &shot.layout, &shot.cue)));
        drop(run);
        let mut follower = Follower::new(&path);
        let update = follower.look().unwrap();
        assert_eq!(update.records.len(), 5);
        followed.apply(update);
        assert_eq!(followed.condition, Condition::Is(Phase::Finished));
        assert_eq!(followed.config.as_ref().unwrap().plan.shots, 160);
        assert!(followed.examples.is_some() && followed.notices.is_empty());
        std::fs::remove_file(path.join("metrics.jsonl")).unwrap();
        followed.apply(follower.look().unwrap());
        assert!(followed.notices[0].contains("metrics.jsonl has been removed"), "{:?}", followed.notices);
    }
}
