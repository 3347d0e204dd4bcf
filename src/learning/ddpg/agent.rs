//! Deep deterministic policy gradient (Lillicrap et al. 2016; thesis 4.4) with several actor heads.
//!
//! The fields of [`Hyperparameters`] document the differences from the thesis' agent and their reasons. A shot is a whole episode, so
//! the critic's target has no bootstrap term and does not use the target networks. These are the averaged weights that play, are
//! evaluated and are shipped.

use candle_core::{DType, Device, Result, Tensor};
use candle_nn::{Module, Optimizer, ops::sigmoid};
use rand::Rng;

use super::{
    action::{ACTIONS, Action},
    hyperparameters::Hyperparameters,
    networks::Networks,
    observation::Observation,
    observation_batch::{ObservationBatch, action_rows},
    randomized_tables::Context,
};
use crate::learning::{
    learner::UpdateStats,
    nn::{
        adam::{Adam, soft_update},
        number,
    },
};

/// Absolute output of the actor above which the hyperbolic tangent (0.96 here) has hardly any slope.
const SATURATED: f64 = 2.0;

/// Weights of the squared differences in [`Ddpg::imitation_loss`]: a small error of the aim loses the point, an equal error of the
/// speed seldom does.
const IMITATION_WEIGHTS: [f32; ACTIONS] = [4.0, 1.0, 1.0, 1.0, 1.0];

/// One shot in the replay buffer: observation, context, action and success. A shot is a whole episode, so there is no next state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    pub observation: Observation,
    pub context: Context,
    pub action: Action,
    /// Reward of the action as a share of the highest possible reward.
    pub success: f32,
}

/// A minibatch of shots, with as many observations as actions and successes.
#[derive(Clone, Debug)]
pub struct ShotBatch {
    pub observed: ObservationBatch,
    /// The action played in each observation.
    pub actions: Vec<Action>,
    /// Success of each action, 0 to 1.
    pub successes: Vec<f32>,
}

/// The agent: online networks, target networks (their moving averages) and optimiser states.
#[derive(Debug)]
pub struct Ddpg {
    pub(super) hyper: Hyperparameters,
    pub(super) online: Networks,
    pub(super) target: Networks,
    pub(super) actor_optimiser: Adam,
    pub(super) critic_optimiser: Adam,
}

impl Ddpg {
    /// Creates an untrained agent.
    pub fn new(hyper: Hyperparameters, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        Self::starting_from(Networks::random(&hyper, rng)?, hyper)
    }

    /// Creates an agent that starts learning with these networks.
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

    /// Makes one update from a minibatch of `played` shots. The actor also imitates `searched`, the best strokes found by search.
    /// `lr_factor` scales both learning rates. Returns the critic's mean cross entropy, nats, and its mean probability of success over
    /// all heads.
    ///
    /// # Errors
    /// Fails if sizes differ or the networks no longer return finite numbers.
    pub fn update(&mut self, played: &ShotBatch, searched: Option<&ShotBatch>, lr_factor: f64) -> Result<UpdateStats> {
        let loss = self.critic_loss(played)?;
        self.critic_optimiser.set_learning_rate(lr_factor * self.hyper.critic_learning_rate);
        self.critic_optimiser.backward_step(&loss)?;

        let (mut objective, probability) =
            self.actor_objective(&played.observed.first(self.hyper.actor_batch_size)?)?;
        if let Some(searched) = searched {
            objective = (objective - (self.imitation_loss(searched)? * self.hyper.imitation)?)?;
        }
        self.actor_optimiser.set_learning_rate(lr_factor * self.hyper.actor_learning_rate);
        self.actor_optimiser.backward_step(&objective.neg()?)?;

        let tau = averaging_rate(self.hyper.tau, self.critic_optimiser.steps());
        soft_update(self.target.critic.parameters(), self.online.critic.parameters(), tau)?;
        soft_update(self.target.actor.parameters(), self.online.actor.parameters(), tau)?;
        Ok(UpdateStats { loss: number(&loss)?, value: number(&probability)? })
    }

    /// Returns the mean cross entropy between the critic's probabilities and the observed successes.
    fn critic_loss(&self, ShotBatch { observed, actions, successes }: &ShotBatch) -> Result<Tensor> {
        let rows = action_rows(observed.space(), actions)?;
        let successes = Tensor::from_slice(successes, (actions.len(), 1), &Device::Cpu)?;
        let logits = self.online.critic.forward(&observed.with_actions(&rows)?)?;
        mean_cross_entropy(&logits, &successes)
    }

