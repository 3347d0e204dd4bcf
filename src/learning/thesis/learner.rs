//! The thesis' agents as a training run drives them.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    agent::{Agent, EpisodeState, Settings},
    carom::{Carom, cue_inputs},
    ddpg::PlainDdpg,
    dqn::Dqn,
    q_learning::QLearning,
};
use crate::{
    learning::{
        evaluation::Score,
        learner::{
            AgentKind, Iteration, Learner, Progress, StartError, TrainingPlan, defaults_of, note_of, settings_from,
        },
        nn::weights::{Reader, WeightsError, Writer},
    },
    physics::CueInputs,
    table::{Layout, Table},
};

/// Shots of an iteration. As many as the agents play before their first update, so that updates come in whole hundreds.
const SHOTS_PER_ITERATION: u64 = 100;

/// The lines in the list of agents.
pub const Q_LEARNING: AgentKind = line::<QLearning>();
/// See [`Q_LEARNING`].
pub const DQN: AgentKind = line::<Dqn>();
/// See [`Q_LEARNING`].
pub const DDPG: AgentKind = line::<PlainDdpg>();

const fn line<A: Agent + 'static>() -> AgentKind {
    AgentKind {
        name: A::NAME,
        title: A::TITLE,
        defaults: defaults_of::<A::Settings>,
        start: start::<A>,
        restore: restore::<A>,
        shots_per_iteration: |_| Some(SHOTS_PER_ITERATION),
        of_one_start: &[],
    }
}

fn start<A: Agent + 'static>(
    plan: TrainingPlan,
    table: Table,
    settings: &Value,
) -> Result<Box<dyn Learner>, StartError> {
    let settings = settings_from(settings, A::Settings::validate)?;
    if settings.are_about_points() && plan.reward.rule().is_none() {
        let reason = "hindsight and demonstrations are about points: use them with r3, one-cushion or three-cushion";
        return Err(StartError::settings(reason));
    }
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(plan.seed);
    let game = Carom::new(table, plan.reward, settings.episode());
    let agent = A::new(settings, &mut rng)?;
    Ok(Box::new(TrainingLoop { plan, agent, game, episode: EpisodeState::default(), rng, shots: 0 }))
}

fn restore<A: Agent + 'static>(reader: &Reader<'_>, note: Value) -> Result<Box<dyn Learner>, WeightsError> {
    let note: TrainingLoopState<A::Settings> = serde_json::from_value(note).map_err(|_| WeightsError::Foreign)?;
    note.settings.validate()?;
    let agent = A::restore(note.settings, reader, note.agent)?;
    let TrainingLoopState { plan, game, episode, rng, shots, .. } = note;
    Ok(Box::new(TrainingLoop { plan, agent, game, episode, rng, shots }))
}

/// An agent and its game.
#[derive(Debug)]
struct TrainingLoop<A> {
    plan: TrainingPlan,
    agent: A,
    game: Carom,
    episode: EpisodeState,
    rng: Xoshiro256PlusPlus,
    shots: u64,
}

/// What a file holds beside arrays.
#[derive(Serialize, Deserialize)]
struct TrainingLoopState<S> {
    plan: TrainingPlan,
    settings: S,
    agent: Value,
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
        self.plan
    }

    fn table(&self) -> &Table {
        self.game.table()
    }

    fn settings(&self) -> Value {
        // The settings were read from JSON or are the defaults: they can be written.
        note_of(self.agent.settings()).unwrap_or_default()
    }

    fn shots(&self) -> u64 {
        self.shots
    }

    fn progress(&self) -> Progress {
        self.agent.progress()
    }

    fn iterate(&mut self) -> candle_core::Result<Iteration> {
        let shots = self.plan.shots.saturating_sub(self.shots).clamp(1, SHOTS_PER_ITERATION);
        let (mut iteration, mut updates) = (Iteration::default(), 0_u32);
        for _ in 0..shots {
            let (reward, learnt) = self.episode.shoot(&mut self.agent, &mut self.game, &mut self.rng)?;
            iteration.mean_reward += reward / shots as f64;
            if let Some(stats) = learnt {
                iteration.critic_loss += stats.loss;
                iteration.q_value += stats.value;
                updates += 1;
            }
        }
        self.shots += shots;
        iteration.critic_loss /= f64::from(updates.max(1));
        iteration.q_value /= f64::from(updates.max(1));
        Ok(iteration)
    }

    fn score(&self, layouts: &[Layout]) -> candle_core::Result<Score> {
        let play = |layout| {
            let choice = self.agent.best(&self.game.observation(layout))?;
            let reward = self.game.reward_of(layout, choice.action);
            Ok((reward, reward >= 1.0))
        };
        Ok(Score::of(&layouts.iter().map(play).collect::<candle_core::Result<Vec<_>>>()?))
    }

    fn shots_on(&self, layouts: &[Layout]) -> candle_core::Result<Vec<CueInputs>> {
        let shot = |layout| self.agent.best(&self.game.observation(layout)).map(|choice| cue_inputs(choice.action));
        layouts.iter().map(shot).collect()
    }

    fn policy(&self, _held_out_reward: f64, _date: &str) -> Result<Option<Vec<u8>>, WeightsError> {
        Ok(None)
    }

    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError> {
        let agent = self.agent.save(writer)?;
        note_of(&TrainingLoopState {
            plan: self.plan,
            settings: self.agent.settings().clone(),
            agent,
            game: self.game.clone(),
            episode: self.episode,
            rng: self.rng.clone(),
            shots: self.shots,
        })
    }

    fn load_weights(&mut self, weights: &Reader<'_>) -> Result<(), WeightsError> {
        self.agent.load_weights(weights)
    }
}
