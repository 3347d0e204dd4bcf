//! A batch of observations as input of the networks, and the conversion of actions to the critic's input as a candle operation.

use std::sync::{Arc, OnceLock};

use candle_core::{CpuStorage, CustomOp1, Device, Layout, Result, Shape, Tensor, bail};

use super::{
    action::{ACTIONS, Action, ActionSpace},
    context::{Inputs, push_context},
    dual::Dual,
    features::{ACTION_FEATURES, keep_action_only, push_action_features, push_state_features},
    first_contact::RAIL_FEATURES,
    observation::Observation,
    paths::Paths,
};
use crate::{
    learning::nn::{stored_values, values},
    table::{Rail, Table},
};

/// An observation with its context.
#[derive(Clone, Debug)]
pub struct ContextualObservation {
    pub observation: Observation,
    pub table: Arc<Table>,
    /// The player's errors as a multiple of an expert's; only networks with a context use them.
    pub errors: f64,
}

/// Converts actions to the rows of a tensor, without the unused numbers.
pub fn action_rows(space: ActionSpace, actions: &[Action]) -> Result<Tensor> {
    let used = space.actions();
    let values: Vec<f32> = actions.iter().flat_map(|action| action[..used].iter().copied()).collect();
    Tensor::from_vec(values, (actions.len(), used), &Device::Cpu)
}

/// Converts the rows of a tensor to actions; the unused numbers are zero.
pub fn actions_in(space: ActionSpace, rows: &Tensor) -> Result<Vec<Action>> {
    let values: Vec<f32> = rows.flatten_all()?.to_vec1()?;
    Ok(values.chunks_exact(space.actions()).map(padded).collect())
}

fn padded(used: &[f32]) -> Action {
    let mut action = [0.0; ACTIONS];
    action[..used.len()].copy_from_slice(used);
    action
}

/// A batch of observations with their features.
#[derive(Clone, Debug)]
pub struct ObservationBatch {
    inputs: Inputs,
    pub observations: Arc<[ContextualObservation]>,
    /// The actor's input, one row per observation.
    pub states: Tensor,
}

impl ObservationBatch {
    /// Creates a batch for networks with these inputs.
    pub fn new(inputs: Inputs, observations: Vec<ContextualObservation>) -> Result<Self> {
        let mut features = Vec::with_capacity(observations.len() * inputs.actor());
        for ContextualObservation { observation, table, errors } in &observations {
            push_state_features(table, observation, &mut features);
            if inputs.context {
                push_context(table, observation.mirror, *errors, &mut features);
            }
            if inputs.rails_first {
                features.extend(Rail::ALL.map(|rail| f32::from(u8::from(observation.rail == Some(rail)))));
            }
        }
        let states = Tensor::from_vec(features, (observations.len(), inputs.actor()), &Device::Cpu)?;
        Ok(Self { inputs, observations: observations.into(), states })
    }

    /// Creates a batch of observations on one table for networks without a context and actions in `space`.
    pub fn on(table: &Arc<Table>, space: ActionSpace, observations: Vec<Observation>) -> Result<Self> {
        let contextual = |observation| ContextualObservation { observation, table: Arc::clone(table), errors: 0.0 };
        let inputs = Inputs { space, context: false, closed_form: true, rails_first: false };
        Self::new(inputs, observations.into_iter().map(contextual).collect())
    }

    pub const fn space(&self) -> ActionSpace {
        self.inputs.space
    }

    /// Returns the first `count` observations, or all if there are fewer.
    pub fn first(&self, count: usize) -> Result<Self> {
        let count = count.min(self.observations.len());
        Ok(Self {
            inputs: self.inputs,
            observations: self.observations[..count].into(),
            states: self.states.narrow(0, 0, count)?,
        })
    }

    /// Returns the critic's input for `actions` (rows x actions of the space), one row per action. Each observation has the same number of
    /// consecutive rows. Gradients flow to the actions.
    ///
    /// # Errors
    /// Fails if the number of actions is not a multiple of the number of observations.
    pub fn with_actions(&self, actions: &Tensor) -> Result<Tensor> {
        actions.apply_op1(Join { observed: self.clone(), slopes: OnceLock::new(), differentiate: actions.track_op() })
    }
}

/// The operation that appends the features of actions to those of observations.
struct Join {
    observed: ObservationBatch,
    /// Slopes of the action features along the actions, row by row, stored by the forward pass for the backward pass.
    slopes: OnceLock<Vec<Action>>,
    differentiate: bool,
}

