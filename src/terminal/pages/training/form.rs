//! The form for a new run.

use std::{
    ffi::OsString,
    path::{Path, PathBuf},
};

use crate::{
    game::Reward,
    learning::{
        agents::AGENTS,
        run::{list::Summary, run_name},
    },
    printing::{shell_word, timestamp},
    terminal::{
        Launch,
        pages::{around, neighbour},
    },
};

/// Tables that a run can be started on.
pub const TABLES: [&str; 3] = ["match", "textbook", "thesis"];
/// Numbers of shots to choose from; others can be typed.
const BUDGETS: [u64; 9] =
    [100_000, 300_000, 1_000_000, 3_000_000, 5_000_000, 10_000_000, 30_000_000, 100_000_000, 300_000_000];

/// Seconds beyond which a run is a long one.
const DAY: f64 = 86_400.0;
/// Shots a second that the agents usually play and learn from, measurements included, on one core of which others work as
/// well: those of the first 20 s of `carom train`, `ddpg` on `match`, the others on `thesis`. An idle core is two to three
/// times as fast. They only decide whether a run of more than a day has to be confirmed.
const USUAL_SPEEDS: [(&str, f64); 4] =
    [("ddpg", 3000.0), ("q-learning", 15_000.0), ("dqn", 2500.0), ("thesis-ddpg", 12_000.0)];
/// The same of an agent that has not been measured.
const SLOWEST: f64 = 2500.0;

/// A field of the form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// The agent.
    Agent,
    /// What it is rewarded for.
    Reward,
    /// The table.
    Table,
    /// Shots to play.
    Shots,
    /// The seed.
    Seed,
    /// The run whose weights it starts with.
    From,
}

impl Field {
    /// All of them, in their order on the screen.
    pub const ALL: [Self; 6] = [Self::Agent, Self::Reward, Self::Table, Self::Shots, Self::Seed, Self::From];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Agent => "agent",
            Self::Reward => "reward",
            Self::Table => "table",
            Self::Shots => "shots",
            Self::Seed => "seed",
            Self::From => "start with",
        }
    }
}

/// What is filled in.
#[derive(Debug)]
pub struct Form {
    /// The marked field.
    pub field: Field,
    /// Whether nothing was typed since the field was entered or its value chosen: the next digit begins another number.
    is_fresh: bool,
    /// Place of the agent in [`AGENTS`].
    pub agent: usize,
    /// What it is rewarded for.
    pub reward: Reward,
    /// The table's name.
    pub table: &'static str,
    /// Shots to play, as they were typed.
    pub shots: String,
    /// The seed, as it was typed.
    pub seed: String,
    /// Name and folder of the run whose weights it starts with.
    pub from: Option<(String, PathBuf)>,
    /// When the form was opened: the run's name begins with it.
    opened: String,
}

impl Form {
    /// The form with what is usual.
    pub fn new() -> Self {
        Self {
            field: Field::Agent,
            is_fresh: true,
            agent: 0,
            reward: Reward::default(),
            table: TABLES[0],
            shots: "5000000".into(),
            seed: "1".into(),
            from: None,
            opened: timestamp(),
        }
    }

    /// Marks another field, the next where positive.
    pub fn move_mark(&mut self, fields: isize) {
        self.field = neighbour(&Field::ALL, self.field, fields);
        self.is_fresh = true;
    }

    /// Takes the next value of the marked field, or the one before. `runs` are those whose weights can be taken.
    pub fn choose(&mut self, step: isize, runs: &[Summary]) {
        self.is_fresh = true;
        match self.field {
            Field::Agent => {
                self.agent = around(self.agent, step, AGENTS.len());
                // Another agent's weights are of no use.
                self.from = None;
            }
            Field::Reward => self.reward = neighbour(&Reward::ALL, self.reward, step),
            Field::Table => self.table = neighbour(&TABLES, self.table, step),
            Field::Shots => {
                let shots = self.shots.parse::<u64>().unwrap_or(0);
                let next = if step > 0 {
                    BUDGETS.into_iter().find(|&budget| budget > shots)
                } else {
                    BUDGETS.into_iter().rfind(|&budget| budget < shots)
                };
                if let Some(next) = next {
                    self.shots = next.to_string();
                }
            }
            Field::Seed => {
                let seed = self.seed.parse::<u64>().unwrap_or(0).saturating_add_signed(step as i64);
                self.seed = seed.to_string();
            }
            Field::From => {
                let agent = AGENTS[self.agent].name;
                let own = runs
                    .iter()
                    .filter(|run| run.agent == agent)
                    .map(|run| Some((run.name.clone(), run.folder.clone())));
                let choices: Vec<Option<(String, PathBuf)>> = std::iter::once(None).chain(own).collect();
                self.from = neighbour(&choices, self.from.clone(), step);
            }
        }
    }

