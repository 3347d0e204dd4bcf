//! What the user sees while training: a bar on a terminal, else a line for every measurement.

use std::{
    fmt::Write as _,
    io::{IsTerminal, Write as _},
};

use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::learning::run::{Run, Watcher, metrics::Record};

/// The progress of one run.
pub struct Screen {
    bar: ProgressBar,
    json: bool,
    /// The run's seed, where there are several runs.
    seed: Option<u64>,
}

/// A line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    #[serde(flatten)]
    record: &'a Record,
}

impl Screen {
    /// For a run that is about to start, alone or one of several with different seeds.
    pub fn new(run: &Run, json: bool, seed: Option<u64>) -> Self {
        let learner = run.learner();
        let plan = learner.plan();
        let bar = if seed.is_none() && std::io::stderr().is_terminal() && !learner.is_finished() {
            ProgressBar::new(plan.shots)
        } else {
            ProgressBar::hidden()
        };
        if !learner.is_finished() {
            eprintln!(
                "training {} for {} on \"{}\" with seed {} in {}",
                learner.agent(),
                plan.reward,
                learner.table().name,
                plan.seed,
                run.folder().display()
            );
        }
        let template = "{elapsed_precise} {wide_bar} {human_pos}/{human_len} shots, {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_position(learner.shots());
        bar.reset_eta();
        Self { bar, json, seed }
    }

    /// Takes the bar away.
    pub fn close(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watcher for Screen {
    fn line(&mut self, record: &Record) {
        if self.json
            && let Ok(line) = serde_json::to_string(&Line { seed: self.seed, record })
        {
            // A reader that has gone away must not end the training.
            let _ = writeln!(std::io::stdout(), "{line}");
        }
        self.bar.set_position(record.shots);
        let Some(reward) = record.held_out_reward else { return };
        let mut summary = format!("loss {:.4}, held-out reward {reward:.4}", record.critic_loss);
        self.bar.set_message(summary.clone());
        if self.bar.is_hidden() {
            if let Some(seed) = self.seed {
                // Writing to a string cannot fail.
                let _ = write!(summary, ", seed {seed}");
            }
            eprintln!("{:.0} s, {} shots, {:.0}/s, {summary}", record.seconds, record.shots, record.shots_per_second);
        }
    }

    fn warn(&mut self, sentence: &str) {
        let whose = self.seed.map(|seed| format!("seed {seed}: ")).unwrap_or_default();
        self.bar.suspend(|| eprintln!("warning: {whose}{sentence}"));
    }
}
