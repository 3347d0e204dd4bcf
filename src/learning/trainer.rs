//! The training loop: play, remember, learn.

use std::sync::Arc;

use candle_core::Result;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::{
    action::{ACTION_SPACE, Action, cue_inputs},
    calendar::today,
    ddpg::Ddpg,
    features::FEATURE_VERSION,
    hyperparameters::Hyperparameters,
    learner::Turn,
    policy::Policy,
    policy_file::Origin,
    replay::{Experience, ReplayBuffer},
    scenes::Scenes,
    view::{VIEWS, View},
};
use crate::{
    game::Reward,
    table::{Layout, Table},
};

/// What is to be learnt, and how long.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// What earns a reward.
    pub reward: Reward,
    /// Seed of everything random. The same task gives the same weights on the same machine.
    pub seed: u64,
    /// Shots to play, over which the learning rates fall.
    pub shots: u64,
    /// The agent's settings.
    pub hyperparameters: Hyperparameters,
}

/// An agent at practice on a table.
#[derive(Debug)]
pub struct Trainer {
    pub(super) task: Task,
    pub(super) table: Arc<Table>,
    pub(super) agent: Ddpg,
    pub(super) replay: ReplayBuffer,
    pub(super) rng: Xoshiro256PlusPlus,
    pub(super) shots: u64,
    pub(super) updates: u64,
}

impl Trainer {
    /// A beginner.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn new(task: Task, table: Table) -> Result<Self> {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(task.seed);
        let agent = Ddpg::new(task.hyperparameters.clone(), &mut rng)?;
        let replay = ReplayBuffer::new(task.hyperparameters.replay);
        Ok(Self { task, table: Arc::new(table), agent, replay, rng, shots: 0, updates: 0 })
    }

    /// Shots played so far.
    pub const fn shots(&self) -> u64 {
        self.shots
    }

    /// Whether all shots of the task have been played.
    pub const fn is_finished(&self) -> bool {
        self.shots >= self.task.shots
    }

    /// Updates made so far.
    pub const fn updates(&self) -> u64 {
        self.updates
    }

    /// What is being learnt.
    pub const fn task(&self) -> &Task {
        &self.task
    }

    /// The table.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// A policy that plays with the averaged networks as they are now. `held_out_reward` is what they have been
    /// measured to earn.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn policy(&self, held_out_reward: f64) -> Result<Policy> {
        let origin = Origin {
            table: self.table.name.clone(),
            reward: self.task.reward,
            actions: ACTION_SPACE.to_owned(),
            features: FEATURE_VERSION.to_owned(),
            seed: self.task.seed,
            shots: self.shots,
            date: today(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            held_out_reward,
            hyperparameters: self.task.hyperparameters.clone(),
        };
        Ok(Policy::new(self.agent.target().duplicate()?, origin))
    }

    /// Plays some shots, then learns from a batch of those that are remembered.
    ///
    /// # Errors
    /// Where the networks no longer give finite numbers.
    pub fn turn(&mut self) -> Result<Turn> {
        let pace = self.pace();
        let mean_reward = self.play()?;
        let batch = self.replay.sample(self.task.hyperparameters.batch, &mut self.rng);
        let scenes = Scenes::new(&self.table, batch.iter().map(|experience| experience.view).collect())?;
        let actions: Vec<_> = batch.iter().map(|experience| experience.action).collect();
        let successes: Vec<_> = batch.iter().map(|experience| experience.success).collect();
        let losses = self.agent.update(&scenes, &actions, &successes, pace)?;
        self.updates += 1;
        // What the actor climbs is the critic's mean value of its actions.
        let q_value = -losses.actor;
        Ok(Turn { mean_reward, q_value, critic_loss: losses.critic, actor_loss: Some(losses.actor) })
    }

    /// Part of the first learning rates that is left: half a cosine from 1 at the first shot to 0 at the last.
    pub fn pace(&self) -> f64 {
        let done = (self.shots as f64 / self.task.shots as f64).min(1.0);
        0.5 * (1.0 + (std::f64::consts::PI * done).cos())
    }

    /// Plays the shots of one turn, each on a fresh layout, and returns their mean reward.
    fn play(&mut self) -> Result<f64> {
        let Hyperparameters { shots_per_update, critic_chooses, .. } = self.task.hyperparameters;
        let layouts: Vec<_> = (0..shots_per_update).map(|_| Layout::random(&self.table, &mut self.rng)).collect();
        let chosen = ((shots_per_update as f64 * critic_chooses).round() as usize).min(layouts.len());
        let mut total = self.play_favourites(&layouts[..chosen])?;
        total += self.play_any(&layouts[chosen..])?;
        self.shots += layouts.len() as u64;
        Ok(total / layouts.len().max(1) as f64)
    }

    /// Plays near the critic's favourite on every layout: there it must learn where it is wrong. Returns the rewards'
    /// sum.
    fn play_favourites(&mut self, layouts: &[Layout]) -> Result<f64> {
        if layouts.is_empty() {
            return Ok(0.0);
        }
        let scenes = Scenes::new(&self.table, layouts.iter().flat_map(View::all).collect())?;
        let (actions, logits) = self.agent.online().judge(&scenes)?;
        let heads = actions.len() / scenes.views().len();
        let mut total = 0.0;
        for (index, layout) in layouts.iter().enumerate() {
            let rows = index * VIEWS * heads..(index + 1) * VIEWS * heads;
            let best = rows.max_by(|a, b| logits[*a].total_cmp(&logits[*b])).unwrap_or(0);
            total += self.shoot(layout, scenes.views()[best / heads], actions[best]);
        }
        Ok(total)
    }

    /// Plays near any head's choice in any view of every layout. Returns the rewards' sum.
    fn play_any(&mut self, layouts: &[Layout]) -> Result<f64> {
        if layouts.is_empty() {
            return Ok(0.0);
        }
        let views = layouts.iter().map(|layout| View::new(layout, self.rng.random_range(0..VIEWS))).collect();
        let scenes = Scenes::new(&self.table, views)?;
        let actions = self.agent.online().actions(&scenes)?;
        let heads = actions.len() / layouts.len();
        let mut total = 0.0;
        for (index, layout) in layouts.iter().enumerate() {
            let choice = actions[index * heads + self.rng.random_range(0..heads)];
            total += self.shoot(layout, scenes.views()[index], choice);
        }
        Ok(total)
    }

    /// Plays and remembers one shot near `choice`; returns its reward.
    fn shoot(&mut self, layout: &Layout, view: View, choice: Action) -> f64 {
        let action = self.task.hyperparameters.exploration.stray(choice, &mut self.rng);
        let reward = self.task.reward.of(&self.table, layout, &cue_inputs(&self.table, &view, action));
        let success = (reward / highest(self.task.reward)) as f32;
        self.replay.push(Experience { view, action, success });
        reward
    }
}