    /// Returns the mean weighted squared distance from each searched stroke to the nearest head's action. It counts only strokes whose
    /// success is at least the critic's probability of that action (the Q-filter of Nair et al. 2018).
    fn imitation_loss(&self, ShotBatch { observed, actions, successes }: &ShotBatch) -> Result<Tensor> {
        let (space, rows) = (observed.space(), actions.len());
        let used = space.actions();
        let proposed = self.online.squash(&self.online.actor.forward(&observed.states)?)?;
        let searched = action_rows(space, actions)?.reshape((rows, 1, used))?;
        let weights = Tensor::new(&IMITATION_WEIGHTS[..used], &Device::Cpu)?;
        let distances =
            proposed.reshape((rows, (), used))?.broadcast_sub(&searched)?.sqr()?.broadcast_mul(&weights)?.sum(2)?;
        let nearest = distances.argmin_keepdim(1)?;
        let heads = distances.dim(1)?;
        let first: Vec<u32> = (0..rows).map(|row| (row * heads) as u32).collect();
        let own = (Tensor::from_vec(first, rows, &Device::Cpu)? + nearest.flatten_all()?)?;
        let logits =
            self.online.critic.forward_frozen(&observed.with_actions(&proposed.detach().index_select(&own, 0)?)?)?;
        let successes = Tensor::from_slice(successes, (rows, 1), &Device::Cpu)?;
        let is_worse = sigmoid(&logits)?.le(&successes)?.to_dtype(DType::F32)?;
        (distances.gather(&nearest, 1)? * is_worse)?.mean_all()
    }

    /// Returns the actor's objective over every head's action (the deterministic policy gradient), and the critic's mean probability.
    /// The objective is the mean probability plus a share of the mean logit, less the penalty of saturated outputs.
    fn actor_objective(&self, observed: &ObservationBatch) -> Result<(Tensor, Tensor)> {
        let outputs = self.online.actor.forward(&observed.states)?;
        let actions = self.online.squash(&outputs)?;
        let logits = self.online.critic.forward_frozen(&observed.with_actions(&actions)?)?;
        let probability = sigmoid(&logits)?.mean_all()?;
        let objective = (&probability + (logits.mean_all()? * self.hyper.logit_weight)?)?;
        if self.hyper.saturation_penalty == 0.0 {
            return Ok((objective, probability));
        }
        let excess = (outputs.abs()? - SATURATED)?.relu()?.sqr()?.mean_all()?;
        Ok(((objective - (excess * self.hyper.saturation_penalty)?)?, probability))
    }
}

/// Returns the rate of the soft update after this number of updates: higher at first, so that the average forgets the random weights with
/// which it began (as TensorFlow's `ExponentialMovingAverage` does with `num_updates`). At a constant rate of 0.001, a fifth of them would
/// be left after 300,000 shots.
fn averaging_rate(tau: f64, updates: u32) -> f64 {
    tau.max(9.0 / (10.0 + f64::from(updates)))
}

