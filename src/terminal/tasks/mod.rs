//! Background tasks of the pages, each kind on a thread of its own: the screen never waits.

pub mod advice;
pub mod calibration;
pub mod drills;
pub mod event;
pub mod onlooker;
mod polling;
mod practice;
pub mod recommender;
pub mod reel;
mod trainer;
pub mod training;
mod worker;

use std::{
    io,
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{Sender, channel},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use crate::{
    learning::run::{
        POLICY,
        examples::Examples,
        follow::Follower,
        list::{Listing, RunsFolder},
        request::Request,
    },
    table::Table,
    terminal::{
        CalibrationTask, CoachJob, CoachWorker, DrillTask, FollowSlot, Keeping, Launch, Reel, SettingsFile,
        SettingsTask, Subscriptions, TrainerFailure, TrainingReport,
        tasks::{event::Event, onlooker::Onlooker, polling::Poll, trainer::Trainer, worker::Worker},
    },
};

pub use practice::PracticeWorker;

/// Time between two looks at a run that is followed.
const FOLLOW_INTERVAL: Duration = Duration::from_millis(100);
/// Time between two looks at the list of runs.
const LIST_INTERVAL: Duration = Duration::from_secs(2);

/// Does what is wanted and sends what comes of it to the screen.
#[derive(Debug)]
pub struct Tasks {
    to_screen: Sender<Event>,
    subscriptions: Subscriptions,
    list: Option<Poll>,
    followed: [Option<Poll>; 2],
    shown: Option<Poll>,
    /// The coach's thread.
    pub coach: Worker<Box<CoachJob>>,
    /// The thread that plays strokes and writes files for the drills.
    practice: Worker<DrillTask>,
    /// The thread of the settings' file.
    pub settings: Worker<SettingsTask>,
    /// The thread that keeps what is measured at a table, and that of what follows from it.
    kept: Worker<CalibrationTask>,
    judged: Worker<CalibrationTask>,
    /// Threads that write something, each once.
    writing: Vec<JoinHandle<()>>,
    /// Set when answers are no longer wanted.
    is_closing: Arc<AtomicBool>,
}

impl Tasks {
    /// Nothing is wanted yet. A screen that is gone needs no answers.
    ///
    /// # Errors
    /// A thread that could not be started, here and below.
    pub fn new(to_screen: Sender<Event>) -> io::Result<Self> {
        let is_closing: Arc<AtomicBool> = Arc::default();
        let (answers, mut coach) = (to_screen.clone(), CoachWorker::default());
        let coach = Worker::start("coach", move |job: Box<CoachJob>| {
            if !job.cancel.load(Ordering::Relaxed) {
                coach.answer(&job, |answer| drop(answers.send(Event::Answer(answer))));
            }
        })?;
        let (reports, mut practice, closing) = (to_screen.clone(), PracticeWorker::default(), Arc::clone(&is_closing));
        let practice = Worker::start("practice", move |task: DrillTask| {
            if task.writes() || !closing.load(Ordering::Relaxed) {
                practice.work(task, &reports);
            }
        })?;
        let (reports, mut file) = (to_screen.clone(), SettingsFile::default());
        let set = move |task| drop(reports.send(Event::Settings(file.run(&task))));
        let calibrate = || {
            let reports = to_screen.clone();
            move |task: CalibrationTask| drop(reports.send(Event::Calibration(task.run())))
        };
        Ok(Self {
            subscriptions: Subscriptions::default(),
            list: None,
            followed: [None, None],
            shown: None,
            coach,
            practice,
            settings: Worker::start("settings", set)?,
            kept: Worker::start("calibration", calibrate())?,
            judged: Worker::of_the_newest("calibrate", calibrate())?,
            writing: Vec::new(),
            is_closing,
            to_screen,
        })
    }

    /// Starts to find out what is wanted now, and stops what is not wanted any more.
    ///
    /// # Errors
    /// A thread that could not be started.
    pub fn subscribe(&mut self, subscriptions: Subscriptions) -> io::Result<()> {
        let before = std::mem::replace(&mut self.subscriptions, subscriptions);
        let (now, to_screen) = (&self.subscriptions, &self.to_screen);
        renew(&mut self.list, [&before.runs, &now.runs], |folder| {
            Poll::start("runs", LIST_INTERVAL, to_screen.clone(), list(folder))
        })?;
        renew(&mut self.shown, [&before.shown, &now.shown], |folder| {
            let mut onlooker = Onlooker::new(folder);
            Poll::start("onlooker", FOLLOW_INTERVAL, to_screen.clone(), move || onlooker.look().map(Event::Shown))
        })?;
        for (n, slot) in FollowSlot::ALL.into_iter().enumerate() {
            renew(&mut self.followed[n], [&before.followed[n], &now.followed[n]], |folder| {
                let look = follow(slot, folder, to_screen.clone())?;
                Poll::start("follower", FOLLOW_INTERVAL, to_screen.clone(), look)
            })?;
        }
        Ok(())
    }

    /// The screen has taken an event: its sender may look again. Events never pile up before a slow screen.
    pub fn taken(&self, event: &Event) {
        let poll = match event {
            Event::Shown(_) => &self.shown,
            Event::Training(TrainingReport::Runs(_)) => &self.list,
            Event::Training(TrainingReport::Followed(FollowSlot::Main, ..)) => &self.followed[0],
            Event::Training(TrainingReport::Followed(FollowSlot::Compared, ..)) => &self.followed[1],
            _ => &None,
        };
        if let Some(poll) = poll {
            poll.taken();
        }
    }

    /// Does tasks of the drill screens, one after the other. What takes long and writes nothing keeps no others waiting.
    ///
    /// # Errors
    /// As [`Tasks::new`].
    pub fn practise(&self, tasks: Vec<DrillTask>) -> io::Result<()> {
        for task in tasks {
            if matches!(task, DrillTask::Estimate(..)) {
                let (to_screen, mut practice) = (self.to_screen.clone(), PracticeWorker::default());
                thread::Builder::new().name("estimate".into()).spawn(move || practice.work(task, &to_screen))?;
            } else {
                // A thread that has ended has sent its last report.
                self.practice.give(task);
            }
        }
        Ok(())
    }

    /// Does tasks of the calibration's page. What is found out of the newest entries keeps no others waiting.
    pub fn calibrate(&self, tasks: Vec<CalibrationTask>) {
        for task in tasks {
            let worker = if task.writes() { &self.kept } else { &self.judged };
            worker.give(task);
        }
    }

    /// Waits until what the player has noted, set or asked of a run is on the disk: the screen may close before.
    pub fn finish(self) {
        self.is_closing.store(true, Ordering::Relaxed);
        self.practice.finish();
        self.kept.finish();
        self.settings.finish();
        for thread in self.writing {
            // A panic there was reported when it happened.
            let _ = thread.join();
        }
    }

    /// Starts a process that trains.
    ///
    /// # Errors
    /// As [`Tasks::new`].
    pub fn train(&self, launch: Launch) -> io::Result<()> {
        let (hand_over, started) = channel::<Result<Trainer, TrainerFailure>>();
        let Launch { arguments, folder } = launch;
        self.spawn("trainer", move || {
            let failure = started.recv().ok()?.and_then(trainer::wait).err()?;
            Some(TrainingReport::TrainerFailed(folder, failure))
        })?;
        // Not on the thread, which may not come to it before the screen closes. It waits for this.
        let _ = hand_over.send(trainer::start(&arguments));
        Ok(())
    }

    /// Asks a run for something.
    ///
    /// # Errors
    /// As [`Tasks::new`].
    pub fn send(&mut self, request: Request, folder: PathBuf) -> io::Result<()> {
        self.write("request", move || {
            Some(TrainingReport::Sent(request, request.send(&folder).map_err(|error| error.to_string())))
        })
    }

    /// Keeps a policy under a name.
    ///
    /// # Errors
    /// As [`Tasks::new`].
    pub fn keep(&mut self, keeping: Keeping) -> io::Result<()> {
        self.write("keep", move || {
            let outcome = keeping.keep();
            Some(TrainingReport::Kept(keeping, outcome))
        })
    }

    /// Reads the policy of the run in `folder`.
    ///
    /// # Errors
    /// As [`Tasks::new`].
    pub fn load_policy(&self, folder: PathBuf) -> io::Result<()> {
        self.spawn("policy", move || {
            let policy = training::load_policy(&folder);
            Some(TrainingReport::Policy(folder, policy))
        })?;
        Ok(())
    }

    /// Does what writes something: the program does not end before.
    fn write(&mut self, name: &str, work: impl FnOnce() -> Option<TrainingReport> + Send + 'static) -> io::Result<()> {
        self.writing.retain(|thread| !thread.is_finished());
        let thread = self.spawn(name, work)?;
        self.writing.push(thread);
        Ok(())
    }

    fn spawn(
        &self,
        name: &str,
        work: impl FnOnce() -> Option<TrainingReport> + Send + 'static,
    ) -> io::Result<JoinHandle<()>> {
        let to_screen = self.to_screen.clone();
        thread::Builder::new().name(name.into()).spawn(move || {
            if let Some(report) = work() {
                // A screen that is gone needs no answer.
                let _ = to_screen.send(Event::Training(report));
            }
        })
    }
}

/// Where another folder is wanted than before, or none, ends the poll and starts one for that.
fn renew(
    poll: &mut Option<Poll>,
    [before, now]: [&Option<PathBuf>; 2],
    start: impl FnOnce(PathBuf) -> io::Result<Poll>,
) -> io::Result<()> {
    if before != now {
        // What is dropped stops.
        *poll = None;
        *poll = now.clone().map(start).transpose()?;
    }
    Ok(())
}

/// Lists the runs, and reports where anything has changed.
fn list(folder: PathBuf) -> impl FnMut() -> Option<Event> {
    let (mut runs, mut before) = (RunsFolder::new(&folder), None);
    move || {
        let found = match runs.look() {
            // Nothing has ever been trained.
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Listing::default()),
            found => found.map_err(|error| format!("{}: {error}", folder.display())),
        };
        if before.as_ref() == Some(&found) {
            return None;
        }
        before = Some(found.clone());
        Some(Event::Training(TrainingReport::Runs(found)))
    }
}

