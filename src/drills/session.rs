//! A practice session: its goal, its attempts, and the next exercise.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use super::{Exercise, ExerciseError, Record};
use crate::{
    coach::{Doubt, Shooter, Skill},
    game::scores,
    physics::{CueInputs, has_room},
    printing::format_timestamp,
    table::{CueBall, Layout, Table, is_default},
};

/// When a session is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// When the player stops.
    Free,
    /// When the exercise was made this many times in a row.
    Run(u32),
    /// After one attempt at each exercise.
    Exam,
    /// After this number of innings, 0 for no limit. Each stroke starts from where the last one left the balls.
    Game {
        /// Innings, each of which ends with a miss.
        innings: u32,
    },
    /// A game between two sides, white and yellow. A miss ends an inning, and the other side continues from the
    /// resulting layout with its own cue ball. It ends, always after equally many innings of both sides, when the limit
    /// of innings is reached or a side has made the points.
    Match {
        /// Innings of each side, 0 for no limit.
        innings: u32,
        /// The points that win, called the distance; 0 if only the innings count.
        #[serde(default, skip_serializing_if = "is_default")]
        points: u32,
        /// Whether the coach plays the second side.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        against_coach: bool,
    },
}

impl Goal {
    /// Whether it is a game: its attempts then do not count as repetitions of an exercise.
    pub const fn is_game(self) -> bool {
        matches!(self, Self::Game { .. } | Self::Match { .. })
    }

    /// Returns the name of such a session.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "practice",
            Self::Run(_) => "run",
            Self::Exam => "exam",
            Self::Game { .. } => "game",
            Self::Match { .. } => "match",
        }
    }

    /// Describes it in a few words.
    pub fn words(self) -> String {
        match self {
            Self::Free => "free repetition".to_owned(),
            Self::Run(points) => format!("run of {points}"),
            Self::Exam => "exam".to_owned(),
            Self::Game { innings } => with_lengths("game", 0, innings),
            Self::Match { innings, points, against_coach } => {
                with_lengths(if against_coach { "against the coach" } else { "match" }, points, innings)
            }
        }
    }
}

/// Appends the points and the innings, unless they are 0.
fn with_lengths(name: &str, points: u32, innings: u32) -> String {
    let of = |count: u32, what: &str| match count {
        0 => String::new(),
        1 => format!(", 1 {what}"),
        _ => format!(", {count} {what}s"),
    };
    format!("{name}{}{}", of(points, "point"), of(innings, "inning"))
}

/// Where the strokes are played.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Venue {
    /// In the program, by simulation with the player's errors.
    Program,
    /// At a real table: the player enters the results.
    Table,
}

impl Venue {
    /// Both venues, the real table first.
    pub const ALL: [Self; 2] = [Self::Table, Self::Program];

    /// Returns the name in records.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Program => "here",
            Self::Table => "table",
        }
    }
}

/// One attempt. Unknown properties, such as most of those at a real table, are omitted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Attempt {
    /// Name of the exercise.
    pub exercise: String,
    /// Unix time in seconds.
    pub at: u64,
    /// Whether it made the point.
    pub made: bool,
    /// Whether the player had looked at a shot that makes the point, or had let the coach play. Such an attempt counts
    /// too, and is marked.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub helped: bool,
    /// Whether the coach played it; then it does not count for the player's record.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub by_coach: bool,
    /// The ball positions, m, if they differ from the exercise's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Layout>,
    /// The stroke that the player intended.
    #[serde(default, rename = "meant", skip_serializing_if = "Option::is_none")]
    pub intended: Option<CueInputs>,
    /// The stroke that resulted, with the player's errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub played: Option<CueInputs>,
    /// How often the player makes the intended stroke, a share from 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chance: Option<f64>,
    /// The recommended shot: the model shot if the layout is the exercise's, else the coach's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub advised: Option<CueInputs>,
    /// How often the player makes the recommended shot, a share from 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub advised_chance: Option<f64>,
}

