//! Deep deterministic policy gradient (Lillicrap et al. 2016; thesis 4.4) with several actor heads.
//!
//! What differs from the thesis' agent, and why, stands at the fields of [`Hyperparameters`]. The target networks take
//! no part in the critic's target, for a shot is a whole episode and nothing follows it; they are the averaged weights
//! that play, are evaluated and are shipped.

use candle_core::{DType, Device, Result, Tensor};
use candle_nn::{Module, Optimizer, ops::sigmoid};
use rand::Rng;

use super::{
    action::{ACTIONS, Action},
    hyperparameters::Hyperparameters,
    networks::Networks,
    observation::Observation,
    observation_batch::{ObservationBatch, action_rows},
    randomized_tables::Conditions,
};
use crate::learning::{
    learner::UpdateStats,
    nn::adam::{Adam, soft_update},
};

/// Outputs of the actor beyond which the hyperbolic tangent, 0.96 here, hardly has a slope.
const SATURATED: f64 = 2.0;

/// Weights of the squared differences in [`Ddpg::imitation_loss`]: a small error of the aim loses the point, the same share of the
/// speed seldom does.
const WAY_WEIGHTS: [f32; ACTIONS] = [4.0, 1.0, 1.0, 1.0, 1.0];

/// One shot as the replay buffer holds it: what was seen, what was done, what it earned. A shot is a whole episode, so there is no next state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    pub observation: Observation,
    pub conditions: Conditions,
    pub action: Action,
    /// What that earned, as a share of the most that there is to earn.
    pub success: f32,
}

/// Shots to learn from: as many observations as actions and successes.
#[derive(Clone, Debug)]
pub struct ShotBatch {
    pub observed: ObservationBatch,
    /// The action that was taken in each observation.
    pub actions: Vec<Action>,
    /// The success, 0 to 1, that each had.
    pub successes: Vec<f32>,
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
    pub fn new(hyper: Hyperparameters, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        Self::starting_from(Networks::random(&hyper, rng)?, hyper)
    }

    /// An agent that begins to learn with these networks.
    pub fn starting_from(online: Networks, hyper: Hyperparameters) -> Result<Self> {
        let [actor, critic] = hyper.adam();
        Ok(Self {
            target: online.duplicate()?,
            actor_optimiser: Adam::new(vec![online.actor.parameters().clone()], actor)?,
            critic_optimiser: Adam::new(vec![online.critic.parameters().clone()], critic)?,
            online,
            hyper,
        })
    }

    /// Learns from a batch of shots that were played, and the actor besides from the best strokes that searches have found.
    /// `lr_factor` scales both learning rates. Returns the critic's mean cross entropy, nats, and its mean probability of success over
    /// all heads.
    ///
    /// # Errors
    /// Where sizes differ, or where the networks no longer give finite numbers.
    pub fn update(&mut self, played: &ShotBatch, searched: Option<&ShotBatch>, lr_factor: f64) -> Result<UpdateStats> {
        let loss = self.critic_loss(played)?;
        self.critic_optimiser.set_learning_rate(lr_factor * self.hyper.critic_learning_rate);
        self.critic_optimiser.backward_step(&loss)?;

        let (mut climbed, probability) = self.actor_goal(&played.observed.first(self.hyper.actor_batch)?)?;
        if let Some(searched) = searched {
            climbed = (climbed - (self.imitation_loss(searched)? * self.hyper.imitation)?)?;
        }
        self.actor_optimiser.set_learning_rate(lr_factor * self.hyper.actor_learning_rate);
        self.actor_optimiser.backward_step(&climbed.neg()?)?;

        soft_update(self.target.critic.parameters(), self.online.critic.parameters(), self.hyper.target_rate)?;
        soft_update(self.target.actor.parameters(), self.online.actor.parameters(), self.hyper.target_rate)?;
        let number = |tensor: &Tensor| tensor.to_scalar::<f32>().map(f64::from);
        Ok(UpdateStats { loss: number(&loss)?, value: number(&probability)? })
    }

    /// The mean cross entropy between the critic's probabilities and what happened.
    fn critic_loss(&self, ShotBatch { observed, actions, successes }: &ShotBatch) -> Result<Tensor> {
        let taken = action_rows(observed.space(), actions)?;
        let successes = Tensor::from_slice(successes, (actions.len(), 1), &Device::Cpu)?;
        let logits = self.online.critic.forward(&observed.with_actions(&taken)?)?;
        mean_cross_entropy(&logits, &successes)
    }

