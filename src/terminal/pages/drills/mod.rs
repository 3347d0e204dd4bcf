//! The drill page: the exercise library, the open exercise, exams and their results, the records, and the filmed shots.
//!
//! Background tasks ([`DrillTask`]) read and write files, and play and judge strokes. Each reports its result as a
//! [`DrillReport`](crate::terminal::DrillReport). [`actions`] implements the key actions.

mod actions;
mod against_coach;
mod aim_line;
mod book;
mod catalogue;
pub mod film;
mod goals;
pub mod keys;
mod match_setup;
mod question;
mod records;
mod reports;
mod turn;
mod turn_actions;
mod view;
mod watched;
mod what_if;

use std::{collections::HashMap, path::Path};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    coach::{Skill, Units},
    drills::{Goal, Library, Session, Venue},
    game::Rule,
    storage::DataPaths,
    table::{CueBall, Layout, PRESETS, Table},
    terminal::{
        DrillContext, DrillTask, Effect, Settings,
        pages::{
            Page,
            drills::{film::FilmsScreen, goals::Lengths},
            next_skill,
        },
        ui::{Message, TextField},
    },
};

pub use aim_line::AimLine;
pub use book::{Book, record_of};
pub use catalogue::Catalogue;
pub use match_setup::{MatchField, MatchSetup};
pub use question::Question;
pub use records::{Estimate, Records};
pub use turn::{ModelShotState, Stage, Turn};
pub use watched::Watched;

/// The player whose errors are simulated.
#[derive(Clone, Copy, Debug, Default)]
pub struct Player {
    /// The current skill: the standard errors of the simulated strokes.
    pub skill: Skill,
    /// The skill that the user has saved as the own one.
    pub own_skill: Option<Skill>,
    /// The skill of the settings.
    settings_skill: Skill,
    /// The skill on the coach page. Only an explicit choice changes it.
    pub coach_page_skill: Skill,
}

impl Player {
    /// Chooses the next skill.
    fn choose_next(&mut self) {
        self.choose(next_skill(self.skill, self.own_skill, self.settings_skill));
    }

    /// Chooses `skill`, for the coach page too.
    const fn choose(&mut self, skill: Skill) {
        (self.skill, self.coach_page_skill) = (skill, skill);
    }
}

/// Options for repeating exercises.
#[derive(Clone, Debug, Default)]
struct RepetitionOptions {
    /// The goal that was chosen for an exercise, by its name.
    goals: HashMap<String, Goal>,
    /// Whether the balls are shifted. Unlike the goal this is kept from exercise to exercise.
    shifted: bool,
    lengths: Lengths,
}

/// An exam that is over, while its result is shown or an exercise of it is practised.
#[derive(Debug)]
pub struct ExamResult {
    /// The exam.
    pub session: Session,
    /// Index of the marked exercise.
    pub mark: usize,
}

/// A position that is transferred between this page and the coach page.
#[derive(Clone, Debug)]
pub struct TransferredPosition {
    /// The table.
    pub table: Table,
    /// The positions of the balls.
    pub layout: Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// The cue ball.
    pub cue_ball: CueBall,
}

/// The state of the drill page.
#[derive(Debug)]
pub struct DrillsPage {
    /// The folders of sessions and positions.
    pub places: DataPaths,
    /// The list of exercises.
    pub catalogue: Catalogue,
    /// The practice record.
    pub book: Book,
    /// The open exercise.
    pub turn: Option<Turn>,
    /// The state of the records screen.
    pub records: Records,
    /// The filmed shots.
    pub film: FilmsScreen,
    /// The player whose errors are simulated.
    pub player: Player,
    /// When the user's own skill was saved, or the time of the last attempt before that, Unix time in seconds; `None` if none is saved.
    skill_since: Option<u64>,
    /// The open question.
    pub question: Option<Question>,
    /// The message of the status line.
    pub message: Option<Message>,
    /// Whether the coach may advise jumps and massés.
    pub jumps: bool,
    /// The units for displayed values.
    pub units: Units,
    /// Whether the stroke is shown in numbers (degrees and speed) instead of the form of the advice.
    pub is_in_numbers: bool,
    /// The table of the settings: a bundled one or a file.
    settings_table: String,
    /// The custom table of the coach page, if it has one. Exercises of its size are played on it.
    own_table: Option<Box<Table>>,
    options: RepetitionOptions,
    /// The choices for the next match against the coach.
    pub match_setup: MatchSetup,
    /// The exam whose result is shown.
    pub exam_result: Option<ExamResult>,
    /// A position for the coach page, until the app takes it.
    pub position_for_coach: Option<TransferredPosition>,
    /// The coach page's rule when the library was last opened.
    opened_for: Option<Rule>,
    /// The level of the last chosen exam.
    exam_level: u8,
    /// The stack of screens; the last one is open.
    pages: Vec<DrillContext>,
    /// An unfinished exam that was left, until the app takes it.
    pub unfinished_exam: Option<Session>,
    /// What the disk has refused, as the player was last told; `None` if everything is saved.
    unsaved: Option<String>,
    /// Unfinished runs, games, matches and notes from a real table that were left, one for each exercise. Opening the exercise resumes it.
    unfinished_sessions: Vec<Session>,
    rng: Xoshiro256PlusPlus,
}

