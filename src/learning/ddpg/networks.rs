//! The actor and the critic, and what they say about a batch of observations.

use candle_core::{Result, Tensor};
use rand::Rng;

use super::{
    action::{Action, aim_at},
    context::Inputs,
    hyperparameters::Hyperparameters,
    observation::Observation,
    observation_batch::{ObservationBatch, Seen, actions_in},
    squash::Squash,
};
use crate::learning::nn::mlp::{Mlp, Operations};

/// Steps of a sequence that fills the square evenly (powers of the inverse of the plastic number, Roberts 2018).
const TIP_STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];

/// An actor and a critic.
#[derive(Clone, Debug)]
pub struct Networks {
    /// From an observation to the heads' actions, before the squashing.
    pub actor: Mlp,
    /// From an observation and an action to the logit of success.
    pub critic: Mlp,
    squash: Squash,
}

impl Networks {
    /// Networks that were made with these settings.
    pub fn new(hyper: &Hyperparameters, actor: Mlp, critic: Mlp) -> Result<Self> {
        let squash = Squash::new(hyper, actor.sizes().last().copied().unwrap_or(0))?;
        Ok(Self { actor, critic, squash })
    }

    /// New networks: the heads start at offsets spread over the ball, at the middle of their speeds, at middle elevation and with
    /// tips here and there; the critic starts at one half.
    pub fn random(hyper: &Hyperparameters, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        let outputs = hyper.actions.actions();
        let mut start = Vec::with_capacity(hyper.heads * outputs);
        for head in 0..hyper.heads {
            let offset = (head as f64 + 0.5) / hyper.heads as f64;
            let tip = TIP_STEPS.map(|step| ((0.5 + step * head as f64).fract() - 0.5) as f32);
            start.extend_from_slice(&[aim_at(offset).atanh(), 0.0, tip[0], tip[1], 0.0][..outputs]);
        }
        let [actor, critic] = hyper.sizes();
        let actor = Mlp::random(&actor, rng)?.with_output_bias(&start)?;
        Self::new(hyper, actor, Mlp::random(&critic, rng)?)
    }

    /// A copy with its own parameters.
    pub fn duplicate(&self) -> Result<Self> {
        let (actor, critic) = (self.actor.duplicate()?, self.critic.duplicate()?);
        Ok(Self { actor, critic, squash: self.squash.clone() })
    }

    /// These networks with other operations.
    #[must_use]
    pub fn with(self, operations: Operations) -> Self {
        Self { actor: self.actor.with(operations), critic: self.critic.with(operations), ..self }
    }

    /// The heads' actions, the heads of an observation one after the other.
    pub fn actions(&self, observed: &ObservationBatch) -> Result<Vec<Action>> {
        actions_in(observed.space(), &self.propose(observed)?)
    }

    /// The heads' actions and the critic's logit of success for each.
    pub fn judge(&self, observed: &ObservationBatch) -> Result<(Vec<Action>, Vec<f32>)> {
        let actions = self.propose(observed)?;
        let logits = self.critic.forward_frozen(&observed.with_actions(&actions)?)?;
        Ok((actions_in(observed.space(), &actions)?, logits.flatten_all()?.to_vec1()?))
    }

    /// What all heads propose in what is `seen` of so many layouts, of each alike, layout by layout: the observation, the action and the
    /// critic's logit, an observation's heads one after the other.
    pub fn proposals(
        &self,
        inputs: Inputs,
        seen: Vec<Seen>,
        layouts: usize,
    ) -> Result<Vec<Vec<(Observation, Action, f32)>>> {
        if layouts == 0 {
            return Ok(Vec::new());
        }
        let observed = ObservationBatch::new(inputs, seen)?;
        let (actions, logits) = self.judge(&observed)?;
        let (heads, each) = (actions.len() / observed.seen().len(), actions.len() / layouts);
        let all = actions.into_iter().zip(logits).enumerate();
        let all = all.map(|(row, (action, logit))| (observed.seen()[row / heads].observation, action, logit));
        Ok(all.collect::<Vec<_>>().chunks(each).map(<[_]>::to_vec).collect())
    }

    /// The actions that the actor's outputs stand for, a row each; gradients flow to the outputs.
    pub fn squash(&self, outputs: &Tensor) -> Result<Tensor> {
        self.squash.actions(outputs)
    }

    fn propose(&self, observed: &ObservationBatch) -> Result<Tensor> {
        self.squash.actions(&self.actor.forward_frozen(observed.states())?)
    }
}
