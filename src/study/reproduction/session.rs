//! Reproduces several figures: runs every training once, on several threads, and outputs each figure as soon as its curves are
//! complete.

use std::{
    fmt::Write,
    sync::{Mutex, PoisonError},
};

use super::{
    curves::{Curve, Point, Training, random_play},
    figures::{Figure, Measure, Variant},
};
use crate::{learning::learner::StartError, platform::parallel, statistics::mean_and_deviation, table::Table};

/// The figures to reproduce, and how to train for them.
#[derive(Clone, Debug)]
pub struct Session {
    /// The figures.
    pub figures: Vec<Figure>,
    /// Number of shots of every training; `None` for each figure's own number.
    pub shots: Option<u64>,
    /// Base seed of all trainings.
    pub seed: u64,
    /// Number of parallel trainings. The curves do not depend on it.
    pub threads: usize,
    /// The table of all trainings.
    pub table: Table,
}

/// A figure with its curves.
#[derive(Clone, Debug)]
pub struct ReproducedFigure {
    /// The figure.
    pub figure: Figure,
    /// The base seed of the session.
    pub seed: u64,
    /// The curves, in the order of [`Figure::curves`].
    pub curves: Vec<Curve>,
    /// Mean reward of random play.
    pub random: f64,
}

impl ReproducedFigure {
    /// Returns every curve with its variant and its seed.
    fn curves(&self) -> impl Iterator<Item = (&'static Variant, u64, &Curve)> {
        let named = self.figure.curves().zip(&self.curves);
        named.map(|((variant, more), curve)| (variant, self.seed.wrapping_add(more), curve))
    }
}

/// Why the figures could not be reproduced.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// An agent cannot start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// A figure cannot be written.
    #[error(transparent)]
    Output(#[from] std::io::Error),
}

impl Session {
    /// Returns all distinct trainings.
    fn trainings(&self) -> Vec<Training> {
        let mut trainings: Vec<Training> = Vec::new();
        for figure in &self.figures {
            for training in self.trainings_of(figure) {
                if !trainings.contains(&training) {
                    trainings.push(training);
                }
            }
        }
        trainings
    }

    fn trainings_of(&self, figure: &Figure) -> impl Iterator<Item = Training> {
        let (figure, shots, seed) = (*figure, self.shots.unwrap_or(figure.shots), self.seed);
        figure.curves().map(move |(variant, more)| Training::of(&figure, *variant, shots, seed.wrapping_add(more)))
    }

    /// Returns the number of shots of all trainings together.
    pub fn shots(&self) -> u64 {
        self.trainings().iter().map(|training| training.shots).sum()
    }

    /// Runs all trainings and passes each figure to `hand_over` once it is complete. `played` receives the number of shots
    /// after each iteration and returns whether to continue.
    ///
    /// # Errors
    /// Fails if an agent cannot start, or with any error of `hand_over`.
    pub fn run(
        &self,
        played: &(dyn Fn(u64) -> bool + Sync),
        hand_over: &mut (dyn FnMut(&ReproducedFigure) -> std::io::Result<()> + Send),
    ) -> Result<(), SessionError> {
        let trainings = self.trainings();
        let shared = Mutex::new((vec![None; trainings.len()], self.figures.clone()));
        let hand_over = Mutex::new(hand_over);
        let numbered: Vec<(usize, &Training)> = trainings.iter().enumerate().collect();
        parallel::try_map(self.threads, &numbered, |(index, training)| {
            let Some(curve) = training.run(&self.table, played)? else { return Ok(()) };
            let complete = {
                let (curves, left) = &mut *shared.lock().unwrap_or_else(PoisonError::into_inner);
                curves[*index] = Some(curve);
                self.complete(&trainings, curves, left)
            };
            for (figure, curves) in complete {
                let random = random_play(&self.table, figure.reward, self.seed);
                let mut hand_over = hand_over.lock().unwrap_or_else(PoisonError::into_inner);
                hand_over(&ReproducedFigure { figure, seed: self.seed, curves, random })?;
            }
            Ok(())
        })
        .map(|_| ())
    }