/// The largest reward there is: the critic's probabilities end at one.
const fn highest(reward: Reward) -> f64 {
    match reward {
        Reward::R1 | Reward::R1Difficulty | Reward::R3 => 1.0,
        Reward::R2 | Reward::R4 => 2.0,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::learning::evaluation::{HELD_OUT_SEED, held_out_layouts, score};

    /// A task that is learnt in an instant, or not at all.
    pub fn small_task() -> Task {
        let hyperparameters = Hyperparameters {
            actor_layers: vec![16],
            critic_layers: vec![16, 16],
            batch: 32,
            actor_batch: 8,
            shots_per_update: 16,
            replay: 100,
            ..Hyperparameters::default()
        };
        Task { reward: Reward::R1, seed: 5, shots: 160, hyperparameters }
    }

    #[test]
    fn the_same_task_gives_the_same_weights_and_another_seed_gives_others() {
        let weights = |seed| {
            let mut trainer = Trainer::new(Task { seed, ..small_task() }, Table::default()).unwrap();
            while !trainer.is_finished() {
                trainer.turn().unwrap();
            }
            assert_eq!((trainer.shots(), trainer.updates()), (160, 10));
            trainer.agent.target().actor.parameters().to_vec1::<f32>().unwrap()
        };
        assert_eq!(weights(5), weights(5));
        assert_ne!(weights(5), weights(6));
    }

    #[test]
    fn the_learning_rate_falls_from_one_to_nothing() {
        let mut trainer = Trainer::new(small_task(), Table::default()).unwrap();
        assert_eq!(trainer.pace(), 1.0);
        while !trainer.is_finished() {
            let before = trainer.pace();
            trainer.turn().unwrap();
            assert!(trainer.pace() < before);
        }
        assert!(trainer.pace() < 1e-12);
    }

    #[test]
    fn points_come_more_often_after_seconds_of_practice() {
        let hyperparameters = Hyperparameters {
            actor_layers: vec![64, 64],
            critic_layers: vec![64, 64],
            batch: 128,
            actor_batch: 32,
            shots_per_update: 64,
            target_rate: 0.01,
            ..Hyperparameters::default()
        };
        let task = Task { reward: Reward::R3, seed: 1, shots: 64 * 1_000, hyperparameters };
        let table = Table::default();
        let mut trainer = Trainer::new(task, table.clone()).unwrap();
        let layouts = held_out_layouts(&table, 400, HELD_OUT_SEED);
        let reward = |trainer: &Trainer| score(&trainer.policy(0.0).unwrap(), &table, Reward::R3, &layouts).mean_reward;
        let before = reward(&trainer);
        while !trainer.is_finished() {
            trainer.turn().unwrap();
        }
        let after = reward(&trainer);
        assert!(after > before + 0.15, "{before} before, {after} after");
    }
}
