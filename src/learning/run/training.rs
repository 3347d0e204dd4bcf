//! The training loop of a run: iterations, evaluations, metrics, checkpoints and requests.

use std::{
    fs, thread,
    time::{Duration, Instant},
};

use serde_json::json;

use super::{
    BEST_OF_K, METRICS, RESULT, REWARD, Run, RunError, Schedule,
    error::file,
    event_file::EventFile,
    examples::Examples,
    heartbeat::Heartbeat,
    json,
    metrics::{MetricsFile, Record},
    request::Request,
    status::Phase,
};
use crate::{
    learning::{
        evaluation::{HELD_OUT_SEED, Score, held_out_layouts},
        learner::{Iteration, Learner, TrainingPlan},
    },
    printing::VERSION,
    table::Layout,
};

/// Longest time between two checkpoints, which a power failure can cost. It may depend on the clock, because nothing depends on
/// the time at which a checkpoint is written.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);

/// Time between two polls for the end of a pause.
const PAUSE_POLL_INTERVAL: Duration = Duration::from_millis(100);

/// What a run reports in its own process. Other processes follow its folder ([`super::follow`]).
#[derive(Clone, Copy, Debug)]
pub enum Report<'a> {
    /// A line of metrics.
    Line(&'a Record),
    /// A warning about a problem that does not stop the training.
    Warning(&'a str),
}

/// How a run ended, with its score on the held-out layouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// All shots have been played.
    Finished(Score),
    /// It was stopped and can be resumed.
    Stopped(Score),
    /// It was abandoned: nothing was saved, and the caller must discard the run.
    Abandoned,
}

/// Limits that end the training before the plan is finished.
pub struct Limits<'a> {
    /// Longest training time, without pauses.
    pub time: Option<Duration>,
    /// Called between two iterations; returns whether to stop.
    pub stop: &'a dyn Fn() -> bool,
}

/// Outputs of the training.
struct Reporting<'a> {
    metrics: MetricsFile,
    /// `None` if the run is finished or the file cannot be written. The latter is ignored: the file only repeats the metrics for
    /// `TensorBoard`.
    events: Option<EventFile>,
    clock: Clock,
    heartbeat: Heartbeat,
    layouts: Vec<Layout>,
    report: &'a mut dyn FnMut(Report<'_>),
}