impl DrillsPage {
    /// Creates the page, closed; `seed` seeds the random errors, shifts and exams.
    pub fn new(places: DataPaths, seed: u64) -> Self {
        Self {
            places,
            catalogue: Catalogue::new(Library::bundled().clone()),
            book: Book::default(),
            turn: None,
            records: Records::default(),
            film: FilmsScreen::default(),
            player: Player::default(),
            skill_since: None,
            question: None,
            message: None,
            jumps: true,
            units: Units::default(),
            is_in_numbers: false,
            settings_table: String::new(),
            own_table: None,
            options: RepetitionOptions::default(),
            match_setup: MatchSetup::default(),
            exam_result: None,
            position_for_coach: None,
            opened_for: None,
            exam_level: 0,
            pages: Vec::new(),
            unfinished_exam: None,
            unsaved: None,
            unfinished_sessions: Vec::new(),
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
        }
    }

    /// Applies the settings that concern this page.
    pub fn apply_settings(&mut self, settings: &Settings) {
        (self.units, self.jumps, self.player.settings_skill) = (settings.units, settings.jumps, settings.skill);
        self.settings_table.clone_from(&settings.table);
        if let Some(turn) = &mut self.turn {
            turn.jumps = settings.jumps;
        }
    }

    /// Opens the page: at the last open screen, or in the library at the exercises of the coach page's rule. Takes over the coach
    /// page's `skill`, and its table if that is a custom one. The record is read again from the disk.
    pub fn open(&mut self, skill: Skill, rule: Rule, table: &Table) -> Effect {
        self.message = None;
        self.own_table = (!PRESETS.contains(&&*table.name)).then(|| Box::new(table.clone()));
        let mut tasks = vec![self.load()];
        if skill != self.player.coach_page_skill {
            self.player.choose(skill);
            tasks.extend(self.change_player());
        }
        if self.pages.is_empty() {
            if self.opened_for.replace(rule) != Some(rule) {
                self.catalogue.mark_first_of(rule);
            }
            self.pages.push(DrillContext::Library);
        }
        Effect::Drill(tasks)
    }

    /// Returns the task that reads the record from the disk.
    pub fn load(&self) -> DrillTask {
        DrillTask::Load(Box::new(self.places.clone()))
    }

    /// Whether the disk has refused something that is still not saved.
    pub const fn has_unsaved(&self) -> bool {
        self.unsaved.is_some()
    }

    /// Resumes a session that was left in an earlier run of the program.
    pub fn resume(&mut self, session: Session, skill: Skill) -> Effect {
        self.unfinished_exam = self.unfinished().filter(|open| open.is_exam() && open.id != session.id).cloned();
        self.own_table = session.table.clone().or(self.own_table.take());
        self.close_exercise();
        self.player.coach_page_skill = skill;
        // An exam keeps the player with whom it began; the practice after it does not.
        if !session.is_exam() {
            self.player.skill = session.skill;
        }
        let mut tasks = vec![self.load()];
        tasks.extend(self.practise(session));
        // A damaged session opens no screen.
        if self.pages.is_empty() {
            self.pages.push(DrillContext::Library);
        }
        Effect::Drill(tasks)
    }

    /// The open session, or the last one with an end that was left, if it is not over. An exam counts from its first stroke on.
    pub fn unfinished(&self) -> Option<&Session> {
        let Some(turn) = &self.turn else {
            return self.unfinished_sessions.iter().rfind(|left| left.goal != Goal::Free);
        };
        let has_begun = !turn.session.is_exam() || !turn.session.attempts.is_empty() || turn.is_waiting();
        Some(&turn.session).filter(|session| has_begun && !session.is_over())
    }

    /// Shows the open session, and closes any question or screen over it.
    pub fn show_session(&mut self) {
        self.question = None;
        self.pages = vec![DrillContext::Library, DrillContext::Exercise];
    }

    /// Shows the result of an exam that is over, with its first missed exercise marked.
    fn show_result(&mut self, session: Session) {
        let mark = session.attempts.iter().position(|attempt| !attempt.made).unwrap_or(0);
        self.exam_result = Some(ExamResult { session, mark });
        self.pages = vec![DrillContext::Library, DrillContext::Result];
    }

    /// The open game or match, or the last one that was left, if it is not over. Like an exam it can be resumed at the next start of
    /// the program, whatever the user does in between.
    pub fn open_game(&self) -> Option<&Session> {
        let open = self.turn.as_ref().filter(|turn| turn.is_in_progress()).map(|turn| &turn.session);
        open.into_iter().chain(self.unfinished_sessions.iter().rev()).find(|session| session.is_game())
    }

