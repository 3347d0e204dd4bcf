//! Exploration in training: the actor's action plus noise, so that the critic learns its surroundings.

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::action::{Action, ActionSpace};
use crate::statistics::normal_pair;

/// Settings of the exploration noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "noise and uniform, or one of them, like { uniform = 0.1 }")]
pub struct Exploration {
    /// Standard deviations of the noise, in units of half an action's range; each shot draws one of them. Small ones
    /// sample the edges of a success window for the critic, large ones other windows.
    pub noise: Vec<f32>,
    /// Share of shots that are drawn uniformly from all actions.
    pub uniform: f64,
}

impl Default for Exploration {
    fn default() -> Self {
        Self { noise: vec![0.015, 0.05, 0.2], uniform: 0.1 }
    }
}

impl Exploration {
    /// Returns the action to play instead of `choice`.
    pub fn perturb(&self, space: ActionSpace, choice: Action, rng: &mut (impl Rng + ?Sized)) -> Action {
        let mut action = choice;
        let used = &mut action[..space.actions()];
        if rng.random_bool(self.uniform.clamp(0.0, 1.0)) {
            used.fill_with(|| rng.random_range(-1.0..=1.0));
        } else {
            let scale = self.noise[rng.random_range(0..self.noise.len())];
            for pair in used.chunks_mut(2) {
                for (value, noise) in pair.iter_mut().zip(normal_pair(rng)) {
                    *value = (*value + scale * noise as f32).clamp(-1.0, 1.0);
                }
            }
        }
        action
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::ddpg::action::ACTIONS;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn noise_has_the_promised_spread_and_stays_in_range() {
        let exploration = Exploration { noise: vec![0.1], uniform: 0.0 };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
        let perturbed: Vec<Action> =
            (0..10_000).map(|_| exploration.perturb(ActionSpace::PhiV, [0.5, 1.0, 0.0, 0.0, 0.0], &mut rng)).collect();
        let mean = perturbed.iter().map(|action| action[0]).sum::<f32>() / 10_000.0;
        let variance = perturbed.iter().map(|action| (action[0] - mean).powi(2)).sum::<f32>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.004 && (variance.sqrt() - 0.1).abs() < 0.004);
        assert!(perturbed.iter().all(|action| action[1] <= 1.0));
    }

    #[test]
    fn uniform_shots_fill_the_range() {
        let exploration = Exploration { noise: vec![0.0], uniform: 1.0 };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        let low =
            (0..1000).filter(|_| exploration.perturb(ActionSpace::Full, [0.9; ACTIONS], &mut rng)[0] < 0.0).count();
        assert!((400..600).contains(&low), "{low}");
    }
}
