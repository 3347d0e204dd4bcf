//! The actor and the critic: their creation, and their outputs for a batch of observations.

use candle_core::{Device, Result, Tensor};
use rand::Rng;

use super::{
    action::{Action, action_for_offset, action_for_speed},
    context::Inputs,
    hyperparameters::Hyperparameters,
    observation::Observation,
    observation_batch::{ContextualObservation, ObservationBatch, actions_in},
};
use crate::learning::nn::{
    mlp::{Mlp, Operations},
    weights::{Reader, WeightsError},
};

/// Steps of a low-discrepancy sequence in the square (powers of the inverse of the plastic number, Roberts 2018).
const TIP_STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];

/// Index of the speed in an action.
const SPEED: usize = 1;

#[derive(Clone, Debug)]
pub struct Networks {
    /// Maps an observation to the heads' actions, before the squashing.
    pub actor: Mlp,
    /// Maps an observation and an action to the logit of success.
    pub critic: Mlp,
    /// Numbers in an action.
    numbers: usize,
    /// Half width and middle of the range of each actor output, if heads have their own speed ranges.
    ranges: Option<[Tensor; 2]>,
}

impl Networks {
    /// Combines an actor and a critic that were created with these settings.
    pub fn new(hyper: &Hyperparameters, actor: Mlp, critic: Mlp) -> Result<Self> {
        let (numbers, outputs) = (hyper.actions.actions(), actor.sizes().last().copied().unwrap_or(0));
        let (mut half, mut middle) = (vec![1.0_f32; outputs], vec![0.0_f32; outputs]);
        for (head, speeds) in (0..outputs / numbers).zip(hyper.head_speeds.iter().cycle()) {
            let [low, high] = speeds.map(action_for_speed);
            half[head * numbers + SPEED] = 0.5 * (high - low);
            middle[head * numbers + SPEED] = 0.5 * (high + low);
        }
        let row = |values| Tensor::from_vec(values, (1, outputs), &Device::Cpu);
        let ranges = if hyper.head_speeds.is_empty() { None } else { Some([row(half)?, row(middle)?]) };
        Ok(Self { actor, critic, numbers, ranges })
    }

    /// Creates untrained networks. The heads start at offsets spread over the ball, at the middle of their speed ranges, at middle
    /// elevation and with tip positions spread evenly; the critic starts at a probability of one half.
    pub fn random(hyper: &Hyperparameters, rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        let outputs = hyper.actions.actions();
        let mut start = Vec::with_capacity(hyper.heads * outputs);
        for head in 0..hyper.heads {
            let offset = (head as f64 + 0.5) / hyper.heads as f64;
            let tip = TIP_STEPS.map(|step| ((0.5 + step * head as f64).fract() - 0.5) as f32);
            start.extend_from_slice(&[action_for_offset(offset).atanh(), 0.0, tip[0], tip[1], 0.0][..outputs]);
        }
        let [actor, critic] = hyper.sizes();
        let actor = Mlp::random(&actor, rng)?.with_output_bias(&start)?;
        Self::new(hyper, actor, Mlp::random(&critic, rng)?)
    }

    /// Reads the networks from a file in which their names begin with `prefix`.
    pub fn read(reader: &Reader<'_>, prefix: &str, hyper: &Hyperparameters) -> std::result::Result<Self, WeightsError> {
        let [actor, critic] = hyper.sizes();
        let actor = reader.network(&format!("{prefix}actor"), &actor)?;
        let critic = reader.network(&format!("{prefix}critic"), &critic)?;
        Ok(Self::new(hyper, actor, critic)?)
    }

    /// Returns a copy with its own parameters.
    pub fn duplicate(&self) -> Result<Self> {
        Ok(Self { actor: self.actor.duplicate()?, critic: self.critic.duplicate()?, ..self.clone() })
    }

    #[must_use]
    pub fn with_operations(self, operations: Operations) -> Self {
        Self { actor: self.actor.with_operations(operations), critic: self.critic.with_operations(operations), ..self }
    }

    /// Returns the heads' actions, observation by observation.
    pub fn actions(&self, observed: &ObservationBatch) -> Result<Vec<Action>> {
        actions_in(observed.space(), &self.propose(observed)?)
    }

    /// Returns the proposals of all heads for these observations: the observation, the action and the critic's logit.
    pub fn proposals(
        &self,
        inputs: Inputs,
        observations: Vec<ContextualObservation>,
    ) -> Result<Vec<(Observation, Action, f32)>> {
        let observed = ObservationBatch::new(inputs, observations)?;
        let rows = self.propose(&observed)?;
        let logits = self.critic.forward_frozen(&observed.with_actions(&rows)?)?.flatten_all()?.to_vec1::<f32>()?;
        let actions = actions_in(observed.space(), &rows)?;
        let heads = actions.len() / observed.observations.len();
        let all = actions.into_iter().zip(logits).enumerate();
        Ok(all.map(|(row, (action, logit))| (observed.observations[row / heads].observation, action, logit)).collect())
    }

    /// Squashes the actor's outputs (observations x outputs) to the heads' actions: between -1 and 1, with every head's speed within its
    /// range, one row per action, observation by observation. Gradients flow to the outputs.
    pub fn squash(&self, outputs: &Tensor) -> Result<Tensor> {
        let squashed = outputs.tanh()?;
        let actions = match &self.ranges {
            Some([half, middle]) => squashed.broadcast_mul(half)?.broadcast_add(middle)?,
            None => squashed,
        };
        actions.reshape(((), self.numbers))
    }

    fn propose(&self, observed: &ObservationBatch) -> Result<Tensor> {
        self.squash(&self.actor.forward_frozen(&observed.states)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::action::{ActionSpace, DecodedAction},
        table::Table,
    };
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn each_head_covers_only_its_speed_range() {
        let hyper =
            Hyperparameters { heads: 3, head_speeds: vec![[0.3, 2.0], [1.5, 6.0]], ..Hyperparameters::default() };
        let space = ActionSpace::Full;
        let outputs = hyper.heads * space.actions();
        let networks = Networks::random(&hyper, &mut Xoshiro256PlusPlus::seed_from_u64(1)).unwrap();
        let speeds = |output: f32| {
            let outputs = Tensor::full(output, (1, outputs), &Device::Cpu).unwrap();
            let actions = actions_in(space, &networks.squash(&outputs).unwrap()).unwrap();
            assert!(actions.iter().all(|action| (action[0] - output.tanh()).abs() < 1e-6), "{actions:?}");
            // With a level cue, the action's speed is that of the stroke.
            let level =
                |action: &[f32; 5]| DecodedAction::of(&Table::default(), [action[0], action[1], 0.0, 0.0, -1.0]);
            actions.iter().map(|action| level(action).speed.value).collect::<Vec<_>>()
        };
        for (output, expected) in [(-20.0, [0.3, 1.5, 0.3]), (20.0, [2.0, 6.0, 2.0]), (0.0, [1.15, 3.75, 1.15])] {
            let speeds = speeds(output);
            assert!(speeds.iter().zip(expected).all(|(speed, expected)| (speed - expected).abs() < 1e-6), "{speeds:?}");
        }
    }
}
