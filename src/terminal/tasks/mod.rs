//! Background tasks of the pages, each kind on its own thread, so that the screen never waits.

pub mod advice;
pub mod calibration;
pub mod drills;
pub mod event;
mod polling;
mod practice;
pub mod recommender;
pub mod reel;
pub mod table_watcher;
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
        CalibrationTask, CoachJob, CoachWorker, DrillTask, FollowSlot, Launch, Reel, SavePolicyTask, SettingsFile,
        SettingsTask, Subscriptions, TrainerFailure, TrainingReport,
        tasks::{event::Event, polling::Poll, table_watcher::TableWatcher, trainer::Trainer, worker::Worker},
    },
};

pub use practice::PracticeWorker;

/// Polling interval of a followed run.
const FOLLOW_INTERVAL: Duration = Duration::from_millis(100);
/// Polling interval of the list of runs.
const LIST_INTERVAL: Duration = Duration::from_secs(2);

/// Runs background tasks and sends their reports to the screen.
#[derive(Debug)]
pub struct Tasks {
    to_screen: Sender<Event>,
    subscriptions: Subscriptions,
    list: Option<Poll>,
    followed: [Option<Poll>; 2],
    followed_table: Option<Poll>,
    /// The coach's thread.
    pub coach: Worker<Box<CoachJob>>,
    /// The thread that plays strokes and writes files for the drills.
    practice: Worker<DrillTask>,
    /// The thread of the settings file.
    pub settings: Worker<SettingsTask>,
    /// The thread that saves measurements at a table, and the thread that evaluates them.
    calibration_writer: Worker<CalibrationTask>,
    calibration_evaluator: Worker<CalibrationTask>,
    /// Short-lived threads that write something.
    writing: Vec<JoinHandle<()>>,
    /// Set when answers are no longer needed.
    is_closing: Arc<AtomicBool>,
}

