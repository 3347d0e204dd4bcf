//! The questions of the training page.

use crate::{
    storage::{MAX_NAME_BYTES, is_letter},
    terminal::{
        TrainingCondition,
        pages::training::watch::Watch,
        ui::TextField,
        words::{count, long_time_words},
    },
};

/// A question that waits for an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// Whether to start a long run.
    Long {
        /// Number of shots.
        shots: u64,
        /// Estimated duration at the agent's usual speed, s.
        seconds: f64,
    },
    /// Whether to stop the run and save it.
    Stop,
    /// Whether to abandon the run.
    Abandon,
    /// The name under which to save the policy, with the text typed so far.
    Name(TextField),
    /// Whether to replace the saved policy with this name.
    Replace(String),
}

impl Question {
    /// The question, without the typed text; `watch` is the watched run, if there is one.
    pub fn text(&self, watch: Option<&Watch>) -> String {
        let name = watch.map_or("the run", |watch| &watch.own.name);
        match self {
            Self::Long { shots, seconds } => format!(
                "{} shots take about {}, at the usual {:.0} shots a second; start the run?",
                count(*shots),
                long_time_words(*seconds),
                *shots as f64 / seconds
            ),
            Self::Stop => format!("stop {name}: measure it, save it and end it?"),
            Self::Abandon => {
                let Some(watch) = watch else { return format!("abandon {name}?") };
                let shots = count(watch.own.run.shots());
                let best = watch.own.run.best();
                let best = best.map_or(String::new(), |best| format!(", with a best held-out reward of {best:.3}"));
                format!("abandon {name}: end it now and delete its folder? {shots} shots are lost{best}")
            }
            Self::Name(_) => "keep the networks under the name: ".to_owned(),
            Self::Replace(name) => format!("there are networks called {name} already; replace them?"),
        }
    }

    /// The condition under which the question makes sense.
    pub const fn when(&self) -> TrainingCondition {
        match self {
            Self::Long { .. } => TrainingCondition::Always,
            Self::Stop | Self::Abandon => TrainingCondition::Active,
            Self::Name(_) | Self::Replace(_) => TrainingCondition::HasPolicy,
        }
    }

    /// Creates the question for a name of the policy of the run `run`.
    pub fn name(run: &str) -> Self {
        Self::Name(TextField::new(MAX_NAME_BYTES).with_suggestion(&proposed_name(run)))
    }

    /// The text field of the answer; `None` if the answer is yes or no.
    pub const fn field(&self) -> Option<&TextField> {
        if let Self::Name(typed) = self { Some(typed) } else { None }
    }
}

/// Proposes a name for the policy of the run `run`: the last part of its path, with characters that names do not allow replaced.
fn proposed_name(run: &str) -> String {
    let last = run.rsplit(['/', '\\']).find(|part| !part.is_empty()).unwrap_or_default();
    let letters = last.chars().enumerate().map(|(n, letter)| {
        let is_kept = is_letter(letter) && (n > 0 || letter != '.');
        if is_kept { letter } else { '-' }
    });
    TextField::new(MAX_NAME_BYTES).with(&letters.collect::<String>()).text().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::is_name;

    #[test]
    fn proposed_policy_names_are_accepted() {
        let long = "\u{e4}".repeat(80);
        for (run, name) in [
            ("20261120-ddpg", "20261120-ddpg"),
            ("/home/me/runs/group/seed-1", "seed-1"),
            ("runs/my run (2)/", "my-run--2-"),
            (".hidden", "-hidden"),
            (long.as_str(), &long[..100]),
        ] {
            assert_eq!(proposed_name(run), name);
            assert!(is_name(name), "{name}");
        }
    }
}
