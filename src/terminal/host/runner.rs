//! The event loop: waits for events, passes them to the app, and draws a frame after changes.

use std::{
    collections::HashSet,
    io::{self, Write},
    sync::mpsc::{Receiver, RecvTimeoutError},
    time::{Duration, Instant},
};

use crossterm::event::Event as TerminalEvent;
use tracing::{info, warn};

use crate::{
    platform::{self, Signal},
    printing::{self, FULL_VERSION, OneLine},
    storage::{DataPaths, remove_if_exists, save_json},
    terminal::{
        App, CoachAnswer, CoachEvent, DrillReport, DrillTask, Effect, SavedSession, TrainingReport,
        host::{events, guard::TerminalGuard, log, pace::Pace, table_sharing::TableSharing},
        tasks::{Tasks, event::Event},
    },
};

/// Smallest interval between two frames; the effects of faster keys are drawn together.
const MIN_FRAME_INTERVAL: Duration = Duration::from_millis(15);

/// Smallest interval between two saves of the session.
const SAVE_INTERVAL: Duration = Duration::from_secs(2);

/// Interval between two attempts to save what the disk has refused.
const RETRY_INTERVAL: Duration = Duration::from_secs(10);

/// Whether the loop continues.
enum Flow {
    Continue,
    Quit,
    /// A signal ends the process.
    EndBySignal(i32),
}

/// Runs the app on the terminal until the player quits.
///
/// # Errors
/// Any error of the terminal.
pub fn run(app: App, paths: DataPaths) -> io::Result<()> {
    // The program works without a log too.
    let _ = log::start(&paths.log, std::env::var("CAROM_LOG").ok().as_deref());
    info!(version = FULL_VERSION, caps = ?app.caps, "the screen opens");
    let (to_screen, events) = events::open()?;
    let session = TerminalGuard::start(app.mouse)?;
    let tasks = Tasks::new(to_screen)?;
    let saved = (None, Instant::now());
    let known_practice = app.coach.earlier_session().iter().flat_map(SavedSession::practice_ids).collect();
    let (ticked, retried) = (Instant::now(), Instant::now());
    let sharing = TableSharing::new(paths.spectator_folder.clone());
    let (has_resumed, has_save_failed, last_logged) = (false, false, String::new());
    let mut runner = Runner {
        app,
        session,
        tasks,
        paths,
        ticked,
        has_resumed,
        saved,
        may_have_changed: true,
        known_practice,
        retried,
        has_save_failed,
        last_logged,
        sharing,
    };
    let end = runner.event_loop(&events);
    runner.sharing.stop();
    runner.save_session(true);
    let draft_saved = runner.save_draft();
    info!(?end, "the screen closes");
    let left = runner.session.leave();
    // The player sees the shell again while the last changes are written.
    runner.tasks.finish();
    let retried = events.try_iter().filter_map(|event| match event {
        Event::Drill(DrillReport::Retried(retried)) => Some(retried),
        _ => None,
    });
    if let Some(Err(sentence)) = retried.last() {
        let _ = writeln!(printing::stderr(), "{sentence}");
    }
    if let Err(error) = draft_saved {
        // A terminal that is gone shows nothing.
        let _ = writeln!(printing::stderr(), "the stroke that was typed in part is lost: {error}");
    }
    match end? {
        // The parent process must see that a signal ended the program, even if the terminal is already gone.
        Some(signal) => platform::exit_by_signal(signal),
        None => left,
    }
}

/// Whether an event can wait for the next frame: news of runs, and better shots while the coach still thinks.
const fn can_be_deferred(event: &Event) -> bool {
    matches!(
        event,
        Event::Training(TrainingReport::Followed(..) | TrainingReport::HasPolicy(..))
            | Event::Answer(CoachAnswer { event: CoachEvent::Better(_), .. })
    )
}

struct Runner {
    app: App,
    session: TerminalGuard,
    tasks: Tasks,
    paths: DataPaths,
    /// Time of the last tick of the app, or of the return from being suspended.
    ticked: Instant,
    /// Whether the terminal has already been taken over again when the signal for it arrives.
    has_resumed: bool,
    /// The session saved last, and the time of the save or of finding it unchanged.
    saved: (Option<SavedSession>, Instant),
    /// Whether anything has happened since then that may have changed the session.
    may_have_changed: bool,
    /// Identifiers of the practice sessions that this program has loaded or saved.
    known_practice: HashSet<String>,
    /// Time of the last attempt to save what the disk has refused, or when everything was saved.
    retried: Instant,
    /// Whether saving the session has failed.
    has_save_failed: bool,
    /// The last message written to the log.
    last_logged: String,
    /// Writer of the shared table.
    sharing: TableSharing,
}

