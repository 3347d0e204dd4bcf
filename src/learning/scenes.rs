//! A batch of views as the networks take it, and the step from an action to the critic's input as a candle operation.

use std::sync::{Arc, OnceLock};

use candle_core::{CpuStorage, CustomOp1, Device, Layout, Result, Shape, Tensor, bail};

use super::{
    action::{ACTIONS, Action},
    features::{ACTION_FEATURES, STATE_FEATURES, action_features, push_state_features},
    tensors::{stored_values, values},
    view::View,
};
use crate::table::Table;

/// Inputs of the actor.
pub const ACTOR_INPUTS: usize = STATE_FEATURES;

/// Inputs of the critic.
pub const CRITIC_INPUTS: usize = STATE_FEATURES + ACTION_FEATURES;

/// Views on one table with their state features.
#[derive(Clone, Debug)]
pub struct Scenes {
    table: Arc<Table>,
    views: Arc<[View]>,
    states: Tensor,
}

impl Scenes {
    /// A batch of views.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn new(table: &Arc<Table>, views: Vec<View>) -> Result<Self> {
        let mut features = Vec::with_capacity(views.len() * STATE_FEATURES);
        for view in &views {
            push_state_features(table, view, &mut features);
        }
        let states = Tensor::from_vec(features, (views.len(), STATE_FEATURES), &Device::Cpu)?;
        Ok(Self { table: Arc::clone(table), views: views.into(), states })
    }

    /// The views.
    pub fn views(&self) -> &[View] {
        &self.views
    }

    /// The actor's input, a row for each view.
    pub const fn states(&self) -> &Tensor {
        &self.states
    }

    /// The first `count` views, or all if there are fewer.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn first(&self, count: usize) -> Result<Self> {
        let count = count.min(self.views.len());
        let states = self.states.narrow(0, 0, count)?;
        Ok(Self { table: Arc::clone(&self.table), views: self.views[..count].into(), states })
    }

    /// The critic's input for `actions`, a row for each action (rows x [`ACTIONS`]); each view takes the same number of
    /// consecutive rows. Gradients flow to the actions.
    ///
    /// # Errors
    /// Where the number of actions is no multiple of the number of views.
    pub fn with_actions(&self, actions: &Tensor) -> Result<Tensor> {
        actions.apply_op1(Join { scenes: self.clone(), slopes: OnceLock::new(), differentiate: actions.track_op() })
    }

    /// As [`Scenes::with_actions`], but outside candle's automatic differentiation, with the operation that takes
    /// gradients back from the critic's input to the actions.
    ///
    /// # Errors
    /// As [`Scenes::with_actions`].
    pub fn record_actions(&self, actions: &Tensor) -> Result<(Tensor, Join)> {
        let join = Join { scenes: self.clone(), slopes: OnceLock::new(), differentiate: true };
        Ok((actions.apply_op1_no_bwd(&join)?, join))
    }
}

/// The operation that appends actions to views.
pub struct Join {
    scenes: Scenes,
    /// Slopes of the action features along the actions, kept by the forward pass for the backward pass.
    slopes: OnceLock<Vec<[[f32; ACTIONS]; ACTION_FEATURES]>>,
    differentiate: bool,
}

impl Join {
    /// The gradient for the actions from that for the critic's input.
    ///
    /// # Errors
    /// Where the operation has not run forward.
    pub fn backward(&self, gradient: &Tensor) -> Result<Tensor> {
        let Some(slopes) = self.slopes.get() else { bail!("the forward pass of this operation is missing") };
        let (storage, layout) = gradient.storage_and_layout();
        let gradient = stored_values(&storage, layout)?;
        let mut out: Vec<Action> = Vec::with_capacity(slopes.len());
        for (slopes, row) in slopes.iter().zip(gradient.chunks_exact(CRITIC_INPUTS)) {
            let mut sum = [0.0; ACTIONS];
            for (slope, error) in slopes.iter().zip(&row[STATE_FEATURES..]) {
                for (sum, slope) in sum.iter_mut().zip(slope) {
                    *sum += slope * error;
                }
            }
            out.push(sum);
        }
        Tensor::from_vec(out.into_flattened(), (slopes.len(), ACTIONS), &Device::Cpu)
    }
}

impl CustomOp1 for Join {
    fn name(&self) -> &'static str {
        "critic input"
    }

    fn cpu_fwd(&self, storage: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, columns) = layout.shape().dims2()?;
        let views = self.scenes.views.len();
        if columns != ACTIONS || views == 0 || rows % views != 0 {
            bail!("{rows} actions of {columns} numbers do not fit {views} views");
        }
        let (state_storage, state_layout) = self.scenes.states.storage_and_layout();
        let states = stored_values(&state_storage, state_layout)?;
        let (actions, _) = values(storage, layout)?.as_chunks::<ACTIONS>();
        let mut out = Vec::with_capacity(rows * CRITIC_INPUTS);
        let mut slopes = Vec::with_capacity(if self.differentiate { rows } else { 0 });
        let cases = self.scenes.views.iter().zip(states.chunks_exact(STATE_FEATURES));
        for ((view, state), actions) in cases.zip(actions.chunks_exact(rows / views)) {
            for action in actions {
                let features = action_features(&self.scenes.table, view, *action);
                out.extend_from_slice(state);
                out.extend(features.map(|feature| feature.value as f32));
                if self.differentiate {
                    slopes.push(features.map(|feature| feature.slope.map(|slope| slope as f32)));
                }
            }
        }
        self.slopes.get_or_init(|| slopes);
        Ok((CpuStorage::F32(out), Shape::from((rows, CRITIC_INPUTS))))
    }

    fn bwd(&self, _actions: &Tensor, _inputs: &Tensor, gradient: &Tensor) -> Result<Option<Tensor>> {
        self.backward(gradient).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use candle_core::Var;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn each_view_meets_its_own_actions_and_gradients_reach_them() {
        let table = Arc::new(Table::default());
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(10);
        let layout = crate::table::Layout::random(&table, &mut rng);
        let scenes = Scenes::new(&table, View::all(&layout)[..2].to_vec()).unwrap();
        let actions = Var::new(&[[0.1f32, 0.2], [0.3, 0.4], [0.5, 0.6], [0.7, 0.8]], &Device::Cpu).unwrap();
        let inputs = scenes.with_actions(&actions).unwrap();
        let rows: Vec<Vec<f32>> = inputs.to_vec2().unwrap();
        let states: Vec<Vec<f32>> = scenes.states().to_vec2().unwrap();
        for (row, input) in rows.iter().enumerate() {
            assert_eq!(input[..STATE_FEATURES], states[row / 2]);
        }
        let gradients = inputs.sum_all().unwrap().backward().unwrap();
        let gradient: Vec<Vec<f32>> = gradients.get(&actions).unwrap().to_vec2().unwrap();
        let expected = action_features(&table, &scenes.views()[1], [0.5, 0.6]).map(|f| f.slope[0] as f32);
        assert!((gradient[2][0] - expected.iter().sum::<f32>()).abs() < 1e-4);
        assert!(scenes.with_actions(&actions.narrow(0, 0, 3).unwrap()).is_err());
    }
}