impl Tasks {
    /// Starts the worker threads, without subscriptions. Reports to a closed screen are dropped.
    ///
    /// # Errors
    /// Fails if a thread cannot be started, here and below.
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
            followed_table: None,
            coach,
            practice,
            settings: Worker::start("settings", set)?,
            calibration_writer: Worker::start("calibration", calibrate())?,
            calibration_evaluator: Worker::newest_only("calibrate", calibrate())?,
            writing: Vec::new(),
            is_closing,
            to_screen,
        })
    }

    /// Starts the polls that `subscriptions` adds and stops those that it removes.
    ///
    /// # Errors
    /// Fails if a thread cannot be started.
    pub fn subscribe(&mut self, subscriptions: Subscriptions) -> io::Result<()> {
        let before = std::mem::replace(&mut self.subscriptions, subscriptions);
        let (now, to_screen) = (&self.subscriptions, &self.to_screen);
        restart_if_changed(&mut self.list, [&before.runs, &now.runs], |folder| {
            Poll::start("runs", LIST_INTERVAL, to_screen.clone(), list(folder))
        })?;
        restart_if_changed(&mut self.followed_table, [&before.followed_table, &now.followed_table], |folder| {
            let mut watcher = TableWatcher::new(folder);
            Poll::start("viewer", FOLLOW_INTERVAL, to_screen.clone(), move || watcher.poll().map(Event::FollowedTable))
        })?;
        for (n, slot) in FollowSlot::ALL.into_iter().enumerate() {
            restart_if_changed(&mut self.followed[n], [&before.followed[n], &now.followed[n]], |(folder, _)| {
                let look = follow(slot, folder, to_screen.clone())?;
                Poll::start("follower", FOLLOW_INTERVAL, to_screen.clone(), look)
            })?;
        }
        Ok(())
    }

    /// Confirms that the screen has handled an event, so that its sender may poll again. Events never pile up if the screen is slow.
    pub fn acknowledge(&self, event: &Event) {
        let poll = match event {
            Event::FollowedTable(_) => &self.followed_table,
            Event::Training(TrainingReport::Runs(_)) => &self.list,
            Event::Training(TrainingReport::Followed(FollowSlot::Main, ..)) => &self.followed[0],
            Event::Training(TrainingReport::Followed(FollowSlot::Compared, ..)) => &self.followed[1],
            _ => &None,
        };
        if let Some(poll) = poll {
            poll.acknowledge();
        }
    }

    /// Queues tasks of the drill screens. A long task that writes nothing gets its own thread, so that it does not delay the others.
    ///
    /// # Errors
    /// Like [`Tasks::new`].
    pub fn practise(&self, tasks: Vec<DrillTask>) -> io::Result<()> {
        for task in tasks {
            if matches!(task, DrillTask::Estimate(..)) {
                let (to_screen, mut practice) = (self.to_screen.clone(), PracticeWorker::default());
                thread::Builder::new().name("estimate".into()).spawn(move || practice.work(task, &to_screen))?;
            } else {
                // A worker that has ended has already sent its last report.
                self.practice.submit(task);
            }
        }
        Ok(())
    }

    /// Queues tasks of the calibration page. Evaluations run on another thread than writes, and do not delay them.
    pub fn calibrate(&self, tasks: Vec<CalibrationTask>) {
        for task in tasks {
            let worker = if task.writes() { &self.calibration_writer } else { &self.calibration_evaluator };
            worker.submit(task);
        }
    }

    /// Waits until everything that the player has noted, set or requested of a run is on the disk. The screen may close before. The last
    /// [`DrillReport::Retried`](super::DrillReport::Retried) tells what the disk still refuses.
    pub fn finish(self) {
        self.is_closing.store(true, Ordering::Relaxed);
        self.practice.submit(DrillTask::SaveUnsaved);
        self.practice.finish();
        self.calibration_writer.finish();
        self.settings.finish();
        for thread in self.writing {
            // A panic of the thread was reported when it happened.
            let _ = thread.join();
        }
    }

    /// Starts a training process.
    ///
    /// # Errors
    /// Like [`Tasks::new`].
    pub fn train(&self, launch: Launch) -> io::Result<()> {
        let (hand_over, started) = channel::<Result<Trainer, TrainerFailure>>();
        let Launch { arguments, folder } = launch;
        self.spawn("trainer", move || {
            let failure = started.recv().ok()?.and_then(trainer::wait).err()?;
            Some(TrainingReport::TrainerFailed(folder, failure))
        })?;
        // Start it here: the thread might not get to it before the screen closes. The thread waits for this.
        let _ = hand_over.send(trainer::start(&arguments));
        Ok(())
    }

    /// Sends a request to a run.
    ///
    /// # Errors
    /// Like [`Tasks::new`].
    pub fn send(&mut self, request: Request, folder: PathBuf) -> io::Result<()> {
        self.write("request", move || {
            Some(TrainingReport::Sent(request, request.send(&folder).map_err(|error| error.to_string())))
        })
    }

    /// Saves a policy under a name.
    ///
    /// # Errors
    /// Like [`Tasks::new`].
    pub fn save_policy(&mut self, task: SavePolicyTask) -> io::Result<()> {
        self.write("keep", move || {
            let outcome = task.save();
            Some(TrainingReport::PolicySaved(task, outcome))
        })
    }

    /// Loads the policy of the run in `folder`.
    ///
    /// # Errors
    /// Like [`Tasks::new`].
    pub fn load_policy(&self, folder: PathBuf) -> io::Result<()> {
        self.spawn("policy", move || {
            let policy = training::load_policy(&folder);
            Some(TrainingReport::Policy(folder, policy))
        })?;
        Ok(())
    }

    /// Runs work that writes something; the program waits for it before it ends.
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
                // A closed screen needs no answer.
                let _ = to_screen.send(Event::Training(report));
            }
        })
    }
}

/// If what is polled has changed, ends the poll and starts a new one, if there is anything to poll.
fn restart_if_changed<T: Clone + PartialEq>(
    poll: &mut Option<Poll>,
    [before, now]: [&Option<T>; 2],
    start: impl FnOnce(T) -> io::Result<Poll>,
) -> io::Result<()> {
    if before != now {
        // Dropping a poll stops it.
        *poll = None;
        *poll = now.clone().map(start).transpose()?;
    }
    Ok(())
}

