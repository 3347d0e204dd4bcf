//! The progress display of a training: a bar on a terminal, otherwise a line for every measurement.

use std::io::{self, Write as _};

use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::{
    commands::output::print_note,
    learning::run::{Report, Run, RunError, metrics::Record},
    printing::{self, shell_word},
};

/// The progress of one run.
pub struct Progress {
    bar: ProgressBar,
    json: bool,
    /// The run's seed, if there are several runs.
    seed: Option<u64>,
    /// The error of the last line that could not be written, if any.
    unwritten: Option<io::Error>,
}

/// A line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    #[serde(flatten)]
    record: &'a Record,
}

impl Progress {
    /// Creates the display for a run that is about to start, alone or as one of several with different seeds.
    pub fn new(run: &Run, json: bool, seed: Option<u64>) -> Self {
        let learner = run.learner();
        let plan = learner.plan();
        let bar = if seed.is_none() && printing::is_stderr_terminal() && !learner.is_finished() {
            ProgressBar::new(plan.shots)
        } else {
            ProgressBar::hidden()
        };
        if !learner.is_finished() {
            print_note(format_args!(
                "training {} for {} on \"{}\" with seed {} in {}; from any terminal: carom watch {}",
                learner.agent(),
                plan.reward,
                learner.table().name,
                plan.seed,
                run.folder().display(),
                shell_word(&run.folder().to_string_lossy())
            ));
        }
        let template = "{elapsed_precise} {wide_bar} {human_pos}/{human_len} shots, {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_position(learner.shots());
        bar.reset_eta();
        Self { bar, json, seed, unwritten: None }
    }

    /// Removes the bar.
    ///
    /// # Errors
    /// Fails if a line could not be written.
    pub fn close(self) -> io::Result<()> {
        self.bar.finish_and_clear();
        self.unwritten.map_or(Ok(()), Err)
    }

    /// Prints the last line of a run that is finished already, in JSON: it has the result, and no other line follows.
    pub fn repeat_result(&mut self, run: &Run) -> Result<(), RunError> {
        if self.json && run.learner().is_finished() {
            run.last_line()?.iter().for_each(|record| self.print_record(record));
        }
        Ok(())
    }

    /// Prints a report.
    pub fn report(&mut self, report: Report<'_>) {
        match report {
            Report::Line(record) => self.print_record(record),
            Report::Warning(sentence) => {
                let whose = self.seed.map(|seed| format!("seed {seed}: ")).unwrap_or_default();
                self.bar.suspend(|| print_note(format_args!("warning: {whose}{sentence}")));
            }
        }
    }

    fn print_record(&mut self, record: &Record) {
        if self.json
            && let Ok(line) = printing::json_text(&Line { seed: self.seed, record })
        {
            // A closed output must not end the training.
            self.unwritten = writeln!(printing::stdout(), "{line}").err().or(self.unwritten.take());
        }
        self.bar.set_position(record.shots);
        let Some(summary) = summary(record) else { return };
        self.bar.set_message(summary);
        if let Some(line) = format_record(record).filter(|_| self.bar.is_hidden()) {
            let whose = self.seed.map(|seed| format!(", seed {seed}")).unwrap_or_default();
            print_note(format_args!("{line}{whose}"));
        }
    }
}

/// Formats a measurement as a line; `None` if the record has none.
pub fn format_record(record: &Record) -> Option<String> {
    let Record { seconds, shots, .. } = record;
    let speed = *shots as f64 / seconds.max(1e-9);
    summary(record).map(|summary| format!("{seconds:.0} s, {shots} shots, {speed:.0} shots/s, {summary}"))
}

fn summary(record: &Record) -> Option<String> {
    let reward = record.held_out_reward?;
    Some(format!("critic loss {:.4}, held-out reward {reward:.4}", record.critic_loss))
}
