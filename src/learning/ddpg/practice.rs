//! The shots of a turn: near the agent's choices, a search's solutions, and misses seen in hindsight.

use candle_core::Result;
use rand::RngExt;

use super::{
    action::Action,
    demonstrations::demonstrate,
    hindsight::relabel,
    hyperparameters::Hyperparameters,
    replay::Experience,
    scenes::Scenes,
    stroke::playable,
    trainer::Trainer,
    view::{VIEWS, View},
};
use crate::table::Layout;

/// Steps of resting contacts that are followed in practice; a shot that needs more counts for what it has earned so far.
/// Of 12,000 shots at a ball on the `thesis` table all but one earned the same as when followed to the end, in a
/// twentieth of the time.
pub const PATIENCE: u32 = 20;

impl Trainer {
    /// Plays the shots of one turn, each on a fresh layout, and returns their mean reward.
    pub(super) fn play(&mut self) -> Result<f64> {
        let Hyperparameters { shots_per_update, critic_chooses, demonstrations, .. } = self.task.hyperparameters;
        let layouts: Vec<_> = (0..shots_per_update).map(|_| Layout::random(&self.table, &mut self.rng)).collect();
        let part = |share: f64, of: usize| ((of as f64 * share).round() as usize).min(of);
        let (shown, own) = layouts.split_at(part(demonstrations, shots_per_update));
        self.learn_from_the_expert(shown);
        let (chosen, any) = own.split_at(part(critic_chooses, own.len()));
        let total = self.play_favourites(chosen)? + self.play_any(any)?;
        self.shots += layouts.len() as u64;
        Ok(total / own.len().max(1) as f64)
    }

    /// Remembers an expert's shot on each layout for which there is one.
    fn learn_from_the_expert(&mut self, layouts: &[Layout]) {
        let (reward, space) = (self.task.reward, self.space());
        for layout in layouts {
            if let Some(shot) = demonstrate(&self.table, reward, space, layout, PATIENCE, &mut self.rng) {
                self.replay.push(shot);
            }
        }
    }

    /// Plays near the critic's favourite on every layout: there it must learn where it is wrong. Returns the rewards'
    /// sum.
    fn play_favourites(&mut self, layouts: &[Layout]) -> Result<f64> {
        if layouts.is_empty() {
            return Ok(0.0);
        }
        let scenes = Scenes::new(&self.table, self.space(), layouts.iter().flat_map(View::all).collect())?;
        let (actions, logits) = self.agent.online().judge(&scenes)?;
        let heads = actions.len() / scenes.views().len();
        let mut total = 0.0;
        for (index, layout) in layouts.iter().enumerate() {
            let rows = index * VIEWS * heads..(index + 1) * VIEWS * heads;
            let best = rows.max_by(|a, b| logits[*a].total_cmp(&logits[*b])).unwrap_or(0);
            total += self.shoot(layout, scenes.views()[best / heads], actions[best]);
        }
        Ok(total)
    }

    /// Plays near any head's choice in any view of every layout. Returns the rewards' sum.
    fn play_any(&mut self, layouts: &[Layout]) -> Result<f64> {
        if layouts.is_empty() {
            return Ok(0.0);
        }
        let views = layouts.iter().map(|layout| View::new(layout, self.rng.random_range(0..VIEWS))).collect();
        let scenes = Scenes::new(&self.table, self.space(), views)?;
        let actions = self.agent.online().actions(&scenes)?;
        let heads = actions.len() / layouts.len();
        let mut total = 0.0;
        for (index, layout) in layouts.iter().enumerate() {
            let choice = actions[index * heads + self.rng.random_range(0..heads)];
            total += self.shoot(layout, scenes.views()[index], choice);
        }
        Ok(total)
    }

    /// Plays and remembers one shot near `choice`; returns its reward.
    fn shoot(&mut self, layout: &Layout, view: View, choice: Action) -> f64 {
        let action = self.task.hyperparameters.exploration.stray(self.space(), choice, &mut self.rng);
        // Where the cue has no room there is no stroke, and nothing is earned.
        let reward = playable(&self.table, layout, &view, action)
            .map_or(0.0, |cue| self.task.reward.within(&self.table, layout, &cue, PATIENCE));
        let success = (reward / self.task.reward.highest()) as f32;
        self.replay.push(Experience { view, action, success });
        let hindsight = self.task.hyperparameters.hindsight;
        if hindsight > 0.0 && success < 1.0 && self.rng.random_bool(hindsight) {
            let shot = (layout, &view, action);
            if let Some(point) = relabel(&self.table, self.task.reward, shot, PATIENCE, &mut self.rng) {
                self.replay.push(point);
            }
        }
        reward
    }
}