/// Returns the mean cross entropy of success probabilities, given as logits, against the observed successes. candle-nn's own returns
/// NaN once a probability rounds to 0 or 1.
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
    fn the_average_begins_fast_and_ends_at_tau() {
        assert_eq!([0, 80, 1_000_000].map(|updates| averaging_rate(1e-3, updates)), [0.9, 0.1, 1e-3]);
        let left = |updates: u32| (1..=updates).map(|update| 1.0 - averaging_rate(1e-3, update)).product::<f64>();
        assert!(left(105) < 1e-6, "{}", left(105));
    }

    #[test]
    fn the_saturation_penalty_brings_a_saturated_actor_back() {
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
        let [free, penalised] = [0.0, 0.1].map(outputs);
        assert!(penalised < free - 0.1, "{penalised} against {free}");
    }

    /// An agent with random weights that are large enough for clear preferences, and a batch for it.
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
        // The critic ignores the features that have no slopes.
        for (network, ignored) in [(&agent.online.actor, [].as_slice()), (&agent.online.critic, &FREE_PATHS)] {
            let parameters = network.parameters();
            let mut values: Vec<f32> = (0..parameters.elem_count()).map(|_| rng.random_range(-0.3..0.3)).collect();
            for feature in ignored {
                values[(STATE_FEATURES + feature) * layers[0]..][..layers[0]].fill(0.0);
            }
            parameters.set(&Tensor::new(values, &Device::Cpu).unwrap()).unwrap();
        }
        let table = Arc::new(Table::default());
        let observations =
            (0..20).map(|index| Observation::new(&Layout::random(&table, &mut rng), index % 4)).collect();
        let actions = (0..20).map(|_| std::array::from_fn(|_| rng.random_range(-0.9..0.9))).collect();
        let successes = (0..20).map(|_| f32::from(u8::from(rng.random_bool(0.5)))).collect();
        let observed = ObservationBatch::on(&table, space, observations).unwrap();
        (agent, ShotBatch { observed, actions, successes })
    }

    /// Relative difference between the finite-difference slope of `objective` along its own gradient and the gradient's length.
    fn error_of_gradient(network: &Mlp, objective: impl Fn() -> Tensor) -> f64 {
        let gradients = objective().backward().unwrap();
        let gradient = gradients.get(network.parameters()).unwrap();
        let length = gradient.sqr().unwrap().sum_all().unwrap().to_scalar::<f32>().unwrap().sqrt();
        assert!(length > 1e-3);
        let start = network.parameters().copy().unwrap();
        let at = |step: f32| {
            let moved = (&start + (gradient * f64::from(step / length)).unwrap()).unwrap();
            network.parameters().set(&moved).unwrap();
            f64::from(objective().to_scalar::<f32>().unwrap())
        };
        let slope = (at(1e-3) - at(-1e-3)) / 2e-3;
        network.parameters().set(&start).unwrap();
        (slope / f64::from(length) - 1.0).abs()
    }

    #[test]
    fn all_gradients_agree_with_finite_differences() {
        for space in [ActionSpace::PhiV, ActionSpace::Full] {
            let errors = (21..26).map(|seed| {
                let (agent, batch) = agent_and_batch(space, seed);
                let Networks { actor, critic, .. } = &agent.online;
                [
                    error_of_gradient(critic, || agent.critic_loss(&batch).unwrap()),
                    error_of_gradient(actor, || agent.actor_objective(&batch.observed).unwrap().0),
                    error_of_gradient(actor, || agent.imitation_loss(&batch).unwrap()),
                ]
            });
            let errors: Vec<_> = errors.collect();
            for which in 0..3 {
                // If a rectified unit is just at its kink, the finite difference is the mean of two slopes.
                let close = errors.iter().filter(|errors| errors[which] < 0.005).count();
                assert!(close >= 3 && errors.iter().all(|errors| errors[which] < 0.05), "{space:?}: {errors:?}");
            }
        }
    }

    #[test]
    fn actor_objectives_leave_the_critic_unchanged() {
        let (agent, batch) = agent_and_batch(ActionSpace::Full, 21);
        for objective in [agent.actor_objective(&batch.observed).unwrap().0, agent.imitation_loss(&batch).unwrap()] {
            let gradients = objective.backward().unwrap();
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
        // Success is certain at one action, independent of the layout, and falls with the distance from this action.
        const BEST: [f32; 2] = [0.3, -0.4];
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(22);
        let layers = vec![32, 32];
        let hyper = Hyperparameters {
            actor_layers: layers.clone(),
            critic_layers: layers,
            tau: 0.02,
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
        let observations = observed(&mut rng).observations.to_vec();
        let proposals = agent.target.proposals(agent.hyper.inputs(), observations).unwrap();
        for proposals in proposals.chunks(agent.hyper.heads) {
            let (_, best, _) = proposals.iter().max_by(|(.., a), (.., b)| a.total_cmp(b)).unwrap();
            let errors = [0, 1].map(|k| (best[k] - BEST[k]).abs());
            assert!(errors[0] < 0.2 && errors[1] < 0.2, "{best:?}");
        }
    }

    #[test]
    fn the_nearest_head_imitates_better_searched_strokes() {
        let (start, batch) = agent_and_batch(ActionSpace::Full, 21);
        let loss = |agent: &Ddpg, batch: &ShotBatch| agent.imitation_loss(batch).unwrap().to_scalar::<f32>().unwrap();
        let sure = ShotBatch { successes: vec![1.0; batch.actions.len()], ..batch.clone() };
        assert_eq!(loss(&start, &ShotBatch { successes: vec![0.0; batch.actions.len()], ..batch.clone() }), 0.0);
        let after = |imitation| {
            let hyper = Hyperparameters { imitation, ..start.hyper.clone() };
            let mut agent = Ddpg::starting_from(start.online.duplicate().unwrap(), hyper).unwrap();
            for _ in 0..100 {
                agent.update(&batch, Some(&sure), 1.0).unwrap();
            }
            loss(&agent, &sure)
        };
        let [before, without, with] = [loss(&start, &sure), after(0.0), after(1.0)];
        assert!(
            with < 0.5 * before && with < 0.5 * without,
            "{before} before, {without} without, {with} with imitation"
        );
    }
}
