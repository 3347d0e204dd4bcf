//! What a calibration has found, for people and for programs.

use serde::Serialize;

use crate::{
    calibration::{Calibration, Change, Entries, Next, Oddity, Play, Strange, Verdict, missing_today},
    commands::{
        Failure,
        output::{json_line, line, print_table},
    },
    table::Table,
};

/// How many of the tests that may be played next are told.
const NEXT: usize = 3;

/// What is told.
#[derive(Serialize)]
pub struct Report<'a> {
    table: &'a Table,
    constants: &'a [Change],
    marks: &'a [Verdict],
    left_out: &'a [usize],
    strange: &'a [Strange],
    next: &'a [Next],
    missing: Vec<Missing>,
    odd: Vec<String>,
    contradictory: bool,
    /// With `--daily`: how the table played before and plays now.
    #[serde(skip_serializing_if = "Option::is_none")]
    play: Option<[Play; 2]>,
    #[serde(skip)]
    is_daily: bool,
    #[serde(skip)]
    found: &'a Calibration,
}

/// Strokes of a test that were not entered.
#[derive(Serialize)]
struct Missing {
    test: &'static str,
    strokes: usize,
}

impl<'a> Report<'a> {
    /// What is told of a calibration.
    pub fn new(found: &'a Calibration, entries: &Entries, odd: &[Oddity], play: Option<[Play; 2]>) -> Self {
        let is_daily = play.is_some();
        let missing = if is_daily { missing_today(entries) } else { entries.missing() };
        // What one of the two tests of a day would say is not known without it.
        let play = play.filter(|_| missing.is_empty());
        Self {
            table: &found.table,
            constants: &found.constants,
            marks: &found.verdicts,
            left_out: &found.left_out,
            strange: &found.strange,
            next: &found.next,
            missing: missing.into_iter().map(|(test, strokes)| Missing { test: test.name, strokes }).collect(),
            odd: odd.iter().map(Oddity::to_string).collect(),
            contradictory: found.is_contradictory(),
            play,
            is_daily,
            found,
        }
    }

    /// One object.
    pub fn json(&self) -> Result<(), Failure> {
        Ok(json_line(self)?)
    }

    /// Lines.
    pub fn text(&self) -> Result<(), Failure> {
        let row = |one: &Change| {
            [one.name.clone(), one.told_before().join(" ± "), one.told().join(" ± "), self.found.known(one).to_owned()]
        };
        print_table(["constant", "before", "after", "known"], self.constants.iter().map(row), &[1, 2])?;
        line("")?;
        for verdict in self.marks.iter().filter(|verdict| verdict.misread) {
            line(verdict.doubtful(&in_file(verdict.trial, verdict.test)))?;
        }
        for strange in self.strange {
            line(strange.words(&in_file(strange.trial, strange.test)))?;
        }
        self.found.rails_apart().iter().try_for_each(line)?;
        line(self.found.agreement(in_file))?;
        self.found.meanings().iter().try_for_each(line)?;
        if !self.missing.is_empty() {
            let strokes = |one: &Missing| format!("{} ({})", one.test, one.strokes);
            let all: Vec<String> = self.missing.iter().map(strokes).collect();
            line(format_args!("not entered yet: {}", all.join(", ")))?;
        }
        if let Some([before, now]) = &self.play {
            line(format_args!("today {}", now.against(before)))?;
        }
        if self.is_daily {
            return Ok(());
        }
        let told: Vec<String> =
            self.next.iter().take(NEXT).map(|next| format!("{} ({:.1} bits)", next.test, next.bits)).collect();
        line(format_args!("next, one more stroke of these helps most (1 bit halves a doubt): {}", told.join(", ")))
    }
}

/// What a stroke is called by its place in a file.
fn in_file(trial: usize, test: &str) -> String {
    format!("trial {trial} ({test})")
}
