//! The thesis' figures of learning curves, and the trainings that each needs.

use plotters::style::RGBColor;
use serde_json::{Value, json};

use crate::{
    game::Reward,
    learning::thesis::carom::Episode,
    study::chart::{AZURE, CRIMSON, FOREST, GREY, INK, VIOLET},
};

/// The measure that a figure shows over the shots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Mean reward of the shots played, exploration included.
    MeanReward,
    /// Mean Q-value of the agent's own actions.
    MeanQ,
    /// Critic loss: mean squared error of the Q-values.
    Loss,
}

impl Measure {
    /// Returns the label of the y axis.
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
    /// Title of the figure.
    pub title: &'static str,
    /// The agent.
    pub agent: &'static str,
    /// The reward function.
    pub reward: Reward,
    /// The measure on the y axis.
    pub measure: Measure,
    /// Default number of shots.
    pub shots: u64,
    /// Final value of the thesis' curve; `None` if the thesis does not state it.
    pub thesis: Option<f64>,
    /// Its curves.
    pub variants: &'static [Variant],
    /// Range of seeds of each curve, relative to the seed of the session.
    pub seeds: [u64; 2],
}

const fn figure(
    (name, title): (&'static str, &'static str),
    agent: &'static str,
    reward: Reward,
    measure: Measure,
    shots: u64,
    thesis: Option<f64>,
) -> Figure {
    Figure { name, title, agent, reward, measure, shots, thesis, variants: &VARIANTS, seeds: [0, 1] }
}

/// All figures in the thesis' order, followed by DDPG with r1 and different noise, and the thesis' future work.
pub const FIGURES: [Figure; 12] = {
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
        Figure {
            variants: &NOISES,
            seeds: [0, 3],
            ..figure(("noise", "DDPG, r1, by noise"), DDPG, Reward::R1, MeanReward, 400_000, Some(0.8))
        },
        Figure {
            variants: &FUTURE_WORK,
            // Seeds 1 to 3 were used to choose the settings.
            seeds: [3, 8],
            ..figure(("future-work", "DDPG, r3, with lessons"), DDPG, Reward::R3, MeanReward, 400_000, Some(0.05))
        },
    ]
};

impl Figure {
    /// Returns the variant and the seed of every curve; the seed is relative to the seed of the session.
    pub fn curves(&self) -> impl Iterator<Item = (&'static Variant, u64)> + use<> {
        let [first, end] = self.seeds;
        self.variants.iter().flat_map(move |variant| (first..end).map(move |seed| (variant, seed)))
    }

    /// Returns the figure called `name`.
    ///
    /// # Errors
    /// [`UnknownFigure`], which lists all names.
    pub fn named(name: &str) -> Result<Self, UnknownFigure> {
        FIGURES.into_iter().find(|figure| figure.name == name).ok_or_else(|| UnknownFigure(name.to_owned()))
    }

    /// Returns the prefix of the figure's file names.
    pub fn file_name(&self) -> String {
        if self.name.starts_with(|first: char| first.is_ascii_digit()) {
            format!("figure-{}", self.name)
        } else {
            self.name.to_owned()
        }
    }
}

/// An unknown figure name.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no figure \"{0}\"; use {list}", list = FIGURES.map(|figure| figure.name).join(", "))]
pub struct UnknownFigure(String);

/// The change of a curve's agent compared with the thesis' agent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// No change.
    None,
    /// White exploration noise with a constant standard deviation of 0.1.
    StrongNoise,
    /// The same noise, decaying to a twentieth.
    FallingNoise,
    /// The agent sees layouts in their canonical frame.
    Canonical,
    /// The agent sees layouts in relative coordinates.
    Relative,
    /// The same with the settings of [`Self::Lessons`], but without lessons.
    Control,
    /// Relative coordinates, and learning from shots that score a point in addition to the agent's own shots (thesis 6.1.1 and 6.1.2).
    Lessons {
        /// Share of hindsight transitions in a batch.
        hindsight: f64,
        /// Share of demonstrations in a batch.
        demonstrations: f64,
    },
}

