//! The state of the drill screens: the library, the exercise that is practised, the result of an exam, and the records.
//!
//! Files are read and written, and strokes played and judged, elsewhere ([`DrillTask`]); what comes of it is a
//! [`DrillReport`]. [`actions`] is what each key does.

mod actions;
mod against_coach;
mod aim_line;
mod book;
mod catalogue;
pub mod film;
mod goals;
pub mod keys;
mod question;
mod records;
mod reports;
mod turn;
mod turn_actions;
mod view;
mod watched;
mod what_if;

use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    coach::{Skill, Units},
    drills::{Goal, Library, Session},
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
        ui::{Message, TextField, Typed},
    },
};

pub use aim_line::AimLine;
pub use book::{Book, record_of};
pub use catalogue::Catalogue;
pub use question::Question;
pub use records::{Estimate, Records};
pub use turn::{ModelShotState, Stage, Turn};
pub use watched::Watched;

/// Who plays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Player {
    /// The standard errors that are played.
    pub skill: Skill,
    /// Those that the user has kept as the own ones.
    pub own: Option<Skill>,
    /// Those that the settings say.
    of_settings: Skill,
    /// Those of the coach's player, whom only a choice changes.
    pub at_coach: Skill,
}

impl Player {
    /// The next of those there are.
    fn choose_next(&mut self) {
        self.choose(next_skill(self.skill, self.own, self.of_settings));
    }

    /// Plays with `skill` from now on, at the coach's table too.
    const fn choose(&mut self, skill: Skill) {
        (self.skill, self.at_coach) = (skill, skill);
    }
}

/// How an exercise is repeated; kept from exercise to exercise.
#[derive(Clone, Copy, Debug)]
struct RepetitionOptions {
    goal: Goal,
    shifted: bool,
    lengths: Lengths,
}

/// Balls that come from the coach's table or go there.
#[derive(Clone, Debug)]
pub struct Balls {
    /// The table.
    pub table: Table,
    /// Where the balls lie.
    pub layout: Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// Which of them is the cue ball.
    pub cue_ball: CueBall,
}

/// The state of the drill screens.
#[derive(Debug)]
pub struct DrillsPage {
    /// Where sessions and positions are.
    pub places: DataPaths,
    /// The list of exercises.
    pub catalogue: Catalogue,
    /// What has been played.
    pub book: Book,
    /// The exercise that is practised.
    pub turn: Option<Turn>,
    /// The page of records.
    pub records: Records,
    /// The filmed shots.
    pub film: FilmsScreen,
    /// Who plays.
    pub player: Player,
    /// What is asked.
    pub question: Option<Question>,
    /// What the status line says.
    pub message: Option<Message>,
    /// Whether the coach may advise jumps and massés.
    pub jumps: bool,
    /// The units in which the player is told lengths.
    pub units: Units,
    /// Whether the stroke is told in degrees and by its speed, instead of as advice is.
    pub is_in_numbers: bool,
    /// The table that the settings say: a bundled one or a file.
    of_settings: String,
    /// The player's own table, where the coach's page has one: exercises of its size are played on it.
    own_table: Option<Box<Table>>,
    options: RepetitionOptions,
    /// Balls that are to go to the coach's table, until they are taken.
    pub for_coach: Option<Balls>,
    /// The coach's rule when the library was opened last.
    opened_for: Option<Rule>,
    /// The level of the exam that was chosen last.
    exam_level: u8,
    /// The pages one has come through; the last one is open.
    pages: Vec<DrillContext>,
    /// An exam that was left before its end, until it is taken.
    pub left_exam: Option<Session>,
    /// Runs, games and matches that were left before their end, one an exercise; opening that goes on with it.
    left: Vec<Session>,
    rng: Xoshiro256PlusPlus,
}

impl DrillsPage {
    /// The screens before they are opened; `seed` decides about errors, shifts and exams.
    pub fn new(places: DataPaths, seed: u64) -> Self {
        Self {
            places,
            catalogue: Catalogue::new(Library::bundled().clone()),
            book: Book::default(),
            turn: None,
            records: Records::default(),
            film: FilmsScreen::default(),
            player: Player::default(),
            question: None,
            message: None,
            jumps: true,
            units: Units::default(),
            is_in_numbers: false,
            of_settings: String::new(),
            own_table: None,
            options: RepetitionOptions { goal: Goal::Free, shifted: false, lengths: Lengths::default() },
            for_coach: None,
            opened_for: None,
            exam_level: 0,
            pages: Vec::new(),
            left_exam: None,
            left: Vec::new(),
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
        }
    }

    /// Takes what is set for all pages.
    pub fn take_settings(&mut self, settings: &Settings) {
        (self.units, self.jumps, self.player.of_settings) = (settings.units, settings.jumps, settings.skill);
        self.of_settings.clone_from(&settings.table);
        if let Some(turn) = &mut self.turn {
            turn.jumps = settings.jumps;
        }
    }

