//! Deep deterministic policy gradient (Lillicrap et al. 2016; thesis 4.4) with several actor heads.
//!
//! What differs from the thesis' agent, and why, stands at the fields of [`Hyperparameters`]. The target networks take
//! no part in the critic's target, for a shot is a whole episode and nothing follows it; they are the averaged weights
//! that play, are evaluated and are shipped.

use candle_core::{Device, Result, Tensor, bail};
use candle_nn::ops::sigmoid;
use rand::Rng;

use super::{
    action::Action,
    hyperparameters::Hyperparameters,
    networks::Networks,
    observation_batch::{ObservationBatch, action_rows},
};
use crate::learning::network::{
    adam::{Adam, soft_update},
    pass::Wanted,
};

/// What an update reports.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UpdateStats {
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

    /// Learns from a batch of shots: `observed`, the action taken in each and the success, 0 to 1, that it had.
    /// `lr_factor` scales both learning rates.
    ///
    /// # Errors
    /// Where sizes differ, or where the networks no longer give finite numbers.
    pub fn update(
        &mut self,
        observed: &ObservationBatch,
        actions: &[Action],
        successes: &[f32],
        lr_factor: f64,
    ) -> Result<UpdateStats> {
        let count = observed.observations().len();
        if actions.len() != count || successes.len() != count {
            bail!("{count} observations, {} actions and {} successes are no batch", actions.len(), successes.len());
        }
        let (clip, rate) = (self.hyper.gradient_clip, lr_factor * self.hyper.critic_learning_rate);
        let (gradient, critic) = self.critic_gradient(observed, actions, successes)?;
        self.critic_optimiser.step(self.online.critic.parameters(), &gradient, rate, clip)?;

        let rate = lr_factor * self.hyper.actor_learning_rate;
        let (gradient, actor) = self.actor_gradient(&observed.first(self.hyper.actor_batch)?)?;
        self.actor_optimiser.step(self.online.actor.parameters(), &gradient, rate, clip)?;

        soft_update(self.target.critic.parameters(), self.online.critic.parameters(), self.hyper.target_rate)?;
        soft_update(self.target.actor.parameters(), self.online.actor.parameters(), self.hyper.target_rate)?;
        Ok(UpdateStats { critic, actor })
    }

    /// The mean cross entropy between the critic's probabilities and what happened, and its gradient.
    fn critic_gradient(
        &self,
        observed: &ObservationBatch,
        actions: &[Action],
        successes: &[f32],
    ) -> Result<(Tensor, f64)> {
        let count = actions.len();
        let actions = action_rows(observed.space(), actions)?;
        let successes = Tensor::from_slice(successes, (count, 1), &Device::Cpu)?;
        let judged = self.online.critic.record(&observed.with_actions(&actions)?, Wanted::Parameters)?;
        let logits = judged.outputs();
        // Along a logit the cross entropy rises with what was expected minus what happened.
        let errors = ((sigmoid(logits)? - &successes)? / count as f64)?;
        let (_, gradient) = judged.backward(&errors)?;
        let loss = mean_cross_entropy(logits, &successes)?.to_scalar::<f32>()?;
        Ok((wanted(gradient)?, f64::from(loss)))
    }

    /// The deterministic policy gradient, downhill: every head climbs the critic from its own action. The number is
    /// minus the mean probability that the critic gives the heads.
    fn actor_gradient(&self, observed: &ObservationBatch) -> Result<(Tensor, f64)> {
        let Networks { actor, critic } = &self.online;
        let proposed = actor.record(observed.states(), Wanted::Parameters)?;
        let actions = proposed.outputs().tanh()?.reshape(((), observed.space().actions()))?;
        let (inputs, join) = observed.record_actions(&actions)?;
        let judged = critic.record(&inputs, Wanted::Inputs)?;
        let success = sigmoid(judged.outputs())?;

        // Along a logit the probability s rises with s (1 - s), and the logit itself with 1.
        let slope = ((&success * (1.0 - &success)?)? + self.hyper.logit_weight)?;
        let (along_inputs, _) = judged.backward(&(slope / -(success.elem_count() as f64))?)?;
        let along_actions = join.backward(&wanted(along_inputs)?)?;
        // The slope of the hyperbolic tangent is 1 - tanh².
        let along_outputs = (along_actions * (1.0 - actions.sqr()?)?)?.reshape(proposed.outputs().shape())?;
        let (_, gradient) = proposed.backward(&along_outputs)?;
        Ok((wanted(gradient)?, -f64::from(success.mean_all()?.to_scalar::<f32>()?)))
    }
}

