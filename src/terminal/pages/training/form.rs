//! State of the form for a new training run.

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
    table::PRESETS,
    terminal::{
        Launch,
        pages::{neighbour, wrapping_index},
    },
};

/// Numbers of shots to choose from; others can be typed.
const BUDGETS: [u64; 9] =
    [100_000, 300_000, 1_000_000, 3_000_000, 5_000_000, 10_000_000, 30_000_000, 100_000_000, 300_000_000];

/// Estimated duration above which starting a run needs a confirmation, s.
const MIN_CONFIRMED_DURATION: f64 = 86_400.0;
/// Usual training speed of each agent, shots a second, including evaluations, on one core that is shared with other work.
///
/// Measured in the first 20 s of `carom train`: `ddpg` on `match`, the others on `thesis`. An idle core is two to three times as fast.
/// The speeds only decide whether a run takes more than a day and so needs a confirmation.
const USUAL_SPEEDS: [(&str, f64); 4] =
    [("ddpg", 3000.0), ("q-learning", 15_000.0), ("dqn", 2500.0), ("thesis-ddpg", 12_000.0)];
/// Assumed speed of an agent that has not been measured, shots a second.
const MIN_SPEED: f64 = 2500.0;

/// A field of the form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// The agent.
    Agent,
    /// The reward function.
    Reward,
    /// The table.
    Table,
    /// Shots to play.
    Shots,
    /// The seed.
    Seed,
    /// The run that provides the initial weights.
    From,
}

impl Field {
    /// All fields, in screen order.
    pub const ALL: [Self; 6] = [Self::Agent, Self::Reward, Self::Table, Self::Shots, Self::Seed, Self::From];

    /// The name of the field.
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

/// The values of the form.
#[derive(Debug)]
pub struct Form {
    /// The marked field.
    pub field: Field,
    /// Whether the next digit replaces the number: nothing was typed since the field was entered or its value was chosen.
    is_fresh: bool,
    /// Index of the agent in [`AGENTS`].
    pub agent: usize,
    /// The reward function.
    pub reward: Reward,
    /// The table's name.
    pub table: &'static str,
    /// Shots to play, as typed.
    pub shots: String,
    /// The seed, as typed.
    pub seed: String,
    /// Name and folder of the run that provides the initial weights; `None` for new networks.
    pub from: Option<(String, PathBuf)>,
    /// Time when the form was opened. The run's name begins with it.
    opened: String,
}

impl Form {
    /// Creates the form with default values.
    pub fn new() -> Self {
        Self {
            field: Field::Agent,
            is_fresh: true,
            agent: 0,
            reward: Reward::default(),
            table: PRESETS[0],
            shots: "5000000".into(),
            seed: "1".into(),
            from: None,
            opened: timestamp(),
        }
    }

    /// Moves the mark by `fields`, downwards if positive.
    pub fn move_mark(&mut self, fields: isize) {
        self.field = neighbour(&Field::ALL, self.field, fields);
        self.is_fresh = true;
    }

    /// Chooses the next value of the marked field, or the one before if negative. `runs` are the runs that can provide weights.
    pub fn choose(&mut self, step: isize, runs: &[Summary]) {
        self.is_fresh = true;
        match self.field {
            Field::Agent => {
                self.agent = wrapping_index(self.agent, step, AGENTS.len());
                // Weights of another agent do not fit.
                self.from = None;
            }
            Field::Reward => self.reward = neighbour(&Reward::ALL, self.reward, step),
            Field::Table => self.table = neighbour(&PRESETS, self.table, step),
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

    /// The text of the marked field, if it is a number that can be typed.
    fn number(&mut self) -> Option<&mut String> {
        match self.field {
            Field::Shots => Some(&mut self.shots),
            Field::Seed => Some(&mut self.seed),
            _ => None,
        }
    }

    /// Appends the digits in `letters` to the number in the marked field, or starts a new number with them. Returns `false` if there are
    /// no digits or the field is not a number.
    ///
    /// # Errors
    /// Returns a message with the accepted range if the number would be too large. The field stays unchanged.
    pub fn type_digits(&mut self, letters: &str) -> Result<bool, String> {
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

    /// Deletes the last digit of the number in the marked field. Digits typed afterwards are appended to the rest.
    pub fn erase(&mut self) {
        self.is_fresh = false;
        if let Some(number) = self.number() {
            number.pop();
        }
    }

    /// The number of shots and their estimated duration, s, if that is more than a day.
    pub fn long_run(&self) -> Option<(u64, f64)> {
        let shots = self.shots.parse::<u64>().ok()?;
        let seconds = shots as f64 / self.usual_speed();
        (seconds > MIN_CONFIRMED_DURATION).then_some((shots, seconds))
    }

    /// Usual training speed of the chosen agent, shots a second.
    fn usual_speed(&self) -> f64 {
        let name = AGENTS[self.agent].name;
        USUAL_SPEEDS.iter().find(|(agent, _)| *agent == name).map_or(MIN_SPEED, |(_, speed)| *speed)
    }

    /// The name of the run's folder.
    pub fn name(&self) -> String {
        run_name(&self.opened, AGENTS[self.agent].name, self.table, self.reward, &self.seed)
    }

    /// The parts of the command line that starts the same run. `elsewhere` is the folder for the run if it is not the folder of the
    /// user's runs.
    pub fn command(&self, elsewhere: Option<&Path>) -> Vec<String> {
        let mut options = self.options(elsewhere.is_some());
        options.extend(elsewhere.map(|folder| ("--run", folder.join(self.name()).into())));
        let told = |(name, value): (&str, OsString)| format!("{name} {}", shell_word(&value.to_string_lossy()));
        std::iter::once("carom train".to_owned()).chain(options.into_iter().map(told)).collect()
    }

    /// The options of `carom train`, except the run's folder. The run that provides the weights is given by its folder if `by_folder`, else
    /// by its name.
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

    /// Returns the command that starts the run in a new folder in `runs`.
    ///
    /// # Errors
    /// Returns a message on the number that is not valid.
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