impl Attempt {
    /// Whether `all` begins with `prefix`, ignoring later evaluations of the strokes.
    pub fn is_prefix(prefix: &[Self], all: &[Self]) -> bool {
        let is_same =
            |(one, other): (&Self, &Self)| (&one.exercise, one.at, one.made) == (&other.exercise, other.at, other.made);
        prefix.len() <= all.len() && prefix.iter().zip(all).all(is_same)
    }
}

/// A practice session. It stores copies of its exercises, so that it can be read whatever happens to the originals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Session {
    /// Unique identifier, also the name of its file.
    pub id: String,
    /// Start, Unix time in seconds.
    pub started: u64,
    /// The condition for its end.
    pub goal: Goal,
    /// Where the strokes are played.
    pub venue: Venue,
    /// The player's skill.
    pub skill: Skill,
    /// The coach's skill as the other side of a match; `None` if it is the player's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coach_skill: Option<Skill>,
    /// Whether the balls are shifted slightly at every repetition except the first.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shifted: bool,
    /// Whether the order of the results is unknown; then they do not count for runs and innings.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unordered: bool,
    /// The first cue ball.
    #[serde(default, skip_serializing_if = "is_default")]
    pub cue_ball: CueBall,
    /// Seed of the errors and of the shifts.
    pub seed: u64,
    /// The player's own table, on which exercises for tables of its size are played; `None` if each is played on the
    /// table that it was designed for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<Box<Table>>,
    /// One exercise, or those of an exam. For a game it defines the rule, the table and the first layout.
    pub exercises: Vec<Exercise>,
    /// In chronological order.
    pub attempts: Vec<Attempt>,
}

impl Session {
    /// Returns whoever plays the next attempt, for make probabilities, with uncertain tables and ball positions, as for
    /// pars.
    pub fn shooter(&self) -> Shooter {
        self.shooter_of(self.attempts.len())
    }

    /// Like [`shooter`](Self::shooter), for attempt `number`.
    pub fn shooter_of(&self, number: usize) -> Shooter {
        Shooter { skill: self.skill_of(number), doubt: Doubt::FULL }
    }

    /// Creates a session that begins now. There must be at least one exercise.
    pub fn new(goal: Goal, venue: Venue, exercises: Vec<Exercise>, skill: Skill, seed: u64) -> Self {
        let since = since_epoch();
        let started = since.as_secs();
        let day = format_timestamp(started);
        // Keeps sessions of the same second in order, and avoids collisions between programs that start in the same
        // millisecond.
        let id = format!("{day}-{:03}{:08x}", since.subsec_millis(), rand::random::<u32>());
        Self {
            id,
            started,
            goal,
            venue,
            skill,
            coach_skill: None,
            shifted: false,
            unordered: false,
            cue_ball: CueBall::White,
            seed,
            table: None,
            exercises,
            attempts: Vec::new(),
        }
    }

    /// Returns the table on which an exercise is played.
    ///
    /// # Errors
    /// Fails if the exercise is impossible.
    pub fn table_of(&self, exercise: &Exercise) -> Result<Table, ExerciseError> {
        exercise.table_with(self.table.as_deref())
    }

    /// Returns the exercise's model shot. `None` if it has none, the cue has no room for it, or it makes no point on the
    /// player's own table.
    pub fn model_shot_of(&self, exercise: &Exercise) -> Option<CueInputs> {
        let table = self.table_of(exercise).ok()?;
        let shot = exercise.shot.filter(|shot| has_room(&table, &exercise.layout, shot))?;
        let is_made_for_it = self.table.is_none();
        (is_made_for_it || scores(exercise.rule, &table, &exercise.layout, &shot)).then_some(shot)
    }

    /// Whether the goal is reached.
    pub fn is_over(&self) -> bool {
        match self.goal {
            Goal::Free => false,
            Goal::Run(points) => self.record().high_run >= points,
            Goal::Exam => self.attempts.len() >= self.exercises.len(),
            Goal::Game { innings } => innings > 0 && self.misses() >= innings as usize,
            Goal::Match { .. } => self.is_match_over(),
        }
    }