/// Mean cross entropy of success probabilities, given as logits, against what happened. candle-nn's own gives NaN once
/// a probability rounds to 0 or 1.
fn mean_cross_entropy(logits: &Tensor, successes: &Tensor) -> Result<Tensor> {
    let softplus = (logits.relu()? + (logits.abs()?.neg()?.exp()? + 1.0)?.log()?)?;
    (softplus - (logits * successes)?)?.mean_all()
}

fn wanted(gradient: Option<Tensor>) -> Result<Tensor> {
    match gradient {
        Some(gradient) => Ok(gradient),
        None => bail!("this gradient was not recorded"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::{action::ActionSpace, observation::Observation},
        table::{Layout, Table},
    };
    use candle_core::Var;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;
    use std::sync::Arc;

    /// An agent with an opinion, and a batch for it.
    fn agent_and_batch(space: ActionSpace) -> (Ddpg, ObservationBatch, Vec<Action>, Vec<f32>) {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(21);
        let layers = vec![24, 24];
        let hyper = Hyperparameters {
            actor_layers: layers.clone(),
            critic_layers: layers,
            actions: space,
            ..Hyperparameters::default()
        };
        let agent = Ddpg::new(hyper, &mut rng).unwrap();
        for network in [&agent.online.actor, &agent.online.critic] {
            let parameters = network.parameters();
            let values: Vec<f32> = (0..parameters.elem_count()).map(|_| rng.random_range(-0.3..0.3)).collect();
            parameters.set(&Tensor::from_vec(values, parameters.shape(), &Device::Cpu).unwrap()).unwrap();
        }
        let table = Arc::new(Table::default());
        let observations =
            (0..20).map(|index| Observation::new(&Layout::random(&table, &mut rng), index % 4)).collect();
        let actions = (0..20).map(|_| std::array::from_fn(|_| rng.random_range(-0.9..0.9))).collect();
        let successes = (0..20).map(|_| f32::from(u8::from(rng.random_bool(0.5)))).collect();
        (agent, ObservationBatch::new(&table, space, observations).unwrap(), actions, successes)
    }

    fn assert_close(ours: &Tensor, loss: &Tensor, parameters: &Var) {
        let gradients = loss.backward().unwrap();
        let theirs = gradients.get(parameters).unwrap().to_vec1::<f32>().unwrap();
        let largest = theirs.iter().fold(0.0, |largest: f32, x| largest.max(x.abs()));
        assert!(largest > 1e-4);
        for (ours, theirs) in ours.to_vec1::<f32>().unwrap().iter().zip(theirs) {
            assert!((ours - theirs).abs() < 1e-5 * largest.max(1.0), "{ours} against {theirs}");
        }
    }

    #[test]
    fn the_critics_gradient_is_candles_gradient_of_the_cross_entropy() {
        for space in [ActionSpace::PhiV, ActionSpace::Full] {
            let (agent, observed, actions, successes) = agent_and_batch(space);
            let (gradient, loss) = agent.critic_gradient(&observed, &actions, &successes).unwrap();
            let critic = &agent.online.critic;
            let actions = action_rows(observed.space(), &actions).unwrap();
            let successes = Tensor::from_slice(&successes, (20, 1), &Device::Cpu).unwrap();
            let logits = critic.forward(&observed.with_actions(&actions).unwrap()).unwrap();
            let theirs = mean_cross_entropy(&logits, &successes).unwrap();
            assert_eq!(f64::from(theirs.to_scalar::<f32>().unwrap()), loss);
            assert_close(&gradient, &theirs, critic.parameters());
        }
    }

    #[test]
    fn the_actors_gradient_is_candles_gradient_of_what_it_climbs() {
        for space in [ActionSpace::PhiV, ActionSpace::Full] {
            let (agent, observed, ..) = agent_and_batch(space);
            let (gradient, _) = agent.actor_gradient(&observed).unwrap();
            let actions = agent
                .online
                .actor
                .forward(observed.states())
                .unwrap()
                .tanh()
                .unwrap()
                .reshape(((), observed.space().actions()))
                .unwrap();
            let logits = agent.online.critic.forward_frozen(&observed.with_actions(&actions).unwrap()).unwrap();
            let weighted = (&logits * agent.hyper.logit_weight).unwrap();
            let climbed = (sigmoid(&logits).unwrap() + weighted).unwrap().mean_all().unwrap();
            assert_close(&gradient, &climbed.neg().unwrap(), agent.online.actor.parameters());
        }
    }

    #[test]
    fn cross_entropy_stays_finite_where_the_critic_is_certain() {
        let logits = Tensor::new(&[[200.0f32], [-200.0]], &Device::Cpu).unwrap();
        let successes = Tensor::new(&[[0.0f32], [0.0]], &Device::Cpu).unwrap();
        assert_eq!(mean_cross_entropy(&logits, &successes).unwrap().to_scalar::<f32>().unwrap(), 100.0);
    }

    #[test]
    fn a_task_with_a_known_optimum_is_solved() {
        // Success is certain at one action, whatever the layout, and fades with the distance from there.
        const BEST: [f32; 2] = [0.3, -0.4];
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(22);
        let layers = vec![32, 32];
        let hyper = Hyperparameters {
            actor_layers: layers.clone(),
            critic_layers: layers,
            target_rate: 0.02,
            critic_learning_rate: 3e-3,
            actor_learning_rate: 3e-3,
            actions: ActionSpace::PhiV,
            ..Hyperparameters::default()
        };
        let space = hyper.actions;
        let mut agent = Ddpg::new(hyper, &mut rng).unwrap();
        let table = Arc::new(Table::default());
        let observed = |rng: &mut Xoshiro256PlusPlus| {
            let observations =
                (0..128).map(|index| Observation::new(&Layout::random(&table, rng), index % 4)).collect();
            ObservationBatch::new(&table, space, observations).unwrap()
        };
        for _ in 0..400 {
            let observed = observed(&mut rng);
            let actions: Vec<Action> = (0..128).map(|_| std::array::from_fn(|_| rng.random_range(-1.0..1.0))).collect();
            let miss = |action: &Action| (0..2).map(|k| (action[k] - BEST[k]).powi(2)).sum::<f32>();
            let successes: Vec<f32> = actions.iter().map(|action| (-4.0 * miss(action)).exp()).collect();
            agent.update(&observed, &actions, &successes, 1.0).unwrap();
        }
        let observed = observed(&mut rng);
        let (actions, logits) = agent.target.judge(&observed).unwrap();
        let heads = actions.len() / observed.observations().len();
        for (actions, logits) in actions.chunks(heads).zip(logits.chunks(heads)) {
            let best = (0..heads).max_by(|a, b| logits[*a].total_cmp(&logits[*b])).unwrap();
            let apart = [0, 1].map(|k| (actions[best][k] - BEST[k]).abs());
            assert!(apart[0] < 0.2 && apart[1] < 0.2, "{:?}", actions[best]);
        }
    }

    #[test]
    fn a_batch_of_unequal_parts_is_refused() {
        let (mut agent, observed, actions, successes) = agent_and_batch(ActionSpace::PhiV);
        assert!(agent.update(&observed, &actions[1..], &successes, 1.0).is_err());
    }
}
