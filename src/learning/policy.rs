//! A trained agent as a player: shots for a layout out of one pass through its networks, without the simulator.

use std::sync::Arc;

use candle_core::Result;

use super::{
    action::cue_inputs,
    networks::Networks,
    scenes::Scenes,
    view::{VIEWS, View},
};
use crate::{
    physics::CueInputs,
    table::{Layout, Table},
};

/// A shot that a policy proposes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// The stroke.
    pub cue: CueInputs,
    /// The critic's probability of success, 0 to 1.
    pub success: f64,
}

/// Trained networks.
#[derive(Clone, Debug)]
pub struct Policy {
    networks: Networks,
}

impl Policy {
    /// A policy that plays with `networks`.
    pub(super) const fn new(networks: Networks) -> Self {
        Self { networks }
    }

    /// The stroke that the critic likes best.
    pub fn propose(&self, table: &Table, layout: &Layout) -> CueInputs {
        self.proposals(table, layout)[0].cue
    }

    /// Every head's stroke for either object ball on either side, the critic's favourite first. There is at least one.
    pub fn proposals(&self, table: &Table, layout: &Layout) -> Vec<Proposal> {
        let mut all = self.proposals_for(table, std::slice::from_ref(layout));
        all.pop().expect("a layout has proposals")
    }

    /// [`Policy::proposals`] for many layouts in one pass.
    pub fn proposals_for(&self, table: &Table, layouts: &[Layout]) -> Vec<Vec<Proposal>> {
        self.judge(table, layouts).expect("the sizes of the networks were checked when they were loaded")
    }

    fn judge(&self, table: &Table, layouts: &[Layout]) -> Result<Vec<Vec<Proposal>>> {
        if layouts.is_empty() {
            return Ok(Vec::new());
        }
        let views = layouts.iter().flat_map(View::all).collect();
        let scenes = Scenes::new(&Arc::new(table.clone()), views)?;
        let (actions, logits) = self.networks.judge(&scenes)?;
        let heads = actions.len() / scenes.views().len();
        let mut proposals = actions.iter().zip(&logits).enumerate().map(|(row, (action, logit))| {
            let success = 1.0 / (1.0 + (-f64::from(*logit)).exp());
            // What is not a number must neither win nor upset the order.
            let success = if success.is_nan() { 0.0 } else { success };
            Proposal { cue: cue_inputs(table, &scenes.views()[row / heads], *action), success }
        });
        Ok((0..layouts.len())
            .map(|_| {
                let mut own: Vec<Proposal> = proposals.by_ref().take(VIEWS * heads).collect();
                own.sort_by(|a, b| b.success.total_cmp(&a.success));
                own
            })
            .collect())
    }
}
