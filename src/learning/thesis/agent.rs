//! The interface of the thesis' agents, their training loop, and its implementation of [`Learner`] for training runs.

use candle_core::Error;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use super::{
    carom::{CaromGame, Episode, cue_inputs},
    environment::{Action, Environment, Observation, discrete_action},
};
use crate::{
    learning::{
        evaluation::Score,
        learner::{
            AgentKind, Iteration, Learner, Progress, StartError, TrainingPlan, UpdateStats, current_names, note_of,
            settings_as_object, settings_from,
        },
        nn::weights::{Reader, WeightsError, Writer},
        settings::SettingError,
    },
    physics::CueInputs,
    table::{Layout, Table},
};

/// The action that an agent chose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Choice {
    /// The action.
    pub action: Action,
    /// Index of the action, for agents with discrete actions.
    pub index: u32,
}

impl Choice {
    /// Returns the discrete action with this index.
    pub fn discrete(index: u32) -> Self {
        Self { action: discrete_action(index), index }
    }
}

/// One shot from which an agent learns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transition {
    /// Observation before the shot.
    pub before: Observation,
    /// The action played.
    pub choice: Choice,
    /// Reward of the shot.
    pub reward: f64,
    /// Whether the episode continues after the shot.
    pub continues: bool,
    /// Observation after the shot.
    pub after: Observation,
}

/// An agent's settings. A serde `alias` is the name of a setting in earlier versions.
pub trait Settings: Clone + std::fmt::Debug + Default + Serialize + DeserializeOwned + Send {
    /// When an episode ends.
    fn episode(&self) -> Episode;

    /// Whether the settings require a reward that is about points.
    fn needs_point_rewards(&self) -> bool {
        false
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// Fails with the first setting that is outside its range.
    fn validate(&self) -> Result<(), SettingError>;
}

/// One of the thesis' agents. Methods fail with candle's errors if the networks no longer return finite numbers or an array has another
/// size, and with the errors of files that do not fit the settings.
#[expect(clippy::missing_errors_doc, reason = "the trait's documentation states the errors of all methods")]
pub trait Agent: std::fmt::Debug + Send + Sized {
    /// Name on the command line and in files.
    const NAME: &'static str;

    /// Description in one line, for users.
    const TITLE: &'static str;

    /// The type of the agent's settings.
    type Settings: Settings;

    /// Creates an untrained agent.
    fn new(settings: Self::Settings, rng: &mut Xoshiro256PlusPlus) -> Result<Self, Error>;

    /// The agent's settings.
    fn settings(&self) -> &Self::Settings;

    /// Progress of the learning.
    fn progress(&self) -> Progress;

    /// Chooses an action with exploration, for training. An agent that learns from lessons also looks for them.
    fn explore(&mut self, game: &impl Environment, rng: &mut Xoshiro256PlusPlus) -> Result<Choice, Error>;

    /// Chooses the action that the agent values most, without exploration.
    fn best(&self, seen: &Observation) -> Result<Choice, Error>;

    /// Stores a shot and makes an update from the stored shots. Returns `None`, without an update, while they are too few.
    fn learn(&mut self, transition: &Transition, rng: &mut Xoshiro256PlusPlus) -> Result<Option<UpdateStats>, Error>;

    /// Adds the arrays of the state to a file and returns the rest of the state as a note.
    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError>;

