//! Training for a figure's curve: mean reward, mean Q and loss over every interval of shots.

use candle_core::Error;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde_json::Value;

use super::figures::{Figure, Measure, Reading};
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

/// Shots over which a point of a curve is the mean (4.4.2: intervals of 10,000 episodes).
pub const INTERVAL: u64 = 10_000;

/// Layouts on which an agent is examined once it has learnt: other ones than training measures itself on, which choose settings.
pub const EXAMINED: usize = 10_000;

/// Means over an interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Shots played until its end.
    pub shots: u64,
    /// Mean reward, exploration included.
    pub mean_reward: f64,
    /// Mean value that the agent gives its own choices.
    pub mean_q: f64,
    /// Mean squared error of the values.
    pub loss: f64,
}

impl Point {
    /// What a figure shows of it.
    pub const fn of(&self, measure: Measure) -> f64 {
        match measure {
            Measure::MeanReward => self.mean_reward,
            Measure::MeanQ => self.mean_q,
            Measure::Loss => self.loss,
        }
    }
}

/// What came of a training.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// A point for every interval.
    pub points: Vec<Point>,
    /// Mean reward on held-out layouts, one shot each, without exploration.
    pub held_out: Option<f64>,
    /// Why the training broke down, if it did: then the curve ends early.
    pub broke_down: Option<String>,
}

/// What to train: figures of the same training share its curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Training {
    /// The agent's name.
    pub agent: &'static str,
    /// What is rewarded.
    pub reward: Reward,
    /// The agent's settings, whatever the figure calls them.
    pub settings: Value,
    /// Shots to play.
    pub shots: u64,
    /// Seed of everything random.
    pub seed: u64,
}

impl Training {
    /// The training of a figure.
    pub fn of(figure: &Figure, reading: Reading, shots: u64, seed: u64) -> Self {
        let shots = reading.shots(shots);
        Self { agent: figure.agent, reward: figure.reward, settings: reading.settings(shots), shots, seed }
    }

    /// Trains. `played` is told of shots as they are played, and says whether to go on; without that there is no curve.
    ///
    /// # Errors
    /// Where the agent cannot start.
    pub fn run(&self, table: &Table, played: &dyn Fn(u64) -> bool) -> Result<Option<Curve>, StartError> {
        let agent = AgentKind::named(self.agent).map_err(StartError::settings)?;
        let plan = TrainingPlan { reward: self.reward, seed: self.seed, shots: self.shots };
        let mut learner = (agent.start)(plan, table.clone(), &self.settings)?;
        let mut curve = Curve::default();
        while !learner.is_finished() {
            match interval(learner.as_mut(), played) {
                Ok(Some(point)) => curve.points.push(point),
                Ok(None) => return Ok(None),
                Err(error) => {
                    // The first line says what; candle adds where.
                    curve.broke_down = error.to_string().lines().next().map(str::to_owned);
                    return Ok(Some(curve));
                }
            }
        }
        curve.held_out = Some(learner.score(&held_out_layouts(table, EXAMINED, EVALUATION_SEED))?.mean_reward);
        Ok(Some(curve))
    }
}

/// The next interval; nothing where it was broken off.
fn interval(learner: &mut dyn Learner, played: &dyn Fn(u64) -> bool) -> Result<Option<Point>, Error> {
    let (start, mut sums) = (learner.shots(), Accumulator::default());
    while learner.shots() < start + INTERVAL && !learner.is_finished() {
        let (shots, updates_before) = (learner.shots(), learner.progress().updates);
        let turn = learner.iterate()?;
        let (shots, made) = (learner.shots() - shots, learner.progress().updates - updates_before);
        if !played(shots) {
            return Ok(None);
        }
        // A curve shows what is not finite, too.
        let _ = sums.add(&turn, shots, made);
    }
    let Iteration { mean_reward, q_value, critic_loss, .. } = sums.take();
    Ok(Some(Point { shots: learner.shots(), mean_reward, mean_q: q_value, loss: critic_loss }))
}

/// Mean reward of random play on the layouts on which agents are examined: any direction, any speed.
pub fn random_play(table: &Table, reward: Reward, seed: u64) -> f64 {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut shot = |layout: &Layout| {
        let cue = cue_inputs([rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]);
        reward.with_room(table, layout, &cue, u32::MAX)
    };
    held_out_layouts(table, EXAMINED, EVALUATION_SEED).iter().map(&mut shot).sum::<f64>() / EXAMINED as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reproduction::figures::READINGS;

    #[test]
    fn a_curve_has_a_point_for_every_interval_and_the_same_seed_gives_the_same() {
        let table = Table::preset("thesis").unwrap();
        let figure = Figure::named("q-learning").unwrap();
        let training = |seed| Training::of(&figure, READINGS[0], 12_000, seed);
        let curve = |seed| training(seed).run(&table, &|_| true).unwrap().unwrap();
        let one = curve(1);
        assert_eq!(one.points.iter().map(|point| point.shots).collect::<Vec<_>>(), [10_000, 12_000]);
        assert!(one.points.iter().all(|point| (0.05..0.5).contains(&point.mean_reward)), "{one:?}");
        assert_eq!(one, curve(1));
        assert_ne!(one.points, curve(2).points);
        assert_eq!(training(1).run(&table, &|_| false).unwrap(), None);
    }
}
