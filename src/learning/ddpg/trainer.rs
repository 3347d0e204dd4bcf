//! The state of a training: agent, replay buffers, random numbers and progress. `rollout` and `learner` contain its loop.

use std::sync::Arc;

use candle_core::Result;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::{
    agent::{Ddpg, ShotBatch, Transition},
    hyperparameters::Hyperparameters,
    observation_batch::ObservationBatch,
    policy::{Policy, calibration::Calibration, file::Origin},
    randomized_tables::RandomizedTables,
};
use crate::{
    learning::{learner::TrainingPlan, replay::ReplayBuffer},
    printing::VERSION,
    table::Table,
};

/// Goal, length and settings of a training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The reward, the seed and the number of shots. Equal tasks give equal weights on the same machine.
    #[serde(flatten)]
    pub plan: TrainingPlan,
    pub hyperparameters: Hyperparameters,
}

/// An agent in training on a table.
#[derive(Debug)]
pub struct Trainer {
    pub(super) task: Task,
    pub(super) table: Arc<Table>,
    pub(super) tables: RandomizedTables,
    pub(super) agent: Ddpg,
    pub(super) replay: ReplayBuffer<Transition>,
    /// Replay buffer of the best strokes found by search.
    pub(super) searched: ReplayBuffer<Transition>,
    pub(super) rng: Xoshiro256PlusPlus,
    pub(super) shots: u64,
    pub(super) updates: u64,
}

impl Trainer {
    pub fn new(task: Task, table: Table) -> Result<Self> {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(task.plan.seed);
        let agent = Ddpg::new(task.hyperparameters.clone(), &mut rng)?;
        let [replay, searched] = [(); 2].map(|()| ReplayBuffer::new(task.hyperparameters.buffer_size));
        let table = Arc::new(table);
        let tables = RandomizedTables::new(&table, task.hyperparameters.inputs(), task.plan.seed);
        Ok(Self { task, table, tables, agent, replay, searched, rng, shots: 0, updates: 0 })
    }

    /// Creates a policy from the current target networks. `held_out_reward` is their measured mean reward on held-out layouts.
    pub fn policy(&self, held_out_reward: f64, date: &str) -> Result<Policy> {
        let origin = Origin {
            table: self.table.name.clone(),
            reward: self.task.plan.reward,
            actions: self.task.hyperparameters.actions.meaning().to_owned(),
            features: self.task.hyperparameters.inputs().version(),
            seed: self.task.plan.seed,
            shots: self.shots,
            date: date.to_owned(),
            version: VERSION.to_owned(),
            held_out_reward,
            calibration: Calibration::default(),
            hyperparameters: self.task.hyperparameters.clone(),
        };
        Ok(Policy { networks: self.agent.target.duplicate()?, origin })
    }

    /// Converts stored shots to a minibatch.
    pub(super) fn batch(&self, shots: &[Transition]) -> Result<ShotBatch> {
        let observations = shots.iter().map(|shot| self.tables.contextual(shot.observation, shot.context)).collect();
        Ok(ShotBatch {
            observed: ObservationBatch::new(self.task.hyperparameters.inputs(), observations)?,
            actions: shots.iter().map(|shot| shot.action).collect(),
            successes: shots.iter().map(|shot| shot.success).collect(),
        })
    }

    /// Factor of the initial learning rates: half a cosine from 1 at the first shot to 0 at the last.
    pub fn lr_factor(&self) -> f64 {
        let done = (self.shots as f64 / self.task.plan.shots as f64).min(1.0);
        0.5 * (1.0 + (std::f64::consts::PI * done).cos())
    }
}

#[cfg(test)]
pub(in crate::learning) mod tests {
    use super::*;
    use crate::{
        game::Reward,
        learning::{
            evaluation::{HELD_OUT_SEED, held_out_layouts},
            learner::Learner,
        },
    };

    /// A task with tiny networks, for tests of the mechanics; the agent may learn nothing.
    pub fn small_task() -> Task {
        let hyperparameters = Hyperparameters {
            actor_layers: vec![16],
            critic_layers: vec![16, 16],
            batch_size: 32,
            actor_batch_size: 8,
            shots_per_update: 16,
            buffer_size: 100,
            calibrated: 200,
            ..Hyperparameters::default()
        };
        Task { plan: TrainingPlan { reward: Reward::R1, seed: 5, shots: 160 }, hyperparameters }
    }

    #[test]
    fn another_seed_gives_other_weights() {
        let weights = |seed| {
            let mut task = small_task();
            task.plan.seed = seed;
            let trainer = Trainer::new(task, Table::default()).unwrap();
            trainer.agent.target.actor.parameters().to_vec1::<f32>().unwrap()
        };
        assert_ne!(weights(5), weights(6));
    }

    #[test]
    fn every_kind_of_shot_counts_as_one_shot() {
        for (ranking, critic_chooses) in [(0.0, 0.3), (0.5, 0.5), (1.0, 0.0), (0.4, 1.0)] {
            let mut task = small_task();
            task.hyperparameters = Hyperparameters { critic_chooses, ranking, ..task.hyperparameters };
            let mut trainer = Trainer::new(task, Table::default()).unwrap();
            trainer.iterate().unwrap();
            assert_eq!((trainer.shots(), trainer.replay.len()), (16, 16), "ranking {ranking}");
        }
    }

    #[test]
    fn the_learning_rate_factor_falls_from_one_to_zero() {
        let mut trainer = Trainer::new(small_task(), Table::default()).unwrap();
        assert_eq!(trainer.lr_factor(), 1.0);
        while !trainer.is_finished() {
            let before = trainer.lr_factor();
            trainer.iterate().unwrap();
            assert!(trainer.lr_factor() < before);
        }
        assert!(trainer.lr_factor() < 1e-12);
        assert_eq!((trainer.shots(), trainer.updates), (160, 10));
    }

    #[test]
    fn seconds_of_training_raise_the_reward() {
        let hyperparameters = Hyperparameters {
            actor_layers: vec![64, 64],
            critic_layers: vec![64, 64],
            batch_size: 128,
            actor_batch_size: 32,
            shots_per_update: 64,
            tau: 0.01,
            ..Hyperparameters::default()
        };
        let task = Task { plan: TrainingPlan { reward: Reward::R3, seed: 1, shots: 64 * 1_000 }, hyperparameters };
        let table = Table::preset("textbook").unwrap();
        let mut trainer = Trainer::new(task, table.clone()).unwrap();
        let layouts = held_out_layouts(&table, 400, HELD_OUT_SEED);
        let reward =
            |trainer: &Trainer| trainer.policy(0.0, "").unwrap().score(&table, Reward::R3, &layouts).mean_reward;
        let before = reward(&trainer);
        while !trainer.is_finished() {
            trainer.iterate().unwrap();
        }
        let after = reward(&trainer);
        assert!(after > before + 0.15, "{before} before, {after} after");
    }
}
