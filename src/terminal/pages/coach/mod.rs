//! The coach page: the balls, the coach's advice on them, and the playback of a shot.
//!
//! [`actions`] implements the key actions, [`request`] the requests to the coach, and [`dragging`] moving balls with the mouse.
//! [`saving`] saves positions, [`positions`] reads typed ones, and [`question`] holds the questions for both. [`lesson`] shows the
//! diamond systems, [`own_stroke`] is the player's own stroke, and [`spectators`] shares the table with other people. [`last_session`]
//! continues earlier sessions of the program.

mod actions;
mod advised;
mod dragging;
pub mod keys;
mod last_session;
mod lesson;
mod own_stroke;
mod positions;
mod question;
mod request;
mod saving;
mod spectators;
pub mod view;

use std::{collections::HashMap, sync::Arc, time::Duration};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    coach::{FirstContact, Skill, Units, Verdict},
    drills::Session,
    game::Rule,
    learning::Policy,
    simulation::Event,
    storage::Player,
    table::{CueBall, Layout, LayoutError, Table},
    terminal::{
        CoachQuery, Proposal, SavedSession, Settings, Shot, Terms,
        pages::Page,
        shot::{History, Playback, placing::STEPS},
        ui::{Message, TextField, Typed},
        words::step_words,
    },
};

pub use advised::{AdviceState, Choice};
use dragging::Drag;
use question::Question;
use request::{PendingRequest, RunningAnalysis};
pub use spectators::FollowedPlayer;
use spectators::Sharing;

/// Mode of the coach page: what the arrow keys do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The arrow keys move balls.
    Placing,
    /// The arrow keys step through a shot.
    Watching,
}

const DEFAULT_STEP: usize = 2;
/// Time between two frames of the spinner, s.
const SPINNER_INTERVAL: f64 = 0.1;

/// The state that undo restores: table, policy, ball positions, cue ball, query terms and advice.
#[derive(Clone, Debug)]
struct Snapshot {
    table: Arc<Table>,
    policy: Option<(String, Arc<Policy>)>,
    layout: Layout,
    cue_ball: CueBall,
    /// The query terms before and after this step, if the step itself has changed them.
    terms: Option<[Terms; 2]>,
    /// The advice on this layout, one entry for each answered query.
    advised: Vec<AdviceState>,
}

impl Snapshot {
    /// Creates a snapshot without advice.
    const fn new(table: Arc<Table>, layout: Layout) -> Self {
        Self { table, policy: None, layout, cue_ball: CueBall::White, terms: None, advised: Vec::new() }
    }
}

/// Content of the side panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InfoPanel {
    /// The ball positions in placing mode, the shot in words before the stroke, and the motion of the balls during playback.
    #[default]
    Shot,
    /// The success rate of each proposed shot.
    Chances,
    /// The error margin of each input of the stroke.
    Margins,
    /// The layout after the shot, and the next shot.
    Plan,
}

impl InfoPanel {
    /// All panels, in the order in which the key cycles through them.
    const ALL: [Self; 4] = [Self::Shot, Self::Chances, Self::Margins, Self::Plan];
}

/// The state of the coach page.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice or a fact of its own")]
pub struct CoachPage {
    /// What the arrow keys do.
    pub mode: Mode,
    /// The ball that the arrow keys move.
    pub selected: usize,
    /// Playback position and speed of the shot.
    pub playback: Playback,
    /// The message of the status line.
    pub message: Option<Message>,
    /// The query to the coach: the policy and the terms.
    pub query: CoachQuery,
    /// The user's own measured skill; `None` if none is saved.
    pub own_skill: Option<Skill>,
    /// The chosen panel.
    pub info: InfoPanel,
    /// Whether the shot is described in the thesis' numbers instead of a player's words.
    pub is_in_numbers: bool,
    /// Whether all events are listed; otherwise contacts only.
    pub has_all_events: bool,
    /// Whether a jump is also shown from the side.
    has_side_view: bool,
    /// The units for displayed values.
    pub units: Units,
    /// The player's name, under which others can follow the table; `None` if the program was started without one.
    pub player: Option<Player>,
    /// Whether the table is shared with spectators or belongs to another player.
    sharing: Sharing,
    /// The player's own stroke; `None` if there is none.
    own_stroke: Option<own_stroke::OwnStrokeState>,
    history: History<Snapshot>,
    /// The mouse drag in progress; it moves the selected ball.
    drag: Option<Drag>,
    /// The table and the rule before a policy of the user's own was taken, and the rule that came with it.
    before_policy: Option<(Arc<Table>, [Rule; 2])>,
    /// The query terms from the settings, without later changes by keys.
    settings_terms: Terms,
    /// The query terms at the start of this session.
    start_terms: Terms,
    /// Saved sessions that have not been resumed, the latest first.
    earlier_sessions: Vec<SavedSession>,
    /// Whether a saved session has been resumed.
    has_resumed: bool,
    /// Unfinished exams that were left: first those that were left again without a stroke, at the end the latest.
    unfinished_exams: Vec<Session>,
    /// The number of attempts that each exam had when it was last resumed, by the exam's identifier.
    resumed_exams: HashMap<String, usize>,
    /// The question that is open over the table.
    question: Option<Question>,
    /// The name of the position that is being saved to disk.
    saving_name: Option<String>,
    /// The lesson on a diamond system that is displayed.
    lesson: Option<lesson::Lesson>,
    step: usize,
    /// Whether the arrow keys move a ball to the next quarter diamond instead of by millimetres.
    quarters: bool,
    /// Thinking time of the coach, and the upper limit for that setting.
    budget: Duration,
    max_budget: Duration,
    pending: Option<PendingRequest>,
    running_analysis: Option<RunningAnalysis>,
    job_count: u64,
    rng: Xoshiro256PlusPlus,
}

