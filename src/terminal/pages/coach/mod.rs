//! The state of the coach's screen: the balls, the coach's advice on them, and the clock of a shot's playback.
//!
//! [`actions`] is what each key does to it, [`request`] how the coach is asked, [`dragging`] what the mouse does to balls, [`saving`]
//! how they are saved, [`positions`] how they are typed, [`question`] what is asked for that; [`lesson`] teaches diamond systems,
//! [`own_stroke`] is the player's own stroke, [`spectators`] are others who look on.

mod actions;
mod advised;
mod dragging;
pub mod keys;
mod lesson;
mod own_stroke;
mod page;
mod positions;
mod question;
mod request;
mod saving;
mod spectators;
pub mod view;

use std::{sync::Arc, time::Duration};

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
        shot::{History, Playback, placing::STEPS},
        ui::Message,
        words::step_words,
    },
};

pub use advised::{AdviceState, Choice};
use dragging::Drag;
use question::Question;
use request::{Pending, Studying};
use spectators::Company;
pub use spectators::Followed;

/// What the arrow keys are for on the coach's screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// They move balls.
    Placing,
    /// They step through a shot.
    Watching,
}

const FIRST_STEP: usize = 2;
/// Seconds a picture of the spinner stays.
const SPINNER_INTERVAL: f64 = 0.1;

/// Everything that a step back brings back: where the balls lie, on which table, who is asked, for what, and the advice on them.
#[derive(Clone, Debug)]
struct Snapshot {
    table: Arc<Table>,
    policy: Option<(String, Arc<Policy>)>,
    layout: Layout,
    cue_ball: CueBall,
    /// What was asked for before this step and since, where the step itself has changed it.
    terms: Option<[Terms; 2]>,
    /// The advice on these balls, for each question about them that was answered.
    advised: Vec<AdviceState>,
}

impl Snapshot {
    /// Balls on a table, of which nothing has been asked yet.
    const fn new(table: Arc<Table>, layout: Layout) -> Self {
        Self { table, policy: None, layout, cue_ball: CueBall::White, terms: None, advised: Vec::new() }
    }
}

/// What the panel beside the shot's tells; see the screen for what goes with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InfoPanel {
    /// The shot in words before the stroke; where the balls lie while they are placed, and how they move as it plays.
    #[default]
    Shot,
    /// How often each shot is made that may be chosen.
    Chances,
    /// How far off each input may be.
    Margins,
    /// Where the balls stop, and the next shot.
    Plan,
}

impl InfoPanel {
    /// All of them, in the order in which the key turns to them.
    const ALL: [Self; 4] = [Self::Shot, Self::Chances, Self::Margins, Self::Plan];
}

/// The state of the coach's screen.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice or a fact of its own")]
pub struct CoachPage {
    /// What the arrow keys are for.
    pub mode: Mode,
    /// The ball that the arrow keys move.
    pub selected: usize,
    /// The clock of the shot.
    pub playback: Playback,
    /// What the status line says.
    pub message: Option<Message>,
    /// Whose advice is asked, and for what.
    pub query: CoachQuery,
    /// The user's own skill, where one is kept.
    pub own: Option<Skill>,
    /// What the panels show.
    pub info: InfoPanel,
    /// Whether the shot is told in the thesis' numbers instead of a player's.
    pub is_in_numbers: bool,
    /// Whether all events are listed; else contacts only.
    pub has_all_events: bool,
    /// Whether a jump is shown from the side too.
    is_from_side: bool,
    /// The units in which lengths are told.
    pub units: Units,
    /// The player's name, under which others can follow the table.
    pub player: Option<Player>,
    /// Who else is at this table.
    company: Company,
    /// The player's own stroke, while there is one.
    own_stroke: Option<own_stroke::Own>,
    history: History<Snapshot>,
    /// The selected ball is held by the mouse.
    drag: Option<Drag>,
    /// What the settings ask for, whatever keys have changed since.
    of_settings: Terms,
    /// What was asked for at the start.
    of_start: Terms,
    /// Where the last sessions ended that were not gone on with, the last one first.
    before: Vec<SavedSession>,
    /// Whether one of them was gone on with.
    has_gone_back: bool,
    /// Exams that were left before their end, until they are gone on with; the last one is the latest.
    pub left_exams: Vec<Session>,
    /// What is asked over the table.
    question: Option<Question>,
    /// The name of the position that is being written.
    writing: Option<String>,
    /// The system that is taught.
    lesson: Option<lesson::Lesson>,
    step: usize,
    /// Whether steps go from one quarter of a diamond to the next, whatever their size is in millimetres.
    quarters: bool,
    /// Time that the coach may think, and the most that may be set.
    budget: Duration,
    most: Duration,
    pending: Option<Pending>,
    studying: Option<Studying>,
    questions: u64,
    rng: Xoshiro256PlusPlus,
}

