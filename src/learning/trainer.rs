//! The training loop: play, remember, learn.

use std::sync::Arc;

use candle_core::Result;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::{
    action::cue_inputs,
    ddpg::{Ddpg, Hyperparameters, Losses},
    policy::Policy,
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

/// What one turn of the loop did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    /// Mean reward of the shots played, with their noise.
    pub mean_reward: f64,
    /// Losses of the update.
    pub losses: Losses,
}

/// An agent at practice on a table.
#[derive(Debug)]
pub struct Trainer {
    task: Task,
    table: Arc<Table>,
    agent: Ddpg,
    replay: ReplayBuffer,
    rng: Xoshiro256PlusPlus,
    shots: u64,
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
        Ok(Self { task, table: Arc::new(table), agent, replay, rng, shots: 0 })
    }

    /// Shots played so far.
    pub const fn shots(&self) -> u64 {
        self.shots
    }

    /// Whether all shots of the task have been played.
    pub const fn is_finished(&self) -> bool {
        self.shots >= self.task.shots
    }

    /// The averaged networks as they are now.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn policy(&self) -> Result<Policy> {
        Ok(Policy::new(self.agent.target().duplicate()?))
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
        Ok(Turn { mean_reward, losses })
    }

    /// Half a cosine from 1 at the first shot to 0 at the last.
    fn pace(&self) -> f64 {
        let done = (self.shots as f64 / self.task.shots as f64).min(1.0);
        0.5 * (1.0 + (std::f64::consts::PI * done).cos())
    }

    /// Plays the shots of one turn, each on a fresh layout, and returns their mean reward.
    fn play(&mut self) -> Result<f64> {
        let count = self.task.hyperparameters.shots_per_update;
        let mut layouts = Vec::with_capacity(count);
        let mut views = Vec::with_capacity(count);
        for _ in 0..count {
            let layout = Layout::random(&self.table, &mut self.rng);
            views.push(View::new(&layout, self.rng.random_range(0..VIEWS)));
            layouts.push(layout);
        }
        let scenes = Scenes::new(&self.table, views)?;
        let proposals = self.agent.online().actions(&scenes)?;
        let heads = proposals.len() / count.max(1);
        let mut total = 0.0;
        for ((layout, view), proposals) in layouts.iter().zip(scenes.views()).zip(proposals.chunks(heads.max(1))) {
            let choice = proposals[self.rng.random_range(0..proposals.len())];
            let action = self.task.hyperparameters.exploration.stray(choice, &mut self.rng);
            let reward = self.task.reward.of(&self.table, layout, &cue_inputs(&self.table, view, action));
            total += reward;
            let success = (reward / highest(self.task.reward)) as f32;
            self.replay.push(Experience { view: *view, action, success });
        }
        self.shots += count as u64;
        Ok(total / count.max(1) as f64)
    }
}

/// The largest reward there is: the critic's probabilities end at one.
const fn highest(reward: Reward) -> f64 {
    match reward {
        Reward::R1 | Reward::R1Difficulty | Reward::R3 => 1.0,
        Reward::R2 | Reward::R4 => 2.0,
    }
}