impl CoachPage {
    /// Creates the page; `seed` seeds the generator of random layouts.
    ///
    /// # Errors
    /// Fails if the layout is not possible on the table.
    pub fn new(table: Table, layout: Layout, seed: u64) -> Result<Self, LayoutError> {
        layout.validate(&table)?;
        Ok(Self {
            mode: Mode::Placing,
            selected: 0,
            playback: Playback::default(),
            message: None,
            query: CoachQuery::default(),
            own_skill: None,
            info: InfoPanel::default(),
            is_in_numbers: false,
            has_all_events: false,
            has_side_view: false,
            units: Units::default(),
            player: None,
            sharing: Sharing::Private,
            own_stroke: None,
            history: History::new(Snapshot::new(Arc::new(table), layout)),
            drag: None,
            before_policy: None,
            settings_terms: CoachQuery::default().terms(),
            start_terms: CoachQuery::default().terms(),
            earlier_sessions: Vec::new(),
            has_resumed: false,
            unfinished_exams: Vec::new(),
            resumed_exams: HashMap::new(),
            question: None,
            saving_name: None,
            lesson: None,
            step: DEFAULT_STEP,
            quarters: false,
            budget: Duration::from_millis(Settings::default().think_ms),
            max_budget: Duration::MAX,
            pending: None,
            running_analysis: None,
            job_count: 0,
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
        })
    }

    /// Limits the coach's thinking time, whatever the setting is.
    pub fn limit_thinking_time(&mut self, most: Duration) {
        self.max_budget = most;
        self.budget = self.budget.min(most);
    }

    /// Applies all settings at the start.
    pub fn apply_settings(&mut self, settings: &Settings) {
        let Settings { rule, skill, doubt, plan, jumps, .. } = *settings;
        self.settings_terms = Terms { rule, skill, plan, first: FirstContact::Any };
        self.start_terms = self.settings_terms;
        self.query = CoachQuery { doubt, jumps, ..self.query.with(self.settings_terms) };
        self.budget = Duration::from_millis(settings.think_ms).min(self.max_budget);
        self.units = settings.units;
        self.set_step(settings.step_mm);
        self.playback.set_speed(settings.speed);
    }

    /// Applies the settings that differ from `before` and leaves everything else unchanged.
    ///
    /// # Errors
    /// Returns a message if the table cannot be read. The other settings are applied nevertheless.
    pub fn apply_changed_settings(&mut self, before: &Settings, settings: &Settings) -> Result<(), String> {
        self.budget = Duration::from_millis(settings.think_ms).min(self.max_budget);
        self.units = settings.units;
        if before.step_mm != settings.step_mm {
            self.set_step(settings.step_mm);
        }
        if before.speed != settings.speed {
            self.playback.set_speed(settings.speed);
        }
        let set = |terms: Terms| Terms {
            rule: changed_or_current(terms.rule, before.rule, settings.rule),
            skill: changed_or_current(terms.skill, before.skill, settings.skill),
            plan: changed_or_current(terms.plan, before.plan, settings.plan),
            ..terms
        };
        self.settings_terms = set(self.settings_terms);
        let query = CoachQuery {
            doubt: changed_or_current(self.query.doubt, before.doubt, settings.doubt),
            jumps: changed_or_current(self.query.jumps, before.jumps, settings.jumps),
            ..self.query.with(set(self.query.terms()))
        };
        if query != self.query {
            self.cancel();
            self.query = query;
            self.reset_playback();
        }
        if before.table != settings.table {
            self.set_table(&settings.table()?);
        }
        Ok(())
    }

