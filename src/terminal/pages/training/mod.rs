//! The training page: the list of runs, the form for a new run, and a watched run.
//!
//! Training runs in separate processes, which this page only starts, follows and controls. [`actions`] implements the key actions.

mod actions;
mod charts;
mod form;
pub mod keys;
mod question;
mod replay;
mod runs;
mod view;
mod watch;

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

use crate::{
    game::Reward,
    learning::{
        Policy,
        run::{
            follow::{Condition, Update},
            request::Request,
        },
    },
    printing::shell_word,
    storage::DataPaths,
    table::Table,
    terminal::{
        CoachQuery, FollowSlot, SavePolicyTask, Subscriptions, TrainerFailure, TrainingContext, TrainingReport,
        pages::Page,
        ui::{Message, TextField, Typed},
        words::name_taken_message,
    },
};

pub use form::{Field, Form};
pub use question::Question;
pub use runs::RunList;
pub use watch::{NamedRun, Watch, name_in};

/// Time that a started run has to show up. Within this time, nothing else is started in its folder.
const LAUNCH_TIMEOUT: Duration = Duration::from_secs(5);

/// The state of the training page.
#[derive(Debug)]
pub struct TrainingPage {
    /// The folders of runs and policies.
    pub places: DataPaths,
    /// The folder whose runs are listed and in which new ones are started.
    pub folder: PathBuf,
    /// The list of runs.
    pub list: RunList,
    /// The form for a new run.
    pub form: Form,
    /// The watched run.
    pub watch: Option<Watch>,
    /// The open question.
    pub question: Option<Question>,
    /// The message of the status line.
    pub message: Option<Message>,
    /// Whether the program shows only this page, so that there is no page to return to.
    pub is_only_page: bool,
    /// Whether the user is a guest, who can only watch runs.
    pub is_guest: bool,
    /// The folder and start time of the last started run, until it is seen training or has failed.
    launched: Option<(PathBuf, Instant)>,
    /// Number of runs opened so far.
    openings: u64,
    /// The stack of screens; the last one is open.
    pages: Vec<TrainingContext>,
}

impl TrainingPage {
    /// Creates the page, closed.
    pub fn new(places: DataPaths) -> Self {
        Self {
            folder: places.runs.clone(),
            places,
            list: RunList::default(),
            form: Form::new(),
            watch: None,
            question: None,
            message: None,
            is_only_page: false,
            is_guest: false,
            launched: None,
            openings: 0,
            pages: Vec::new(),
        }
    }

    /// Opens the page at the last open screen, or at the list.
    pub fn open(&mut self) {
        self.message = None;
        if self.pages.is_empty() {
            self.pages.push(TrainingContext::Runs);
        }
    }

    /// Opens this page as the only one: with a run, or with the list of the runs in the folder `list`, by default the user's.
    pub fn open_as_only_page(&mut self, run: Option<PathBuf>, list: Option<PathBuf>) {
        self.is_only_page = true;
        self.pages = vec![TrainingContext::Runs];
        if let Some(list) = list {
            self.folder = list;
        }
        if let Some(run) = run {
            self.show(&run);
        }
    }

    /// Opens the screen of the run in `folder`.
    fn show(&mut self, folder: &Path) {
        self.list.mark_named(&name_in(&self.folder, folder));
        self.openings += 1;
        self.watch = Some(Watch::new(folder, &self.places.runs, self.openings));
        self.pages.retain(|page| *page == TrainingContext::Runs);
        self.pages.push(TrainingContext::Watch);
    }

    /// Whether a process for the run in `folder` has been started and may not have reported yet.
    fn is_launched(&self, folder: &Path) -> bool {
        self.launched.as_ref().is_some_and(|(launched, since)| launched == folder && since.elapsed() < LAUNCH_TIMEOUT)
    }

    /// Whether the user has left the page.
    pub const fn is_closed(&self) -> bool {
        self.pages.is_empty()
    }

    /// The open screen.
    pub fn page(&self) -> TrainingContext {
        self.pages.last().copied().unwrap_or(TrainingContext::Runs)
    }

    /// The data that the page needs from background tasks now.
    pub fn subscriptions(&self) -> Subscriptions {
        let lists = matches!(self.page(), TrainingContext::Runs | TrainingContext::Form | TrainingContext::Compare);
        let opened = |named: &NamedRun| (named.run.folder.clone(), named.opening);
        Subscriptions {
            runs: lists.then(|| self.folder.clone()),
            followed: [
                self.watch.as_ref().map(|watch| opened(&watch.own)),
                self.watch.as_ref().and_then(|watch| watch.other.as_ref()).map(opened),
            ],
            followed_table: None,
        }
    }

