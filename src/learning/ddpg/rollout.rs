//! Rollout, the shots of one iteration: near the agent's choices, a search's solutions, and misses seen in hindsight.

use candle_core::Result;
use rand::RngExt;

use super::{
    action::Action,
    demonstrations::demonstrate,
    first_contact::playable,
    hindsight::relabel,
    hyperparameters::Hyperparameters,
    observation::{OBSERVATIONS, Observation},
    observation_batch::ObservationBatch,
    replay::Transition,
    trainer::Trainer,
};
use crate::{learning::evaluation::CONTACT_STEPS, table::Layout};

impl Trainer {
    /// Plays the shots of one turn, each on a fresh layout, and returns their mean reward.
    pub(super) fn play(&mut self) -> Result<f64> {
        let Hyperparameters { shots_per_update, critic_chooses, demonstrations, .. } = self.task.hyperparameters;
        let layouts: Vec<_> = (0..shots_per_update).map(|_| Layout::random(&self.table, &mut self.rng)).collect();
        let part = |share: f64, of: usize| ((of as f64 * share).round() as usize).min(of);
        let (shown, own) = layouts.split_at(part(demonstrations, shots_per_update));
        self.add_demonstrations(shown);
        let (chosen, any) = own.split_at(part(critic_chooses, own.len()));
        let total = self.play_near_best(chosen)? + self.play_any(any)?;
        self.shots += layouts.len() as u64;
        Ok(total / own.len().max(1) as f64)
    }

    /// Remembers an expert's shot on each layout for which there is one.
    fn add_demonstrations(&mut self, layouts: &[Layout]) {
        let (reward, space) = (self.task.reward, self.space());
        for layout in layouts {
            if let Some(shot) = demonstrate(&self.table, reward, space, layout, CONTACT_STEPS, &mut self.rng) {
                self.replay.push(shot);
            }
        }
    }

    /// Plays near the critic's favourite on every layout: there it must learn where it is wrong. Returns the rewards'
    /// sum.
    fn play_near_best(&mut self, layouts: &[Layout]) -> Result<f64> {
        if layouts.is_empty() {
            return Ok(0.0);
        }
        let observed =
            ObservationBatch::new(&self.table, self.space(), layouts.iter().flat_map(Observation::all).collect())?;
        let (actions, logits) = self.agent.online().judge(&observed)?;
        let heads = actions.len() / observed.observations().len();
        let mut total = 0.0;
        for (index, layout) in layouts.iter().enumerate() {
            let rows = index * OBSERVATIONS * heads..(index + 1) * OBSERVATIONS * heads;
            let best = rows.max_by(|a, b| logits[*a].total_cmp(&logits[*b])).unwrap_or(0);
            total += self.rollout(layout, observed.observations()[best / heads], actions[best]);
        }
        Ok(total)
    }

    /// Plays near any head's choice in any observation of every layout. Returns the rewards' sum.
    fn play_any(&mut self, layouts: &[Layout]) -> Result<f64> {
        if layouts.is_empty() {
            return Ok(0.0);
        }
        let observations =
            layouts.iter().map(|layout| Observation::new(layout, self.rng.random_range(0..OBSERVATIONS))).collect();
        let observed = ObservationBatch::new(&self.table, self.space(), observations)?;
        let actions = self.agent.online().actions(&observed)?;
        let heads = actions.len() / layouts.len();
        let mut total = 0.0;
        for (index, layout) in layouts.iter().enumerate() {
            let choice = actions[index * heads + self.rng.random_range(0..heads)];
            total += self.rollout(layout, observed.observations()[index], choice);
        }
        Ok(total)
    }

    /// Plays and remembers one shot near `choice`; returns its reward.
    fn rollout(&mut self, layout: &Layout, observation: Observation, choice: Action) -> f64 {
        let action = self.task.hyperparameters.exploration.stray(self.space(), choice, &mut self.rng);
        // Where the cue has no room there is no stroke, and nothing is earned.
        let reward = playable(&self.table, layout, &observation, action)
            .map_or(0.0, |cue| self.task.reward.within(&self.table, layout, &cue, CONTACT_STEPS));
        let success = (reward / self.task.reward.highest()) as f32;
        self.replay.push(Transition { observation, action, success });
        let hindsight = self.task.hyperparameters.hindsight;
        if hindsight > 0.0 && success < 1.0 && self.rng.random_bool(hindsight) {
            let shot = (layout, &observation, action);
            if let Some(point) = relabel(&self.table, self.task.reward, shot, CONTACT_STEPS, &mut self.rng) {
                self.replay.push(point);
            }
        }
        reward
    }
}
