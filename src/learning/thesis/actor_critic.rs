//! A plain actor and its critic: what the thesis' DDPG learns with, all of it in one candle tensor.

use candle_core::{Device, Result, Tensor, Var, bail};
use rand::{Rng, RngExt};

use super::{
    kernels::Rows,
    pass::Pass,
    update::{Batch, BatchStats, Rates, Sizes, Update, Workspace},
};
use crate::learning::network::{pass::parameter_count, tensors::stored_values};

/// Networks, target networks and optimisers.
#[derive(Debug)]
pub struct ActorCritic {
    sizes: Sizes,
    rates: Rates,
    /// Parameters, target parameters and both averages of Adam, each the actor's and then the critic's.
    state: Var,
    updates: u32,
    workspace: Workspace,
}

impl ActorCritic {
    /// Networks with weights drawn from `rng` (Glorot and Bengio 2010); the target networks begin as copies. They learn
    /// from batches of `rows`.
    ///
    /// # Errors
    /// Where the sizes do not belong to an actor and its critic.
    pub fn random(sizes: Sizes, rates: Rates, rows: usize, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        let mut values = glorot(&sizes.actor, rng);
        values.extend(glorot(&sizes.critic, rng));
        values.extend_from_within(..);
        values.resize(sizes.values(), 0.0);
        Self::from_values(sizes, rates, rows, values, 0)
    }

    /// Networks that go on from what [`ActorCritic::values`] and [`ActorCritic::updates`] gave.
    ///
    /// # Errors
    /// Where the number of values does not fit the sizes.
    pub fn from_values(sizes: Sizes, rates: Rates, rows: usize, values: Vec<f32>, updates: u32) -> Result<Self> {
        let workspace = Workspace::new(&sizes, rows)?;
        let count = sizes.values();
        if values.len() != count {
            bail!("networks of sizes {sizes:?} have {count} values, not {}", values.len());
        }
        let state = Var::from_vec(values, count, &Device::Cpu)?;
        Ok(Self { sizes, rates, state, updates, workspace })
    }

    /// Layer sizes.
    pub const fn sizes(&self) -> &Sizes {
        &self.sizes
    }

    /// Updates made so far.
    pub const fn updates(&self) -> u32 {
        self.updates
    }

    /// Everything that changes: parameters, target parameters, Adam's averages of the gradient and of its square, each
    /// the actor's and then the critic's.
    pub const fn state(&self) -> &Var {
        &self.state
    }

    /// The values of [`ActorCritic::state`].
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn values(&self) -> Result<Vec<f32>> {
        self.state.to_vec1()
    }

    /// The actor's parameters within the state.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn actor(&self) -> Result<Tensor> {
        self.state.narrow(0, 0, self.sizes.parameters()[0])
    }

    /// The critic's parameters within the state.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn critic(&self) -> Result<Tensor> {
        let [actor, critic] = self.sizes.parameters();
        self.state.narrow(0, actor, critic)
    }

    /// Writes the actor's action in `state` to `action`, through the buffers of a pass of one row.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub(super) fn act(&self, single: &mut Pass, state: &[f32], action: &mut [f32]) -> Result<()> {
        if state.len() != self.sizes.states() || action.len() != self.sizes.actions() {
            bail!("an actor of sizes {:?} was given {} and {} values", self.sizes.actor, state.len(), action.len());
        }
        let (storage, layout) = self.state.storage_and_layout();
        let parameters = &stored_values(&storage, layout)?[..self.sizes.parameters()[0]];
        single.forward(parameters, Rows::new(state, state.len()), action, self.sizes.actions());
        Ok(())
    }

    /// One update: the critic's step, the actor's step and both soft updates.
    ///
    /// # Errors
    /// Where the batch has another size, or where the networks no longer give finite numbers.
    pub fn update(&mut self, batch: &mut Batch) -> Result<BatchStats> {
        let update = Update::new(&mut self.workspace, batch, &self.rates, self.updates + 1);
        self.state.inplace_op1(&update)?;
        self.updates += 1;
        Ok(update.seen())
    }
}

/// Weights uniform within ±sqrt(6 / (inputs + outputs)) and biases of nought, as Keras begins.
pub(super) fn glorot(sizes: &[usize], rng: &mut (impl Rng + ?Sized)) -> Vec<f32> {
    let mut parameters = Vec::with_capacity(parameter_count(sizes));
    for pair in sizes.windows(2) {
        let bound = (6.0 / (pair[0] + pair[1]) as f32).sqrt();
        parameters.extend((0..pair[0] * pair[1]).map(|_| rng.random_range(-bound..=bound)));
        parameters.resize(parameters.len() + pair[1], 0.0);
    }
    parameters
}