impl CoachPage {
    /// The screen at its start; `seed` decides about random layouts.
    ///
    /// # Errors
    /// A layout that is not possible on the table.
    pub fn new(table: Table, layout: Layout, seed: u64) -> Result<Self, LayoutError> {
        layout.validate(&table)?;
        Ok(Self {
            mode: Mode::Placing,
            selected: 0,
            playback: Playback::default(),
            message: None,
            query: CoachQuery::default(),
            own: None,
            info: InfoPanel::default(),
            is_in_numbers: false,
            has_all_events: false,
            is_from_side: false,
            units: Units::default(),
            player: None,
            company: Company::Alone,
            own_stroke: None,
            history: History::new(Snapshot::new(Arc::new(table), layout)),
            drag: None,
            of_settings: CoachQuery::default().terms(),
            of_start: CoachQuery::default().terms(),
            before: Vec::new(),
            has_gone_back: false,
            left_exams: Vec::new(),
            question: None,
            writing: None,
            lesson: None,
            step: FIRST_STEP,
            quarters: false,
            budget: Duration::from_millis(Settings::default().think_ms),
            most: Duration::MAX,
            pending: None,
            studying: None,
            questions: 0,
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
        })
    }

    /// Asks for what the last session asked for at its end, but for what has been set otherwise since; and offers to go on from
    /// where it ended, and those before it that were not gone on with, as far as that is somewhere else.
    pub fn offer(&mut self, last: Option<SavedSession>) {
        if let Some((last, set)) = last.as_ref().and_then(|last| Some((last, last.settings?))) {
            self.query = self.query.with(self.of_settings.with_change([set, last.terms()]));
        }
        self.of_start = self.query.terms();
        let is_elsewhere = |last: &SavedSession| {
            last.layout != *self.layout() || last.table != *self.table() || last.practice.is_some()
        };
        let mut before = last.map_or_else(Vec::new, SavedSession::with_former);
        before.retain(is_elsewhere);
        self.before = before;
        let words = match self.before.first() {
            None => return,
            Some(SavedSession { practice: Some(practice), .. }) if practice.is_exam() || practice.is_game() => {
                format!("c goes on with the {} of the last session", practice.goal.name())
            }
            Some(_) => "c goes on from where the last session ended".to_owned(),
        };
        self.message = Some(Message::plain(words));
    }

    /// What the next session may go on from, with what is practised, or the exam or `game` that waits to be gone on with; `None` while
    /// nothing is and the balls lie as at the start.
    pub fn saved_session(&self, practised: Option<&Session>, game: Option<&Session>) -> Option<SavedSession> {
        let is_begun = self.is_begun() || practised.or(game).is_some() || !self.left_exams.is_empty();
        if self.followed().is_some() || !is_begun {
            return None;
        }
        let of_before = self.before.first().and_then(|before| before.practice.as_ref());
        let mut exams = practised.into_iter().chain(self.left_exams.iter().rev()).chain(of_before);
        let practice = exams.find(|session| session.is_exam()).or(practised).or(game);
        let ended = |practice: Option<&Session>| {
            let (table, terms) = (self.table().clone(), self.query.terms());
            SavedSession::new(table, *self.layout(), self.cue_ball(), terms, practice.cloned()).under(self.of_settings)
        };
        // One a session: any other exam or game that was left is as if one before had ended there.
        let others = self.left_exams.iter().rev().chain(game);
        let others = others.filter(|other| practice.is_none_or(|practice| practice.id != other.id));
        let former = others.map(|other| ended(Some(other))).chain(self.before.iter().cloned());
        Some(ended(practice).followed_by(former.collect()))
    }

    /// Whether anything has been done since the start.
    fn is_begun(&self) -> bool {
        self.history.can_undo() || !self.history.present().advised.is_empty() || self.query.terms() != self.of_start
    }

    /// Goes on with the exam that was left, or from where the last session ended; gives what was practised there.
    pub fn resume(&mut self) -> Option<Session> {
        if let Some(exam) = self.left_exams.pop() {
            return Some(exam);
        }
        if self.before.is_empty() {
            return None;
        }
        let last = self.before.remove(0);
        // What was asked for came back at the start, where the session kept it as it does today, and keys may have changed it since.
        let terms = if last.settings.is_some() { self.query.terms() } else { last.terms() };
        let query = CoachQuery { policy: self.policy_on(&last.table), ..self.query.with(terms) };
        let its_rule = if last.rule == query.rule { String::new() } else { format!(", under the rule {}", last.rule) };
        self.take(&last.table, last.layout, last.cue_ball, query);
        let which = if std::mem::replace(&mut self.has_gone_back, true) { "that earlier" } else { "the last" };
        let more = if self.before.is_empty() { "" } else { "; c goes back to the one before" };
        let said = format!("this is where {which} session ended{its_rule}; Enter asks the coach{more}");
        self.message = Some(Message::good(said));
        last.practice
    }

