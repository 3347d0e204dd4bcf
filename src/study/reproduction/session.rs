//! Several figures at once: every training is done once, on as many threads as asked for, and each figure is handed
//! over as soon as its curves are there.

use std::{
    fmt::Write,
    sync::{Mutex, PoisonError},
};

use super::{
    curves::{Curve, Training, random_play},
    figures::{Figure, Measure},
};
use crate::{learning::learner::StartError, platform::parallel, table::Table};

/// What is to be drawn, and from how long a practice.
#[derive(Clone, Debug)]
pub struct Session {
    /// The figures.
    pub figures: Vec<Figure>,
    /// Shots to play instead of each figure's own number.
    pub shots: Option<u64>,
    /// Seed of every training.
    pub seed: u64,
    /// Trainings at a time. The curves do not depend on it.
    pub threads: usize,
    /// Where they play.
    pub table: Table,
}

/// A figure with its curves.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The figure.
    pub figure: Figure,
    /// A curve for each of [`Figure::curves`].
    pub curves: Vec<Curve>,
    /// Mean reward of random play.
    pub random: f64,
}

/// Why figures could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// An agent does not start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// A figure cannot be handed over.
    #[error(transparent)]
    Output(#[from] std::io::Error),
}

impl Session {
    /// Every training, each once.
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
        figure.curves().map(move |(reading, more)| Training::of(&figure, *reading, shots, seed.wrapping_add(more)))
    }

    /// Shots of all trainings.
    pub fn shots(&self) -> u64 {
        self.trainings().iter().map(|training| training.shots).sum()
    }

    /// Trains everything and hands over each figure once it is complete. `played` is told of shots and says whether to
    /// go on.
    ///
    /// # Errors
    /// Where an agent cannot start, or whatever `hand_over` reports.
    pub fn run(
        &self,
        played: &(dyn Fn(u64) -> bool + Sync),
        hand_over: &mut (dyn FnMut(&Drawn) -> std::io::Result<()> + Send),
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
                hand_over(&Drawn { figure, curves, random })?;
            }
            Ok(())
        })
        .map(|_| ())
    }

    /// Takes those figures off the list whose curves are all there.
    fn complete(
        &self,
        trainings: &[Training],
        curves: &[Option<Curve>],
        left: &mut Vec<Figure>,
    ) -> Vec<(Figure, Vec<Curve>)> {
        let curve =
            |training| trainings.iter().position(|known| *known == training).and_then(|index| curves[index].clone());
        let mut complete = Vec::new();
        left.retain(|figure| {
            let Some(curves) = self.trainings_of(figure).map(curve).collect::<Option<Vec<_>>>() else { return true };
            complete.push((*figure, curves));
            false
        });
        complete
    }
}

/// The names of a figure's curves.
fn names(figure: &Figure) -> impl Iterator<Item = String> {
    let seeds = figure.seeds;
    figure.curves().map(move |(reading, seed)| {
        if seeds == 1 { reading.name.to_owned() } else { format!("{} ({} of {seeds} seeds)", reading.name, seed + 1) }
    })
}

/// All points of a figure's curves as CSV.
pub fn csv(drawn: &Drawn) -> String {
    let mut text = "episode,shots,mean_reward,mean_q,loss\n".to_owned();
    for (name, curve) in names(&drawn.figure).zip(&drawn.curves) {
        for point in &curve.points {
            // Writing to a string cannot fail.
            let _ =
                writeln!(text, "{name},{},{:.5},{:.5},{:.6}", point.shots, point.mean_reward, point.mean_q, point.loss);
        }
    }
    text
}

/// One line for each curve of a figure of rewards: where it ended, and what the agent then earns without exploration.
pub fn summary(drawn: &Drawn) -> Vec<String> {
    let Drawn { figure, curves, random } = drawn;
    let lines = names(figure).zip(curves).map(|(name, curve)| {
        let last = curve.points.last().map_or(f64::NAN, |point| point.of(figure.measure));
        let mut line = format!("{}, {name}: {} {last:.3} at last", figure.title, figure.measure.label());
        if let Some(reward) = curve.held_out.filter(|_| figure.measure == Measure::MeanReward) {
            let _ = write!(line, ", {reward:.3} without exploration, random play {random:.3}");
        }
        if let Some(reason) = &curve.broke_down {
            let _ = write!(line, "; the training broke down: {reason}");
        }
        line
    });
    lines.collect()
}