/// Where the part number `part` of a network's values lies: 0 parameters, 1 target, 2 and 3 the optimiser's averages.
#[cfg(test)]
fn part(sizes: &Sizes, part: usize, critic: bool) -> std::ops::Range<usize> {
    let [a, c] = sizes.parameters();
    let start = part * (a + c) + if critic { a } else { 0 };
    start..start + if critic { c } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::network::{
        adam::{Adam, soft_update},
        mlp::Mlp,
    };
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    const RATES: Rates = Rates { learning_rate: 1e-3, discount: 0.99, keep: 0.999, gradient_clip: 1.0 };

    fn uniform(count: usize, rng: &mut Xoshiro256PlusPlus) -> Vec<f32> {
        (0..count).map(|_| rng.random_range(-1.0f32..1.0)).collect()
    }

    fn random_batch(sizes: &Sizes, rows: usize, goes_on: impl Fn(usize) -> bool, seed: u64) -> Batch {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let width = sizes.critic[0];
        Batch {
            inputs: uniform(rows * width, &mut rng),
            rewards: uniform(rows, &mut rng),
            goes_on: (0..rows).map(|row| f32::from(u8::from(goes_on(row)))).collect(),
            next_inputs: uniform(rows * width, &mut rng),
        }
    }

    /// The same agent, written plainly with candle's tensors and its automatic differentiation.
    struct Plain {
        sizes: Sizes,
        networks: [Mlp; 4],
        optimisers: [Adam; 2],
    }

    impl Plain {
        fn of(agent: &ActorCritic) -> Self {
            let (sizes, values) = (agent.sizes.clone(), agent.values().unwrap());
            let network = |number, critic: bool| {
                let layers = if critic { &sizes.critic } else { &sizes.actor };
                Mlp::from_parameters(layers, values[part(&sizes, number, critic)].to_vec()).unwrap()
            };
            let networks = [network(0, false), network(0, true), network(1, false), network(1, true)];
            let optimisers = sizes.parameters().map(|count| Adam::new(count).unwrap());
            Self { sizes, networks, optimisers }
        }

        fn update(&mut self, batch: &Batch) -> BatchStats {
            let [actor, critic, actor_target, critic_target] = &self.networks;
            let (states, rows) = (self.sizes.states(), batch.rewards.len());
            let tensor = |values: &[f32], width| Tensor::from_slice(values, (rows, width), &Device::Cpu).unwrap();
            let inputs = tensor(&batch.inputs, self.sizes.critic[0]);
            let state = |inputs: &Tensor| inputs.narrow(1, 0, states).unwrap().contiguous().unwrap();
            let with = |state: &Tensor, action: &Tensor| Tensor::cat(&[state, action], 1).unwrap();
            let next = state(&tensor(&batch.next_inputs, self.sizes.critic[0]));
            let next = critic_target.forward(&with(&next, &actor_target.forward(&next).unwrap())).unwrap();
            let next = (next * tensor(&batch.goes_on, 1)).unwrap();
            let wanted = (tensor(&batch.rewards, 1) + (next * RATES.discount).unwrap()).unwrap().detach();
            let loss = (critic.forward(&inputs).unwrap() - wanted).unwrap().sqr().unwrap().mean_all().unwrap();
            let step = |network: &Mlp, adam: &mut Adam, loss: &Tensor| {
                let gradients = loss.backward().unwrap();
                let gradient = gradients.get(network.parameters()).unwrap();
                adam.step(network.parameters(), gradient, RATES.learning_rate, RATES.gradient_clip).unwrap();
            };
            let [actor_adam, critic_adam] = &mut self.optimisers;
            step(critic, critic_adam, &loss);
            let state = state(&inputs);
            let actions = actor.forward(&state).unwrap();
            let value = critic.forward_frozen(&with(&state, &actions)).unwrap().mean_all().unwrap();
            step(actor, actor_adam, &value.neg().unwrap());
            soft_update(critic_target.parameters(), critic.parameters(), 1.0 - RATES.keep).unwrap();
            soft_update(actor_target.parameters(), actor.parameters(), 1.0 - RATES.keep).unwrap();
            let number = |tensor: Tensor| f64::from(tensor.to_scalar::<f32>().unwrap());
            BatchStats { loss: number(loss), value: number(value) }
        }
    }

    #[test]
    fn a_hundred_updates_agree_with_candles_automatic_differentiation() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for (actor, critic, goes_on) in [
            (vec![16, 16, 16], vec![32, 32, 32], [true, true]),
            (vec![16, 16, 16], vec![32, 32, 32], [true, false]),
            (vec![20, 7], vec![40], [false, false]),
        ] {
            let sizes = Sizes::new(6, 2, &actor, &critic);
            let mut agent = ActorCritic::random(sizes.clone(), RATES, 32, &mut rng).unwrap();
            let mut plain = Plain::of(&agent);
            for seed in 0..100 {
                let mut batch = random_batch(&sizes, 32, |row| goes_on[row % 2], seed);
                let expected = plain.update(&batch);
                let seen = agent.update(&mut batch).unwrap();
                assert!((seen.loss - expected.loss).abs() < 1e-5 && (seen.value - expected.value).abs() < 1e-5);
            }
            let values = agent.values().unwrap();
            for (network, (number, critic)) in plain.networks.iter().zip([(0, false), (0, true), (1, false), (1, true)])
            {
                let expected = network.parameters().to_vec1::<f32>().unwrap();
                for (ours, theirs) in values[part(&sizes, number, critic)].iter().zip(expected) {
                    assert!((ours - theirs).abs() < 1e-5, "{ours} against {theirs}");
                }
            }
        }
    }

    #[test]
    fn the_first_step_goes_down_the_finite_differences_of_both_losses() {
        // Adam's averages after one step are the gradient times 0.1, which makes it visible.
        let rates = Rates { learning_rate: 1e-12, gradient_clip: f64::INFINITY, ..RATES };
        let sizes = Sizes::new(6, 2, &[5, 4], &[6, 5]);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
        let batch = random_batch(&sizes, 8, |_| true, 9);
        let start = {
            let mut values = ActorCritic::random(sizes.clone(), rates, 8, &mut rng).unwrap().values().unwrap();
            values[..2 * sizes.parameters().iter().sum::<usize>()].iter_mut().for_each(|value| *value *= 1.5);
            values
        };
        let run = |values: Vec<f32>| {
            let mut agent = ActorCritic::from_values(sizes.clone(), rates, 8, values, 0).unwrap();
            let seen = agent.update(&mut batch.clone()).unwrap();
            (seen, agent.values().unwrap())
        };
        let (_, after) = run(start.clone());
        for critic in [false, true] {
            let (parameters, gradient) = (part(&sizes, 0, critic), part(&sizes, 2, critic));
            let mut largest = 0.0f64;
            for index in (0..parameters.len()).step_by(3) {
                let at = |step: f32| {
                    let mut values = start.clone();
                    values[parameters.start + index] += step;
                    let seen = run(values).0;
                    if critic { seen.loss } else { -seen.value }
                };
                let differences = (at(2e-3) - at(-2e-3)) / 4e-3;
                let ours = f64::from(after[gradient.start + index]) * 10.0;
                assert!((ours - differences).abs() < 3e-3, "critic {critic}, {index}: {ours} against {differences}");
                largest = largest.max(ours.abs());
            }
            assert!(largest > 0.05, "a gradient of nought agrees with anything");
        }
    }

    #[test]
    fn an_action_is_what_the_actors_network_gives() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let sizes = Sizes::new(6, 2, &[16, 16, 16], &[32]);
        let agent = ActorCritic::random(sizes.clone(), RATES, 4, &mut rng).unwrap();
        let state = uniform(6, &mut rng);
        let mut action = [0.0; 2];
        agent.act(&mut Pass::new(&sizes.actor, 1), &state, &mut action).unwrap();
        let actor = Mlp::from_parameters(&sizes.actor, agent.actor().unwrap().to_vec1().unwrap()).unwrap();
        let expected = actor.forward(&Tensor::from_slice(&state, (1, 6), &Device::Cpu).unwrap()).unwrap();
        for (ours, theirs) in action.iter().zip(&expected.to_vec2::<f32>().unwrap()[0]) {
            assert!((ours - theirs).abs() < 1e-6);
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused_before_they_do_harm() {
        let sizes = Sizes::new(6, 2, &[4], &[4]);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(6);
        let mut agent = ActorCritic::random(sizes.clone(), RATES, 8, &mut rng).unwrap();
        let mut batch = random_batch(&sizes, 8, |_| false, 1);
        batch.rewards[3] = f32::NAN;
        let before = agent.values().unwrap();
        assert!(agent.update(&mut batch).unwrap_err().to_string().contains("finite"));
        assert_eq!(agent.values().unwrap(), before);
        assert_eq!(agent.updates(), 0);
        assert!(agent.update(&mut random_batch(&sizes, 7, |_| false, 1)).is_err());
        assert!(
            ActorCritic::random(Sizes { actor: vec![6, 4, 2], critic: vec![7, 4, 1] }, RATES, 8, &mut rng).is_err()
        );
    }
}