    /// Switches to another table.
    pub fn set_table(&mut self, table: &Table) {
        if table != self.table() {
            let before = *self.layout();
            self.set_query(table, CoachQuery { policy: None, ..self.query.clone() });
            let balls = if *self.layout() == before { "" } else { ", with the balls on the opening spots" };
            self.message = Some(Message::good(format!("the table is now {}{balls}; Enter asks the coach", table.name)));
        }
    }

    fn set_step(&mut self, step_mm: f64) {
        self.step = STEPS.iter().position(|step| *step == step_mm).unwrap_or(DEFAULT_STEP);
    }

    /// Switches to the policy and rule of `query` on `table`. Balls that the user has placed keep their positions if these are possible on
    /// the table.
    pub fn set_query(&mut self, table: &Table, query: CoachQuery) {
        let current = *self.layout();
        let stays =
            self.table() == table || current.opening_side(self.table()).is_none() && current.validate(table).is_ok();
        let layout = if stays { current } else { Layout::opening(table) };
        let rule =
            if query.rule == self.query.rule { String::new() } else { format!("; the rule is now {}", query.rule) };
        let on =
            if table.name == self.table().name { String::new() } else { format!("; the table is now {}", table.name) };
        let news = format!("the coach plays with {}{on}{rule}; Enter asks it", query.name());
        if query.policy.is_some() {
            let (before, rule) = self.table_and_rule_without_policy();
            self.before_policy = Some((before, [rule, query.rule]));
        }
        let CoachQuery { skill, doubt, plan, jumps, first, .. } = self.query;
        self.replace_position(table, layout, self.cue_ball(), CoachQuery { skill, doubt, plan, jumps, first, ..query });
        self.message = Some(Message::good(news));
    }

    /// The table and the rule from before the user's own policy was taken; a rule that was chosen since stays.
    fn table_and_rule_without_policy(&self) -> (Arc<Table>, Rule) {
        match self.before_policy.as_ref().filter(|_| self.query.policy.is_some()) {
            Some((table, [before, own])) => {
                (Arc::clone(table), if self.query.rule == *own { *before } else { self.query.rule })
            }
            None => (Arc::clone(&self.history.present().table), self.query.rule),
        }
    }

    /// Switches to another player skill. A shot for the former skill is no longer displayed.
    pub fn set_skill(&mut self, skill: Skill) {
        if self.query.skill != skill {
            self.change_terms(Terms { skill, ..self.query.terms() });
        }
    }

    /// Takes over a position from another page, with its rule. The policy is kept if the table is the same.
    pub fn set_position(&mut self, table: &Table, layout: Layout, rule: Rule, cue_ball: CueBall) {
        let policy = self.policy_on(table);
        let its_rule = if rule == self.query.rule { String::new() } else { format!(", with their rule, {rule}") };
        self.replace_position(table, layout, cue_ball, CoachQuery { policy, rule, ..self.query.clone() });
        self.message = Some(Message::plain(format!("the balls are taken over{its_rule}; Enter asks the coach")));
    }

    /// Returns the current policy if `table` is the current table, for which the policy was trained.
    fn policy_on(&self, table: &Table) -> Option<(String, Arc<Policy>)> {
        self.query.policy.clone().filter(|_| self.table() == table)
    }

    /// Puts balls on a table and sets the query, as one undoable step.
    fn replace_position(&mut self, table: &Table, layout: Layout, cue_ball: CueBall, query: CoachQuery) {
        self.cancel();
        self.end_drag();
        let known = &self.history.present().table;
        let table = if **known == *table { Arc::clone(known) } else { Arc::new(table.clone()) };
        let terms = Some([self.query.terms(), query.terms()]).filter(|[before, after]| before != after);
        self.history.push(Snapshot { policy: query.policy.clone(), cue_ball, terms, ..Snapshot::new(table, layout) });
        self.query = query;
        self.reset_playback();
    }

    /// The current table.
    pub fn table(&self) -> &Table {
        &self.history.present().table
    }

    /// The ball positions before the shot.
    pub const fn layout(&self) -> &Layout {
        &self.history.present().layout
    }

    /// The current cue ball.
    pub const fn cue_ball(&self) -> CueBall {
        self.history.present().cue_ball
    }

    /// The advice on the current layout, if it answers the current query.
    pub fn current_advice(&self) -> Option<&AdviceState> {
        self.history.present().advised.iter().find(|advised| advised.query == self.query)
    }

