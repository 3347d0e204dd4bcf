//! A plain actor and its critic, and how they learn (thesis Algorithm 4): candle's modules, optimiser and gradients.

use candle_core::{Device, Result, Tensor, bail};
use candle_nn::{Module, Optimizer, loss::mse};
use rand::Rng;

use super::{
    agent::UpdateStats,
    batch::{Batch, number},
    environment::{ACTIONS, STATES},
};
use crate::learning::nn::{
    adam::{Adam, AdamConfig, soft_update},
    mlp::{Mlp, Operations, parameter_count},
};

/// Hidden layers of both networks. The actor goes from the state to the action, the critic from both to one value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layers {
    /// The actor's.
    pub actor: Vec<usize>,
    /// The critic's.
    pub critic: Vec<usize>,
}

impl Layers {
    fn sizes(&self) -> [Vec<usize>; 2] {
        [
            [&[STATES], self.actor.as_slice(), &[ACTIONS]].concat(),
            [&[STATES + ACTIONS], &self.critic[..], &[1]].concat(),
        ]
    }
}

/// How to learn (thesis Table 4; the networks' example gives the clipping).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Adam's learning rate for both networks.
    pub learning_rate: f64,
    /// The part k of the target networks that a soft update keeps (equation 59).
    pub keep: f64,
    /// Longest gradient that is not shortened.
    pub gradient_clip: f64,
}

impl Rates {
    const fn adam(&self) -> AdamConfig {
        AdamConfig { learning_rate: self.learning_rate, gradient_clip: self.gradient_clip }
    }
}

/// How the actor learns beside climbing the critic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guidance {
    /// Weight of the critic's slope.
    pub climbing: f64,
    /// The first rows of a batch, so many, are lessons: the actor goes towards what was done there.
    pub lessons: usize,
    /// Weight of that.
    pub cloning: f64,
    /// How near a lesson must be to the actor's own action to count, in direction and speed: of several ways to make a point the
    /// nearest is followed, not the mean of all, which makes none.
    pub width: [f64; 2],
    /// How strongly actions outside the range are pulled back to it.
    pub pull: f64,
}

impl Guidance {
    /// Nothing but the critic.
    pub const NONE: Self = Self { climbing: 1.0, lessons: 0, cloning: 0.0, width: [1.0; 2], pull: 0.0 };

    /// What the actor's step goes down, from the mean `value` of its `actions`.
    fn loss(&self, value: &Tensor, actions: &Tensor, batch: &Batch) -> Result<Tensor> {
        let mut loss = (value * -self.climbing)?;
        let rows = actions.dim(0)? as f64;
        if self.lessons > 0 {
            // Climbing a bell around each lesson climbs the success of an action with noise of that width.
            let [own, shown] = [actions, &batch.actions].map(|actions| actions.narrow(0, 0, self.lessons));
            let scale = Tensor::new(&self.width.map(|width| (1.0 / width) as f32), &Device::Cpu)?;
            let apart = (own? - shown?)?.broadcast_mul(&scale)?.sqr()?.sum(1)?;
            let near = (apart * -0.5)?.exp()?.sum_all()?;
            loss = (loss - (near * (self.cloning * self.width[0] / rows))?)?;
        }
        if self.pull > 0.0 {
            let beyond = (actions - actions.detach().clamp(-1f32, 1f32)?)?;
            loss = (loss + (beyond.sqr()?.sum_all()? * (0.5 * self.pull / rows))?)?;
        }
        Ok(loss)
    }
}

/// An actor and a critic.
#[derive(Debug)]
struct Pair {
    actor: Mlp,
    critic: Mlp,
}

impl Pair {
    fn networks(&self) -> [&Mlp; 2] {
        [&self.actor, &self.critic]
    }

    fn duplicate(&self) -> Result<Self> {
        Ok(Self { actor: self.actor.duplicate()?, critic: self.critic.duplicate()? })
    }

    fn with(self, operations: Operations) -> Self {
        Self { actor: self.actor.with(operations), critic: self.critic.with(operations) }
    }
}

/// Networks, target networks and optimisers.
#[derive(Debug)]
pub struct ActorCritic {
    rates: Rates,
    online: Pair,
    target: Pair,
    actor_optimiser: Adam,
    critic_optimiser: Adam,
}

