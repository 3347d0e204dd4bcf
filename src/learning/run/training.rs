//! The loop that fills a run's folder.

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
    metrics::{self, MetricsFile, Record},
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

/// Longest time between two checkpoints: what a power cut costs. It may depend on the clock, because nothing depends on
/// when a checkpoint is written.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);

/// Time between two looks at whether a pause is over.
const NAP: Duration = Duration::from_millis(100);

/// Receives the events of a run in its own process. Other processes follow its folder ([`super::follow`]).
pub trait Watcher {
    /// A line of metrics.
    fn line(&mut self, record: &Record);

    /// Something went wrong, and training goes on.
    fn warn(&mut self, sentence: &str);
}

/// How a run ended, with what it earns on the held-out layouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// All shots have been played.
    Finished(Score),
    /// It was stopped and can go on.
    Stopped(Score),
    /// It was given up: nothing was saved, and the run is to be discarded.
    Abandoned,
}

/// When training ends before the plan is finished.
pub struct Limits<'a> {
    /// Longest time to train, pauses left out.
    pub time: Option<Duration>,
    /// Asked between two iterations whether to stop.
    pub stop: &'a dyn Fn() -> bool,
}

/// Where training reports to.
struct Reporting<'a> {
    metrics: MetricsFile,
    /// None where it cannot be written: it is for looking at, and nothing is lost.
    events: Option<EventFile>,
    clock: Clock,
    heartbeat: Heartbeat,
    layouts: Vec<Layout>,
    watcher: &'a mut dyn Watcher,
}

