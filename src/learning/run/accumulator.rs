//! The accumulator of what a run has to report since its last line of metrics.

use serde::{Deserialize, Serialize};

use crate::learning::learner::Iteration;

/// Sums over iterations. They are part of a checkpoint: a line's means must not depend on where a run was interrupted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Accumulator {
    #[serde(rename = "turns")]
    iterations: u64,
    mean_reward: f64,
    q_value: f64,
    critic_loss: f64,
    actor_loss: Option<f64>,
}

impl Accumulator {
    /// Adds an iteration. `false` where it has numbers that are not finite.
    #[must_use]
    pub fn add(&mut self, iteration: &Iteration) -> bool {
        self.iterations += 1;
        self.mean_reward += iteration.mean_reward;
        self.q_value += iteration.q_value;
        self.critic_loss += iteration.critic_loss;
        if let Some(loss) = iteration.actor_loss {
            *self.actor_loss.get_or_insert_default() += loss;
        }
        let sums = [self.mean_reward, self.q_value, self.critic_loss, self.actor_loss.unwrap_or_default()];
        sums.iter().all(|sum| sum.is_finite())
    }

    /// The means over the iterations added since the last call.
    pub fn take(&mut self) -> Iteration {
        let Self { iterations, mean_reward, q_value, critic_loss, actor_loss } = std::mem::take(self);
        let count = iterations.max(1) as f64;
        Iteration {
            mean_reward: mean_reward / count,
            q_value: q_value / count,
            critic_loss: critic_loss / count,
            actor_loss: actor_loss.map(|sum| sum / count),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_over_the_iterations_since_the_last_and_survive_a_file() {
        let iteration = |reward| Iteration { mean_reward: reward, q_value: 0.1, critic_loss: 0.7, actor_loss: None };
        let mut accumulator = Accumulator::default();
        assert!(accumulator.add(&iteration(0.1)) && accumulator.add(&iteration(0.2)));
        let text = serde_json::to_string(&accumulator).unwrap();
        let mut again: Accumulator = serde_json::from_str(&text).unwrap();
        assert_eq!(again, accumulator);
        assert_eq!((again.take().mean_reward, again.take()), (f64::midpoint(0.1, 0.2), Iteration::default()));
        assert!(!accumulator.add(&Iteration { critic_loss: f64::INFINITY, ..iteration(0.0) }));
    }
}
