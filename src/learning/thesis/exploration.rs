//! Exploration of the thesis' agents: epsilon-greedy (4.2.1) and Ornstein-Uhlenbeck noise.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::environment::{ACTIONS, Action};
use crate::{
    learning::settings::{SettingError, check_share},
    statistics::normal_pair,
};

/// Schedule of the probability of a random action, which falls linearly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "first, last and over, or some of them, like { last = 0.1 }")]
pub struct Epsilon {
    /// Probability at the first shot.
    pub first: f64,
    /// Probability from shot number `over` on.
    pub last: f64,
    /// Number of shots over which the probability falls.
    pub over: u64,
}

impl Epsilon {
    /// Returns the probability after `shots` shots.
    pub fn after(&self, shots: u64) -> f64 {
        let done = (shots as f64 / self.over.max(1) as f64).min(1.0);
        self.first + done * (self.last - self.first)
    }

    pub(super) fn validate(&self) -> Result<(), SettingError> {
        check_share("epsilon.first", self.first)?;
        check_share("epsilon.last", self.last)
    }
}

/// An Ornstein-Uhlenbeck process with mean zero, discretised as in keras-rl: `x += -theta x dt + sigma sqrt(dt) n`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "theta, sigma and dt, or some of them, like { sigma = 0.3 }")]
pub struct OrnsteinUhlenbeck {
    /// Rate of return to zero.
    pub theta: f64,
    /// Strength of the random part.
    pub sigma: f64,
    /// Time between two shots.
    pub dt: f64,
}

impl OrnsteinUhlenbeck {
    /// Returns the standard deviation of the noise on a shot: that of the first step if the process `restarts` with every shot, else
    /// the stationary one.
    pub fn deviation(&self, restarts: bool) -> f64 {
        let step = self.sigma * self.dt.sqrt();
        let retained = 1.0 - self.theta * self.dt;
        // A process that does not decay has no stationary deviation.
        if restarts || retained.abs() >= 1.0 { step } else { step / (1.0 - retained * retained).sqrt() }
    }

    /// Draws the next value after `now`.
    pub fn step(&self, now: Action, rng: &mut (impl Rng + ?Sized)) -> Action {
        let step = (self.sigma * self.dt.sqrt()) as f32;
        let noise = normal_pair(rng).map(|noise| noise as f32);
        let retained = (1.0 - self.theta * self.dt) as f32;
        std::array::from_fn::<f32, ACTIONS, _>(|index| retained * now[index] + step * noise[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn epsilon_falls_linearly_and_stays_low() {
        let epsilon = Epsilon { first: 1.0, last: 0.2, over: 100 };
        assert_eq!([0, 50, 100, 999].map(|shots| (epsilon.after(shots) * 1e3).round()), [1e3, 600.0, 200.0, 200.0]);
    }

    #[test]
    fn the_process_matches_its_variance_and_correlation() {
        let process = OrnsteinUhlenbeck { theta: 0.15, sigma: 0.3, dt: 1.0 };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let (mut now, mut square, mut product, count) = ([0.0; 2], 0.0, 0.0, 200_000);
        for _ in 0..count {
            let next = process.step(now, &mut rng);
            square += f64::from(next[1] * next[1]);
            product += f64::from(next[1] * now[1]);
            now = next;
        }
        // x' = a x + s n has the variance s² / (1 - a²) and the correlation a between neighbours.
        let expected = 0.09 / (1.0 - 0.85 * 0.85);
        assert!((square / f64::from(count) - expected).abs() < 0.01 * expected * 3.0);
        assert!((product / square - 0.85).abs() < 0.01);
    }
}
