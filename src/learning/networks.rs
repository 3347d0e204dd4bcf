//! The actor and the critic, and what they say about a batch of views.

use candle_core::{Result, Tensor};
use rand::Rng;

use super::{
    action::{ACTIONS, Action, aim_at},
    hyperparameters::Hyperparameters,
    mlp::Mlp,
    scenes::{ACTOR_INPUTS, CRITIC_INPUTS, Scenes},
};

/// An actor and a critic.
#[derive(Clone, Debug)]
pub struct Networks {
    /// From a view to the heads' actions, before the squashing.
    pub actor: Mlp,
    /// From a view and an action to the logit of success.
    pub critic: Mlp,
}

impl Networks {
    /// New networks: the heads start at offsets spread over the ball and at middle speed, the critic at one half.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn random(hyper: &Hyperparameters, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        let mut start = Vec::with_capacity(hyper.heads * ACTIONS);
        for head in 0..hyper.heads {
            let offset = (head as f64 + 0.5) / hyper.heads as f64;
            start.extend([aim_at(offset).atanh(), 0.0]);
        }
        let sizes = |inputs, hidden: &[usize], outputs| [&[inputs], hidden, &[outputs]].concat();
        let actor_sizes = sizes(ACTOR_INPUTS, &hyper.actor_layers, hyper.heads * ACTIONS);
        let critic_sizes = sizes(CRITIC_INPUTS, &hyper.critic_layers, 1);
        Ok(Self {
            actor: Mlp::random(&actor_sizes, rng)?.with_output_bias(&start)?,
            critic: Mlp::random(&critic_sizes, rng)?,
        })
    }

    /// A copy with its own parameters.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn duplicate(&self) -> Result<Self> {
        Ok(Self { actor: self.actor.duplicate()?, critic: self.critic.duplicate()? })
    }

    /// The heads' actions, the heads of a view one after the other.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn actions(&self, scenes: &Scenes) -> Result<Vec<Action>> {
        actions_of(&self.propose(scenes)?)
    }

    /// The heads' actions and the critic's logit of success for each.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn judge(&self, scenes: &Scenes) -> Result<(Vec<Action>, Vec<f32>)> {
        let actions = self.propose(scenes)?;
        let logits = self.critic.forward_frozen(&scenes.with_actions(&actions)?)?;
        Ok((actions_of(&actions)?, logits.flatten_all()?.to_vec1()?))
    }

    fn propose(&self, scenes: &Scenes) -> Result<Tensor> {
        self.actor.forward_frozen(scenes.states())?.tanh()?.reshape(((), ACTIONS))
    }
}

fn actions_of(tensor: &Tensor) -> Result<Vec<Action>> {
    Ok(tensor.flatten_all()?.to_vec1::<f32>()?.as_chunks::<ACTIONS>().0.to_vec())
}
