//! What the training screen asks before it does something.

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
    /// Whether to start a run of so many shots, which takes so many seconds if the agent is as fast as usual.
    Long {
        /// Its shots.
        shots: u64,
        /// The seconds.
        seconds: f64,
    },
    /// Whether to stop the run and save it.
    Stop,
    /// Whether to abandon the run.
    Abandon,
    /// Under which name the policy is kept, as far as it is typed.
    Name(TextField),
    /// Whether the policy that has this name already may be replaced.
    Replace(String),
}

impl Question {
    /// The question about the run that is watched, if there is one, without what is typed.
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

    /// As long as what it may be asked and answered.
    pub const fn when(&self) -> TrainingCondition {
        match self {
            Self::Long { .. } => TrainingCondition::Always,
            Self::Stop | Self::Abandon => TrainingCondition::AtWork,
            Self::Name(_) | Self::Replace(_) => TrainingCondition::HasPolicy,
        }
    }

    /// The question under which name the policy of the run called `run` is kept.
    pub fn name(run: &str) -> Self {
        Self::Name(TextField::new(MAX_NAME_BYTES).offering(&proposed_name(run)))
    }

    /// The text that is typed, where some is.
    pub const fn field(&self) -> Option<&TextField> {
        if let Self::Name(typed) = self { Some(typed) } else { None }
    }
}

/// A name for the policy of the run called `run`: the last part of that, as far as it may stand in a name.
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
    fn every_run_is_proposed_a_name_that_is_accepted() {
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