    /// Lets the coach think no longer than that, whatever is set.
    pub fn think_at_most(&mut self, most: Duration) {
        self.most = most;
        self.budget = self.budget.min(most);
    }

    /// Begins as the user wants it.
    pub fn take_settings(&mut self, settings: &Settings) {
        let Settings { rule, skill, doubt, plan, jumps, .. } = *settings;
        self.of_settings = Terms { rule, skill, plan, first: FirstContact::Any };
        self.of_start = self.of_settings;
        self.query = CoachQuery { doubt, jumps, ..self.query.with(self.of_settings) };
        self.budget = Duration::from_millis(settings.think_ms).min(self.most);
        self.units = settings.units;
        self.set_step(settings.step_mm);
        self.playback.set_speed(settings.speed);
    }

    /// Takes what has been set otherwise since `before`, and leaves all else as it is.
    ///
    /// # Errors
    /// A sentence where the table cannot be read; everything else is taken.
    pub fn take_changes(&mut self, before: &Settings, settings: &Settings) -> Result<(), String> {
        self.budget = Duration::from_millis(settings.think_ms).min(self.most);
        self.units = settings.units;
        if before.step_mm != settings.step_mm {
            self.set_step(settings.step_mm);
        }
        if before.speed != settings.speed {
            self.playback.set_speed(settings.speed);
        }
        let set = |terms: Terms| Terms {
            rule: other(terms.rule, before.rule, settings.rule),
            skill: other(terms.skill, before.skill, settings.skill),
            plan: other(terms.plan, before.plan, settings.plan),
            ..terms
        };
        self.of_settings = set(self.of_settings);
        let query = CoachQuery {
            doubt: other(self.query.doubt, before.doubt, settings.doubt),
            jumps: other(self.query.jumps, before.jumps, settings.jumps),
            ..self.query.with(set(self.query.terms()))
        };
        if query != self.query {
            self.cancel();
            self.query = query;
            self.rest();
        }
        if before.table != settings.table {
            self.take_table(&settings.table()?);
        }
        Ok(())
    }

    /// Plays on another table from now on.
    pub fn take_table(&mut self, table: &Table) {
        if table != self.table() {
            self.take_query(table, CoachQuery { policy: None, ..self.query.clone() });
            self.message = Some(Message::good(format!("the table is now {}; Enter asks the coach", table.name)));
        }
    }

    fn set_step(&mut self, step_mm: f64) {
        self.step = STEPS.iter().position(|step| *step == step_mm).unwrap_or(FIRST_STEP);
    }

    /// Asks the policy of `query` from now on, under its rule, on `table`: balls that have been placed stay where they lie, if they can
    /// lie there.
    pub fn take_query(&mut self, table: &Table, query: CoachQuery) {
        let lies = *self.layout();
        let stays = self.table() == table || lies.opening_side(self.table()).is_none() && lies.validate(table).is_ok();
        let layout = if stays { lies } else { Layout::opening(table) };
        let news = format!("the coach plays with {}; Enter asks it", query.name());
        let CoachQuery { skill, doubt, plan, jumps, first, .. } = self.query;
        self.take(table, layout, self.cue_ball(), CoachQuery { skill, doubt, plan, jumps, first, ..query });
        self.message = Some(Message::good(news));
    }

    /// Plays for another player from now on; a shot for the one before is no longer shown.
    pub fn take_skill(&mut self, skill: Skill) {
        if self.query.skill != skill {
            self.change_terms(Terms { skill, ..self.query.terms() });
        }
    }

    /// Takes balls from elsewhere, and what counts as a point there; the same policy is asked if the table
    /// is the same.
    pub fn take_position(&mut self, table: &Table, layout: Layout, rule: Rule, cue_ball: CueBall) {
        let policy = self.policy_on(table);
        let its_rule = if rule == self.query.rule { String::new() } else { format!(" and its rule, {rule}") };
        self.take(table, layout, cue_ball, CoachQuery { policy, rule, ..self.query.clone() });
        self.message = Some(Message::plain(format!("the balls of the exercise{its_rule}; Enter asks the coach")));
    }