    /// Opens the page that was open last, or the library at the exercises of the coach's rule, for the coach's player of `skill` and the
    /// coach's table, if that is the player's own; what is on the disk is read again.
    pub fn open(&mut self, skill: Skill, rule: Rule, table: &Table) -> Effect {
        self.message = None;
        self.own_table = (!PRESETS.contains(&&*table.name)).then(|| Box::new(table.clone()));
        let mut tasks = vec![self.load()];
        if skill != self.player.at_coach {
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

    /// Reads what is on the disk.
    pub fn load(&self) -> DrillTask {
        DrillTask::Load(Box::new(self.places.clone()))
    }

    /// Goes on with a session that an earlier one of the program has left.
    pub fn resume(&mut self, session: Session, skill: Skill) -> Effect {
        self.left_exam = self.unfinished().filter(|open| open.is_exam() && open.id != session.id).cloned();
        self.own_table = session.table.clone().or(self.own_table.take());
        self.leave_turn();
        self.player.at_coach = skill;
        self.player.skill = session.skill;
        let mut tasks = vec![self.load()];
        tasks.extend(self.practise(session));
        // A damaged one has no page.
        if self.pages.is_empty() {
            self.pages.push(DrillContext::Library);
        }
        Effect::Drill(tasks)
    }

    /// The session that is practised, or was left last, as long as it is not over. An exam has not begun before its first
    /// stroke.
    pub fn unfinished(&self) -> Option<&Session> {
        let Some(turn) = &self.turn else { return self.left.last() };
        let has_begun = !turn.session.is_exam() || !turn.session.attempts.is_empty();
        Some(&turn.session).filter(|session| has_begun && !session.is_over())
    }

    /// Whether an exam has begun and is not over.
    pub fn has_open_exam(&self) -> bool {
        self.unfinished().is_some_and(Session::is_exam)
    }

    /// Shows the session that is open, whatever was asked or shown over it.
    pub fn show_session(&mut self) {
        self.question = None;
        self.pages = vec![DrillContext::Library, DrillContext::Exercise];
    }

    /// The game or match that is open or was left last, as long as it is not over: like an exam it is gone on with at the next start,
    /// whatever was done after it.
    pub fn open_game(&self) -> Option<&Session> {
        let open = self.turn.as_ref().filter(|turn| turn.is_under_way()).map(|turn| &turn.session);
        open.into_iter().chain(self.left.iter().rev()).find(|session| session.is_game())
    }

    /// Whether one has gone back to the coach from the first page.
    pub const fn is_left(&self) -> bool {
        self.pages.is_empty()
    }

    /// The page that is open.
    pub fn page(&self) -> DrillContext {
        self.pages.last().copied().unwrap_or(DrillContext::Library)
    }

    /// The key context: the page's, or that of the search over it.
    pub fn place(&self) -> DrillContext {
        match &self.question {
            Some(Question::Search { .. }) => DrillContext::Search,
            _ => self.page(),
        }
    }

    /// Lists what has the words that are being typed.
    fn search(&mut self) {
        if let Some(Question::Search { typed, .. }) = &self.question {
            self.catalogue.find_text(typed.text().trim());
        }
    }

    /// A session's seed.
    fn seed(&mut self) -> u64 {
        self.rng.random()
    }

    /// Closes the exercise; what was played is on the disk.
    fn leave_turn(&mut self) {
        if let Some(mut turn) = self.turn.take() {
            turn.stop_asking();
            if turn.is_under_way() {
                self.left.retain(|left| left.exercises != turn.session.exercises);
                self.left.push(turn.newest().clone());
            }
        }
        self.pages.retain(|page| *page == DrillContext::Library);
    }

    /// Who plays in the exercise that is open, or would in another: an exam stays with whom it was begun.
    pub fn skill(&self) -> Skill {
        self.turn.as_ref().map_or(self.player.skill, |turn| turn.session.skill)
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

/// Says that an exercise made for `table` is played on another one, or not on the one that the settings say: a bundled one or a file.
fn other_table_words(table: &str, played: &str, set: &str) -> Option<String> {
    if played != table {
        return Some(format!("on your {played}; what is said of the shot is for {table}"));
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

    fn input(&mut self, typed: Typed) -> bool {
        let taken = self.field_mut().is_some_and(|field| field.take(typed));
        if taken {
            self.message = None;
            self.search();
        }
        taken
    }

    fn tick(&mut self, seconds: f64) {
        // Ticks come for toasts too; only what is on the screen may move.
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
            // In the film white is the cue ball, whatever waits behind it.
            (DrillContext::Films | DrillContext::Film, _) | (_, None) => CueBall::White,
            (_, Some(turn)) => turn.cue_ball,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exercise_says_so_where_the_settings_have_another_table() {
        let said = |set| other_table_words("match", "match", set);
        assert_eq!(said(""), None, "no settings were read");
        assert_eq!(said("match"), None);
        assert_eq!(said("textbook").as_deref(), Some("on match, not on textbook"));
        assert_eq!(said("/tables/Tisch 2.toml").as_deref(), Some("on match, not on your Tisch 2"));
        let own = other_table_words("match", "Tisch 2", "/tables/Tisch 2.toml");
        assert_eq!(own.as_deref(), Some("on your Tisch 2; what is said of the shot is for match"));
    }
}
