//! The quantities of a run's metrics, as charts show them.

use super::metrics::Record;

/// A quantity of the metrics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Mean reward of the shots played, exploration included (the thesis' Figures 23 to 25, left).
    Reward,
    /// Mean value that the agent assigns to its own choices (the same figures, middle).
    QValue,
    /// Loss of the critic or of the Q-function (the same figures, right).
    CriticLoss,
    /// Mean reward on held-out layouts, without exploration.
    HeldOut,
    /// Loss of the actor.
    ActorLoss,
    /// Best-of-k success: share of the held-out layouts on which any proposal earns 1 or more.
    BestOfK,
    /// Shots per second, without the time of evaluations.
    ShotSpeed,
    /// Updates per second, without the time of evaluations.
    UpdateSpeed,
    /// Strength of the exploration.
    Exploration,
}

impl Quantity {
    /// Number of quantities.
    pub const COUNT: usize = Self::ALL.len();

    /// All quantities, in the order of their keys; the first four are the main ones.
    pub const ALL: [Self; 9] = [
        Self::Reward,
        Self::QValue,
        Self::CriticLoss,
        Self::HeldOut,
        Self::ActorLoss,
        Self::BestOfK,
        Self::ShotSpeed,
        Self::UpdateSpeed,
        Self::Exploration,
    ];

    /// Returns the name for charts.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reward => "mean reward",
            Self::QValue => "mean Q-value",
            Self::CriticLoss => "critic loss",
            Self::HeldOut => "held-out success",
            Self::ActorLoss => "actor loss",
            Self::BestOfK => "best-of-k success",
            Self::ShotSpeed => "shots a second",
            Self::UpdateSpeed => "updates a second",
            Self::Exploration => "exploration",
        }
    }

    /// Returns the value in a line of metrics; the speed of updates needs the previous line. `None` if the line does not contain the
    /// quantity, which is different from a value of NaN.
    pub fn of(self, record: &Record, before: Option<&Record>) -> Option<f64> {
        match self {
            Self::Reward => Some(record.rollout_reward),
            Self::QValue => Some(record.q_value),
            Self::CriticLoss => Some(record.critic_loss),
            Self::HeldOut => record.held_out_reward,
            Self::ActorLoss => record.actor_loss,
            Self::BestOfK => record.best_of_k,
            Self::ShotSpeed => Some(record.shots_per_second),
            Self::UpdateSpeed => {
                let (updates, shots) = before.map_or((0, 0), |before| (before.updates, before.shots));
                let played = record.shots.saturating_sub(shots);
                let updates_per_shot = record.updates.saturating_sub(updates) as f64 / played as f64;
                (played > 0).then_some(updates_per_shot * record.shots_per_second)
            }
            Self::Exploration => record.exploration,
        }
    }
}