/// Follows a run. For the one that is watched, its shots are recorded too, and whether it has a policy is reported.
///
/// # Errors
/// A thread that could not be started.
fn follow(
    slot: FollowSlot,
    folder: PathBuf,
    to_screen: Sender<Event>,
) -> io::Result<impl FnMut() -> Option<Event> + Send + 'static> {
    let recorder = if slot == FollowSlot::Main { Some(recorder(folder.clone(), to_screen.clone())?) } else { None };
    let mut follower = Follower::new(&folder);
    let (mut table, mut examples, mut had_policy) = (None, None, None);
    Ok(move || {
        let update = follower.look();
        // Reported first, so that a run that has just finished never seems to have no policy.
        if slot == FollowSlot::Main {
            let has_policy = folder.join(POLICY).exists();
            if had_policy.replace(has_policy) != Some(has_policy) {
                // A screen that is gone needs no news.
                let _ = to_screen.send(Event::Training(TrainingReport::HasPolicy(folder.clone(), has_policy)));
            }
        }
        let mut update = update?;
        table = update.config.as_ref().map(|config| config.table.clone()).or(table.take());
        examples = update.examples.take().or(examples.take());
        if let Some(recorder) = &recorder
            && let Some(table) = table.clone()
            && let Some(examples) = examples.take()
        {
            recorder.give((examples, table));
        }
        Some(Event::Training(TrainingReport::Followed(slot, folder.clone(), Box::new(update))))
    })
}