impl ActorCritic {
    /// Networks with weights drawn from `rng` (Glorot and Bengio 2010); the target networks begin as copies.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn random(layers: &Layers, rates: Rates, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        let [actor, critic] = layers.sizes();
        Self::starting_from(Pair { actor: Mlp::glorot(&actor, rng)?, critic: Mlp::glorot(&critic, rng)? }, rates)
    }

    /// Learning starts with these networks.
    fn starting_from(online: Pair, rates: Rates) -> Result<Self> {
        Ok(Self {
            target: online.duplicate()?,
            actor_optimiser: Adam::new(vec![online.actor.parameters().clone()], rates.adam())?,
            critic_optimiser: Adam::new(vec![online.critic.parameters().clone()], rates.adam())?,
            online,
            rates,
        })
    }

    /// Networks that go on from what [`ActorCritic::values`] and [`ActorCritic::updates`] gave.
    ///
    /// # Errors
    /// Where the number of values does not fit the layers.
    pub fn from_values(layers: &Layers, rates: Rates, values: &[f32], updates: u32) -> Result<Self> {
        let [online, target, first, second] = split(layers, values)?;
        let resume = |network: &Mlp, moments: [&Mlp; 2]| {
            let moments = moments.map(|moment| moment.parameters().as_detached_tensor());
            Adam::resume(vec![network.parameters().clone()], rates.adam(), vec![moments], updates)
        };
        Ok(Self {
            actor_optimiser: resume(&online.actor, [&first.actor, &second.actor])?,
            critic_optimiser: resume(&online.critic, [&first.critic, &second.critic])?,
            online,
            target,
            rates,
        })
    }

    /// Networks that begin to learn with the weights among such values.
    ///
    /// # Errors
    /// Where the number of values does not fit the layers.
    pub fn from_weights(layers: &Layers, rates: Rates, values: &[f32]) -> Result<Self> {
        let [online, ..] = split(layers, values)?;
        Self::starting_from(online, rates)
    }

    /// These networks with other operations.
    #[must_use]
    pub fn with(self, operations: Operations) -> Self {
        Self { online: self.online.with(operations), target: self.target.with(operations), ..self }
    }

    /// Updates made so far.
    pub const fn updates(&self) -> u32 {
        self.actor_optimiser.steps()
    }

    /// Everything that changes: parameters, target parameters, Adam's averages of the gradient and of its square, each
    /// the actor's and then the critic's.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn values(&self) -> Result<Vec<f32>> {
        let mut values = Vec::new();
        for network in self.online.networks().into_iter().chain(self.target.networks()) {
            values.extend(network.parameters().to_vec1::<f32>()?);
        }
        for order in 0..2 {
            for optimiser in [&self.actor_optimiser, &self.critic_optimiser] {
                for moments in optimiser.moments() {
                    values.extend(moments[order].to_vec1::<f32>()?);
                }
            }
        }
        Ok(values)
    }

    /// The actor's actions in `states` (rows x states).
    ///
    /// # Errors
    /// Where they have another shape.
    pub fn act(&self, states: &Tensor) -> Result<Tensor> {
        self.online.actor.forward_frozen(states)
    }

    /// Learns from now on at `share` of its learning rate.
    pub fn slow_down(&mut self, share: f64) {
        for optimiser in [&mut self.actor_optimiser, &mut self.critic_optimiser] {
            optimiser.set_learning_rate(share * self.rates.learning_rate);
        }
    }

    /// One update: the critic's step, the actor's step and both soft updates.
    ///
    /// # Errors
    /// Where the networks no longer give finite numbers.
    pub fn update(&mut self, batch: &Batch) -> Result<UpdateStats> {
        self.update_guided(batch, &Guidance::NONE)
    }

    /// As [`ActorCritic::update`], the actor's step guided by more than the critic.
    ///
    /// # Errors
    /// Where the networks no longer give finite numbers.
    pub fn update_guided(&mut self, batch: &Batch, guidance: &Guidance) -> Result<UpdateStats> {
        let Pair { actor, critic } = &self.online;
        // The critic comes nearer to what it should have said: the reward and, where the episode went on, the value of the
        // target actor's action thereafter in the target critic's eyes (equations 57 and 58).
        let wanted = batch.targets(|states| {
            let actions = self.target.actor.forward_frozen(states)?;
            self.target.critic.forward_frozen(&Tensor::cat(&[states, &actions], 1)?)
        })?;
        let loss = mse(&critic.forward(&Tensor::cat(&[&batch.states, &batch.actions], 1)?)?, &wanted)?;
        self.critic_optimiser.backward_step(&loss)?;

        // The actor climbs the critic (the deterministic policy gradient), and may be guided.
        let actions = actor.forward(&batch.states)?;
        let value = critic.forward_frozen(&Tensor::cat(&[&batch.states, &actions], 1)?)?.mean_all()?;
        self.actor_optimiser.backward_step(&guidance.loss(&value, &actions, batch)?)?;

        for (target, online) in self.target.networks().into_iter().zip(self.online.networks()) {
            soft_update(target.parameters(), online.parameters(), 1.0 - self.rates.keep)?;
        }
        Ok(UpdateStats { loss: number(&loss)?, value: number(&value)? })
    }
}