impl Run {
    /// Trains until the plan is finished, a limit is reached or a [`Request`] in the folder ends it. The folder then contains
    /// a checkpoint from which the run can be resumed. If an intermediate checkpoint cannot be written, it reports a warning
    /// and training continues to the next one.
    ///
    /// # Errors
    /// Fails if training fails or the last checkpoint cannot be written.
    pub fn train(&mut self, limits: &Limits<'_>, report: &mut dyn FnMut(Report<'_>)) -> Result<Ending, RunError> {
        let path = self.folder.join(METRICS);
        let (metrics, records) = MetricsFile::open(&path, self.learner.shots()).map_err(file(&path))?;
        let (last, shots) = (records.last().map(|record| record.shots), self.learner.shots());
        let layouts = held_out_layouts(self.learner.table(), self.state.schedule.evaluation_layouts, HELD_OUT_SEED);
        let mut events = None;
        // A finished run writes no more lines.
        if !self.learner.is_finished() {
            events = EventFile::open(&self.folder, &records, shots).ok();
            // A result exists here if the last checkpoint of a finished run was lost and the run resumes from the previous one.
            let _ = fs::remove_file(self.folder.join(RESULT));
        }
        let before = records.last().map_or(0.0, |record| record.seconds);
        let clock = Clock { start: Instant::now(), before, paused: Duration::ZERO, last: (before, shots) };
        let mut heartbeat = Heartbeat::new(&self.folder);
        heartbeat.status.logged = last.unwrap_or(0);
        let mut reporting = Reporting { metrics, events, clock, heartbeat, layouts, report };
        let ending = self.iterate_until(limits, &mut reporting).and_then(|ending| {
            // A request to abandon may have arrived during the last evaluation, after which no other poll follows.
            if Request::receive(&self.folder) == Some(Ok(Request::Abandon)) {
                return Ok(Ending::Abandoned);
            }
            if let Ending::Finished(score) = ending
                && self.result().is_none()
            {
                self.write_result(score)?;
            }
            Ok(ending)
        });
        let (phase, reason) = match &ending {
            Ok(Ending::Finished(_)) => (Phase::Finished, None),
            Ok(Ending::Stopped(_) | Ending::Abandoned) => (Phase::Stopped, None),
            Err(error) => (Phase::Failed, Some(error.to_string())),
        };
        reporting.heartbeat.end(phase, self.learner.as_ref(), reporting.clock.seconds(), reason);
        ending
    }

    /// Writes the result with the score of the last evaluation, for programs that compare runs.
    fn write_result(&self, score: Score) -> Result<(), RunError> {
        let learner = self.learner.as_ref();
        let TrainingPlan { reward, seed, .. } = learner.plan();
        let result = json!({
            "agent": learner.agent(), "reward": reward, "seed": seed, "table": learner.table().name, "version": VERSION,
            // May exceed the plan by a part of the last iteration.
            "shots": learner.shots(),
            "updates": learner.progress().updates,
            REWARD: score.mean_reward,
            BEST_OF_K: score.best_of_k,
        });
        json::write(&self.folder.join(RESULT), &result)
    }

    fn iterate_until(&mut self, limits: &Limits<'_>, reporting: &mut Reporting<'_>) -> Result<Ending, RunError> {
        if self.learner.is_finished() {
            let Some(score) = self.result() else {
                let score = self.measure(reporting, Phase::Measuring)?;
                return self.finish(score, limits, reporting);
            };
            // The stored score, because another version's simulator might measure another one.
            reporting.heartbeat.status.held_out_reward = Some(score.mean_reward);
            return if self.policy_path().exists() {
                Ok(Ending::Finished(score))
            } else {
                self.finish(score, limits, reporting)
            };
        }
        let mut saved = Instant::now();
        loop {
            reporting.heartbeat.beat(Phase::Training, self.learner.as_ref(), reporting.clock.seconds());
            let is_over = || (limits.stop)() || limits.time.is_some_and(|limit| reporting.clock.session() >= limit);
            let mut stops = is_over();
            match reporting.request() {
                Some(Request::Pause) => match self.pause(reporting, limits.stop) {
                    Request::Abandon => return Ok(Ending::Abandoned),
                    request => stops |= request == Request::Stop,
                },
                Some(Request::Stop) => stops = true,
                Some(Request::Abandon) => return Ok(Ending::Abandoned),
                Some(Request::Resume) | None => {}
            }
            if stops {
                // Saved before the evaluation, which may take long: a user who cannot wait may end it by a second signal.
                self.save(&mut reporting.metrics, None).map_err(|reason| self.unsaved(reason))?;
                let score = self.measure(reporting, Phase::Stopping)?;
                self.write_policy(score, &mut || true).map_err(|reason| self.unsaved(reason))?;
                return Ok(Ending::Stopped(score));
            }
            let score = self.iterate(reporting)?;
            if score.is_some() || saved.elapsed() >= CHECKPOINT_INTERVAL {
                let result = self.save(&mut reporting.metrics, score);
                saved = Instant::now();
                match (result, score.filter(|_| self.learner.is_finished())) {
                    (Ok(()), Some(score)) => return self.finish(score, limits, reporting),
                    (Ok(()), None) => {}
                    (Err(reason), Some(_)) => return Err(self.unsaved(reason)),
                    (Err(reason), None) => reporting.warn_of_checkpoint(&reason, self.learner.shots()),
                }
            }
        }
    }

    /// Writes the policy of a run that has played its last shot and is saved. Its calibration may take minutes; a run that is stopped
    /// meanwhile repeats it when it is resumed.
    fn finish(&self, score: Score, limits: &Limits<'_>, reporting: &mut Reporting<'_>) -> Result<Ending, RunError> {
        let mut ending = Ending::Finished(score);
        let mut go_on = || {
            reporting.heartbeat.beat(Phase::Measuring, self.learner.as_ref(), reporting.clock.seconds());
            let request = reporting.request();
            if request == Some(Request::Abandon) {
                ending = Ending::Abandoned;
            } else if request == Some(Request::Stop) || (limits.stop)() {
                ending = Ending::Stopped(score);
            }
            matches!(ending, Ending::Finished(_))
        };
        self.write_policy(score, &mut go_on).map_err(|reason| self.unsaved(reason))?;
        Ok(ending)
    }

    /// Saves and waits for the next request, which is never another pause.
    fn pause(&mut self, reporting: &mut Reporting<'_>, stop: &dyn Fn() -> bool) -> Request {
        let begin = Instant::now();
        if let Err(reason) = self.save(&mut reporting.metrics, None) {
            reporting.warn_of_checkpoint(&reason, self.learner.shots());
        }
        let seconds = reporting.clock.seconds();
        let request = loop {
            reporting.heartbeat.beat(Phase::Paused, self.learner.as_ref(), seconds);
            match reporting.request() {
                Some(Request::Pause) | None if stop() => break Request::Stop,
                Some(Request::Pause) | None => thread::sleep(PAUSE_POLL_INTERVAL),
                Some(request) => break request,
            }
        };
        reporting.clock.paused += begin.elapsed();
        request
    }

    /// Evaluates the agent on the held-out layouts; `phase` is the phase to report meanwhile.
    fn measure(&self, reporting: &mut Reporting<'_>, phase: Phase) -> Result<Score, RunError> {
        let learner = self.learner.as_ref();
        reporting.heartbeat.beat(phase, learner, reporting.clock.seconds());
        let score = learner.score(&reporting.layouts)?;
        // The status contains the reward, because a stopped run has no line of metrics for it.
        reporting.heartbeat.status.held_out_reward = Some(score.mean_reward);
        // A failure to write is ignored, because the examples are only for display.
        let _ = Examples::of(learner, &reporting.layouts)?.write(&self.folder);
        Ok(score)
    }

    /// Makes one iteration, and the evaluation and the line of metrics that are due after it. Returns the score of the evaluation.
    fn iterate(&mut self, reporting: &mut Reporting<'_>) -> Result<Option<Score>, RunError> {
        let Schedule { log_every, evaluate_every, .. } = self.state.schedule;
        let [before, updated] = [self.learner.shots(), self.learner.progress().updates];
        let iteration = self.learner.iterate()?;
        let shots = self.learner.shots();
        let is_finite =
            self.state.accumulator.add(&iteration, shots - before, self.learner.progress().updates - updated);
        let passed = |every: u64| before / every != shots / every;
        let trained = reporting.clock.seconds();
        let is_due = is_finite && (self.learner.is_finished() || passed(evaluate_every));
        let score = if is_due { Some(self.measure(reporting, Phase::Measuring)?) } else { None };
        if !is_finite || score.is_some() || passed(log_every) {
            let measuring = reporting.clock.seconds() - trained;
            let record = reporting.clock.record(self.learner.as_ref(), self.state.accumulator.take(), score, measuring);
            reporting.metrics.push(&record);
            if reporting.events.as_mut().is_some_and(|events| events.push(&record).is_err()) {
                reporting.events = None;
            }
            (reporting.report)(Report::Line(&record));
            // If the disk is full, the line stays pending in memory. No checkpoint is written before it.
            if reporting.metrics.flush().is_ok() {
                reporting.heartbeat.status.logged = shots;
            }
        }
        if is_finite { Ok(score) } else { Err(RunError::NotFinite(shots)) }
    }
}

