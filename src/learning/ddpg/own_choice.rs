//! The shots by which a finished run's critic is calibrated: its own choice on fresh layouts.

use candle_core::Result;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    action::Action,
    hyperparameters::Hyperparameters,
    observation::Observation,
    policy::calibration::{Calibration, Trial},
    rollout::Scene,
    trainer::Trainer,
    ways::playable,
};
use crate::table::Layout;

/// How often a player who errs strikes each of his choices.
const ATTEMPTS: usize = 16;

/// Layouts that are judged in one pass: their numbers stay in the processor's cache.
const AT_ONCE: usize = 64;

/// Tells these layouts from all else that is drawn from a run's seed.
const STREAM: u64 = 0x0070_6c61_7474;

impl Trainer {
    /// Fits the calibration: the averaged networks' own choice is played on fresh layouts, half of them on the run's own table, with
    /// errors drawn as in practice.
    pub(super) fn calibration(&self) -> Result<Calibration> {
        let Hyperparameters { perfect, calibrated, .. } = self.task.hyperparameters;
        let reward = self.task.plan.reward;
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.task.plan.seed ^ STREAM);
        let scenes: Vec<Scene> = (0..calibrated)
            .map(|number| {
                let conditions = self.tables.draw(perfect, &mut rng);
                let conditions = if number % 2 == 0 { conditions.at_home() } else { conditions };
                (Layout::random(self.tables.table(conditions), &mut rng), conditions)
            })
            .collect();
        let mut trials = Vec::with_capacity(calibrated);
        for scenes in scenes.chunks(AT_ONCE) {
            for ((layout, conditions), mut proposals) in scenes.iter().zip(self.judged(&self.agent.target, scenes)?) {
                let table = self.tables.table(*conditions);
                let has_room = |(observation, action, _): &(Observation, Action, f32)| {
                    playable(table, layout, observation, *action).is_ok()
                };
                proposals.sort_by(|(.., a), (.., b)| a.total_cmp(b));
                let Some((observation, action, logit)) = proposals.into_iter().rfind(has_room) else { continue };
                let attempts = if conditions.errors == 0.0 { 1 } else { ATTEMPTS };
                let attempt = |_| self.tables.attempt(reward, layout, (&observation, action), *conditions, &mut rng);
                trials.push(Trial {
                    logit: f64::from(logit),
                    errors: f64::from(conditions.errors),
                    attempts: attempts as f64,
                    successes: (0..attempts).map(attempt).sum::<f64>() / reward.highest(),
                });
            }
        }
        Ok(Calibration::of(&trials))
    }
}