/// The four parts of [`ActorCritic::values`].
fn split(layers: &Layers, values: &[f32]) -> Result<[Pair; 4]> {
    let [actor, critic] = layers.sizes();
    let [actors, critics] = [&actor, &critic].map(|sizes| parameter_count(sizes));
    let expected = 4 * (actors + critics);
    if values.len() != expected {
        bail!("an actor of layers {actor:?} and a critic of {critic:?} have {expected} values, not {}", values.len());
    }
    let mut parts = values.chunks_exact(actors + critics).map(|part| {
        let (first, second) = part.split_at(actors);
        Ok(Pair {
            actor: Mlp::from_parameters(&actor, first.to_vec())?,
            critic: Mlp::from_parameters(&critic, second.to_vec())?,
        })
    });
    let mut part = || parts.next().unwrap_or_else(|| bail!("the values have fewer than four parts"));
    Ok([part()?, part()?, part()?, part()?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::thesis::replay::StoredTransition;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    const RATES: Rates = Rates { learning_rate: 1e-3, keep: 0.999, gradient_clip: 1.0 };

    fn layers(actor: &[usize], critic: &[usize]) -> Layers {
        Layers { actor: actor.to_vec(), critic: critic.to_vec() }
    }

    fn random_batch(rows: usize, goes_on: impl Fn(usize) -> bool, seed: u64) -> Batch {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let drawn: Vec<StoredTransition> = (0..rows)
            .map(|row| {
                let mut number = || rng.random_range(-1.0f32..1.0);
                StoredTransition {
                    state: std::array::from_fn(|_| number()),
                    action: std::array::from_fn(|_| number()),
                    index: 0,
                    reward: number(),
                    goes_on: goes_on(row),
                    next: std::array::from_fn(|_| number()),
                }
            })
            .collect();
        Batch::new(&drawn, 0.99).unwrap()
    }

    #[test]
    fn the_first_step_goes_down_the_finite_differences_of_both_losses() {
        // Adam's averages after one step are the gradient times 0.1, which makes it visible.
        let rates = Rates { learning_rate: 1e-12, gradient_clip: f64::INFINITY, ..RATES };
        let layers = layers(&[5, 4], &[6, 5]);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
        let batch = random_batch(8, |_| true, 9);
        let mut start = ActorCritic::random(&layers, rates, &mut rng).unwrap().values().unwrap();
        let count = start.len() / 4;
        start[..2 * count].iter_mut().for_each(|value| *value *= 1.5);
        let run = |values: &[f32]| {
            let mut agent = ActorCritic::from_values(&layers, rates, values, 0).unwrap();
            let seen = agent.update(&batch).unwrap();
            (seen, agent.values().unwrap())
        };
        let (_, after) = run(&start);
        let actors = parameter_count(&layers.sizes()[0]);
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
            assert!(largest > 0.05, "a gradient of nought agrees with anything");
        }
    }

    #[test]
    fn the_actor_goes_to_the_nearest_lesson_and_back_into_its_range() {
        let layers = layers(&[16; 3], &[32; 3]);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let mut agent = ActorCritic::random(&layers, RATES, &mut rng).unwrap();
        let state = [0.3, -0.2, 0.5, 0.1, -0.7, 0.4];
        let lesson = |direction| StoredTransition {
            state,
            action: [direction, 0.5],
            index: 0,
            reward: 1.0,
            goes_on: false,
            next: state,
        };
        let states = Tensor::from_slice(&state, (1, STATES), &Device::Cpu).unwrap();
        let act = |agent: &ActorCritic| agent.act(&states).unwrap().flatten_all().unwrap().to_vec1::<f32>().unwrap();
        let own = act(&agent)[0];
        let (near, far) = (own + 0.25, own - 0.6);
        let guidance = Guidance { climbing: 0.0, lessons: 4, cloning: 1.0, width: [0.2, 0.5], pull: 0.0 };
        // Their mean lies on the other side.
        let batch = Batch::new(&[lesson(near), lesson(far), lesson(near), lesson(far)], 0.0).unwrap();
        for _ in 0..400 {
            agent.update_guided(&batch, &guidance).unwrap();
        }
        assert!((act(&agent)[0] - near).abs() < 0.03 && (act(&agent)[1] - 0.5).abs() < 0.03, "{:?}", act(&agent));
        let outside = Batch::new(&[lesson(1.8)], 0.0).unwrap();
        let far = Guidance { width: [9.0; 2], lessons: 1, ..guidance };
        let back = Guidance { lessons: 0, pull: 1.0, ..guidance };
        // What Adam still carries leads on into the range.
        for (guidance, within) in [(far, 1.2..2.0), (back, -1.05..1.05)] {
            for _ in 0..1000 {
                agent.update_guided(&outside, &guidance).unwrap();
            }
            assert!(within.contains(&act(&agent)[0]), "{guidance:?}: {:?}", act(&agent));
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused_before_they_do_harm() {
        let layers = layers(&[4], &[4]);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(6);
        let mut agent = ActorCritic::random(&layers, RATES, &mut rng).unwrap();
        let mut batch = random_batch(8, |_| false, 1);
        batch.rewards = (batch.rewards * f64::NAN).unwrap();
        let before = agent.values().unwrap();
        assert!(agent.update(&batch).unwrap_err().to_string().contains("finite"));
        assert_eq!((agent.values().unwrap(), agent.updates()), (before.clone(), 0));
        assert!(ActorCritic::from_values(&layers, RATES, &before[1..], 0).is_err());
    }
}