impl Reporting<'_> {
    /// Polls for a request; warns about one that is not understood.
    fn request(&mut self) -> Option<Request> {
        self.heartbeat.request()?.map_err(|sentence| self.warn(&sentence)).ok()
    }

    fn warn(&mut self, sentence: &str) {
        (self.report)(Report::Warning(sentence));
        self.heartbeat.status.warning = Some(sentence.to_owned());
    }

    fn warn_of_checkpoint(&mut self, reason: &RunError, shots: u64) {
        let sentence = format!(
            "the checkpoint after {shots} shots could not be written: {reason}; the previous one is intact, and training \
             goes on"
        );
        self.warn(&sentence);
    }
}

/// Clock of the training time, without pauses.
#[derive(Debug)]
struct Clock {
    start: Instant,
    /// Seconds of the earlier sessions.
    before: f64,
    /// Total time of pauses.
    paused: Duration,
    /// Seconds and shots of the last line, or of the start.
    last: (f64, u64),
}

impl Clock {
    /// Returns the training time of this session.
    fn session(&self) -> Duration {
        self.start.elapsed().saturating_sub(self.paused)
    }

    /// Returns the seconds of training in all sessions.
    fn seconds(&self) -> f64 {
        self.before + self.session().as_secs_f64()
    }

    /// Returns the line of metrics that is due now, `measuring` seconds after the last shot. The speed excludes this time, because it would
    /// otherwise drop at every evaluation.
    fn record(&mut self, learner: &dyn Learner, means: Iteration, score: Option<Score>, measuring: f64) -> Record {
        let seconds = self.seconds();
        let (shots, progress) = (learner.shots(), learner.progress());
        let record = Record {
            shots,
            seconds,
            shots_per_second: (shots - self.last.1) as f64 / (seconds - measuring - self.last.0).max(1e-9),
            updates: progress.updates,
            learning_rate: progress.learning_rate,
            critic_loss: means.critic_loss,
            actor_loss: means.actor_loss,
            q_value: means.q_value,
            rollout_reward: means.mean_reward,
            exploration: Some(progress.exploration),
            replay_fill: progress.replay_fill,
            held_out_reward: score.map(|score| score.mean_reward),
            best_of_k: score.map(|score| score.best_of_k),
        };
        self.last = (seconds, shots);
        record
    }
}
