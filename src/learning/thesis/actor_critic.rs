//! A plain actor-critic pair and its update (thesis Algorithm 4), with candle's modules, optimiser and gradients.

use candle_core::{Device, Result, Tensor};
use candle_nn::{Module, Optimizer};
use rand::Rng;

use super::{
    environment::{ACTIONS, STATES},
    replay::Batch,
};
use crate::learning::{
    learner::UpdateStats,
    nn::{
        adam::{Adam, AdamConfig, soft_update},
        mlp::{Mlp, Operations, parameter_count},
        number,
        squared_error::squared_error,
        weights::{WeightsError, units},
    },
};

/// Returns the layer sizes of an actor (state to action) and of a critic (state and action to one value) with these hidden layers.
pub fn sizes(actor: &[usize], critic: &[usize]) -> [Vec<usize>; 2] {
    [[&[STATES], actor, &[ACTIONS]].concat(), [&[STATES + ACTIONS], critic, &[1]].concat()]
}

/// Learning rate, gradient clipping and soft update (thesis Table 4; the clipping is that of keras-rl's example).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    pub adam: AdamConfig,
    /// Soft update: `target = polyak * target + (1 - polyak) * online` (equation 59, with k in place of polyak).
    pub polyak: f64,
}

/// The actor's loss: the deterministic policy gradient and further terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActorLoss {
    /// Weight of the deterministic policy gradient, the ascent on the critic.
    pub policy_gradient: f64,
    /// Number of lessons, which are the first rows of a batch: the actor moves towards the actions in these rows.
    pub lessons: usize,
    /// Weight of the lessons (behaviour cloning).
    pub cloning: f64,
    /// Standard deviations, in direction and speed, of the Gaussian by which a lesson counts less the farther it is from the actor's own
    /// action. If several different shots make the point, the actor follows the nearest one and not their mean, which makes none.
    pub width: [f64; 2],
    /// Weight of the penalty on actions out of range.
    pub bounds_penalty: f64,
}

impl ActorLoss {
    /// The policy gradient alone.
    pub const POLICY_GRADIENT: Self =
        Self { policy_gradient: 1.0, lessons: 0, cloning: 0.0, width: [1.0; 2], bounds_penalty: 0.0 };

    /// Returns the loss, from the sum of the critic's values of its `actions`.
    fn of(&self, values: &Tensor, actions: &Tensor, batch: &Batch) -> Result<Tensor> {
        let rows = actions.dim(0)? as f64;
        let mut loss = (values * (-self.policy_gradient / rows))?;
        if self.lessons > 0 {
            // Ascent on a Gaussian around each lesson is ascent on the success of an action with noise of that width.
            let [own, demonstrated] = [actions, &batch.actions].map(|actions| actions.narrow(0, 0, self.lessons));
            let scale = Tensor::new(&self.width.map(|width| (1.0 / width) as f32), &Device::Cpu)?;
            let squared_distance = (own? - demonstrated?)?.broadcast_mul(&scale)?.sqr()?.sum(1)?;
            let gaussians = (squared_distance * -0.5)?.exp()?.sum_all()?;
            loss = (loss - (gaussians * (self.cloning * self.width[0] / rows))?)?;
        }
        if self.bounds_penalty > 0.0 {
            let excess = (actions - actions.detach().clamp(-1f32, 1f32)?)?;
            loss = (loss + (excess.sqr()?.sum_all()? * (0.5 * self.bounds_penalty / rows))?)?;
        }
        Ok(loss)
    }
}

/// An actor and a critic with their target networks and optimisers. Each array contains the actor's first, then the critic's.
#[derive(Debug)]
pub struct ActorCritic {
    rates: Rates,
    online: [Mlp; 2],
    target: [Mlp; 2],
    optimisers: [Adam; 2],
}

impl ActorCritic {
    /// Creates networks of these [`sizes`] with weights drawn from `rng` (Glorot and Bengio 2010). The target networks start as copies.
    pub fn random([actor, critic]: &[Vec<usize>; 2], rates: Rates, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        Self::starting_from([Mlp::glorot(actor, rng)?, Mlp::glorot(critic, rng)?], rates)
    }

    /// Starts learning with these networks: the target networks are copies, the optimisers are new.
    fn starting_from(online: [Mlp; 2], rates: Rates) -> Result<Self> {
        let [actor, critic] = &online;
        let target = [actor.duplicate()?, critic.duplicate()?];
        let optimiser = |network: &Mlp| Adam::new(vec![network.parameters().clone()], rates.adam);
        Ok(Self { optimisers: [optimiser(actor)?, optimiser(critic)?], rates, online, target })
    }

