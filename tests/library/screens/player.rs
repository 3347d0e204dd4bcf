//! A simulated user: presses keys, runs the tasks that the program requests, and examines the screens.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use carom::{
    drills::{Exercise, Session, store::Store},
    learning::run::{
        follow::{Condition, Update},
        status::{Phase, RunStatus},
    },
    physics::CueInputs,
    statistics::SuccessRate,
    storage::DataPaths,
    table::{Layout, Table},
    terminal::{
        Advice, AdviceTask, App, Capabilities, CoachAnswer, CoachEvent, CoachJob, CoachWorker, DrillReport, DrillTask,
        Effect, FollowSlot, ModelShot, PracticeWorker, Proposal, Reel, Settings, SettingsFile, Shot, TrainingReport,
    },
};
use crossterm::event::KeyEvent;
use ratatui::{Terminal, backend::TestBackend, buffer::Buffer, style::Color};
use tempfile::TempDir;

pub use super::snapshot::{check, check_at, check_text};
use super::{
    keys::key,
    practice::exercise,
    runs::{RUN, RUNS, full_update, listing, status},
};

pub const TRUE_COLOUR: Capabilities = Capabilities::TRUE_COLOUR;
pub const NO_COLOUR: Capabilities = Capabilities::NO_COLOUR;
pub const ASCII: Capabilities = Capabilities::ASCII;

/// The terminal sizes of most tests.
pub const SIZES: [(u16, u16); 2] = [(80, 24), (120, 40)];

/// A shot that makes the point from the opening position, so that the pictures do not depend on the coach; two others; and one that makes
/// the point from the end positions of the first.
pub const SHOT: &str = "0.2,0.3,6,-8.8,2.5";
pub const OTHER_SHOTS: [&str; 2] = ["0.4,-0.22,2.37,-104.8,4.84", "0.09,0.35,2,-73.3,2.58"];
pub const NEXT_SHOT: &str = "-0.353,0.054,3.2,87.8,5.07";

pub struct Player {
    pub app: App,
    /// The request to the coach, which a test answers at any time.
    pub advice_job: Option<Box<CoachJob>>,
    pub analysis_job: Option<Box<CoachJob>>,
    /// The request to estimate how often the player's own stroke succeeds.
    pub success_rate_job: Option<Box<CoachJob>>,
    /// The coach's model shot in the drills; `None` by default, because the coach's result depends on the speed of the machine.
    pub model_shot: Option<&'static str>,
    pub copied: Vec<String>,
    /// Requests to processes and to the terminal.
    pub effects: Vec<Effect>,
    pub practice: PracticeWorker,
    settings: SettingsFile,
    folder: TempDir,
}

/// Returns the stroke that is written like this.
pub fn cue(text: &str) -> CueInputs {
    CueInputs::parse(text).unwrap()
}

/// Returns the player's folders; tests report the runs themselves.
pub fn places(folder: &Path) -> DataPaths {
    DataPaths { runs: RUNS.into(), policies: "/policies".into(), ..DataPaths::under(folder) }
}

/// Returns a proposal whose shot succeeds in `made` of 1000 attempts.
pub fn proposal(table: &Table, layout: &Layout, cue: &str, made: usize) -> Proposal {
    let shot = Shot::new(table, layout, self::cue(cue), true, "policy").unwrap();
    Proposal {
        shot: Arc::new(shot),
        made: Some(SuccessRate::new(made, 1000)),
        risk: None,
        next: Some(0.97),
        is_early: false,
    }
}

/// Returns the coach's advice on the opening position.
pub fn advice(job: &CoachJob) -> Advice {
    let proposal = |cue, made| proposal(&job.table, &job.layout, cue, made);
    let best = proposal(SHOT, 940);
    let others = OTHER_SHOTS.into_iter().zip([893, 620]).map(|(cue, made)| proposal(cue, made));
    advice_of(std::iter::once(best).chain(others).collect())
}

/// Returns the coach's advice with these proposals.
pub fn advice_of(proposals: Vec<Proposal>) -> Advice {
    Advice { proposals, seed: 1, effort: None, found: None }
}

/// Returns all answers of the real coach to a request.
pub fn worker_answers(worker: &mut CoachWorker, job: &CoachJob) -> Vec<CoachAnswer> {
    let mut answers = Vec::new();
    worker.answer(job, |answer| answers.push(answer));
    answers
}