    /// The number in the marked field, if it is one that can be typed.
    fn number(&mut self) -> Option<&mut String> {
        match self.field {
            Field::Shots => Some(&mut self.shots),
            Field::Seed => Some(&mut self.seed),
            _ => None,
        }
    }

    /// Adds the digits among what is typed to the number in the marked field, or begins another one with them; `false` where
    /// there are none or it takes none.
    ///
    /// # Errors
    /// A sentence that says what is accepted, where the number would be too large; it stays as it was.
    pub fn typed(&mut self, letters: &str) -> Result<bool, String> {
        let digits: String = letters.chars().filter(char::is_ascii_digit).collect();
        let (name, is_fresh) = (self.field.name(), self.is_fresh);
        let Some(number) = self.number().filter(|_| !digits.is_empty()) else { return Ok(false) };
        let before = if is_fresh { "" } else { number.as_str() };
        let typed: u64 = format!("{before}{digits}")
            .parse()
            .map_err(|_| format!("{name}: accepted is a whole number up to {}", u64::MAX))?;
        *number = typed.to_string();
        self.is_fresh = false;
        Ok(true)
    }

    /// Takes the last digit of the number in the marked field back; what is typed then follows what is left.
    pub fn erase(&mut self) {
        self.is_fresh = false;
        if let Some(number) = self.number() {
            number.pop();
        }
    }

    /// The number of shots and how long they usually take, s, where that is beyond a day.
    pub fn long_run(&self) -> Option<(u64, f64)> {
        let shots = self.shots.parse::<u64>().ok()?;
        let seconds = shots as f64 / self.usual_speed();
        (seconds > DAY).then_some((shots, seconds))
    }

    /// Shots a second that the agent usually plays and learns from.
    fn usual_speed(&self) -> f64 {
        let name = AGENTS[self.agent].name;
        USUAL_SPEEDS.iter().find(|(agent, _)| *agent == name).map_or(SLOWEST, |(_, speed)| *speed)
    }

    /// The name of the run's folder.
    pub fn name(&self) -> String {
        run_name(&self.opened, AGENTS[self.agent].name, self.table, self.reward, &self.seed)
    }

    /// The command line that starts the same run, an option after the other; in `elsewhere` where that is not the folder of the
    /// user's runs.
    pub fn command(&self, elsewhere: Option<&Path>) -> Vec<String> {
        let mut options = self.options(elsewhere.is_some());
        options.extend(elsewhere.map(|folder| ("--run", folder.join(self.name()).into())));
        let told = |(name, value): (&str, OsString)| format!("{name} {}", shell_word(&value.to_string_lossy()));
        std::iter::once("carom train".to_owned()).chain(options.into_iter().map(told)).collect()
    }

    /// The options of `carom train` but the run's folder; the run that it begins with by its folder or else by its name.
    fn options(&self, by_folder: bool) -> Vec<(&'static str, OsString)> {
        let from = self.from.as_ref().map(|(name, path)| if by_folder { path.into() } else { name.into() });
        [
            ("--agent", AGENTS[self.agent].name.into()),
            ("--reward", self.reward.to_string().into()),
            ("--table", self.table.into()),
            ("--steps", (&self.shots).into()),
            ("--seed", (&self.seed).into()),
        ]
        .into_iter()
        .chain(from.map(|from| ("--from", from)))
        .collect()
    }

    /// What starts the run in a folder of `runs`.
    ///
    /// # Errors
    /// A sentence that says which number is wrong.
    pub fn launch(&self, runs: &Path) -> Result<Launch, String> {
        if !self.shots.parse::<u64>().is_ok_and(|shots| shots > 0) {
            return Err(format!("{:?} is not a number of shots; use 1 or more", self.shots));
        }
        if self.seed.parse::<u64>().is_err() {
            return Err(format!("{:?} is not a seed; use 0 or more", self.seed));
        }
        let folder = runs.join(self.name());
        let options = self.options(true).into_iter().chain([("--run", folder.clone().into())]);
        let options = options.flat_map(|(name, value)| [name.into(), value]);
        let arguments = std::iter::once("train".into()).chain(options).collect();
        Ok(Launch { arguments, folder })
    }
}
