//! The thesis' agents as a training run drives them.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    agent::{Agent, EpisodeState, Settings},
    carom::{Carom, cue_inputs},
};
use crate::{
    learning::{
        evaluation::Score,
        learner::{
            AgentKind, Iteration, Learner, Progress, StartError, TrainingPlan, note_of, settings_as_object,
            settings_from,
        },
        nn::weights::{Reader, WeightsError, Writer},
    },
    physics::CueInputs,
    table::{Layout, Table},
};

/// Shots of an iteration. As many as the agents play before their first update, so that updates come in whole hundreds.
const SHOTS_PER_ITERATION: u64 = 100;

/// The line of a thesis' agent in the list of agents.
pub const fn kind_of<A: Agent + 'static>() -> AgentKind {
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
        must_match: &["canonical"],
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

    fn iterate(&mut self) -> candle_core::Result<Iteration> {
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

    fn score(&self, layouts: &[Layout]) -> candle_core::Result<Score> {
        let play = |layout| {
            let choice = self.agent.best(&self.state.game.observation(layout))?;
            let State { plan, game, .. } = &self.state;
            // As every other agent is measured: on a table with room for the cue, a stroke without any earns nothing.
            let reward = plan.reward.with_room(&game.table, layout, &cue_inputs(choice.action), u32::MAX);
            Ok((reward, reward >= 1.0))
        };
        Ok(Score::of(&layouts.iter().map(play).collect::<candle_core::Result<Vec<_>>>()?))
    }

    fn shots_on(&self, layouts: &[Layout]) -> candle_core::Result<Vec<CueInputs>> {
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
