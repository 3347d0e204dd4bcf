//! What a run has to report since its last line of metrics.

use serde::{Deserialize, Serialize};

use crate::learning::learner::Turn;

/// Sums over turns. They are part of a checkpoint: a line's means must not depend on where a run was interrupted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    turns: u64,
    mean_reward: f64,
    q_value: f64,
    critic_loss: f64,
    actor_loss: Option<f64>,
}

impl Tally {
    /// Adds a turn. `false` where it has numbers that are not finite.
    #[must_use]
    pub fn add(&mut self, turn: &Turn) -> bool {
        self.turns += 1;
        self.mean_reward += turn.mean_reward;
        self.q_value += turn.q_value;
        self.critic_loss += turn.critic_loss;
        if let Some(loss) = turn.actor_loss {
            *self.actor_loss.get_or_insert_default() += loss;
        }
        let sums = [self.mean_reward, self.q_value, self.critic_loss, self.actor_loss.unwrap_or_default()];
        sums.iter().all(|sum| sum.is_finite())
    }

    /// The means over the turns added since the last call.
    pub fn take(&mut self) -> Turn {
        let Self { turns, mean_reward, q_value, critic_loss, actor_loss } = std::mem::take(self);
        let turns = turns.max(1) as f64;
        Turn {
            mean_reward: mean_reward / turns,
            q_value: q_value / turns,
            critic_loss: critic_loss / turns,
            actor_loss: actor_loss.map(|sum| sum / turns),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_over_the_turns_since_the_last_and_survive_a_file() {
        let turn = |reward| Turn { mean_reward: reward, q_value: 0.1, critic_loss: 0.7, actor_loss: None };
        let mut tally = Tally::default();
        assert!(tally.add(&turn(0.1)) && tally.add(&turn(0.2)));
        let text = serde_json::to_string(&tally).unwrap();
        let mut again: Tally = serde_json::from_str(&text).unwrap();
        assert_eq!(again, tally);
        assert_eq!((again.take().mean_reward, again.take()), (f64::midpoint(0.1, 0.2), Turn::default()));
        assert!(!tally.add(&Turn { critic_loss: f64::INFINITY, ..turn(0.0) }));
    }
}