    /// Restores the networks and optimisers from the results of [`ActorCritic::values`] and [`ActorCritic::updates`].
    pub fn from_values(
        sizes: &[Vec<usize>; 2],
        rates: Rates,
        values: &[f32],
        updates: u32,
    ) -> std::result::Result<Self, WeightsError> {
        let [online, target, first, second] = split(sizes, values)?;
        let optimisers = [0, 1].map(|network: usize| {
            let moments = [&first, &second].map(|moments| moments[network].parameters().as_detached_tensor());
            Adam::resume(vec![online[network].parameters().clone()], rates.adam, vec![moments], updates)
        });
        Ok(Self { rates, online, target, optimisers })
    }

    /// Restarts learning with the online networks: the target networks become copies of them, the optimisers new.
    pub fn restarted(self) -> Result<Self> {
        Self::starting_from(self.online, self.rates)
    }

    #[must_use]
    pub fn with_operations(self, operations: Operations) -> Self {
        let [online, target] =
            [self.online, self.target].map(|pair| pair.map(|network| network.with_operations(operations)));
        Self { online, target, ..self }
    }

    pub const fn updates(&self) -> u32 {
        self.optimisers[0].steps()
    }

    /// Returns all that changes in learning: parameters, target parameters, Adam's averages of the gradient and of its square. Each
    /// part contains the actor's values, then the critic's.
    pub fn values(&self) -> Result<Vec<f32>> {
        let parameters = self.online.iter().chain(&self.target).map(|network| network.parameters().as_tensor());
        let moments = self.optimisers.iter().flat_map(Adam::moments);
        let (first, second) = (moments.clone().map(|[first, _]| first), moments.map(|[_, second]| second));
        let all = parameters.chain(first).chain(second).map(Tensor::to_vec1::<f32>);
        Ok(all.collect::<Result<Vec<_>>>()?.concat())
    }

    /// Returns the actor's actions in `states` (rows x states).
    pub fn act(&self, states: &Tensor) -> Result<Tensor> {
        self.online[0].forward_frozen(states)
    }

    /// Sets the learning rate of both optimisers to `share` of the configured one.
    pub fn scale_learning_rates(&mut self, share: f64) {
        for optimiser in &mut self.optimisers {
            optimiser.set_learning_rate(share * self.rates.adam.learning_rate);
        }
    }

    /// Makes one update: the critic's step, the actor's step and both soft updates.
    ///
    /// # Errors
    /// Fails if the networks no longer return finite numbers.
    pub fn update(&mut self, batch: &Batch, actor_loss: &ActorLoss) -> Result<UpdateStats> {
        let [[actor, critic], [target_actor, target_critic]] = [&self.online, &self.target];
        let [actor_optimiser, critic_optimiser] = &mut self.optimisers;
        // The critic moves towards its targets: the reward plus, if the episode continued, the discounted value that the target critic
        // assigns to the target actor's action in the next state (equations 57 and 58).
        let targets = batch.targets(|states| {
            let actions = target_actor.forward_frozen(states)?;
            target_critic.forward_frozen(&Tensor::cat(&[states, &actions], 1)?)
        })?;
        let loss = squared_error(&critic.forward(&Tensor::cat(&[&batch.states, &batch.actions], 1)?)?, &targets)?;
        critic_optimiser.backward_step(&loss)?;

        // The actor ascends the critic (the deterministic policy gradient) and follows the lessons.
        let actions = actor.forward(&batch.states)?;
        let values = critic.forward_frozen(&Tensor::cat(&[&batch.states, &actions], 1)?)?.sum_all()?;
        actor_optimiser.backward_step(&actor_loss.of(&values, &actions, batch)?)?;

        for (target, online) in self.target.iter().zip(&self.online) {
            soft_update(target.parameters(), online.parameters(), 1.0 - self.rates.polyak)?;
        }
        Ok(UpdateStats { loss: number(&loss)?, value: number(&values)? / actions.dim(0)? as f64 })
    }
}