impl Runner {
    /// Runs the loop. Returns the signal that ended the program, or `None` if the player did.
    fn event_loop(&mut self, events: &Receiver<Event>) -> io::Result<Option<i32>> {
        self.draw()?;
        let mut pace = Pace::new(Instant::now());
        loop {
            self.tasks.subscribe(self.app.subscriptions())?;
            let interval = self.app.frame_interval().map(Duration::from_secs_f64);
            // A toast that disappears needs one more frame.
            let toast = self.app.toasts.time_left().map(|left| self.ticked + Duration::from_secs_f64(left));
            let retry = self.app.drills.has_unsaved().then(|| self.retried + RETRY_INTERVAL);
            let writing = self.next_save().into_iter().chain(retry).chain(self.sharing.due(&self.app));
            let first = match pace.next_wake(interval).into_iter().chain(toast).chain(writing).min() {
                // Nothing moves: no timer, no processor time, no bytes.
                None => events.recv().map_err(|_| RecvTimeoutError::Disconnected),
                Some(due) => events.recv_timeout(due.saturating_duration_since(Instant::now())),
            };
            let first = match first {
                Ok(first) => Some(first),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
            };
            if first.is_some() {
                std::thread::sleep(MIN_FRAME_INTERVAL.saturating_sub(pace.since(Instant::now())));
            }
            // Time that passed while nothing moved does not count.
            let passed = self.ticked.elapsed();
            self.ticked = Instant::now();
            if !self.app.drills.has_unsaved() {
                self.retried = self.ticked;
            }
            self.may_have_changed |= first.is_some() || interval.is_some();
            if interval.is_some() || toast.is_some() {
                self.app.tick(passed.as_secs_f64());
            }
            let mut can_wait = first.is_some();
            for event in first.into_iter().chain(events.try_iter()) {
                can_wait &= can_be_deferred(&event);
                match self.handle(event)? {
                    Flow::Continue => {}
                    Flow::Quit => return Ok(None),
                    Flow::EndBySignal(signal) => return Ok(Some(signal)),
                }
            }
            self.retry_saving()?;
            if can_wait && !pace.on_report(Instant::now(), self.app.frame_interval().is_some()) {
                continue;
            }
            // Before the frame, which a slow link may delay.
            self.save_session(false);
            if let Err(sentence) = self.sharing.write(&self.app) {
                self.app.sharing_failed(sentence);
            }
            self.log_messages();
            self.draw()?;
            pace.on_drawn(Instant::now());
        }
    }

    /// Tries again at intervals to save what the disk has refused.
    fn retry_saving(&mut self) -> io::Result<()> {
        if self.app.drills.has_unsaved() && self.retried.elapsed() >= RETRY_INTERVAL {
            self.retried = Instant::now();
            self.tasks.practise(vec![DrillTask::SaveUnsaved])?;
        }
        Ok(())
    }

    /// Time of the next save of the session; `None` if nothing has happened.
    fn next_save(&self) -> Option<Instant> {
        self.may_have_changed.then(|| self.saved.1 + SAVE_INTERVAL)
    }

    /// Saves the session at the end and at intervals, so that a crash loses at most two seconds of it.
    fn save_session(&mut self, at_the_end: bool) {
        let (before, when) = &self.saved;
        if !at_the_end && (!self.may_have_changed || when.elapsed() < SAVE_INTERVAL) {
            return;
        }
        self.may_have_changed = false;
        let last = self.app.saved_session();
        if last == *before {
            self.saved.1 = Instant::now();
            return;
        }
        let path = &self.paths.last_session;
        let coach = &self.app.coach;
        let mine = last.clone().or_else(|| coach.earlier_session());
        self.known_practice.extend(mine.iter().flat_map(SavedSession::practice_ids));
        // A file that cannot be read is replaced.
        let stored = SavedSession::load(path).ok().flatten();
        let saved = match SavedSession::with_those_of_others(mine, stored, &self.known_practice) {
            // Another player's table is shown; the player's own session stays.
            _ if coach.followed().is_some() => Ok(()),
            Some(last) => save_json(path, &last),
            // What was saved is over, and nothing was saved before it.
            None => remove_if_exists(path),
        };
        if let Err(error) = saved
            // Report the failure once: repeating it would not help.
            && !std::mem::replace(&mut self.has_save_failed, true)
        {
            let path = path.display();
            self.app.report_failure(format!("{path}: {error}; the next start cannot go on from here"));
        }
        self.saved = (last, Instant::now());
    }