    /// The mean square of the way from searched strokes to the nearest head's, where the critic does not think the head's to be better
    /// (the filter of Nair et al. 2018).
    fn imitation_loss(&self, ShotBatch { observed, actions, successes }: &ShotBatch) -> Result<Tensor> {
        let (space, rows) = (observed.space(), actions.len());
        let used = space.actions();
        let proposed = self.online.squash(&self.online.actor.forward(&observed.states)?)?;
        let wanted = action_rows(space, actions)?.reshape((rows, 1, used))?;
        let weights = Tensor::new(&WAY_WEIGHTS[..used], &Device::Cpu)?;
        let apart =
            proposed.reshape((rows, (), used))?.broadcast_sub(&wanted)?.sqr()?.broadcast_mul(&weights)?.sum(2)?;
        let nearest = apart.argmin_keepdim(1)?;
        let heads = apart.dim(1)?;
        let first: Vec<u32> = (0..rows).map(|row| (row * heads) as u32).collect();
        let own = (Tensor::from_vec(first, rows, &Device::Cpu)? + nearest.flatten_all()?)?;
        let thought =
            self.online.critic.forward_frozen(&observed.with_actions(&proposed.detach().index_select(&own, 0)?)?)?;
        let made = Tensor::from_slice(successes, (rows, 1), &Device::Cpu)?;
        let is_worse = sigmoid(&thought)?.le(&made)?.to_dtype(DType::F32)?;
        (apart.gather(&nearest, 1)? * is_worse)?.mean_all()
    }

    /// What the actor climbs, from every head's own action (the deterministic policy gradient): the mean of the critic's
    /// probability and of a share of its logit, less what saturated outputs cost; beside it the mean probability.
    fn actor_goal(&self, observed: &ObservationBatch) -> Result<(Tensor, Tensor)> {
        let outputs = self.online.actor.forward(&observed.states)?;
        let actions = self.online.squash(&outputs)?;
        let logits = self.online.critic.forward_frozen(&observed.with_actions(&actions)?)?;
        let probability = sigmoid(&logits)?.mean_all()?;
        let goal = (&probability + (logits.mean_all()? * self.hyper.logit_weight)?)?;
        if self.hyper.saturation_penalty == 0.0 {
            return Ok((goal, probability));
        }
        let beyond = (outputs.abs()? - SATURATED)?.relu()?.sqr()?.mean_all()?;
        Ok(((goal - (beyond * self.hyper.saturation_penalty)?)?, probability))
    }
}