    /// The policy that is asked, where the table is the one that it was trained for.
    fn policy_on(&self, table: &Table) -> Option<(String, Arc<Policy>)> {
        self.query.policy.clone().filter(|_| self.table() == table)
    }

    /// Puts balls on a table, as a step that can be taken back, for `query` to be asked.
    fn take(&mut self, table: &Table, layout: Layout, cue_ball: CueBall, query: CoachQuery) {
        self.cancel();
        self.drop_ball();
        let known = &self.history.present().table;
        let table = if **known == *table { Arc::clone(known) } else { Arc::new(table.clone()) };
        let terms = Some([self.query.terms(), query.terms()]).filter(|[before, after]| before != after);
        self.history.push(Snapshot { policy: query.policy.clone(), cue_ball, terms, ..Snapshot::new(table, layout) });
        self.query = query;
        self.rest();
    }

    /// The table that is played on.
    pub fn table(&self) -> &Table {
        &self.history.present().table
    }

    /// Where the balls lie before the shot.
    pub const fn layout(&self) -> &Layout {
        &self.history.present().layout
    }

    /// The ball that is the cue ball.
    pub const fn cue_ball(&self) -> CueBall {
        self.history.present().cue_ball
    }

    /// The advice on the layout, if it answers what is asked now.
    pub fn advised(&self) -> Option<&AdviceState> {
        self.history.present().advised.iter().find(|advised| advised.query == self.query)
    }

    /// The same as it is shown: nothing while the coach looks for something better.
    pub fn shown(&self) -> Option<&AdviceState> {
        self.advised().filter(|_| self.pending.is_none())
    }

    fn advised_mut(&mut self) -> Option<&mut AdviceState> {
        let query = &self.query;
        self.history.present_mut().advised.iter_mut().find(|advised| advised.query == *query)
    }

    /// The shot that is shown: the best so far while the coach thinks, else the chosen one of its advice.
    pub fn proposal(&self) -> Option<&Proposal> {
        let pending = self.pending.as_ref().filter(|pending| pending.query == self.query);
        let so_far = pending.and_then(|pending| pending.so_far.as_ref());
        so_far.or_else(|| self.advised().map(|advised| &advised.choice().proposal))
    }

    /// What the chosen panel tells: where the balls lie, while there is no shot and none is looked for.
    pub fn panel(&self) -> InfoPanel {
        if self.shot().is_some() || self.pending.is_some() { self.info } else { InfoPanel::Shot }
    }

    /// The shot that is on the table: the player's own while there is one, else the one that is shown.
    pub fn shot(&self) -> Option<&Arc<Shot>> {
        self.what_if().map(|what_if| &what_if.shot).or_else(|| self.proposal().map(|proposal| &proposal.shot))
    }

    /// The shot that is being watched.
    pub fn watched(&self) -> Option<&Shot> {
        self.shot().filter(|_| self.mode == Mode::Watching).map(Arc::as_ref)
    }

    /// The shot that is told in words: the one that is about to be played.
    pub fn told(&self) -> Option<&Proposal> {
        let is_told = self.mode == Mode::Watching && self.playback.time == 0.0 && self.lesson.is_none();
        self.proposal().filter(|_| is_told)
    }

    /// What is listed of what happens in `shot`.
    pub fn events(&self, shot: &Shot) -> Vec<Event> {
        let all = shot.recording.events().iter();
        all.filter(|event| self.has_all_events || shot.recording.is_told(event)).copied().collect()
    }

    /// What came of the shot that is watched, once the balls lie still.
    pub fn verdict(&self) -> Option<Verdict> {
        let shot = self.watched().filter(|shot| self.playback.time >= shot.recording.duration())?;
        Some(shot.verdict(self.query.rule, self.table()))
    }

    /// The chosen step in millimetres, mm.
    pub fn step_mm(&self) -> f64 {
        STEPS[self.step]
    }

    /// How far a key moves a ball, in words.
    pub fn step_words(&self) -> String {
        if self.quarters { "1/4 diamond".to_owned() } else { step_words(self.step_mm(), self.units.length) }
    }

    /// Number of the spinner's picture, while the coach thinks.
    pub fn spinner(&self) -> Option<usize> {
        self.pending.as_ref().map(|pending| (pending.waited / SPINNER_INTERVAL) as usize)
    }

    /// The thread that thinks is gone, and with it the answer.
    pub fn lost(&mut self) {
        if self.pending.take().is_some() {
            self.message = Some(Message::warning("the coach has failed; quit and start again to ask it"));
        }
    }
}

/// The value of now, or the one that has been set otherwise.
fn other<T: Copy + PartialEq>(now: T, before: T, after: T) -> T {
    if before == after { now } else { after }
}