    /// Restores the agent whose [`Agent::save`] filled the file and returned `note`.
    fn restore(settings: Self::Settings, reader: &Reader<'_>, note: Value) -> Result<Self, WeightsError>;

    /// Loads only the weights or the table by which the agent plays, from a file that [`Agent::save`] filled.
    fn load_weights(&mut self, reader: &Reader<'_>) -> Result<(), WeightsError>;
}

/// State of an agent and its environment within their episodes.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct EpisodeState {
    /// Whether an episode is in progress.
    running: bool,
}

impl EpisodeState {
    /// Plays a shot and learns (Algorithms 2 to 4). Begins an episode if none is in progress. Returns the shot's reward and
    /// the statistics of the update after it.
    ///
    /// # Errors
    /// Fails if the networks no longer return finite numbers.
    pub fn shoot<A: Agent>(
        &mut self,
        agent: &mut A,
        environment: &mut impl Environment,
        rng: &mut Xoshiro256PlusPlus,
    ) -> Result<(f64, Option<UpdateStats>), Error> {
        if !self.running {
            environment.reset(rng);
        }
        let before = environment.observe();
        let choice = agent.explore(environment, rng)?;
        let outcome = environment.step(choice.action);
        let (reward, continues, after) = (outcome.reward, !outcome.terminated, environment.observe());
        self.running = continues;
        Ok((reward, agent.learn(&Transition { before, choice, reward, continues, after }, rng)?))
    }
}

/// Shots per iteration: as many as the agents play before their first update, so that the number of updates is a multiple of 100.
const SHOTS_PER_ITERATION: u64 = 100;

/// Returns the entry of a thesis agent in the list of agents.
pub(crate) const fn kind_of<A: Agent + 'static>() -> AgentKind {
    AgentKind {
        name: A::NAME,
        title: A::TITLE,
        settings: |settings| {
            settings_from(settings, A::Settings::validate).map(|settings: A::Settings| settings_as_object(&settings))
        },
        current_names: current_names::<A::Settings>,
        start: |plan, table, settings| {
            let settings = settings_from(settings, A::Settings::validate)?;
            if settings.needs_point_rewards() && plan.reward.rule().is_none() {
                let reason =
                    "hindsight and demonstrations are about points: use them with r3, one-cushion or three-cushion";
                return Err(StartError::Settings(reason.to_owned()));
            }
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(plan.seed);
            let game = CaromGame::new(table, plan.reward, settings.episode());
            let agent = A::new(settings, &mut rng)?;
            let state = State { plan, game, episode: EpisodeState::default(), rng, shots: 0 };
            Ok(Box::new(TrainingLoop { agent, state }))
        },
        restore: |reader, note| {
            let note = serde_json::from_value(note).map_err(|_| WeightsError::Metadata)?;
            let Note::<A::Settings> { settings, agent, state } = note;
            settings.validate()?;
            Ok(Box::new(TrainingLoop { agent: A::restore(settings, reader, agent)?, state }))
        },
        not_inherited: &[],
        must_match: &["canonical", "relative"],
    }
}

/// An agent and its game.
#[derive(Debug)]
struct TrainingLoop<A> {
    agent: A,
    state: State,
}

/// The JSON note of a file, next to its arrays.
#[derive(Serialize, Deserialize)]
struct Note<S> {
    settings: S,
    agent: Value,
    #[serde(flatten)]
    state: State,
}

/// State of the training loop other than the agent's.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    plan: TrainingPlan,
    game: CaromGame,
    #[serde(rename = "progress")]
    episode: EpisodeState,
    rng: Xoshiro256PlusPlus,
    shots: u64,
}

impl<A: Agent> Learner for TrainingLoop<A> {
    fn agent(&self) -> &'static str {
        A::NAME
    }

    fn plan(&self) -> TrainingPlan {
        self.state.plan
    }

    fn table(&self) -> &Table {
        &self.state.game.table
    }

    fn settings(&self) -> Value {
        settings_as_object(self.agent.settings())
    }

    fn shots(&self) -> u64 {
        self.state.shots
    }

    fn progress(&self) -> Progress {
        self.agent.progress()
    }

    fn iterate(&mut self) -> Result<Iteration, Error> {
        let State { plan, game, episode, rng, shots: played } = &mut self.state;
        let shots = plan.shots.saturating_sub(*played).clamp(1, SHOTS_PER_ITERATION);
        let (mut iteration, mut updates) = (Iteration::default(), 0_u32);
        for _ in 0..shots {
            let (reward, learnt) = episode.shoot(&mut self.agent, game, rng)?;
            iteration.mean_reward += reward / shots as f64;
            if let Some(stats) = learnt {
                iteration.critic_loss += stats.loss;
                iteration.q_value += stats.value;
                updates += 1;
            }
        }
        *played += shots;
        iteration.critic_loss /= f64::from(updates.max(1));
        iteration.q_value /= f64::from(updates.max(1));
        Ok(iteration)
    }

    fn score(&self, layouts: &[Layout]) -> Result<Score, Error> {
        let game = &self.state.game;
        let play = |layout| {
            // Scored like every other agent: on a table that checks the room for the cue, a stroke without room earns nothing.
            let reward = game.reward_of(layout, self.agent.best(&game.observation(layout))?.action);
            Ok((reward, reward >= 1.0))
        };
        Ok(Score::of(&layouts.iter().map(play).collect::<Result<Vec<_>, Error>>()?))
    }

    fn choose_shots(&self, layouts: &[Layout]) -> Result<Vec<CueInputs>, Error> {
        let shot =
            |layout| self.agent.best(&self.state.game.observation(layout)).map(|choice| cue_inputs(choice.action));
        layouts.iter().map(shot).collect()
    }

    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError> {
        let (settings, agent) = (self.agent.settings().clone(), self.agent.save(writer)?);
        note_of(&Note { settings, agent, state: self.state.clone() })
    }

    fn load_weights(&mut self, weights: &Reader<'_>) -> Result<(), WeightsError> {
        self.agent.load_weights(weights)
    }
}