    /// Whether the user has gone back to the coach page.
    pub const fn is_closed(&self) -> bool {
        self.pages.is_empty()
    }

    /// The open screen.
    pub fn page(&self) -> DrillContext {
        self.pages.last().copied().unwrap_or(DrillContext::Library)
    }

    /// The key context: that of the screen, or of the search over it.
    pub fn key_context(&self) -> DrillContext {
        match &self.question {
            Some(Question::Search { .. }) => DrillContext::Search,
            _ => self.page(),
        }
    }

    /// Number of notes from a real table that are newer than the user's own skill; 0 if none is saved.
    pub fn notes_since_skill(&self) -> usize {
        let since = self.skill_since.unwrap_or(u64::MAX);
        let notes = self.book.sessions.iter().filter(|session| session.venue == Venue::Table);
        notes.flat_map(|session| &session.attempts).filter(|note| note.at > since).count()
    }

    /// Draws the random seed of a session.
    fn seed(&mut self) -> u64 {
        self.rng.random()
    }

    /// Closes the exercise. Its attempts are on the disk already. An unfinished run, game or match is kept for resuming, and so are notes from
    /// a real table, which can then still be undone.
    fn close_exercise(&mut self) {
        if let Some(mut turn) = self.turn.take() {
            turn.cancel_request();
            if turn.is_in_progress() || turn.can_undo() && !turn.latest_session().is_over() {
                self.unfinished_sessions.retain(|left| !left.repeats(&turn.exercise));
                self.unfinished_sessions.push(turn.latest_session().clone());
            }
        }
        self.pages.retain(|page| *page == DrillContext::Library);
    }

    /// The skill in the open exercise, or in the next one if none is open. A session keeps the skill with which it was begun.
    pub fn skill(&self) -> Skill {
        let session = match self.page() {
            DrillContext::Match => None,
            DrillContext::Result => self.exam_result.as_ref().map(|result| &result.session),
            _ => self.turn.as_ref().map(|turn| &turn.session),
        };
        session.map_or(self.player.skill, |session| session.skill)
    }

    /// Opens the list of filmed shots.
    pub fn open_films(&mut self) {
        self.film.playback.pause();
        if !matches!(self.page(), DrillContext::Films) {
            self.pages.retain(|page| !matches!(page, DrillContext::Films | DrillContext::Film));
            self.pages.push(DrillContext::Films);
        }
    }
}

/// A note if an exercise made for `table` is played on another table, or if its table is not the one of the settings (`set`, a
/// bundled table or a file). `None` if all are the same.
fn other_table_words(table: &str, played: &str, set: &str) -> Option<String> {
    if played != table {
        return Some(format!("on your {played}; the advice is for {table}"));
    }
    let whose = if PRESETS.contains(&set) { "" } else { "your " };
    let name = Path::new(set).file_stem()?.to_string_lossy();
    (set != table).then(|| format!("on {table}, not on {whose}{name}"))
}

impl Page for DrillsPage {
    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn field_mut(&mut self) -> Option<&mut TextField> {
        match self.question.as_mut()? {
            Question::Search { typed, .. } | Question::Code(typed) | Question::Stroke(typed) => Some(typed),
            _ => None,
        }
    }

    fn on_typed(&mut self) {
        if let Some(Question::Search { typed, .. }) = &self.question {
            self.catalogue.search(typed.text().trim());
        }
    }

    fn tick(&mut self, seconds: f64) {
        // There are ticks for toasts too, so only the visible screen may advance.
        match (self.page(), &mut self.turn) {
            (DrillContext::Film, _) => self.film.tick(seconds),
            (DrillContext::Exercise, Some(turn)) => turn.tick(seconds),
            _ => {}
        }
    }

    fn frame_interval(&self) -> Option<f64> {
        let is_moving = match self.page() {
            DrillContext::Exercise => self.turn.as_ref().is_some_and(Turn::is_moving),
            DrillContext::Film => self.film.playback.playing,
            _ => false,
        };
        is_moving.then_some(1.0 / 30.0)
    }

    fn cue_ball(&self) -> CueBall {
        match (self.page(), &self.turn) {
            // In the film white is the cue ball, whatever exercise is open behind it.
            (DrillContext::Films | DrillContext::Film, _) | (_, None) => CueBall::White,
            (_, Some(turn)) => turn.cue_ball,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exercise_notes_a_table_other_than_the_settings() {
        let said = |set| other_table_words("match", "match", set);
        assert_eq!(said(""), None, "no settings were read");
        assert_eq!(said("match"), None);
        assert_eq!(said("textbook").as_deref(), Some("on match, not on textbook"));
        assert_eq!(said("/tables/Tisch 2.toml").as_deref(), Some("on match, not on your Tisch 2"));
        let own = other_table_words("match", "Tisch 2", "/tables/Tisch 2.toml");
        assert_eq!(own.as_deref(), Some("on your Tisch 2; the advice is for match"));
    }
}