    /// Removes the figures whose curves are all available from `left`, and returns them.
    fn complete(
        &self,
        trainings: &[Training],
        curves: &[Option<Curve>],
        left: &mut Vec<Figure>,
    ) -> Vec<(Figure, Vec<Curve>)> {
        let curve = |training: Training| {
            trainings.iter().position(|known| *known == training).and_then(|index| curves[index].clone())
        };
        let mut complete = Vec::new();
        left.retain(|figure| {
            let Some(curves) = self.trainings_of(figure).map(curve).collect::<Option<Vec<_>>>() else { return true };
            complete.push((*figure, curves));
            false
        });
        complete
    }
}

/// Returns all points of a figure's curves as CSV.
pub fn csv(drawn: &ReproducedFigure) -> String {
    let mut text = "curve,seed,shots,mean_reward,mean_q,loss\n".to_owned();
    for (variant, seed, curve) in drawn.curves() {
        for Point { shots, mean_reward, mean_q, loss } in &curve.points {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{},{seed},{shots},{mean_reward:.5},{mean_q:.5},{loss:.6}", variant.name);
        }
    }
    text
}

/// Returns a line for each curve: its final value and, for figures of rewards, the agent's mean reward without exploration.
/// Readings with several seeds get another line with mean and standard deviation.
pub fn summary(drawn: &ReproducedFigure) -> Vec<String> {
    let ReproducedFigure { figure, random, .. } = drawn;
    let held_out = |curve: &Curve| curve.held_out.filter(|_| figure.measure == Measure::MeanReward);
    let of_curve = |(variant, seed, curve): (&Variant, u64, &Curve)| {
        let last = curve.points.last().map_or(f64::NAN, |point| point.of(figure.measure));
        let (title, name, measure) = (figure.title, variant.name, figure.measure.label());
        let mut line = format!("{title}, {name}, seed {seed}: final {measure} {last:.3}");
        if let Some(reward) = held_out(curve) {
            let _ = write!(line, ", {reward:.3} without exploration, random play {random:.3}");
        }
        if let Some(reason) = &curve.breakdown {
            let _ = write!(line, "; the training broke down: {reason}");
        }
        line
    };
    let of_seeds = |variant: &Variant| {
        let of_variant = || drawn.curves().filter(|(other, ..)| other.name == variant.name);
        let rewards: Vec<f64> = of_variant().filter_map(|(.., curve)| held_out(curve)).collect();
        let (mean, deviation) = mean_and_deviation(&rewards);
        let deviation = deviation?;
        let (title, name, seeds) = (figure.title, variant.name, rewards.len());
        let broken = of_variant().filter(|(.., curve)| curve.breakdown.is_some()).count();
        let broken = if broken == 0 { String::new() } else { format!("; {broken} more broke down") };
        Some(format!(
            "{title}, {name}, {seeds} seeds: mean {mean:.3} without exploration, standard deviation {deviation:.3}{broken}"
        ))
    };
    drawn.curves().map(of_curve).chain(figure.variants.iter().filter_map(of_seeds)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn session(names: &[&str]) -> Session {
        let figures = names.iter().map(|name| Figure::named(name).unwrap()).collect();
        Session { figures, shots: Some(1000), seed: 1, threads: 1, table: Table::default() }
    }

    #[test]
    fn figures_with_equal_setups_share_a_training() {
        // Three curves each; the one-shot curve is that of noise 0.03 with seed 1.
        assert_eq!(session(&["23", "24"]).trainings().len(), 3);
        assert_eq!(session(&["23", "noise"]).trainings().len(), 3 + 15 - 1);
    }

    #[test]
    fn reported_seeds_differ_from_the_tuning_seeds() {
        let session = session(&["future-work"]);
        assert!(session.trainings().iter().all(|training| training.seed > 3));
        let curve = |seed: u32| Curve { held_out: Some(0.01 * f64::from(seed)), ..Curve::default() };
        let curves = session.trainings().iter().map(|training| curve(training.seed as u32)).collect();
        let drawn = ReproducedFigure { figure: session.figures[0], seed: 1, curves, random: 0.007 };
        let lines = summary(&drawn);
        assert!(lines[0].contains("the thesis' agent, seed 4") && lines[0].contains("0.040 without"), "{lines:?}");
        let last = lines.last().unwrap();
        assert!(last.contains("both, 5 seeds: mean 0.060 without exploration, standard deviation 0.016"), "{last}");
    }
}