    /// The advice that is displayed; `None` while the coach searches.
    pub fn displayed_advice(&self) -> Option<&AdviceState> {
        self.current_advice().filter(|_| self.pending.is_none())
    }

    fn current_advice_mut(&mut self) -> Option<&mut AdviceState> {
        let query = &self.query;
        self.history.present_mut().advised.iter_mut().find(|advised| advised.query == *query)
    }

    /// The displayed shot of the coach: the best so far while it thinks, else the chosen one of its advice.
    pub fn proposal(&self) -> Option<&Proposal> {
        let pending = self.pending.as_ref().filter(|pending| pending.query == self.query);
        let so_far = pending.and_then(|pending| pending.best_so_far.as_ref());
        so_far.or_else(|| self.current_advice().map(|advised| &advised.choice().proposal))
    }

    /// The panel to display: the chosen one, or the ball positions if there is no shot and no search.
    pub fn panel(&self) -> InfoPanel {
        if self.shot().is_some() || self.pending.is_some() { self.info } else { InfoPanel::Shot }
    }

    /// The shot on the table: the player's own if there is one, else the coach's.
    pub fn shot(&self) -> Option<&Arc<Shot>> {
        self.what_if().map(|what_if| &what_if.shot).or_else(|| self.proposal().map(|proposal| &proposal.shot))
    }

    /// The shot in playback mode.
    pub fn watched(&self) -> Option<&Shot> {
        self.shot().filter(|_| self.mode == Mode::Watching).map(Arc::as_ref)
    }

    /// The shot to describe in words: the one that is about to be played.
    pub fn described_shot(&self) -> Option<&Proposal> {
        let is_told = self.mode == Mode::Watching && self.playback.time == 0.0 && self.lesson.is_none();
        self.proposal().filter(|_| is_told)
    }

    /// The events of `shot` that the event list displays.
    pub fn events(&self, shot: &Shot) -> Vec<Event> {
        shot.recording.listed_events(self.has_all_events).copied().collect()
    }

    /// The result of the watched shot; `None` until the balls have stopped.
    pub fn verdict(&self) -> Option<Verdict> {
        let shot = self.watched().filter(|shot| self.playback.time >= shot.recording.duration())?;
        Some(shot.verdict(self.query.rule, self.table()))
    }

    /// The chosen step size, mm.
    pub fn step_mm(&self) -> f64 {
        STEPS[self.step]
    }

    /// The chosen step size in words.
    pub fn step_words(&self) -> String {
        if self.quarters { "1/4 diamond".to_owned() } else { step_words(self.step_mm(), self.units.length) }
    }

    /// Frame number of the spinner; `None` if the coach is not thinking.
    pub fn spinner(&self) -> Option<usize> {
        self.pending.as_ref().map(|pending| (pending.elapsed / SPINNER_INTERVAL) as usize)
    }

    /// Handles the loss of the coach's worker thread, and with it of the pending answer.
    pub fn handle_worker_loss(&mut self) {
        if self.pending.take().is_some() {
            self.message = Some(Message::warning("the coach has failed; quit and start again to ask it"));
        }
    }
}

impl Page for CoachPage {
    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn field_mut(&mut self) -> Option<&mut TextField> {
        match self.question.as_mut()? {
            Question::Positions(typed) | Question::Stroke(typed) | Question::Title(typed, _) => Some(typed),
            Question::Replace(_) => None,
        }
    }

    fn input(&mut self, typed: Typed) -> bool {
        if self.followed().is_some() {
            return false;
        }
        let taken = self.field_mut().is_some_and(|field| field.handle(typed));
        if let (Typed::Paste(text), false) = (typed, self.question.is_some()) {
            // Text that is pasted while no question is open contains ball positions.
            self.paste(text);
            return true;
        }
        if taken {
            self.message = None;
        }
        taken
    }

    fn tick(&mut self, seconds: f64) {
        if let Some(pending) = &mut self.pending {
            pending.elapsed += seconds;
        }
        if let Some(duration) = self.shot().map(|shot| shot.recording.duration()) {
            self.playback.tick(seconds, duration);
        }
    }

    fn frame_interval(&self) -> Option<f64> {
        if self.playback.playing { Some(1.0 / 30.0) } else { self.pending.as_ref().map(|_| SPINNER_INTERVAL) }
    }

    fn cue_ball(&self) -> CueBall {
        Self::cue_ball(self)
    }
}

/// Returns `after` if the setting has changed, else the current value `now`.
fn changed_or_current<T: Copy + PartialEq>(now: T, before: T, after: T) -> T {
    if before == after { now } else { after }
}
