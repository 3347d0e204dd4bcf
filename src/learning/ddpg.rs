//! Deep deterministic policy gradient (Lillicrap et al. 2016; thesis 4.4) with several actor heads.
//!
//! What differs from the thesis' agent, and why, stands at the fields of [`Hyperparameters`]. The target networks take
//! no part in the critic's target, for a shot is a whole episode and nothing follows it; they are the averaged weights
//! that play, are evaluated and are shipped.

use candle_core::{Device, Result, Tensor, Var, bail};
use candle_nn::ops::sigmoid;
use rand::Rng;
use serde::{Deserialize, Serialize};

use super::{
    action::{ACTIONS, Action},
    adam::{Adam, soft_update},
    exploration::Exploration,
    networks::Networks,
    scenes::Scenes,
};

/// What can be tuned. The defaults trained the bundled policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hyperparameters {
    /// Actions that the actor proposes for a view. One alone averages between success windows and misses all; several,
    /// started apart, each climb their own window, and the critic chooses.
    pub heads: usize,
    /// Units of the actor's hidden layers.
    pub actor_layers: Vec<usize>,
    /// Units of the critic's hidden layers.
    pub critic_layers: Vec<usize>,
    /// Adam's step for the critic at the start; it falls to nothing over the run along half a cosine.
    pub critic_learning_rate: f64,
    /// The same for the actor: slower, so that it follows a critic that has settled.
    pub actor_learning_rate: f64,
    /// Largest norm of a gradient.
    pub gradient_clip: f64,
    /// Part of the way that the target networks go at every update. The thesis' 0.001.
    pub target_rate: f64,
    /// Experiences in a critic update.
    pub batch: usize,
    /// Views among them for which the actor is updated too: every head costs a pass through the critic.
    pub actor_batch: usize,
    /// New shots before every update.
    pub shots_per_update: usize,
    /// Shots that are remembered. A shot's outcome never changes, but old shots are about actions that the actor has
    /// left behind.
    pub replay: usize,
    /// Weight of the logit beside the probability in what the actor climbs: without it there is no slope where the
    /// critic is certain of a miss.
    pub logit_weight: f64,
    /// How far the behaviour strays from the actor's proposals.
    pub exploration: Exploration,
}

impl Default for Hyperparameters {
    fn default() -> Self {
        Self {
            heads: 4,
            actor_layers: vec![256, 256, 256],
            critic_layers: vec![256, 256, 256],
            critic_learning_rate: 1e-3,
            actor_learning_rate: 3e-4,
            gradient_clip: 1.0,
            target_rate: 1e-3,
            batch: 512,
            actor_batch: 128,
            shots_per_update: 256,
            replay: 1 << 17,
            logit_weight: 0.02,
            exploration: Exploration { noise: vec![0.03, 0.12, 0.3], uniform: 0.2 },
        }
    }
}

/// What an update reports.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    /// Mean cross entropy of the critic, nats.
    pub critic: f64,
    /// Minus what the actor climbs: the mean over its heads of the critic's probability.
    pub actor: f64,
}

/// The agent: networks, their averaged copies, and the optimisers' state.
#[derive(Debug)]
pub struct Ddpg {
    hyper: Hyperparameters,
    online: Networks,
    target: Networks,
    actor_optimiser: Adam,
    critic_optimiser: Adam,
}

impl Ddpg {
    /// An agent that has learnt nothing.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn new(hyper: Hyperparameters, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        let online = Networks::random(&hyper, rng)?;
        Ok(Self {
            target: online.duplicate()?,
            actor_optimiser: Adam::new(online.actor.parameters().elem_count())?,
            critic_optimiser: Adam::new(online.critic.parameters().elem_count())?,
            online,
            hyper,
        })
    }

    /// What the agent was made with.
    pub const fn hyperparameters(&self) -> &Hyperparameters {
        &self.hyper
    }

    /// The networks that learn.
    pub const fn online(&self) -> &Networks {
        &self.online
    }

    /// Their running averages: what plays once training is over.
    pub const fn target(&self) -> &Networks {
        &self.target
    }

    /// Learns from a batch of shots: `scenes`, the action taken in each and the success, 0 to 1, that it had.
    /// `pace` scales both learning rates.
    ///
    /// # Errors
    /// Where sizes differ, or where the networks no longer give finite numbers.
    pub fn update(&mut self, scenes: &Scenes, actions: &[Action], successes: &[f32], pace: f64) -> Result<Losses> {
        let count = scenes.views().len();
        if actions.len() != count || successes.len() != count {
            bail!("{count} views, {} actions and {} successes are no batch", actions.len(), successes.len());
        }
        let critic = self.update_critic(scenes, actions, successes, pace)?;
        let actor = self.update_actor(&scenes.first(self.hyper.actor_batch)?, pace)?;
        let rate = self.hyper.target_rate;
        soft_update(self.target.critic.parameters(), self.online.critic.parameters(), rate)?;
        soft_update(self.target.actor.parameters(), self.online.actor.parameters(), rate)?;
        Ok(Losses { critic, actor })
    }

    /// One step down the cross entropy between the critic's probabilities and what happened.
    fn update_critic(&mut self, scenes: &Scenes, actions: &[Action], successes: &[f32], pace: f64) -> Result<f64> {
        let actions = Tensor::from_slice(actions.as_flattened(), (actions.len(), ACTIONS), &Device::Cpu)?;
        let successes = Tensor::from_slice(successes, (successes.len(), 1), &Device::Cpu)?;
        let critic = &self.online.critic;
        let logits = critic.forward(&scenes.with_actions(&actions)?)?;
        let loss = cross_entropy(&logits, &successes)?;
        let gradient = gradient_of(&loss, critic.parameters())?;
        let rate = pace * self.hyper.critic_learning_rate;
        self.critic_optimiser.step(critic.parameters(), &gradient, rate, self.hyper.gradient_clip)?;
        Ok(f64::from(loss.to_scalar::<f32>()?))
    }

    /// One step up the deterministic policy gradient: every head climbs the critic from its own action.
    fn update_actor(&mut self, scenes: &Scenes, pace: f64) -> Result<f64> {
        let actor = &self.online.actor;
        let actions = self.online.propose(scenes)?;
        let logits = self.online.critic.forward_frozen(&scenes.with_actions(&actions)?)?;
        let climbed = (sigmoid(&logits)? + (&logits * self.hyper.logit_weight)?)?;
        let loss = climbed.mean_all()?.neg()?;
        let gradient = gradient_of(&loss, actor.parameters())?;
        let rate = pace * self.hyper.actor_learning_rate;
        self.actor_optimiser.step(actor.parameters(), &gradient, rate, self.hyper.gradient_clip)?;
        Ok(f64::from(loss.to_scalar::<f32>()?))
    }
}

/// Mean cross entropy of success probabilities, given as logits, against what happened. candle-nn's own gives NaN once
/// a probability rounds to 0 or 1.
fn cross_entropy(logits: &Tensor, successes: &Tensor) -> Result<Tensor> {
    let softplus = (logits.relu()? + (logits.abs()?.neg()?.exp()? + 1.0)?.log()?)?;
    (softplus - (logits * successes)?)?.mean_all()
}

fn gradient_of(loss: &Tensor, parameters: &Var) -> Result<Tensor> {
    match loss.backward()?.remove(parameters) {
        Some(gradient) => Ok(gradient),
        None => bail!("the loss does not depend on the parameters"),
    }
}