/// Returns a model shot of the coach.
fn model_shot(task: &AdviceTask, cue: &str) -> ModelShot {
    let Proposal { shot, made, .. } = proposal(&task.table, &task.layout, cue, 400);
    let advice = carom::drills::Advice { cue: shot.cue, solved: true, chance: made.expect("it was judged") };
    ModelShot { advice, is_own: false, shot }
}

/// Starting points.
impl Player {
    /// At the coach, with the files in `folder`; the settings file contains no path of this machine.
    pub fn in_folder(caps: Capabilities, folder: TempDir) -> Self {
        Self::at_table(caps, &Table::default(), folder)
    }

    /// At the coach, on this table.
    pub fn at_table(caps: Capabilities, table: &Table, folder: TempDir) -> Self {
        let file = folder.path().join("config.toml");
        let (settings, mistakes) = Settings::load(&file);
        let app = App::new(table.clone(), Layout::opening(table), caps, 7).unwrap();
        let told = DataPaths { settings: "/home/player/.config/carom/config.toml".into(), ..places(folder.path()) };
        Self {
            app: app.with_paths(told).with_settings(&settings).with_mistakes(&file, &mistakes),
            advice_job: None,
            analysis_job: None,
            success_rate_job: None,
            model_shot: None,
            copied: Vec::new(),
            effects: Vec::new(),
            practice: PracticeWorker::default(),
            settings: SettingsFile::default(),
            folder,
        }
    }

    pub fn with(caps: Capabilities) -> Self {
        Self::in_folder(caps, tempfile::tempdir().unwrap())
    }

    /// At the next start after `earlier` has left.
    pub fn after(mut self, earlier: &Self) -> Self {
        self.app = self.app.with_saved_session(earlier.app.saved_session());
        self
    }

    /// At the coach.
    pub fn new() -> Self {
        Self::with(TRUE_COLOUR)
    }

    /// With this text in the settings file.
    pub fn with_settings(caps: Capabilities, text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("config.toml"), text).unwrap();
        Self::in_folder(caps, folder)
    }

    /// At the library, with these positions and sessions on the disk.
    pub fn at_library(caps: Capabilities, positions: &[Exercise], sessions: &[Session]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::new(&places(folder.path()));
        for position in positions {
            store.save_position(position, false).unwrap();
        }
        for session in sessions {
            store.save(session, &[], 0).unwrap();
        }
        Self::in_folder(caps, folder).press("d")
    }

    /// At the exercise from the opening.
    pub fn practising(caps: Capabilities) -> Self {
        Self::at_library(caps, &[exercise("opening", "From the opening")], &[]).press("Left Enter")
    }

    /// At the list of runs, before it is loaded.
    pub fn at_runs(caps: Capabilities) -> Self {
        Self::with(caps).press("t")
    }

    /// At the list of three runs.
    pub fn listing(caps: Capabilities) -> Self {
        Self::at_runs(caps).report(TrainingReport::Runs(Ok(listing())))
    }

    /// At a run that has played 1.2 of 5 million shots.
    pub fn watching(caps: Capabilities) -> Self {
        Self::listing(caps).press("Enter").has_policy(true).update(FollowSlot::Main, RUN, full_update()).finish_replay()
    }
}

/// Actions.
impl Player {
    /// Presses keys, separated by spaces (see [`key`]); none of them may end the program.
    pub fn press(mut self, keys: &str) -> Self {
        for word in keys.split_whitespace() {
            self.event(&key(word));
            let last = self.effects.last();
            assert!(!matches!(last, Some(Effect::Quit | Effect::Suspend)), "{word} gives {last:?}");
        }
        self
    }

    /// Presses one key and runs the requested task.
    pub fn event(&mut self, event: &KeyEvent) {
        if let Some(effect) = self.app.handle(event) {
            self.run_effect(effect);
        }
    }

    /// Presses a key and returns the tasks that it requests, without running them.
    pub fn requested_tasks(&mut self, word: &str) -> Vec<DrillTask> {
        match self.app.handle(&key(word)) {
            Some(Effect::Drill(tasks)) => tasks,
            other => panic!("{word} gives {other:?}"),
        }
    }

    /// Types words, including spaces.
    pub fn type_in(self, text: &str) -> Self {
        text.chars().fold(self, |player, letter| match letter {
            ' ' => player.press("Space"),
            letter => player.press(&letter.to_string()),
        })
    }