/// Mean cross entropy of success probabilities, given as logits, against what happened. candle-nn's own gives NaN once
/// a probability rounds to 0 or 1.
fn mean_cross_entropy(logits: &Tensor, successes: &Tensor) -> Result<Tensor> {
    let softplus = (logits.relu()? + (logits.abs()?.neg()?.exp()? + 1.0)?.log()?)?;
    (softplus - (logits * successes)?)?.mean_all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::{
            ddpg::{
                action::ActionSpace,
                features::{FREE_PATHS, STATE_FEATURES},
            },
            nn::mlp::Mlp,
        },
        table::{Layout, Table},
    };
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;
    use std::sync::Arc;

    #[test]
    fn a_saturated_actor_comes_back_where_that_costs_something() {
        let outputs = |penalty: f64| {
            let (mut agent, batch) = agent_and_batch(ActionSpace::Full, 21);
            agent.hyper.saturation_penalty = penalty;
            let bias = vec![5.0; agent.hyper.heads * ActionSpace::Full.actions()];
            agent.online.actor = agent.online.actor.duplicate().unwrap().with_output_bias(&bias).unwrap();
            agent = Ddpg::starting_from(agent.online, agent.hyper).unwrap();
            for _ in 0..40 {
                agent.update(&batch, None, 1.0).unwrap();
            }
            let outputs = agent.online.actor.forward(&batch.observed.states).unwrap();
            outputs.mean_all().unwrap().to_scalar::<f32>().unwrap()
        };
        let [free, held] = [0.0, 0.1].map(outputs);
        assert!(held < free - 0.1, "{held} against {free}");
    }

    /// An agent with an opinion, and a batch for it.
    fn agent_and_batch(space: ActionSpace, seed: u64) -> (Ddpg, ShotBatch) {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let layers = vec![24, 24];
        let hyper = Hyperparameters {
            actor_layers: layers.clone(),
            critic_layers: layers.clone(),
            actions: space,
            ..Hyperparameters::default()
        };
        let agent = Ddpg::new(hyper, &mut rng).unwrap();
        for network in [&agent.online.actor, &agent.online.critic] {
            let parameters = network.parameters();
            let values: Vec<f32> = (0..parameters.elem_count()).map(|_| rng.random_range(-0.3..0.3)).collect();
            parameters.set(&Tensor::from_vec(values, parameters.shape(), &Device::Cpu).unwrap()).unwrap();
        }
        // The critic is blind to what its own slopes leave out.
        let critic = &agent.online.critic;
        let mut values = critic.parameters().to_vec1::<f32>().unwrap();
        for feature in FREE_PATHS {
            let first = (STATE_FEATURES + feature) * layers[0];
            values[first..first + layers[0]].fill(0.0);
        }
        critic.parameters().set(&Tensor::new(values, &Device::Cpu).unwrap()).unwrap();
        let table = Arc::new(Table::default());
        let observations =
            (0..20).map(|index| Observation::new(&Layout::random(&table, &mut rng), index % 4)).collect();
        let actions = (0..20).map(|_| std::array::from_fn(|_| rng.random_range(-0.9..0.9))).collect();
        let successes = (0..20).map(|_| f32::from(u8::from(rng.random_bool(0.5)))).collect();
        let observed = ObservationBatch::on(&table, space, observations).unwrap();
        (agent, ShotBatch { observed, actions, successes })
    }

    /// How far the slope of `goal` along its own gradient, by moving the parameters, is from the gradient's length; as a share.
    fn error_of_gradient(network: &Mlp, goal: impl Fn() -> Tensor) -> f64 {
        let gradients = goal().backward().unwrap();
        let gradient = gradients.get(network.parameters()).unwrap();
        let length = gradient.sqr().unwrap().sum_all().unwrap().to_scalar::<f32>().unwrap().sqrt();
        assert!(length > 1e-3);
        let start = network.parameters().copy().unwrap();
        let at = |step: f32| {
            let moved = (&start + (gradient * f64::from(step / length)).unwrap()).unwrap();
            network.parameters().set(&moved).unwrap();
            f64::from(goal().to_scalar::<f32>().unwrap())
        };
        let slope = (at(1e-3) - at(-1e-3)) / 2e-3;
        network.parameters().set(&start).unwrap();
        (slope / f64::from(length) - 1.0).abs()
    }

    #[test]
    fn both_gradients_are_slopes_of_what_is_learnt() {
        for space in [ActionSpace::PhiV, ActionSpace::Full] {
            let errors = (21..26).map(|seed| {
                let (agent, batch) = agent_and_batch(space, seed);
                let Networks { actor, critic, .. } = &agent.online;
                [
                    error_of_gradient(critic, || agent.critic_loss(&batch).unwrap()),
                    error_of_gradient(actor, || agent.actor_goal(&batch.observed).unwrap().0),
                    error_of_gradient(actor, || agent.imitation_loss(&batch).unwrap()),
                ]
            });
            let errors: Vec<_> = errors.collect();
            for which in 0..3 {
                // Where a rectified unit happens to be at its kink, the slope is the mean of two.
                let close = errors.iter().filter(|errors| errors[which] < 0.005).count();
                assert!(close >= 3 && errors.iter().all(|errors| errors[which] < 0.05), "{space:?}: {errors:?}");
            }
        }
    }

    #[test]
    fn the_actor_leaves_the_critic_as_it_is() {
        let (agent, batch) = agent_and_batch(ActionSpace::Full, 21);
        for goal in [agent.actor_goal(&batch.observed).unwrap().0, agent.imitation_loss(&batch).unwrap()] {
            let gradients = goal.backward().unwrap();
            assert!(gradients.get(agent.online.critic.parameters()).is_none());
            assert!(gradients.get(agent.online.actor.parameters()).is_some());
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
            ObservationBatch::on(&table, space, observations).unwrap()
        };
        for _ in 0..400 {
            let observed = observed(&mut rng);
            let actions: Vec<Action> = (0..128).map(|_| std::array::from_fn(|_| rng.random_range(-1.0..1.0))).collect();
            let miss = |action: &Action| (0..2).map(|k| (action[k] - BEST[k]).powi(2)).sum::<f32>();
            let successes: Vec<f32> = actions.iter().map(|action| (-4.0 * miss(action)).exp()).collect();
            agent.update(&ShotBatch { observed, actions, successes }, None, 1.0).unwrap();
        }
        let observed = observed(&mut rng);
        let (actions, logits) = agent.target.judge(&observed).unwrap();
        let heads = actions.len() / observed.seen.len();
        for (actions, logits) in actions.chunks(heads).zip(logits.chunks(heads)) {
            let best = (0..heads).max_by(|a, b| logits[*a].total_cmp(&logits[*b])).unwrap();
            let apart = [0, 1].map(|k| (actions[best][k] - BEST[k]).abs());
            assert!(apart[0] < 0.2 && apart[1] < 0.2, "{:?}", actions[best]);
        }
    }

    #[test]
    fn the_nearest_head_goes_to_where_a_search_has_been_unless_it_is_better_already() {
        let (start, batch) = agent_and_batch(ActionSpace::Full, 21);
        let way = |agent: &Ddpg, batch: &ShotBatch| agent.imitation_loss(batch).unwrap().to_scalar::<f32>().unwrap();
        let sure = ShotBatch { successes: vec![1.0; batch.actions.len()], ..batch.clone() };
        assert_eq!(way(&start, &ShotBatch { successes: vec![0.0; batch.actions.len()], ..batch.clone() }), 0.0);
        let after = |imitation| {
            let hyper = Hyperparameters { imitation, ..start.hyper.clone() };
            let mut agent = Ddpg::starting_from(start.online.duplicate().unwrap(), hyper).unwrap();
            for _ in 0..100 {
                agent.update(&batch, Some(&sure), 1.0).unwrap();
            }
            way(&agent, &sure)
        };
        let [before, alone, drawn] = [way(&start, &sure), after(0.0), after(1.0)];
        assert!(drawn < 0.5 * before && drawn < 0.5 * alone, "{before} before, {alone} alone, {drawn} drawn");
    }
}