/// Lists the runs, and reports changes.
fn list(folder: PathBuf) -> impl FnMut() -> Option<Event> {
    let (mut runs, mut before) = (RunsFolder::new(&folder), None);
    move || {
        let found = match runs.poll() {
            // No run was ever started.
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

/// Follows a run. For the main run, its shots are also recorded, and it is reported whether the run has a policy.
///
/// # Errors
/// Fails if a thread cannot be started.
fn follow(
    slot: FollowSlot,
    folder: PathBuf,
    to_screen: Sender<Event>,
) -> io::Result<impl FnMut() -> Option<Event> + Send + 'static> {
    let recorder = if slot == FollowSlot::Main { Some(recorder(folder.clone(), to_screen.clone())?) } else { None };
    let mut follower = Follower::new(&folder);
    let (mut table, mut examples, mut had_policy) = (None, None, None);
    Ok(move || {
        let update = follower.poll();
        // Reported first, so that a run that has just finished never seems to have no policy.
        if slot == FollowSlot::Main {
            let has_policy = folder.join(POLICY).exists();
            if had_policy.replace(has_policy) != Some(has_policy) {
                // A closed screen needs no news.
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
            recorder.submit((examples, table));
        }
        Some(Event::Training(TrainingReport::Followed(slot, folder.clone(), Box::new(update))))
    })
}

/// Starts a worker that records the shots of the run in `folder`.
fn recorder(folder: PathBuf, to_screen: Sender<Event>) -> io::Result<Worker<(Examples, Table)>> {
    Worker::newest_only("recorder", move |(examples, table): (Examples, Table)| {
        // A closed screen needs no shots.
        let _ =
            to_screen.send(Event::Training(TrainingReport::Recorded(folder.clone(), Reel::record(&examples, &table))));
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::Skill,
        drills::{Goal, Library, Session, Venue, store::Store},
        storage::DataPaths,
        study::filmed::bundled,
        terminal::DrillReport,
    };

    #[test]
    fn writing_tasks_are_done_before_the_program_ends() {
        let (to_screen, events) = channel();
        let mut tasks = Tasks::new(to_screen).unwrap();
        let home = tempfile::tempdir().unwrap();
        tasks.send(Request::Stop, home.path().to_owned()).unwrap();
        tasks.finish();
        assert!(matches!(events.try_recv(), Ok(Event::Training(TrainingReport::Sent(Request::Stop, _)))));
    }

    #[test]
    fn what_the_disk_has_refused_is_saved_or_named_at_the_end() {
        for is_mended in [true, false] {
            let (to_screen, events) = channel();
            let tasks = Tasks::new(to_screen).unwrap();
            let home = tempfile::tempdir().unwrap();
            let paths = DataPaths::under(home.path());
            std::fs::create_dir_all(paths.sessions.parent().unwrap()).unwrap();
            std::fs::write(&paths.sessions, "in the way").unwrap();
            let exercise = Library::bundled().exercises()[0].clone();
            let title = exercise.title.clone();
            let mut session = Session::new(Goal::Free, Venue::Table, vec![exercise], Skill::CLUB, 1);
            session.log(true).unwrap();
            tasks.practise(vec![DrillTask::Load(Box::new(paths.clone()))]).unwrap();
            tasks.practise(vec![DrillTask::Save(Box::new(session.clone()), Vec::new())]).unwrap();
            while !matches!(events.recv(), Ok(Event::Drill(DrillReport::Saved(_, Err(_))))) {}
            if is_mended {
                std::fs::remove_file(&paths.sessions).unwrap();
            }
            tasks.finish();
            let Some(Event::Drill(DrillReport::Retried(retried))) = events.try_iter().last() else { panic!("no end") };
            match retried {
                Ok(()) => assert_eq!(Store::new(&paths).sessions().items[0].attempts, session.attempts),
                Err(words) => assert!(words.starts_with(&format!("not saved: 1 attempt at {title}; ")), "{words}"),
            }
        }
    }

    #[test]
    fn tasks_without_writes_do_not_delay_the_end() {
        let (to_screen, events) = channel();
        let tasks = Tasks::new(to_screen).unwrap();
        let film = || DrillTask::Film(Box::new(bundled().swap_remove(0)));
        let home = tempfile::tempdir().unwrap();
        tasks.practise(vec![DrillTask::Load(Box::new(DataPaths::under(home.path())))]).unwrap();
        tasks.practise((0..40).map(|_| film()).collect()).unwrap();
        tasks.practise(vec![DrillTask::SaveSkill(Skill::CLUB)]).unwrap();
        tasks.finish();
        let reports: Vec<_> = events.try_iter().collect();
        assert!(reports.len() < 40, "{} of 42 tasks were done", reports.len());
        assert!(matches!(reports.last(), Some(Event::Drill(DrillReport::SkillSaved(_, Ok(()))))));
    }
}
