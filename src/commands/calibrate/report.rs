//! The report of a calibration, as text and as JSON.

use serde::Serialize;

use crate::{
    calibration::{Calibration, Change, Entries, EntryProblem, TablePlay, missing_daily_tests},
    commands::{
        Failure,
        output::{json_line, print_line, print_table},
    },
};

/// How many of the most useful next tests are listed.
const NEXT: usize = 3;

/// The report of a calibration.
#[derive(Serialize)]
pub struct Report<'a> {
    #[serde(flatten)]
    found: &'a Calibration,
    missing: Vec<Missing>,
    odd: Vec<String>,
    contradictory: bool,
    /// With `--daily`: how the table played before and how it plays now.
    #[serde(skip_serializing_if = "Option::is_none")]
    play: Option<[TablePlay; 2]>,
    #[serde(skip)]
    is_daily: bool,
}

/// The number of strokes of a test that were not entered.
#[derive(Serialize)]
struct Missing {
    test: &'static str,
    strokes: usize,
}

impl<'a> Report<'a> {
    /// Creates the report of a calibration.
    pub fn new(found: &'a Calibration, entries: &Entries, odd: &[EntryProblem], play: Option<[TablePlay; 2]>) -> Self {
        let is_daily = play.is_some();
        let missing = if is_daily { missing_daily_tests(entries) } else { entries.missing() };
        // The comparison needs both tests of a daily check.
        let play = play.filter(|_| missing.is_empty());
        Self {
            found,
            missing: missing.into_iter().map(|(test, strokes)| Missing { test: test.name, strokes }).collect(),
            odd: odd.iter().map(EntryProblem::to_string).collect(),
            contradictory: found.is_contradictory(),
            play,
            is_daily,
        }
    }

    /// Prints one JSON object.
    pub fn json(&self) -> Result<(), Failure> {
        Ok(json_line(self)?)
    }

    /// Prints lines of text.
    pub fn text(&self) -> Result<(), Failure> {
        let found = self.found;
        let row = |one: &Change| {
            [
                one.name.clone(),
                one.before_text().join(" ± "),
                one.after_text().join(" ± "),
                found.certainty(one).to_owned(),
            ]
        };
        print_table(["constant", "before", "after", "known"], found.constants.iter().map(row), &[1, 2])?;
        print_line("")?;
        for check in found.mark_checks.iter().filter(|check| check.misread) {
            print_line(check.misread_text(&in_file(check.trial, check.test)))?;
        }
        for stroke in &found.outlier_strokes {
            print_line(stroke.words(&in_file(stroke.trial, stroke.test)))?;
        }
        found.differing_rails().iter().try_for_each(print_line)?;
        print_line(found.agreement(in_file))?;
        found.meanings().iter().try_for_each(print_line)?;
        if !self.missing.is_empty() {
            let strokes = |one: &Missing| format!("{} ({})", one.test, one.strokes);
            let all: Vec<String> = self.missing.iter().map(strokes).collect();
            print_line(format_args!("not entered yet: {}", all.join(", ")))?;
        }
        if let Some([before, now]) = &self.play {
            print_line(format_args!("today {}", now.describe_change_from(before)))?;
        }
        if self.is_daily {
            return Ok(());
        }
        let most_useful: Vec<String> =
            found.next.iter().take(NEXT).map(|next| format!("{} ({:.1} bits)", next.test, next.bits)).collect();
        print_line(format_args!(
            "next, one more stroke of these tests helps most (each bit halves an uncertainty): {}",
            most_useful.join(", ")
        ))
    }
}

/// Names a stroke by its position in a file.
fn in_file(trial: usize, test: &str) -> String {
    format!("trial {trial} ({test})")
}
