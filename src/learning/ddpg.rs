//! Deep deterministic policy gradient (Lillicrap et al. 2016; thesis 4.4) with several actor heads.
//!
//! What differs from the thesis' agent, and why, stands at the fields of [`Hyperparameters`]. The target networks take
//! no part in the critic's target, for a shot is a whole episode and nothing follows it; they are the averaged weights
//! that play, are evaluated and are shipped.

use candle_core::{Device, Result, Tensor, bail};
use candle_nn::ops::sigmoid;
use rand::Rng;

use super::{
    action::{ACTIONS, Action},
    adam::{Adam, soft_update},
    hyperparameters::Hyperparameters,
    mlp::Wanted,
    networks::Networks,
    scenes::Scenes,
};

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
    pub(super) hyper: Hyperparameters,
    pub(super) online: Networks,
    pub(super) target: Networks,
    pub(super) actor_optimiser: Adam,
    pub(super) critic_optimiser: Adam,
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
        let count = actions.len();
        let actions = Tensor::from_slice(actions.as_flattened(), (count, ACTIONS), &Device::Cpu)?;
        let successes = Tensor::from_slice(successes, (count, 1), &Device::Cpu)?;
        let critic = &self.online.critic;
        let record = critic.record(&scenes.with_actions(&actions)?, Wanted::Parameters)?;
        let logits = record.outputs();
        // The gradient of the mean cross entropy along a logit: what was expected minus what happened.
        let errors = ((sigmoid(logits)? - &successes)? / count as f64)?;
        let rate = pace * self.hyper.critic_learning_rate;
        let (_, gradient) = record.backward(&errors)?;
        self.critic_optimiser.step(critic.parameters(), &wanted(gradient)?, rate, self.hyper.gradient_clip)?;
        mean_cross_entropy(logits, &successes)
    }

    /// One step up the deterministic policy gradient: every head climbs the critic from its own action.
    fn update_actor(&mut self, scenes: &Scenes, pace: f64) -> Result<f64> {
        let Networks { actor, critic } = &self.online;
        let proposed = actor.record(scenes.states(), Wanted::Parameters)?;
        let actions = proposed.outputs().tanh()?.reshape(((), ACTIONS))?;
        let (inputs, join) = scenes.record_actions(&actions)?;
        let judged = critic.record(&inputs, Wanted::Inputs)?;
        let success = sigmoid(judged.outputs())?;

        // Along a logit, the probability s rises with s (1 - s) and the logit itself with 1.
        let slope = ((&success * (1.0 - &success)?)? + self.hyper.logit_weight)?;
        let (along_inputs, _) = judged.backward(&(slope / -(success.elem_count() as f64))?)?;
        let along_actions = join.backward(&wanted(along_inputs)?)?;
        // The slope of the hyperbolic tangent is 1 - tanh².
        let along_outputs = (along_actions * (1.0 - actions.sqr()?)?)?.reshape(proposed.outputs().shape())?;
        let (_, gradient) = proposed.backward(&along_outputs)?;

        let rate = pace * self.hyper.actor_learning_rate;
        self.actor_optimiser.step(actor.parameters(), &wanted(gradient)?, rate, self.hyper.gradient_clip)?;
        Ok(-f64::from(success.mean_all()?.to_scalar::<f32>()?))
    }
}

/// Mean cross entropy of success probabilities, given as logits, against what happened. candle-nn's own gives NaN once
/// a probability rounds to 0 or 1.
fn mean_cross_entropy(logits: &Tensor, successes: &Tensor) -> Result<f64> {
    let softplus = (logits.relu()? + (logits.abs()?.neg()?.exp()? + 1.0)?.log()?)?;
    Ok(f64::from((softplus - (logits * successes)?)?.mean_all()?.to_scalar::<f32>()?))
}

fn wanted(gradient: Option<Tensor>) -> Result<Tensor> {
    match gradient {
        Some(gradient) => Ok(gradient),
        None => bail!("this gradient was not recorded"),
    }
}
