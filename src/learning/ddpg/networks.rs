//! The actor and the critic, and what they say about a batch of observations.

use std::sync::Arc;

use candle_core::{Device, Result, Tensor};
use rand::Rng;

use super::{
    action::{Action, aim_at, speed_of},
    context::Inputs,
    hyperparameters::Hyperparameters,
    observation::Observation,
    observation_batch::{ObservationBatch, Seen, actions_in},
};
use crate::{
    learning::nn::{
        mlp::{Mlp, Operations},
        weights::{Reader, WeightsError},
    },
    table::{Layout, Table},
};

/// Steps of a sequence that fills the square evenly (powers of the inverse of the plastic number, Roberts 2018).
const TIP_STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];

/// Place of the speed among the numbers of an action.
const SPEED: usize = 1;

#[derive(Clone, Debug)]
pub struct Networks {
    /// From an observation to the heads' actions, before the squashing.
    pub actor: Mlp,
    /// From an observation and an action to the logit of success.
    pub critic: Mlp,
    /// Numbers of an action.
    numbers: usize,
    /// Half the width and the middle of what each output of the actor may become, where heads have speeds of their own.
    ranges: Option<[Tensor; 2]>,
}

impl Networks {
    /// Networks that were made with these settings.
    pub fn new(hyper: &Hyperparameters, actor: Mlp, critic: Mlp) -> Result<Self> {
        let (numbers, outputs) = (hyper.actions.actions(), actor.sizes().last().copied().unwrap_or(0));
        let (mut half, mut middle) = (vec![1.0_f32; outputs], vec![0.0_f32; outputs]);
        for (head, speeds) in (0..outputs / numbers).zip(hyper.head_speeds.iter().cycle()) {
            let [low, high] = speeds.map(speed_of);
            half[head * numbers + SPEED] = 0.5 * (high - low);
            middle[head * numbers + SPEED] = 0.5 * (high + low);
        }
        let row = |values| Tensor::from_vec(values, (1, outputs), &Device::Cpu);
        let ranges = if hyper.head_speeds.is_empty() { None } else { Some([row(half)?, row(middle)?]) };
        Ok(Self { actor, critic, numbers, ranges })
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

    /// The networks in a file whose names there begin with `prefix`.
    pub fn read(reader: &Reader<'_>, prefix: &str, hyper: &Hyperparameters) -> std::result::Result<Self, WeightsError> {
        let [actor, critic] = hyper.sizes();
        let actor = reader.network(&format!("{prefix}actor"), &actor)?;
        let critic = reader.network(&format!("{prefix}critic"), &critic)?;
        Ok(Self::new(hyper, actor, critic)?)
    }

    /// A copy with its own parameters.
    pub fn duplicate(&self) -> Result<Self> {
        Ok(Self { actor: self.actor.duplicate()?, critic: self.critic.duplicate()?, ..self.clone() })
    }

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

    /// What all heads propose from every side on each of the layouts, on their tables and for players with such errors: the observation,
    /// the action and the critic's logit, an observation's heads one after the other.
    pub fn proposals<'a>(
        &self,
        inputs: Inputs,
        scenes: impl ExactSizeIterator<Item = (&'a Arc<Table>, &'a Layout, f64)>,
    ) -> Result<Vec<Vec<(Observation, Action, f32)>>> {
        let layouts = scenes.len();
        if layouts == 0 {
            return Ok(Vec::new());
        }
        let seen = scenes.flat_map(|(table, layout, errors)| {
            let all = Observation::every(table, layout, inputs.rails_first).into_iter();
            all.map(move |observation| Seen { observation, table: Arc::clone(table), errors })
        });
        let observed = ObservationBatch::new(inputs, seen.collect())?;
        let (actions, logits) = self.judge(&observed)?;
        let (heads, each) = (actions.len() / observed.seen.len(), actions.len() / layouts);
        let all = actions.into_iter().zip(logits).enumerate();
        let all = all.map(|(row, (action, logit))| (observed.seen[row / heads].observation, action, logit));
        Ok(all.collect::<Vec<_>>().chunks(each).map(<[_]>::to_vec).collect())
    }

    /// The heads' actions, between -1 and 1 and with every head's speed within its range, for the actor's outputs (observations x
    /// outputs): a row each, the heads of an observation one after the other. Gradients flow to the outputs.
    pub fn squash(&self, outputs: &Tensor) -> Result<Tensor> {
        let squashed = outputs.tanh()?;
        let placed = match &self.ranges {
            Some([half, middle]) => squashed.broadcast_mul(half)?.broadcast_add(middle)?,
            None => squashed,
        };
        placed.reshape(((), self.numbers))
    }

    fn propose(&self, observed: &ObservationBatch) -> Result<Tensor> {
        self.squash(&self.actor.forward_frozen(&observed.states)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::ddpg::action::{ActionSpace, Meaning};
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn each_head_keeps_to_its_speeds_and_all_else_is_free() {
        let hyper =
            Hyperparameters { heads: 3, head_speeds: vec![[0.3, 2.0], [1.5, 6.0]], ..Hyperparameters::default() };
        let space = ActionSpace::Full;
        let outputs = hyper.heads * space.actions();
        let networks = Networks::random(&hyper, &mut Xoshiro256PlusPlus::seed_from_u64(1)).unwrap();
        let speeds = |output: f32| {
            let outputs = Tensor::full(output, (1, outputs), &Device::Cpu).unwrap();
            let actions = actions_in(space, &networks.squash(&outputs).unwrap()).unwrap();
            assert!(actions.iter().all(|action| (action[0] - output.tanh()).abs() < 1e-6), "{actions:?}");
            // Under a level cue an action's speed is the stroke's.
            let level = |action: &[f32; 5]| Meaning::of(&Table::default(), [action[0], action[1], 0.0, 0.0, -1.0]);
            actions.iter().map(|action| level(action).speed.value).collect::<Vec<_>>()
        };
        for (output, expected) in [(-20.0, [0.3, 1.5, 0.3]), (20.0, [2.0, 6.0, 2.0]), (0.0, [1.15, 3.75, 1.15])] {
            let speeds = speeds(output);
            assert!(speeds.iter().zip(expected).all(|(speed, expected)| (speed - expected).abs() < 1e-6), "{speeds:?}");
        }
    }
}