impl Change {
    /// Returns the settings of the change for a training of `shots` shots.
    fn settings(self, shots: u64) -> Value {
        let noise = json!({ "theta": 0.15, "sigma": 1.0, "dt": 0.01 });
        match self {
            Self::None => json!({}),
            Self::StrongNoise => json!({ "noise": noise }),
            Self::FallingNoise => json!({ "noise": noise, "noise_end_factor": 0.05, "decay_steps": shots }),
            Self::Canonical => json!({ "canonical": true }),
            Self::Relative => json!({ "relative": true }),
            Self::Control => json!({
                "bounds_penalty": 0.3,
                "relative": true,
                "batch_size": 64,
                "noise": noise,
                "noise_end_factor": 0.2,
                "learning_rate": 2e-3,
                "learning_rate_end_factor": 0.05,
                "decay_steps": shots,
            }),
            Self::Lessons { hindsight, demonstrations } => {
                let mut settings = Self::Control.settings(shots);
                settings["hindsight"] = json!(hindsight);
                settings["demonstrations"] = json!(demonstrations);
                settings["policy_gradient"] = json!(0.0);
                settings["cloning_width"] = json!([0.2, 0.004]);
                settings
            }
        }
    }
}

/// A variant of the thesis' agent: a meaning of the word "episode", which the thesis does not define, or another change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// Its name in the legend and in the table.
    pub name: &'static str,
    /// Colour of its curve.
    pub color: RGBColor,
    /// When an episode ends.
    pub episode: Episode,
    /// Any other change to the thesis' agent.
    pub change: Change,
}

const fn variant(name: &'static str, color: RGBColor, episode: Episode) -> Variant {
    Variant { name, color, episode, change: Change::None }
}

const fn changed(name: &'static str, color: RGBColor, change: Change) -> Variant {
    Variant { name, color, episode: Episode::OneShot, change }
}

/// Noise on DDPG's actions: 0.03, which the thesis' source uses when an episode is one shot, 0.1, and 0.1 decaying; then 0.03
/// again in the canonical frame and in relative coordinates.
const NOISES: [Variant; 5] = [
    changed("0.03", CRIMSON, Change::None),
    changed("0.1", AZURE, Change::StrongNoise),
    changed("0.1 falling to 0.005", FOREST, Change::FallingNoise),
    changed("0.03 in the canonical frame", VIOLET, Change::Canonical),
    changed("0.03 in relative coordinates", INK, Change::Relative),
];

/// The thesis' future work: the thesis' agent; the same in relative coordinates, and with the settings of the last three but without
/// lessons; hindsight, demonstrations, both.
const FUTURE_WORK: [Variant; 6] = [
    changed("the thesis' agent", INK, Change::None),
    changed("relative coordinates", GREY, Change::Relative),
    changed("the settings without lessons", CRIMSON, Change::Control),
    changed("hindsight", AZURE, Change::Lessons { hindsight: 1.0, demonstrations: 0.0 }),
    changed("demonstrations", FOREST, Change::Lessons { hindsight: 0.0, demonstrations: 1.0 }),
    changed("both", VIOLET, Change::Lessons { hindsight: 0.5, demonstrations: 0.5 }),
];

/// One shot; a game of 20 shots; a game until the first miss, of at most 20 shots.
pub const VARIANTS: [Variant; 3] = [
    variant("one shot", CRIMSON, Episode::OneShot),
    variant("20 shots", AZURE, Episode::Shots(20)),
    variant("until a miss", FOREST, Episode::UntilMiss(20)),
];

impl Variant {
    /// Returns the number of shots for a variant if one-shot episodes play `shots`. Games play a quarter: their shots are
    /// simulated until all balls are at rest, which takes up to ten times as long.
    pub const fn shots(&self, shots: u64) -> u64 {
        match self.episode {
            Episode::OneShot => shots,
            Episode::Shots(_) | Episode::UntilMiss(_) => shots.div_ceil(4),
        }
    }

    /// Returns the agent's settings for this variant and number of shots; all others keep the agent's defaults.
    pub fn settings(&self, shots: u64) -> Value {
        let mut settings = self.change.settings(shots);
        settings["episode"] = json!(self.episode);
        settings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_has_a_name_and_accepts_every_variant() {
        use crate::{learning::learner, table::Table};
        for figure in FIGURES {
            assert_eq!(Figure::named(figure.name), Ok(figure));
            let agent = learner::AgentKind::named(figure.agent).unwrap();
            for variant in figure.variants {
                let plan = learner::TrainingPlan { reward: figure.reward, seed: 1, shots: 1 };
                let learner = (agent.start)(plan, Table::default(), &variant.settings(1)).unwrap();
                for (name, value) in variant.settings(1).as_object().unwrap() {
                    assert_eq!(learner.settings()[name], *value, "{name}");
                }
            }
        }
        assert!(Figure::named("31").unwrap_err().to_string().contains("29, 30, noise"));
    }
}
