//! What the thesis' agents have in common, the loop in which they play and learn, and what a training run drives them by.

use candle_core::Error;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use super::{
    carom::{Carom, Episode, cue_inputs},
    environment::{Action, Environment, Observation, discrete_action},
};
use crate::{
    learning::{
        evaluation::Score,
        learner::{
            AgentKind, Iteration, Learner, Progress, StartError, TrainingPlan, UpdateStats, note_of,
            settings_as_object, settings_from,
        },
        nn::weights::{Reader, WeightsError, Writer},
        settings::SettingError,
    },
    physics::CueInputs,
    table::{Layout, Table},
};

/// What an agent does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Choice {
    /// The action.
    pub action: Action,
    /// Its number, for agents with discrete actions.
    pub index: u32,
}

impl Choice {
    /// The discrete action number `index`.
    pub fn discrete(index: u32) -> Self {
        Self { action: discrete_action(index), index }
    }
}

/// One shot as an agent learns from it.
#[derive(Clone, Copy, Debug)]
pub struct Transition {
    /// What was seen.
    pub before: Observation,
    /// What was done.
    pub choice: Choice,
    /// What it earned.
    pub reward: f64,
    /// Whether the episode goes on.
    pub goes_on: bool,
    /// What is seen now.
    pub after: Observation,
}

/// An agent's settings.
pub trait Settings: Clone + std::fmt::Debug + Default + Serialize + DeserializeOwned + Send {
    /// When an episode is over.
    fn episode(&self) -> Episode;

    /// Whether they are about points: of no use with a reward that says anything else.
    fn are_about_points(&self) -> bool {
        false
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first one that is outside its range.
    fn validate(&self) -> Result<(), SettingError>;
}

/// One of the thesis' agents. Errors are candle's, where networks no longer give finite numbers or an array has another size, and
/// those of files that do not fit the settings.
#[expect(clippy::missing_errors_doc, reason = "said of all of them at once")]
pub trait Agent: std::fmt::Debug + Send + Sized {
    /// Name on the command line and in files.
    const NAME: &'static str;

    /// What it is, in one line for people.
    const TITLE: &'static str;

    /// Its settings.
    type Settings: Settings;

    /// An untrained agent.
    fn new(settings: Self::Settings, rng: &mut Xoshiro256PlusPlus) -> Result<Self, Error>;

    /// Its settings.
    fn settings(&self) -> &Self::Settings;

    /// How far its learning has come.
    fn progress(&self) -> Progress;

    /// What it does while it learns.
    fn explore(&mut self, seen: &Observation, rng: &mut Xoshiro256PlusPlus) -> Result<Choice, Error>;

    /// What it thinks best.
    fn best(&self, seen: &Observation) -> Result<Choice, Error>;

    /// Looks for lessons before a shot is played, which only some agents do.
    fn study(
        &mut self,
        _environment: &impl Environment,
        _seen: &Observation,
        _action: Action,
        _rng: &mut Xoshiro256PlusPlus,
    ) {
    }

    /// Remembers a shot and learns from those that it remembers; nothing as long as these are too few.
    fn learn(&mut self, transition: &Transition, rng: &mut Xoshiro256PlusPlus) -> Result<Option<UpdateStats>, Error>;

    /// Adds the arrays of its state to a file and returns everything else.
    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError>;

    /// The agent whose [`Agent::save`] filled the file and returned `note`.
    fn restore(settings: Self::Settings, reader: &Reader<'_>, note: Value) -> Result<Self, WeightsError>;

    /// Takes what it plays by, and nothing else, from such a file.
    fn load_weights(&mut self, reader: &Reader<'_>) -> Result<(), WeightsError>;
}

/// Where an agent and its environment are in their episodes.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct EpisodeState {
    /// Whether an episode is going on.
    running: bool,
}

impl EpisodeState {
    /// Plays a shot and learns (Algorithms 2 to 4), beginning an episode where none is going on. Returns the shot's reward and
    /// what was learnt after it.
    ///
    /// # Errors
    /// Where the networks no longer give finite numbers.
    pub fn shoot<A: Agent>(
        &mut self,
        agent: &mut A,
        environment: &mut impl Environment,
        rng: &mut Xoshiro256PlusPlus,
    ) -> Result<(f64, Option<UpdateStats>), Error> {
        if !self.running {
            environment.begin(rng);
        }
        let before = environment.observe();
        let choice = agent.explore(&before, rng)?;
        agent.study(environment, &before, choice.action, rng);
        let outcome = environment.act(choice.action);
        let (reward, goes_on, after) = (outcome.reward, !outcome.over, environment.observe());
        self.running = goes_on;
        Ok((reward, agent.learn(&Transition { before, choice, reward, goes_on, after }, rng)?))
    }
}

/// Shots of an iteration. As many as the agents play before their first update, so that updates come in whole hundreds.
const SHOTS_PER_ITERATION: u64 = 100;

/// The line of a thesis' agent in the list of agents.
pub(crate) const fn kind_of<A: Agent + 'static>() -> AgentKind {
    AgentKind {
        name: A::NAME,
        title: A::TITLE,
        settings: |settings| {
            settings_from(settings, A::Settings::validate).map(|settings: A::Settings| settings_as_object(&settings))
        },
        start: |plan, table, settings| {
            let settings = settings_from(settings, A::Settings::validate)?;
            if settings.are_about_points() && plan.reward.rule().is_none() {
                return Err(StartError::settings(
                    "hindsight and demonstrations are about points: use them with r3, one-cushion or three-cushion",
                ));
            }
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(plan.seed);
            let game = Carom::new(table, plan.reward, settings.episode());
            let agent = A::new(settings, &mut rng)?;
            let state = State { plan, game, episode: EpisodeState::default(), rng, shots: 0 };
            Ok(Box::new(TrainingLoop { agent, state }))
        },
        restore: |reader, note| {
            let note = serde_json::from_value(note).map_err(|_| WeightsError::Foreign)?;
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

/// What a file holds beside arrays.
#[derive(Serialize, Deserialize)]
struct Note<S> {
    settings: S,
    agent: Value,
    #[serde(flatten)]
    state: State,
}

/// What there is beside the agent.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    plan: TrainingPlan,
    game: Carom,
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
        let play = |layout| {
            let choice = self.agent.best(&self.state.game.observation(layout))?;
            let State { plan, game, .. } = &self.state;
            // As every other agent is measured: on a table with room for the cue, a stroke without any earns nothing.
            let reward = plan.reward.with_room(&game.table, layout, &cue_inputs(choice.action), u32::MAX);
            Ok((reward, reward >= 1.0))
        };
        Ok(Score::of(&layouts.iter().map(play).collect::<Result<Vec<_>, Error>>()?))
    }

    fn shots_on(&self, layouts: &[Layout]) -> Result<Vec<CueInputs>, Error> {
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
