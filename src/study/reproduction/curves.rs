//! Trains an agent and records its learning curve: mean reward, mean Q and loss over every interval of shots.

use candle_core::Error;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde_json::Value;

use super::figures::{Figure, Measure, Variant};
use crate::{
    game::Reward,
    learning::{
        evaluation::{EVALUATION_SEED, held_out_layouts},
        learner::{AgentKind, Iteration, Learner, StartError, TrainingPlan},
        run::Accumulator,
        thesis::carom::cue_inputs,
    },
    table::{Layout, Table},
};

/// Number of shots averaged in a point of a curve (4.4.2: intervals of 10,000 episodes).
pub const INTERVAL: u64 = 10_000;

/// Number of layouts of an agent's final evaluation. They differ from the layouts for evaluation during training, which serve
/// to choose settings.
pub const EVALUATION_LAYOUTS: usize = 10_000;

/// Means over an interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Shots played by the end of the interval.
    pub shots: u64,
    /// Mean reward, exploration included.
    pub mean_reward: f64,
    /// Mean Q-value of the agent's own actions.
    pub mean_q: f64,
    /// Critic loss: mean squared error of the Q-values.
    pub loss: f64,
}

impl Point {
    /// Returns the measure that a figure shows.
    pub const fn of(&self, measure: Measure) -> f64 {
        match measure {
            Measure::MeanReward => self.mean_reward,
            Measure::MeanQ => self.mean_q,
            Measure::Loss => self.loss,
        }
    }
}

/// The result of a training.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// A point for every interval.
    pub points: Vec<Point>,
    /// Mean reward on held-out layouts, one shot each, without exploration.
    pub held_out: Option<f64>,
    /// Why the training broke down, in which case the curve ends early; `None` if it did not.
    pub breakdown: Option<String>,
}

/// Setup of a training; figures with equal setups share its curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Training {
    /// The agent's name.
    pub agent: &'static str,
    /// The reward function.
    pub reward: Reward,
    /// The agent's settings, whatever the figure calls them.
    pub settings: Value,
    /// Shots to play.
    pub shots: u64,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Training {
    /// Creates the training of one curve of a figure.
    pub fn of(figure: &Figure, variant: Variant, shots: u64, seed: u64) -> Self {
        let shots = variant.shots(shots);
        Self { agent: figure.agent, reward: figure.reward, settings: variant.settings(shots), shots, seed }
    }

    /// Runs the training. `played` receives the number of shots after each iteration and returns whether to continue; `None` if
    /// it stops the training.
    ///
    /// # Errors
    /// Fails if the agent cannot start.
    pub fn run(&self, table: &Table, played: &dyn Fn(u64) -> bool) -> Result<Option<Curve>, StartError> {
        let agent = AgentKind::named(self.agent).map_err(|error| StartError::Settings(error.to_string()))?;
        let plan = TrainingPlan { reward: self.reward, seed: self.seed, shots: self.shots };
        let mut learner = (agent.start)(plan, table.clone(), &self.settings)?;
        let mut curve = Curve::default();
        while !learner.is_finished() {
            match interval(learner.as_mut(), played) {
                Ok(Some(point)) => curve.points.push(point),
                Ok(None) => return Ok(None),
                Err(error) => {
                    // The first line names the error; candle appends a backtrace.
                    curve.breakdown = error.to_string().lines().next().map(str::to_owned);
                    return Ok(Some(curve));
                }
            }
        }
        curve.held_out =
            Some(learner.score(&held_out_layouts(table, EVALUATION_LAYOUTS, EVALUATION_SEED))?.mean_reward);
        Ok(Some(curve))
    }
}

/// Trains for the next interval; `None` if `played` stopped it.
fn interval(learner: &mut dyn Learner, played: &dyn Fn(u64) -> bool) -> Result<Option<Point>, Error> {
    let (start, mut sums) = (learner.shots(), Accumulator::default());
    while learner.shots() < start + INTERVAL && !learner.is_finished() {
        let (shots, updates_before) = (learner.shots(), learner.progress().updates);
        let iteration = learner.iterate()?;
        let (shots, updates) = (learner.shots() - shots, learner.progress().updates - updates_before);
        if !played(shots) {
            return Ok(None);
        }
        // Values that are not finite are kept in the curve.
        let _ = sums.add(&iteration, shots, updates);
    }
    let Iteration { mean_reward, q_value, critic_loss, .. } = sums.take();
    Ok(Some(Point { shots: learner.shots(), mean_reward, mean_q: q_value, loss: critic_loss }))
}

/// Returns the mean reward of random play, with uniform direction and speed, on the layouts of the final evaluation.
pub fn random_play(table: &Table, reward: Reward, seed: u64) -> f64 {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut shot = |layout: &Layout| {
        let cue = cue_inputs([rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]);
        reward.of_playable(table, layout, &cue, u32::MAX)
    };
    held_out_layouts(table, EVALUATION_LAYOUTS, EVALUATION_SEED).iter().map(&mut shot).sum::<f64>()
        / EVALUATION_LAYOUTS as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reproduction::figures::VARIANTS;

    #[test]
    fn curve_has_a_point_per_interval_and_is_reproducible() {
        let table = Table::preset("thesis").unwrap();
        let figure = Figure::named("q-learning").unwrap();
        let training = |seed| Training::of(&figure, VARIANTS[0], 12_000, seed);
        let curve = |seed| training(seed).run(&table, &|_| true).unwrap().unwrap();
        let one = curve(1);
        assert_eq!(one.points.iter().map(|point| point.shots).collect::<Vec<_>>(), [10_000, 12_000]);
        assert!(one.points.iter().all(|point| (0.05..0.5).contains(&point.mean_reward)), "{one:?}");
        assert_eq!(one, curve(1));
        assert_ne!(one.points, curve(2).points);
        assert_eq!(training(1).run(&table, &|_| false).unwrap(), None);
    }
}