    /// Handles the result of a background task. Returns a policy with its table if the coach must use it.
    pub fn receive(&mut self, report: TrainingReport) -> Option<(Table, CoachQuery)> {
        match report {
            TrainingReport::Runs(found) => self.list.set_runs(found),
            TrainingReport::Followed(FollowSlot::Main, folder, update) => self.on_run_update(&folder, *update),
            TrainingReport::Followed(FollowSlot::Compared, folder, update) => {
                let other = self.watch.as_mut().and_then(|watch| watch.other.as_mut());
                if let Some(other) = other.filter(|other| other.run.folder == folder) {
                    other.run.apply(*update);
                }
            }
            TrainingReport::Recorded(folder, reel) => {
                if let Some(watch) = self.watch.as_mut().filter(|watch| watch.folder() == folder) {
                    watch.replay.queue(reel);
                }
            }
            TrainingReport::HasPolicy(folder, has_policy) => {
                if let Some(watch) = self.watch.as_mut().filter(|watch| watch.folder() == folder) {
                    watch.has_policy = has_policy;
                }
                self.close_question();
            }
            TrainingReport::TrainerFailed(folder, failure) => self.on_launch_failure(&folder, &failure),
            TrainingReport::Sent(request, Ok(())) => {
                self.message = Some(Message::plain(match request {
                    Request::Pause => "the run is asked to pause",
                    Request::Resume => "the run is asked to go on",
                    Request::Stop => "the run is asked to stop: it measures itself and saves first",
                    Request::Abandon => "the run is asked to end; its folder will be deleted",
                }));
            }
            TrainingReport::Sent(_, Err(sentence)) => {
                self.message = Some(Message::warning(format!("the run cannot be asked: {sentence}")));
            }
            TrainingReport::PolicySaved(keeping, outcome) => self.on_policy_saved(keeping, outcome),
            TrainingReport::Policy(folder, policy) => return self.on_policy(&folder, policy),
        }
        None
    }

    /// Handles an update of the run in `folder`.
    fn on_run_update(&mut self, folder: &Path, update: Update) {
        let Some(watch) = self.watch.as_mut().filter(|watch| watch.folder() == folder) else { return };
        let before = watch.condition();
        watch.replay.is_outdated |= update.replaces_records;
        watch.own.run.apply(update);
        let has_changed = !watch.condition().is_like(before);
        // The first update may still show the state before the start.
        if has_changed && before != Condition::Unknown && self.is_launched(folder) {
            self.launched = None;
        }
        // The message was about the former state.
        if has_changed && !matches!(before, Condition::Stalled(_)) {
            self.message = None;
        }
        self.close_question();
    }

    /// Handles the failure of a process that should train in `folder`. Ignores it if another process trains there.
    fn on_launch_failure(&mut self, folder: &Path, failure: &TrainerFailure) {
        let watch = self.watch.as_ref().filter(|watch| watch.folder() == folder && watch.is_active());
        let at_work = watch.and_then(|watch| watch.own.run.status.as_ref()).map(|status| status.process);
        if at_work.is_some() && at_work != failure.process {
            return;
        }
        if self.is_launched(folder) {
            self.launched = None;
        }
        if let Some(watch) = self.watch.as_mut().filter(|watch| watch.folder() == folder) {
            watch.failure = Some(failure.sentence.clone());
        }
        let name = name_in(&self.places.runs, folder);
        self.message = Some(Message::warning(format!("{name}: {}", failure.sentence)));
    }

    /// Closes the open question if its condition no longer holds.
    fn close_question(&mut self) {
        let when = self.question.as_ref().map(Question::when);
        if let Some(reason) = when.and_then(|when| self.disabled_reason(when)) {
            self.question = None;
            self.message = Some(Message::warning(reason));
        }
    }

    fn on_policy_saved(&mut self, keeping: SavePolicyTask, outcome: Result<bool, String>) {
        let name = keeping.name;
        let is_watched = self.watch.as_ref().is_some_and(|watch| keeping.from.starts_with(watch.folder()));
        match outcome {
            Ok(true) => {
                let call = shell_word(&name);
                self.message = Some(Message::good(format!("kept; use them with: carom recommend --policy {call}")));
            }
            // Ask only if the run is still watched and no question is open; otherwise show a message.
            Ok(false) if self.page() == TrainingContext::Watch && self.question.is_none() && is_watched => {
                self.question = Some(Question::Replace(name));
            }
            Ok(false) => self.message = Some(Message::warning(name_taken_message(&name))),
            Err(sentence) => self.message = Some(Message::warning(format!("{name} is not kept: {sentence}"))),
        }
    }

    fn on_policy(&mut self, folder: &Path, policy: Result<Arc<Policy>, String>) -> Option<(Table, CoachQuery)> {
        let watch = self.watch.as_ref().filter(|watch| watch.folder() == folder)?;
        let table = watch.table()?.clone();
        match policy {
            Ok(policy) => {
                let rule = watch.reward().and_then(Reward::rule).unwrap_or_default();
                Some((
                    table,
                    CoachQuery { policy: Some((watch.own.name.clone(), policy)), rule, ..CoachQuery::default() },
                ))
            }
            Err(sentence) => self.refuse(sentence),
        }
    }
}

impl Page for TrainingPage {
    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn field_mut(&mut self) -> Option<&mut TextField> {
        if let Some(Question::Name(name)) = &mut self.question { Some(name) } else { None }
    }

    fn input(&mut self, typed: Typed) -> bool {
        let is_form = self.page() == TrainingContext::Form && self.question.is_none();
        let taken = match self.field_mut() {
            Some(name) => name.handle(typed),
            None if is_form => match self.form.type_digits(&typed.letters()) {
                Ok(taken) => taken,
                Err(sentence) => {
                    self.message = Some(Message::warning(sentence));
                    return true;
                }
            },
            None => false,
        };
        if taken {
            self.message = None;
        }
        taken
    }

    fn tick(&mut self, seconds: f64) {
        // There are ticks for toasts too, so only a visible replay may advance.
        let is_seen = self.page() == TrainingContext::Watch;
        if let Some(watch) = self.watch.as_mut().filter(|_| is_seen) {
            watch.replay.tick(seconds);
        }
    }

    fn frame_interval(&self) -> Option<f64> {
        let watch = self.watch.as_ref().filter(|_| self.page() == TrainingContext::Watch)?;
        watch.replay.is_playing().then_some(replay::INTERVAL)
    }
}
