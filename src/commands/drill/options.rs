//! Options that the playing subcommands share, and the typed stroke.

use std::time::Duration;

use super::workspace::skill_or_default;
use crate::{
    coach::Skill,
    commands::{
        Failure,
        input::{parse_seed, search_limits, table_by_name, whole_number, whole_number_from},
        lookup::skill_by_name,
        output::{player_and_rule_words, player_words, print_note},
        typed_stroke::TypedStroke,
    },
    drills::{Exercise, Goal, Session, Venue},
    printing::number,
    table::Table,
};

/// The word that requests the coach's shot.
const COACH: &str = "coach";

/// Default time that the coach has for a shot, ms, if neither a time nor a number of simulations is given.
const BUDGET_MS: u64 = 300;

/// The player, and the form of the output.
#[derive(Debug, clap::Args)]
pub struct PlayOptions {
    /// Who plays: perfect, expert, world-class, national, club, beginner, own, an average at three-cushion like 0.6, or standard errors in
    /// mm, degrees and m/s like "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1". Default: own if `carom drill skill --keep` has saved one, otherwise
    /// expert.
    #[arg(long, value_parser = skill_by_name)]
    skill: Option<Skill>,
    /// Seed of the errors; without it they differ every time.
    #[arg(long, value_parser = parse_seed)]
    seed: Option<u64>,
    /// Time that the coach has for a shot, ms. Default: 300, or unlimited if --simulations is given.
    #[arg(long, value_parser = whole_number(0..=3_600_000_u64))]
    pub(super) budget_ms: Option<u64>,
    /// Number of simulations after which the coach starts nothing new.
    ///
    /// With --seed and without --budget-ms, the same strokes then give the same session, however fast the machine is. As for `carom
    /// recommend`, a minimum of work is always done in addition.
    #[arg(long, value_name = "COUNT", value_parser = whole_number_from(1_u64))]
    pub(super) simulations: Option<u64>,
    /// Let the coach recommend neither jumps over a ball nor massés, which most clubs forbid.
    #[arg(long)]
    pub(super) no_jumps: bool,
    /// Print JSON: one object a line, of the kinds "position", "attempt", "refused" and "result".
    #[arg(long)]
    pub(super) json: bool,
}

impl PlayOptions {
    /// Creates a session that is played in the simulator, on the exercises' tables or on `table`.
    ///
    /// # Errors
    /// Fails if the table does not exist, or if its size differs from that of an exercise.
    pub fn session(&self, goal: Goal, exercises: Vec<Exercise>, table: Option<&str>) -> Result<Session, Failure> {
        let own = table.map(table_by_name).transpose()?;
        if let Some(own) = &own {
            exercises.iter().try_for_each(|exercise| check_size(exercise, own))?;
        }
        let seed = self.seed.unwrap_or_else(rand::random);
        let mut session = Session::new(goal, Venue::Program, exercises, skill_or_default(self.skill), seed);
        let is_another = |own: &Table| session.exercises.iter().any(|exercise| exercise.table != own.name);
        session.table = own.filter(is_another).map(Box::new);
        Ok(session)
    }

    /// Returns the time and the number of simulations that the coach has for a shot.
    pub(super) fn limits(&self) -> (Duration, u64) {
        search_limits(self.budget_ms, self.simulations, BUDGET_MS)
    }

    /// Prints whose errors are played, and a game's rule, for a user who may expect those of the full-screen program.
    pub fn print_player(&self, session: &Session) {
        if self.json {
            return;
        }
        let skill = session.skill;
        match session.exercises.first().filter(|_| session.is_game()) {
            Some(game) => print_note(player_and_rule_words(skill, game.rule)),
            None => print_note(format_args!(
                "For {}; --skill chooses another. The screen's skill is not used.",
                player_words(skill)
            )),
        }
        if let Some(level) = session.coach_skill {
            print_note(format_args!("The coach plays with the skill \"{level}\"."));
        }
    }
}

/// Refuses a table on which the balls of the exercise cannot be placed.
fn check_size(exercise: &Exercise, own: &Table) -> Result<(), Failure> {
    let table = exercise.table().map_err(Failure::failed)?;
    if own.has_size_of(&table) {
        return Ok(());
    }
    let [size, other] = [&table, own].map(size_words);
    Err(Failure::wrong_input(format_args!(
        "{} is on \"{}\", {size}; \"{}\" is another, {other}",
        exercise.name, table.name, own.name
    )))
}

/// Describes the size of a table and its balls.
pub fn size_words(table: &Table) -> String {
    format!("{} by {} m with balls of {} mm", number(table.length), number(table.width), number(2e3 * table.radius))
}

/// A typed stroke, or a request for the coach's.
#[derive(Clone, Copy, Debug)]
pub enum StrokeInput {
    /// The player's stroke.
    Own(TypedStroke),
    /// The coach's stroke.
    Coach,
}

impl std::str::FromStr for StrokeInput {
    type Err = Failure;

    fn from_str(text: &str) -> Result<Self, Failure> {
        if text == COACH {
            return Ok(Self::Coach);
        }
        let stroke = TypedStroke::parse(text)
            .map_err(|error| Failure::wrong_input(format_args!("{error}, or \"{COACH}\" for the coach's shot")))?;
        Ok(Self::Own(stroke))
    }
}