impl Run {
    /// Trains until the plan is finished, a limit is reached or a [`Request`] in the folder says so. The folder then holds
    /// a checkpoint from which the run can go on. A checkpoint on the way that cannot be written is reported to the watcher,
    /// and the next one tried.
    ///
    /// # Errors
    /// Where training breaks down, or where the last checkpoint cannot be written.
    pub fn train(&mut self, limits: &Limits<'_>, watcher: &mut dyn Watcher) -> Result<Ending, RunError> {
        let path = self.folder.join(METRICS);
        let (metrics, records) = MetricsFile::open(&path, self.learner.shots()).map_err(file(&path))?;
        let (last, shots) = (records.last().map(|record| record.shots), self.learner.shots());
        let is_whole = !metrics::lacks_lines(last, shots, self.state.schedule.log_every);
        // A finished run has no more lines.
        let events =
            if self.learner.is_finished() { None } else { EventFile::open(&self.folder, &records, is_whole).ok() };
        let layouts = held_out_layouts(self.learner.table(), self.state.schedule.evaluation_layouts, HELD_OUT_SEED);
        if !self.learner.is_finished() {
            // A finished run whose last checkpoint was lost goes on from the one before.
            let _ = fs::remove_file(self.folder.join(RESULT));
        }
        let before = records.last().map_or(0.0, |record| record.seconds);
        let clock = Clock { start: Instant::now(), before, paused: Duration::ZERO, last: (before, shots) };
        let mut heartbeat = Heartbeat::new(&self.folder);
        heartbeat.status.logged = last.unwrap_or(0);
        let mut reporting = Reporting { metrics, events, clock, heartbeat, layouts, watcher };
        let ending = self.iterate_until(limits, &mut reporting).and_then(|ending| {
            // It may have been given up during the last measurement, after which nothing else is asked for.
            if Request::take(&self.folder) == Some(Ok(Request::Abandon)) {
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

    /// Writes what it has come to with this last measurement, for programs that compare runs.
    fn write_result(&self, score: Score) -> Result<(), RunError> {
        let learner = self.learner.as_ref();
        let TrainingPlan { reward, seed, .. } = learner.plan();
        let result = json!({
            "agent": learner.agent(), "reward": reward, "seed": seed, "table": learner.table().name, "version": VERSION,
            // Those of the last iteration beyond the plan included.
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
            // By this program's own simulator it might be another number.
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
                Some(Request::GoOn) | None => {}
            }
            if stops {
                // Nothing waits for the measurement, which may take long: whoever cannot wait ends it by a second signal.
                self.save(&mut reporting.metrics, None).map_err(|reason| self.unsaved(reason))?;
                let score = self.measure(reporting, Phase::Stopping)?;
                self.write_policy(score, &mut || true).map_err(|reason| self.unsaved(reason))?;
                return Ok(Ending::Stopped(score));
            }
            let score = self.iterate(reporting)?;
            if score.is_some() || saved.elapsed() >= CHECKPOINT_INTERVAL {
                let done = self.save(&mut reporting.metrics, score);
                saved = Instant::now();
                match (done, score.filter(|_| self.learner.is_finished())) {
                    (Ok(()), Some(score)) => return self.finish(score, limits, reporting),
                    (Ok(()), None) => {}
                    (Err(reason), Some(_)) => return Err(self.unsaved(reason)),
                    (Err(reason), None) => reporting.warn_of_checkpoint(&reason, self.learner.shots()),
                }
            }
        }
    }

    /// Writes the policy of a run that has played its last shot and is saved. Its calibration may take minutes; a run that is stopped
    /// meanwhile begins it again when it goes on.
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
                Some(Request::Pause) | None => thread::sleep(NAP),
                Some(request) => break request,
            }
        };
        reporting.clock.paused += begin.elapsed();
        request
    }

    /// Plays the held-out layouts; `phase` says on which occasion.
    fn measure(&self, reporting: &mut Reporting<'_>, phase: Phase) -> Result<Score, RunError> {
        let learner = self.learner.as_ref();
        reporting.heartbeat.beat(phase, learner, reporting.clock.seconds());
        let score = learner.score(&reporting.layouts)?;
        // A run that is stopped has no line of metrics for it.
        reporting.heartbeat.status.held_out_reward = Some(score.mean_reward);
        // They are for looking at: where they cannot be written, nothing is lost.
        let _ = Examples::of(learner, &reporting.layouts)?.write(&self.folder);
        Ok(score)
    }

    /// One iteration, and the measurement and the line of metrics that are due after it.
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
            reporting.watcher.line(&record);
            // Until there is room it waits in memory. No checkpoint is written before it is.
            if reporting.metrics.flush().is_ok() {
                reporting.heartbeat.status.logged = shots;
            }
        }
        if is_finite { Ok(score) } else { Err(RunError::NotFinite(shots)) }
    }
}

impl Reporting<'_> {
    /// What the run is asked to do; what is not understood is told.
    fn request(&mut self) -> Option<Request> {
        match self.heartbeat.request()? {
            Ok(request) => Some(request),
            Err(sentence) => {
                self.warn(&sentence);
                None
            }
        }
    }

    fn warn(&mut self, sentence: &str) {
        self.watcher.warn(sentence);
        self.heartbeat.status.warning = Some(sentence.to_owned());
    }

    fn warn_of_checkpoint(&mut self, reason: &RunError, shots: u64) {
        let sentence = format!(
            "the checkpoint after {shots} shots could not be written: {reason}; the one before is whole, and training \
             goes on to the next"
        );
        self.warn(&sentence);
    }
}

/// The time that training takes, pauses left out.
#[derive(Debug)]
struct Clock {
    start: Instant,
    /// Seconds of the sessions before.
    before: f64,
    /// Time that passed in pauses.
    paused: Duration,
    /// Seconds and shots of the last line, or of the start.
    last: (f64, u64),
}

impl Clock {
    /// Time since the start.
    fn session(&self) -> Duration {
        self.start.elapsed().saturating_sub(self.paused)
    }

    /// Seconds of training in all.
    fn seconds(&self) -> f64 {
        self.before + self.session().as_secs_f64()
    }

    /// The line that is due now, `measuring` seconds after the last shot: a speed that fell with each measurement would say
    /// nothing of either.
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