    /// Returns the exercise of the next attempt; `None` if the session is over.
    pub fn exercise(&self) -> Option<&Exercise> {
        let number = if self.is_exam() { self.attempts.len() } else { 0 };
        self.exercises.get(number).filter(|_| !self.is_over())
    }

    /// Whether the session repeats this exercise alone.
    pub fn repeats(&self, exercise: &Exercise) -> bool {
        matches!(&self.exercises[..], [only] if only.has_same_task(exercise))
    }

    /// Whether the session is an exam.
    pub fn is_exam(&self) -> bool {
        self.goal == Goal::Exam
    }

    /// Whether it is a game: its attempts then do not count as repetitions of an exercise.
    pub const fn is_game(&self) -> bool {
        self.goal.is_game()
    }

    /// Returns the exercise of an attempt, as stored in this session.
    pub fn exercise_of(&self, attempt: &Attempt) -> Option<&Exercise> {
        self.exercises.iter().find(|exercise| exercise.name == attempt.exercise)
    }

    /// Returns the score, including the coach's strokes.
    pub fn record(&self) -> Record {
        Record::of_attempts(self, |_| true)
    }

    /// Returns the number of points in a row at the end, of the side that played last.
    pub fn current_run(&self) -> u32 {
        let sides: Vec<usize> = self.sides().take(self.attempts.len()).collect();
        let played = self.attempts.iter().zip(&sides).rev();
        played.take_while(|(attempt, side)| attempt.made && Some(*side) == sides.last()).count() as u32
    }

    pub(super) fn misses(&self) -> usize {
        self.attempts.iter().filter(|attempt| !attempt.made).count()
    }
}

/// Returns the current Unix time in seconds; 0 if the clock is before 1970.
pub(super) fn now() -> u64 {
    since_epoch().as_secs()
}

fn since_epoch() -> Duration {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::{drills::Category, game::Rule};

    /// An exercise from the opening position.
    pub fn exercise(name: &str) -> Exercise {
        Exercise {
            category: Category::FirstCaroms,
            grade: 1,
            ..Exercise::new_own(name, Rule::StraightRail, "match", Layout::opening(&Table::default()))
        }
    }

    /// A session at a real table with one attempt per letter: `x` is made, any other letter missed.
    pub fn session(goal: Goal, results: &str) -> Session {
        let mut session = Session::new(goal, Venue::Table, vec![exercise("first")], Skill::CLUB, 1);
        for result in results.chars() {
            session.log(result == 'x').unwrap();
        }
        session
    }

    #[test]
    fn run_and_game_goals_end_the_session() {
        assert!(!session(Goal::Run(3), "xx-xx").is_over());
        let done = session(Goal::Run(3), "xx-xxx");
        assert!(done.is_over() && done.exercise().is_none() && done.current_run() == 3);
        let game = Goal::Game { innings: 2 };
        assert!(!session(game, "xxx-x").is_over() && session(game, "xxx-x-").is_over());
        assert!(!session(Goal::Game { innings: 0 }, "-----").is_over());
    }

    #[test]
    fn exam_uses_each_exercise_once() {
        let exercises = ["one", "two"].map(exercise).to_vec();
        let mut session = Session::new(Goal::Exam, Venue::Table, exercises, Skill::CLUB, 1);
        for name in ["one", "two"] {
            assert_eq!(session.exercise().unwrap().name, name);
            session.log(false).unwrap();
        }
        assert!(session.is_over() && session.log(true).is_err());
        assert_eq!(session.exercise_of(&session.attempts[1]).unwrap().name, "two");
        session.undo();
        assert_eq!(session.exercise().unwrap().name, "two");
    }

    #[test]
    fn session_round_trips_through_json() {
        let mut session = session(Goal::Game { innings: 3 }, "x-");
        session.attempts[0].intended = Some(CueInputs { a: 0.1, b: 0.25, theta: 0.0, phi: 0.0, speed: 2.5 });
        let text = serde_json::to_string(&session).unwrap();
        assert_eq!(serde_json::from_str::<Session>(&text).unwrap(), session);
    }
}