/// Records the shots of the run in `folder`.
fn recorder(folder: PathBuf, to_screen: Sender<Event>) -> io::Result<Worker<(Examples, Table)>> {
    Worker::of_the_newest("recorder", move |(examples, table): (Examples, Table)| {
        // A screen that is gone needs no shots.
        let _ =
            to_screen.send(Event::Training(TrainingReport::Recorded(folder.clone(), Reel::record(&examples, &table))));
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{storage::Places, study::filmed::bundled};

    #[test]
    fn what_a_key_has_just_begun_is_done_before_the_program_ends() {
        let (to_screen, events) = channel();
        let mut tasks = Tasks::new(to_screen).unwrap();
        let home = tempfile::tempdir().unwrap();
        tasks.send(Request::Stop, home.path().to_owned()).unwrap();
        tasks.finish();
        assert!(matches!(events.try_recv(), Ok(Event::Training(TrainingReport::Sent(Request::Stop, _)))));
    }

    #[test]
    fn what_writes_nothing_does_not_keep_the_program_from_ending() {
        let (to_screen, events) = channel();
        let tasks = Tasks::new(to_screen).unwrap();
        let film = || DrillTask::Film(Box::new(bundled().swap_remove(0)));
        let home = tempfile::tempdir().unwrap();
        tasks.practise(vec![DrillTask::Load(Box::new(Places::under(home.path())))]).unwrap();
        tasks.practise((0..40).map(|_| film()).collect()).unwrap();
        tasks.practise(vec![DrillTask::KeepSkill(crate::coach::Skill::CLUB)]).unwrap();
        tasks.finish();
        let reports: Vec<_> = events.try_iter().collect();
        assert!(reports.len() < 40, "{} of 42 tasks were done", reports.len());
        assert!(matches!(reports.last(), Some(Event::Drill(drills::DrillReport::SkillKept(_, Ok(()))))));
    }
}