    pub fn wait(mut self, seconds: f64) -> Self {
        self.app.tick(seconds);
        self
    }

    /// Waits for the end of the replay.
    pub fn finish_replay(mut self) -> Self {
        for _ in 0..2000 {
            if self.app.frame_interval().is_none() {
                break;
            }
            self.app.tick(0.1);
        }
        assert_eq!(self.app.frame_interval(), None, "the replay has ended");
        self
    }
}

/// Effects.
impl Player {
    fn run_effect(&mut self, effect: Effect) {
        match effect {
            Effect::AskCoach(job) if job.stroke.is_some() && job.shot.is_none() => self.success_rate_job = Some(job),
            Effect::AskCoach(job) if job.shot.is_some() => self.analysis_job = Some(job),
            Effect::AskCoach(job) => self.advice_job = Some(job),
            Effect::Copy(text) => self.copied.push(text),
            Effect::Drill(tasks) => self.run(tasks),
            Effect::Settings(mut task) => {
                task.paths.settings = self.path("config.toml");
                let report = self.settings.run(&task);
                if let Some(effect) = self.app.receive_settings(report) {
                    self.run_effect(effect);
                }
            }
            Effect::Calibrate(tasks) => {
                for task in tasks {
                    if let Some(effect) = self.app.receive_calibration(task.run()) {
                        self.run_effect(effect);
                    }
                }
            }
            other => self.effects.push(other),
        }
    }

    /// Runs tasks and the tasks that follow from them.
    pub fn run(&mut self, tasks: Vec<DrillTask>) {
        for task in tasks {
            let mut reports = Vec::new();
            match task {
                DrillTask::Advise(task) if task.own.is_none() => {
                    let model_shot = self.model_shot.map(|cue| model_shot(&task, cue));
                    reports.push(DrillReport::ModelShot(task.id, Ok(model_shot)));
                }
                task => self.practice.run(task, &mut |report| reports.push(report)),
            }
            for report in reports {
                let more = self.app.receive_drill(report);
                self.run(more);
            }
        }
    }

    pub fn tell(mut self, id: u64, event: CoachEvent) -> Self {
        if let Some(effect) = self.app.receive(CoachAnswer { id, event }) {
            self.run_effect(effect);
        }
        self
    }

    /// Lets the coach answer with [`SHOT`] and [`OTHER_SHOTS`].
    pub fn answer(mut self) -> Self {
        let job = self.advice_job.take().expect("the coach was asked");
        let advice = advice(&job);
        self.tell(job.id, CoachEvent::Advice(advice))
    }

    /// Returns the stroke of the coach's page's shown shot.
    pub fn shown_cue(&self) -> Option<CueInputs> {
        self.app.coach.shot().map(|shot| shot.cue)
    }

    /// Lets the coach report this shot as the best so far, with `made` of 1000 attempts.
    pub fn report_better(self, cue: &str, made: usize) -> Self {
        let job = self.advice_job.clone().expect("the coach was asked");
        let so_far = proposal(&job.table, &job.layout, cue, made);
        self.tell(job.id, CoachEvent::Better(Proposal { is_early: true, ..so_far }))
    }

    /// Runs the analysis of the displayed shot with the real coach, except for the next shot, which is [`NEXT_SHOT`].
    pub fn finish_analysis(mut self) -> Self {
        // Even if the result is no longer awaited.
        let job = CoachJob { cancel: Arc::default(), ..*self.analysis_job.take().expect("a closer look is wanted") };
        let mut study = None;
        CoachWorker::with_simulation_limit(1).answer(&job, |answer| {
            if let CoachEvent::Analysis(found) = answer.event {
                study = Some(found);
            }
        });
        let end = self.app.coach.shot().unwrap().recording.final_layout();
        let next = proposal(&job.table, &end, NEXT_SHOT, 1000);
        self.tell(job.id, CoachEvent::Analysis(study.unwrap()))
            .tell(job.id, CoachEvent::Next(Some(advice_of(vec![next]))))
    }

    pub fn report(mut self, report: TrainingReport) -> Self {
        self.app.receive_training(report);
        self
    }

    /// Reports news of a run, with its shots recorded as in the program.
    pub fn update(self, slot: FollowSlot, name: &str, mut update: Update) -> Self {
        let folder = Path::new(RUNS).join(name);
        let reel = update.examples.take().map(|examples| Reel::record(&examples, &Table::default()));
        let player = self.report(TrainingReport::Followed(slot, folder.clone(), Box::new(update)));
        match reel.filter(|_| slot == FollowSlot::Main) {
            Some(reel) => player.report(TrainingReport::Recorded(folder, reel)),
            None => player,
        }
    }