    /// Saves the partly typed stroke for the next session, replacing that of the last one, however this session ends.
    fn save_draft(&self) -> io::Result<()> {
        let path = &self.paths.draft;
        let with_path = |error| io::Error::other(format!("{}: {error}", path.display()));
        match self.app.draft() {
            Some(draft) => save_json(path, &draft).map_err(with_path),
            // Another program may have removed the file.
            None if self.app.draft_at_start.is_some() => remove_if_exists(path).map_err(with_path),
            None => Ok(()),
        }
    }

    /// Writes the refusals and failures that were shown to the log.
    fn log_messages(&mut self) {
        for text in self.app.toasts.take_unlogged() {
            // A key that is held down is refused repeatedly.
            if self.last_logged == text {
                continue;
            }
            warn!("{}", OneLine(&text));
            self.last_logged = text;
        }
    }

    fn draw(&mut self) -> io::Result<()> {
        self.session.capture_mouse(self.app.mouse)?;
        self.session.draw(|frame| {
            self.app.resize(frame.area().as_size());
            self.app.draw(frame);
        })
    }

    fn handle(&mut self, event: Event) -> io::Result<Flow> {
        self.tasks.acknowledge(&event);
        let effect = match event {
            Event::Input(TerminalEvent::Key(key)) => self.app.handle(&key),
            Event::Input(TerminalEvent::Paste(text)) => {
                self.app.paste(&text);
                None
            }
            Event::Input(TerminalEvent::Mouse(mouse)) => self.app.mouse(mouse),
            Event::Answer(answer) => self.app.receive(answer),
            // A resize only needs a frame, which follows anyway.
            Event::Input(_) | Event::Signal(Signal::Resized) => None,
            Event::InputEnded => return Ok(Flow::Quit),
            Event::Signal(Signal::Stop) => Some(Effect::Suspend),
            // Another program may have used the terminal meanwhile.
            Event::Signal(Signal::Continued) if std::mem::take(&mut self.has_resumed) => None,
            Event::Signal(Signal::Continued) => {
                self.session.leave()?;
                self.resume()?;
                None
            }
            Event::Signal(Signal::End(signal)) => return Ok(Flow::EndBySignal(signal)),
            Event::Training(report) => {
                self.app.receive_training(report);
                None
            }
            Event::FollowedTable(state) => {
                self.app.coach.receive_shared(state);
                None
            }
            Event::Settings(report) => self.app.receive_settings(report),
            Event::Calibration(report) => self.app.receive_calibration(report),
            Event::Drill(report) => Some(Effect::Drill(self.app.receive_drill(report))),
        };
        match effect {
            Some(Effect::Quit) => return Ok(Flow::Quit),
            Some(Effect::Suspend) => self.suspend()?,
            Some(Effect::AskCoach(job)) => {
                let is_running = self.tasks.coach.submit(job);
                if !is_running {
                    self.app.coach_failed();
                }
            }
            Some(Effect::Train(launch)) => self.tasks.train(*launch)?,
            Some(Effect::Send(request, folder)) => self.tasks.send(request, folder)?,
            Some(Effect::SavePolicy(task)) => self.tasks.save_policy(*task)?,
            Some(Effect::LoadPolicy(folder)) => self.tasks.load_policy(folder)?,
            Some(Effect::Drill(tasks)) => self.tasks.practise(tasks)?,
            Some(Effect::Settings(task)) => _ = self.tasks.settings.submit(*task),
            Some(Effect::Calibrate(tasks)) => self.tasks.calibrate(tasks),
            Some(Effect::Copy(text)) => self.session.copy(&text)?,
            None => {}
        }
        Ok(Flow::Continue)
    }

    /// Restores the terminal and suspends the program until the shell continues it.
    fn suspend(&mut self) -> io::Result<()> {
        self.session.leave()?;
        platform::suspend()?;
        self.has_resumed = true;
        self.resume()
    }

    /// Takes over the terminal again. A running playback continues where it was: the time in between does not count.
    fn resume(&mut self) -> io::Result<()> {
        self.ticked = Instant::now();
        self.session.enter()
    }
}
