//! The thesis' figures of learning curves, and what has to be trained for each.

use serde_json::{Value, json};

use crate::{game::Reward, learning::thesis::carom::Episode};

/// What a figure shows over the shots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Mean reward of the shots played, exploration included.
    MeanReward,
    /// Mean value that the agent gives its own choices.
    MeanQ,
    /// Mean squared error of the values.
    Loss,
}

impl Measure {
    /// Label of the axis.
    pub const fn label(self) -> &'static str {
        match self {
            Self::MeanReward => "mean reward",
            Self::MeanQ => "mean Q",
            Self::Loss => "loss",
        }
    }
}

/// One of the thesis' figures, or of its findings without a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// Number of the figure in the thesis, or a name.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// The agent.
    pub agent: &'static str,
    /// What is rewarded.
    pub reward: Reward,
    /// What is shown.
    pub measure: Measure,
    /// Shots to play unless asked otherwise.
    pub shots: u64,
    /// Where the thesis' curve ends, where it says so.
    pub thesis: Option<f64>,
}

const fn figure(
    (name, title): (&'static str, &'static str),
    agent: &'static str,
    reward: Reward,
    measure: Measure,
    shots: u64,
    thesis: Option<f64>,
) -> Figure {
    Figure { name, title, agent, reward, measure, shots, thesis }
}

/// All figures, in the thesis' order.
pub const FIGURES: [Figure; 10] = {
    use Measure::{Loss, MeanQ, MeanReward};
    const DDPG: &str = "thesis-ddpg";
    [
        figure(("q-learning", "Q-learning, r1"), "q-learning", Reward::R1, MeanReward, 50_000, None),
        figure(("21", "Figure 21: DQN, r1"), "dqn", Reward::R1, MeanReward, 200_000, Some(0.4)),
        figure(("22", "Figure 22: DQN, r2"), "dqn", Reward::R2, MeanReward, 200_000, None),
        figure(("23", "Figure 23: DDPG, r1"), DDPG, Reward::R1, MeanReward, 400_000, Some(0.8)),
        figure(("24", "Figure 24: DDPG, r1"), DDPG, Reward::R1, MeanQ, 400_000, None),
        figure(("25", "Figure 25: DDPG, r1"), DDPG, Reward::R1, Loss, 400_000, None),
        figure(
            ("28", "Figure 28: DDPG, r1 with difficulty"),
            DDPG,
            Reward::R1Difficulty,
            MeanReward,
            400_000,
            Some(0.8),
        ),
        figure(("r2", "DDPG, r2"), DDPG, Reward::R2, MeanReward, 200_000, None),
        figure(("29", "Figure 29: DDPG, r3"), DDPG, Reward::R3, MeanReward, 200_000, Some(0.05)),
        figure(("30", "Figure 30: DDPG, r4"), DDPG, Reward::R4, MeanReward, 200_000, None),
    ]
};

impl Figure {
    /// The figure called `name`.
    ///
    /// # Errors
    /// [`UnknownFigure`], which lists them.
    pub fn named(name: &str) -> Result<Self, UnknownFigure> {
        FIGURES.into_iter().find(|figure| figure.name == name).ok_or_else(|| UnknownFigure(name.to_owned()))
    }

    /// Beginning of the names of its files.
    pub fn file_name(&self) -> String {
        if self.name.starts_with(|first: char| first.is_ascii_digit()) {
            format!("figure-{}", self.name)
        } else {
            self.name.to_owned()
        }
    }
}

/// A figure's name that is not known.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no figure \"{0}\"; use {list}", list = FIGURES.map(|figure| figure.name).join(", "))]
pub struct UnknownFigure(String);

/// A reading of the thesis' word "episode", of which it says no more. All are tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Its name in the legend and in the table.
    pub name: &'static str,
    /// Colour of its curve.
    pub color: &'static str,
    /// When an episode is over.
    pub episode: Episode,
}

/// One shot each; a game of twenty shots; a game until a miss, of at most twenty shots.
pub const READINGS: [Reading; 3] = [
    Reading { name: "one shot", color: "#d1242f", episode: Episode::OneShot },
    Reading { name: "20 shots", color: "#0969da", episode: Episode::Shots(20) },
    Reading { name: "until a miss", color: "#1a7f37", episode: Episode::UntilMiss(20) },
];

impl Reading {
    /// Shots to play where one-shot episodes play `shots`: games a quarter, for their shots are played until all balls
    /// stand still, which takes up to ten times as long.
    pub const fn shots(&self, shots: u64) -> u64 {
        match self.episode {
            Episode::OneShot => shots,
            Episode::Shots(_) | Episode::UntilMiss(_) => shots.div_ceil(4),
        }
    }

    /// Settings of an agent that reads it so; everything else is as the agent's defaults.
    pub fn settings(&self) -> Value {
        json!({ "episode": self.episode })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_has_a_name_and_an_agent_that_takes_every_reading() {
        use crate::{learning::learner, table::Table};
        for figure in FIGURES {
            assert_eq!(Figure::named(figure.name), Ok(figure));
            let agent = learner::Agent::named(figure.agent).unwrap();
            for reading in READINGS {
                let plan = learner::TrainingPlan { reward: figure.reward, seed: 1, shots: 1 };
                let learner = (agent.start)(plan, Table::default(), reading.settings()).unwrap();
                assert_eq!(learner.settings()["episode"], reading.settings()["episode"]);
            }
        }
        assert!(Figure::named("31").unwrap_err().to_string().contains("29, 30"));
    }
}