    pub fn condition(self, condition: Condition, reason: Option<&str>) -> Self {
        let phase = if let Condition::InPhase(phase) = condition { phase } else { Phase::Training };
        let status = RunStatus { phase, reason: reason.map(str::to_owned), ..status() };
        let update = Update { condition: Some(condition), status: Some(status), ..Update::default() };
        self.update(FollowSlot::Main, RUN, update)
    }

    pub fn has_policy(self, has_policy: bool) -> Self {
        self.report(TrainingReport::HasPolicy(Path::new(RUNS).join(RUN), has_policy))
    }
}

/// Display.
impl Player {
    pub fn picture(&self, width: u16, height: u16) -> Buffer {
        self.draw(width, height).backend().buffer().clone()
    }

    pub fn text(&self, width: u16, height: u16) -> String {
        self.draw(width, height).backend().to_string()
    }

    fn draw(&self, width: u16, height: u16) -> Terminal<TestBackend> {
        drawn(&self.app, width, height)
    }

    /// Whether a toast contains `part`.
    pub fn has_toast(&self, part: &str) -> bool {
        self.app.toasts.shown.iter().any(|toast| toast.text.contains(part))
    }

    /// Asserts that a toast contains `part`.
    #[track_caller]
    pub fn warns(&self, part: &str) {
        assert!(self.has_toast(part), "{part}\n{}", self.text(120, 40));
    }

    /// Asserts that no toast is shown: nothing was refused.
    pub fn warns_nothing(&self) {
        assert!(self.app.toasts.shown.is_empty(), "{}", self.text(120, 40));
    }

    /// Asserts that the text is on the screen or in a toast, which may break its lines.
    #[track_caller]
    pub fn says(&self, part: &str) -> &Self {
        let text = self.text(120, 40);
        assert!(text.contains(part) || self.has_toast(part), "{part}\n{text}");
        self
    }

    /// Asserts that the texts are on the screen of this size.
    #[track_caller]
    pub fn shows_at(&self, (width, height): (u16, u16), parts: &[&str]) -> &Self {
        let text = self.text(width, height);
        for part in parts {
            assert!(text.contains(part), "{part}\n{text}");
        }
        self
    }

    /// Asserts that the texts are on the screen at both sizes.
    #[track_caller]
    pub fn shows(&self, parts: &[&str]) -> &Self {
        for size in SIZES {
            self.shows_at(size, parts);
        }
        self
    }

    /// Asserts that none of the texts is on the screen of this size.
    #[track_caller]
    pub fn hides_at(&self, (width, height): (u16, u16), parts: &[&str]) -> &Self {
        let text = self.text(width, height);
        for part in parts {
            assert!(!text.contains(part), "{part}\n{text}");
        }
        self
    }

    /// Asserts that the screen has only ASCII and no colour, at both sizes and a large one.
    #[track_caller]
    pub fn is_plain(&self) -> &Self {
        for (width, height) in SIZES.into_iter().chain([(200, 60)]) {
            let text = self.text(width, height);
            assert!(text.is_ascii() || self.app.caps.unicode, "{text}");
            for cell in self.picture(width, height).content() {
                assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset), "{cell:?}\n{text}");
            }
        }
        self
    }

    #[track_caller]
    pub fn does_not_show(&self, part: &str) -> &Self {
        self.hides_at((120, 40), &[part])
    }

    pub fn store(&self) -> Store {
        Store::new(&places(self.folder.path()))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Returns the folder of the followed run in this slot.
    pub fn followed_run(&self, slot: usize) -> Option<PathBuf> {
        self.app.subscriptions().followed[slot].clone().map(|(folder, _)| folder)
    }

    /// Returns the number of attempts on the disk.
    pub fn attempt_count(&self) -> usize {
        self.store().sessions().items.iter().map(|session| session.attempts.len()).sum()
    }

    /// Returns the text of the settings file.
    pub fn settings_text(&self) -> String {
        fs::read_to_string(self.path("config.toml")).unwrap_or_default()
    }
}

/// Returns a terminal with the screen of `app`.
pub fn drawn(app: &App, width: u16, height: u16) -> Terminal<TestBackend> {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| app.draw(frame)).unwrap();
    terminal
}