impl CustomOp1 for Join {
    fn name(&self) -> &'static str {
        "critic input"
    }

    fn cpu_fwd(&self, storage: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, columns) = layout.shape().dims2()?;
        let (observations, inputs) = (self.observed.observations.len(), self.observed.inputs);
        let (space, state) = (inputs.space, inputs.actor());
        if columns != space.actions() || observations == 0 || rows % observations != 0 {
            bail!(
                "{rows} actions of {columns} numbers do not fit {observations} observations of {} numbers",
                space.actions()
            );
        }
        let (state_storage, state_layout) = self.observed.states.storage_and_layout();
        let states = stored_values(&state_storage, state_layout)?;
        let mut out = Vec::with_capacity(rows * inputs.critic());
        let mut slopes = Vec::with_capacity(if self.differentiate { rows * inputs.action() } else { 0 });
        let mut features: Vec<Dual> = Vec::with_capacity(ACTION_FEATURES + RAIL_FEATURES);
        let each = (rows / observations * columns).max(1);
        let observations = self.observed.observations.iter().zip(states.chunks_exact(state));
        for ((contextual, state), actions) in observations.zip(values(storage, layout)?.chunks_exact(each)) {
            let paths = Paths::of(&contextual.table, &contextual.observation);
            for action in actions.chunks_exact(columns) {
                features.clear();
                push_action_features(&paths, padded(action), self.differentiate, &mut features);
                // The features of a path by a cushion are last; this cuts them off if they are not among the inputs.
                features.truncate(inputs.action());
                if !inputs.closed_form {
                    keep_action_only(&mut features);
                }
                out.extend_from_slice(state);
                out.extend(features.iter().map(|feature| feature.value as f32));
                if self.differentiate {
                    slopes.extend(features.iter().map(|feature| feature.slope.map(|slope| slope as f32)));
                }
            }
        }
        self.slopes.get_or_init(|| slopes);
        Ok((CpuStorage::F32(out), Shape::from((rows, inputs.critic()))))
    }

    fn bwd(&self, _actions: &Tensor, _inputs: &Tensor, gradient: &Tensor) -> Result<Option<Tensor>> {
        let Some(slopes) = self.slopes.get() else { bail!("the forward pass of this operation is missing") };
        let (storage, layout) = gradient.storage_and_layout();
        let gradient = stored_values(&storage, layout)?;
        let inputs = self.observed.inputs;
        let (used, rows) = (inputs.space.actions(), slopes.len() / inputs.action());
        let mut out: Vec<f32> = Vec::with_capacity(rows * used);
        for (slopes, row) in slopes.chunks_exact(inputs.action()).zip(gradient.chunks_exact(inputs.critic())) {
            let mut sum = [0.0; ACTIONS];
            for (slope, error) in slopes.iter().zip(&row[inputs.actor()..]) {
                for (sum, slope) in sum.iter_mut().zip(slope) {
                    *sum += slope * error;
                }
            }
            out.extend(&sum[..used]);
        }
        Tensor::from_vec(out, (rows, used), &Device::Cpu).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use candle_core::Var;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn observations_are_joined_with_their_own_actions() {
        let table = Arc::new(Table::default());
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(10);
        let layout = crate::table::Layout::random(&table, &mut rng);
        for space in [ActionSpace::PhiV, ActionSpace::Full] {
            let observed =
                ObservationBatch::on(&table, space, Observation::all_straight(&layout)[..2].to_vec()).unwrap();
            let values: Vec<Action> =
                (1..5).map(|row| padded(&[0.1 * row as f32; ACTIONS][..space.actions()])).collect();
            let actions = Var::from_tensor(&action_rows(space, &values).unwrap()).unwrap();
            assert_eq!(actions_in(space, &actions).unwrap(), values);
            let inputs = observed.with_actions(&actions).unwrap();
            let rows: Vec<Vec<f32>> = inputs.to_vec2().unwrap();
            let states: Vec<Vec<f32>> = observed.states.to_vec2().unwrap();
            for (row, input) in rows.iter().enumerate() {
                assert_eq!(input.len(), observed.inputs.critic());
                assert_eq!(input[..observed.inputs.actor()], states[row / 2]);
            }
            let gradients = inputs.sum_all().unwrap().backward().unwrap();
            let gradient: Vec<Vec<f32>> = gradients.get(&actions).unwrap().to_vec2().unwrap();
            let mut features = Vec::new();
            push_action_features(
                &Paths::of(&table, &observed.observations[1].observation),
                values[2],
                true,
                &mut features,
            );
            let expected = features.iter().map(|feature| feature.slope[0] as f32).sum::<f32>();
            assert!((gradient[2][0] - expected).abs() < 1e-4);
            assert!(observed.with_actions(&actions.narrow(0, 0, 3).unwrap()).is_err());
        }
    }
}