/// Splits the result of [`ActorCritic::values`] into its four parts.
fn split([actor, critic]: &[Vec<usize>; 2], values: &[f32]) -> std::result::Result<[[Mlp; 2]; 4], WeightsError> {
    let (actors, critics) = (parameter_count(actor), parameter_count(critic));
    let expected = 4 * (actors + critics);
    if values.len() != expected {
        return Err(WeightsError::Shape {
            name: "networks".to_owned(),
            found: format!("{} values", values.len()),
            wanted: format!("{expected}, for an actor with {} and a critic with {}", units(actor), units(critic)),
        });
    }
    let part = |number: usize| -> std::result::Result<[Mlp; 2], WeightsError> {
        let (first, second) = values[number * (actors + critics)..][..actors + critics].split_at(actors);
        Ok([Mlp::from_parameters(actor, first.to_vec())?, Mlp::from_parameters(critic, second.to_vec())?])
    };
    Ok([part(0)?, part(1)?, part(2)?, part(3)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::thesis::{
        agent::{Choice, Transition},
        environment::Observation,
    };
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    const RATES: Rates = Rates { adam: AdamConfig { learning_rate: 1e-3, max_grad_norm: 1.0 }, polyak: 0.999 };

    #[test]
    fn the_first_step_descends_both_losses() {
        // After one step Adam's average of the gradient is 0.1 times the gradient, so the test can read it.
        let adam = AdamConfig { learning_rate: 1e-12, max_grad_norm: f64::INFINITY };
        let (sizes, rates) = (sizes(&[5, 4], &[6, 5]), Rates { adam, ..RATES });
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
        let batch = Batch::random(8, true, &mut Xoshiro256PlusPlus::seed_from_u64(9)).unwrap();
        let mut start = ActorCritic::random(&sizes, rates, &mut rng).unwrap().values().unwrap();
        let count = start.len() / 4;
        start[..2 * count].iter_mut().for_each(|value| *value *= 1.5);
        let run = |values: &[f32]| {
            let mut agent = ActorCritic::from_values(&sizes, rates, values, 0).unwrap();
            let seen = agent.update(&batch, &ActorLoss::POLICY_GRADIENT).unwrap();
            (seen, agent.values().unwrap())
        };
        let (_, after) = run(&start);
        let actors = parameter_count(&sizes[0]);
        for (is_critic, part) in [(false, 0..actors), (true, actors..count)] {
            let mut largest = 0.0f64;
            for index in part.step_by(3) {
                let at = |step: f32| {
                    let mut values = start.clone();
                    values[index] += step;
                    let seen = run(&values).0;
                    if is_critic { seen.loss } else { -seen.value }
                };
                let differences = (at(2e-3) - at(-2e-3)) / 4e-3;
                let ours = f64::from(after[2 * count + index]) * 10.0;
                assert!((ours - differences).abs() < 3e-3, "critic {is_critic}, {index}: {ours} against {differences}");
                largest = largest.max(ours.abs());
            }
            assert!(largest > 0.05, "a gradient of zero would agree with anything");
        }
    }

    #[test]
    fn the_actor_follows_the_nearest_lesson() {
        let sizes = sizes(&[16; 3], &[32; 3]);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let mut agent = ActorCritic::random(&sizes, RATES, &mut rng).unwrap();
        let state = [0.3, -0.2, 0.5, 0.1, -0.7, 0.4];
        let lesson = |direction| Transition {
            before: Observation { state, cell: 0 },
            choice: Choice { action: [direction, 0.5], index: 0 },
            reward: 1.0,
            ..Transition::default()
        };
        let states = Tensor::from_slice(&state, (1, STATES), &Device::Cpu).unwrap();
        let act = |agent: &ActorCritic| agent.act(&states).unwrap().flatten_all().unwrap().to_vec1::<f32>().unwrap();
        let own = act(&agent)[0];
        let (near, far) = (own + 0.25, own - 0.6);
        let actor_loss =
            ActorLoss { policy_gradient: 0.0, lessons: 4, cloning: 1.0, width: [0.2, 0.5], bounds_penalty: 0.0 };
        // The mean of the lessons is on the other side of the actor's own action.
        let batch = Batch::new(&[lesson(near), lesson(far), lesson(near), lesson(far)], 0.0).unwrap();
        for _ in 0..400 {
            agent.update(&batch, &actor_loss).unwrap();
        }
        assert!((act(&agent)[0] - near).abs() < 0.03 && (act(&agent)[1] - 0.5).abs() < 0.03, "{:?}", act(&agent));
        let outside = Batch::new(&[lesson(1.8)], 0.0).unwrap();
        let far = ActorLoss { width: [9.0; 2], lessons: 1, ..actor_loss };
        let back = ActorLoss { lessons: 0, bounds_penalty: 1.0, ..actor_loss };
        // Adam's remaining momentum carries the action on into the range.
        for (actor_loss, within) in [(far, 1.2..2.0), (back, -1.05..1.05)] {
            for _ in 0..1000 {
                agent.update(&outside, &actor_loss).unwrap();
            }
            assert!(within.contains(&act(&agent)[0]), "{actor_loss:?}: {:?}", act(&agent));
        }
    }

    #[test]
    fn non_finite_numbers_are_refused_before_any_change() {
        let sizes = sizes(&[4], &[4]);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(6);
        let mut agent = ActorCritic::random(&sizes, RATES, &mut rng).unwrap();
        let mut batch = Batch::random(8, false, &mut Xoshiro256PlusPlus::seed_from_u64(1)).unwrap();
        batch.rewards = (batch.rewards * f64::NAN).unwrap();
        let before = agent.values().unwrap();
        assert!(agent.update(&batch, &ActorLoss::POLICY_GRADIENT).unwrap_err().to_string().contains("finite"));
        assert_eq!((agent.values().unwrap(), agent.updates()), (before.clone(), 0));
        assert!(ActorCritic::from_values(&sizes, RATES, &before[1..], 0).is_err());
    }
}
