//! From the actor's outputs to actions between -1 and 1, with every head's speed within a range of its own.

use candle_core::{Device, Result, Tensor};

use super::{action::speed_of, hyperparameters::Hyperparameters};

/// Place of the speed among the numbers of an action.
const SPEED: usize = 1;

/// The squashing of an actor's outputs.
#[derive(Clone, Debug)]
pub struct Squash {
    /// Numbers of an action.
    actions: usize,
    /// Half the width and the middle of what each output may become, where heads have ranges of their own.
    ranges: Option<[Tensor; 2]>,
}

impl Squash {
    /// That of an actor with so many outputs and these settings.
    pub fn new(hyper: &Hyperparameters, outputs: usize) -> Result<Self> {
        let actions = hyper.actions.actions();
        if hyper.head_speeds.is_empty() {
            return Ok(Self { actions, ranges: None });
        }
        let (mut half, mut middle) = (vec![1.0_f32; outputs], vec![0.0_f32; outputs]);
        for (head, speeds) in (0..outputs / actions).zip(hyper.head_speeds.iter().cycle()) {
            let [low, high] = speeds.map(speed_of);
            half[head * actions + SPEED] = 0.5 * (high - low);
            middle[head * actions + SPEED] = 0.5 * (high + low);
        }
        let row = |values| Tensor::from_vec(values, (1, outputs), &Device::Cpu);
        Ok(Self { actions, ranges: Some([row(half)?, row(middle)?]) })
    }

    /// The heads' actions for the actor's outputs (observations x outputs), a row each, the heads of an observation one after the
    /// other.
    ///
    /// # Errors
    /// Where the outputs are of another actor.
    pub fn actions(&self, outputs: &Tensor) -> Result<Tensor> {
        let squashed = outputs.tanh()?;
        let placed = match &self.ranges {
            Some([half, middle]) => squashed.broadcast_mul(half)?.broadcast_add(middle)?,
            None => squashed,
        };
        placed.reshape(((), self.actions))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::{
            action::{ActionSpace, Meaning},
            observation_batch::actions_in,
        },
        table::Table,
    };

    #[test]
    fn each_head_keeps_to_its_speeds_and_all_else_is_free() {
        let hyper =
            Hyperparameters { heads: 3, head_speeds: vec![[0.3, 2.0], [1.5, 6.0]], ..Hyperparameters::default() };
        let space = ActionSpace::Full;
        let outputs = hyper.heads * space.actions();
        let squash = Squash::new(&hyper, outputs).unwrap();
        let speeds = |output: f32| {
            let outputs = Tensor::full(output, (1, outputs), &Device::Cpu).unwrap();
            let actions = actions_in(space, &squash.actions(&outputs).unwrap()).unwrap();
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
