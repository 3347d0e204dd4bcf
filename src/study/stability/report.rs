//! The stability table: one row a case, and how it is printed.

use std::fmt::Write as _;

use serde::Serialize;

use super::{Case, Figures, Finding, Progress, Swept, cases};
use crate::printing::ProgressLine;

/// How many shots to play, on each of a case's tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Random shots.
    pub random: u64,
    /// Adversarial shots.
    pub adversarial: u64,
    /// Shots of each stiff or extreme case.
    pub each_case: u64,
    /// Seed of everything.
    pub seed: u64,
}

impl Plan {
    /// What the report is made of.
    pub const REPORT: Self = Self { random: 100_000, adversarial: 10_000, each_case: 1_000, seed: 1 };

    /// A tenth of it.
    pub const QUICK: Self = Self { random: 10_000, adversarial: 1_000, each_case: 100, seed: 1 };

    /// Shots of this case.
    pub const fn shots(&self, case: &Case) -> u64 {
        match case.size {
            super::Size::Random => self.random,
            super::Size::Adversarial => self.adversarial,
            super::Size::Case => self.each_case,
        }
    }
}

/// One row.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What is hard about it.
    pub name: &'static str,
    /// What is checked besides the invariants.
    pub checked: &'static str,
    /// The worst that was measured.
    pub figures: Figures,
    /// Shots that fail.
    pub failed: u64,
    /// What is wrong with the first of them.
    pub example: Option<String>,
    /// That shot, on its table.
    pub finding: Option<Finding>,
    /// Whether all shots were played. They always are; readers of the JSON may ask.
    pub complete: bool,
}

impl Row {
    /// Plays a case; `watch` hears how far it is.
    pub fn of(case: &Case, plan: &Plan, watch: impl FnMut(Progress) + Send) -> Self {
        let Swept { figures, findings: failed, first } = case.run(plan.shots(case), plan.seed, watch);
        let example = first.as_ref().and_then(|finding| finding.violations.first()).map(ToString::to_string);
        Self { name: case.name, checked: case.holds, figures, failed, example, finding: first, complete: true }
    }

    /// Whether nothing failed.
    pub const fn passed(&self) -> bool {
        self.failed == 0
    }

    /// The largest of all errors in places, m.
    pub fn distance(&self) -> f64 {
        let Figures { overlap, outside, jump, apart, .. } = self.figures;
        // Balls that stay apart have no error.
        [overlap, outside, jump, apart].iter().fold(0.0, |worst, figure| figure.value.max(worst))
    }

    fn verdict(&self) -> String {
        match &self.example {
            None => "holds".to_owned(),
            Some(example) => format!("{} fail: {example}", self.failed),
        }
    }

    /// The row in the table for a terminal.
    pub fn line(&self) -> String {
        line(&self.cells())
    }

    fn cells(&self) -> [String; COLUMNS] {
        [
            self.name.to_owned(),
            self.figures.shots.to_string(),
            format!("{:.1e}", self.distance()),
            multiple(self.figures.energy.value),
            multiple(self.figures.unexplained.value),
            format!("{:.1e}", self.figures.missing.value.max(0.0)),
            self.figures.events.to_string(),
            format!("{:.1}", 1e3 * self.figures.seconds),
            self.verdict(),
        ]
    }
}

/// How many times what is allowed; NaN stays to be seen.
fn multiple(value: f64) -> String {
    if value > 1e4 { format!("{value:.1e}") } else { format!("{:.2}", if value < 0.0 { 0.0 } else { value }) }
}

/// Columns of the table.
const COLUMNS: usize = 9;

/// Width of a column of numbers: that of ten million shots.
const NUMBER: usize = 8;

const HEADS: [&str; COLUMNS] = [
    "case",
    "shots",
    "worst overlap, escape, jump or gap, m",
    "energy gained / rounding",
    "energy unexplained / tolerance",
    "energy unexplained, m²/s²",
    "most events",
    "longest, ms",
    "verdict",
];

/// All rows, in order, each as soon as it is played, with a line that tells how far it is.
pub fn rows(plan: &Plan) -> impl Iterator<Item = Row> {
    cases().into_iter().map(|case| {
        let mut line = ProgressLine::default();
        let row = Row::of(&case, plan, |progress| line.show(format_args!("{}: {progress}", case.name)));
        line.clear();
        row
    })
}

/// The heads of the same table for a terminal, where there is little room.
const SHORT_HEADS: [&str; COLUMNS] =
    ["case", "shots", "apart, m", "gained", "missing", "m²/s²", "events", "ms", "verdict"];

/// The heads of the table for a terminal, and what they mean.
pub fn heads() -> String {
    format!(
        "apart: worst overlap, escape, jump or gap; gained: energy, over rounding; missing: energy that nothing explains, over the tolerance, \
         and in m²/s²; events: most of a shot; ms: the longest shot\n\n{}",
        line(&SHORT_HEADS.map(str::to_owned))
    )
}

/// One line of that table: words stand left, numbers right.
fn line(cells: &[String; COLUMNS]) -> String {
    let longest = cases().iter().map(|case| case.name.chars().count()).max().unwrap_or(0);
    let mut line = String::new();
    for (column, cell) in cells.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = match column {
            0 => write!(line, "{cell:<longest$}"),
            _ if column + 1 == COLUMNS => write!(line, "  {cell}"),
            _ => write!(line, "  {cell:>NUMBER$}"),
        };
    }
    line
}

/// The table in Markdown, with what each row checks.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = format!("| {} | what must hold besides the invariants |\n", HEADS.join(" | "));
    text.push_str("|---|---:|---:|---:|---:|---:|---:|---:|---|---|\n");
    for row in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {} | {} |", row.cells().join(" | "), row.checked);
    }
    text
}

/// What the page says about energy.
const AUDIT: &str = "\
Energy is audited both ways. It never grows, at an event or on the way, beyond rounding (32 ε of the energy, and frictions times the rounding of time). And whatever is lost has been taken by a friction or an impact, which take no less:

| what takes energy | by which law | what it may be off by |
|---|---|---|
| sliding, rolling and spinning | their closed forms | rounding |
| a single impact | the formulas of restitution and Coulomb's friction, worked out apart from the engine | rounding |
| several impacts at once, or on balls that rest against something | the change is the work of impulses in closed contacts that push and rub no more than Coulomb allows | errors of 1e-10 m/s, also times the slip; on balls that rest or touch also the friction of an impulse of 2e-8 √(g R), the speed at which chatters of several contacts end; impulses that the change hardly tells apart, as those of balls all but in a row, are known to the rounding of velocities over what it tells |
| a ball pressed against one cushion | its equations, integrated | errors of 1e-10 m/s, of 1e-10 m and of a hundred-thousandth of the work |
| other resting contacts | the accelerations of the recorded course, as far as contacts push | the same, and a thousandth of the accelerations or, where the course obeys the laws at the ends of a piece but less well between them, the share that no forces explain, a hundredth at most |
| a ball at the edge of sliding, its slip below 2e-5 √(g R) | it may resist rolling in part if that explains its course and the cloth holds it as well as it can | where more than a hundredth of its accelerations stays unexplained, that friction may have another direction than the slip |
| a chatter that becomes a resting contact | the energy of its bounces, if the contact lasts as long as they would | |
| balls that never slip | they lose their slip where they begin to press each other, and where an impact makes them slip while they do, as in an impact | what parts those that no forces hold together, 8e-10 √(g R) |
| impacts slower than 1e-3 √(g R) | they may lose nothing along their normal, in shots that have taken so much work that nothing is let rest any more | |
| what is stopped | speeds below 1e-7 m/s | 1e-14 m²/s² a ball, and what the impulses in closed contacts that stop them rub |
| what touches and does not collide | nothing | errors of 1e-10 m/s, of 1e-10 m and of a hundred-thousandth of the work |
| a landing; heights count, too | the cloth's restitution and friction, worked out hop by hop | rounding |
| an impact where balls fly | the formulas of the reference engine: in the air one impact after another, on the cloth together where they happen at once | the overlap of the two bodies over a ball's diameter, by which the direction is uncertain |
| a ball that leaves the table | it takes its energy along | |

The columns below give the largest that was left in an event, on the way to the next or in a whole shot, in multiples of what is explained and in m²/s² (energy over a ball's mass).";

/// A page of Markdown around the table.
pub fn page(plan: &Plan, rows: &[Row]) -> String {
    let Plan { random, adversarial, each_case, seed } = plan;
    let held = rows.iter().filter(|row| row.passed()).count();
    format!(
        "# Stability on stiff and extreme cases\n\n\
        Made by `carom accuracy --stability` with seed {seed}: {random} random shots, {adversarial} adversarial ones and {each_case} of \
        each case, on each of a row's tables. {held} of {} rows hold.\n\n\
        Every shot is checked on its whole course, not at samples: all numbers finite, no ball outside or overlapping another by \
        more than 1e-9 m between events either (on tables longer than 2.84 m in proportion to their length), no jump between the \
        pieces of a course, no collision over a gap, time never back, at most 500 events where the row does not say otherwise, an \
        end, and at most 50 ms of computing. A row that fails says in how many shots, and what happens in the first.\n\n\
        {AUDIT}\n\n{}",
        rows.len(),
        markdown(rows)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Row {
        let figures = Figures { shots: 12, events: 7, ..Figures::default() };
        Row { name: "a case", checked: "something", figures, failed: 0, example: None, finding: None, complete: true }
    }

    #[test]
    fn the_page_says_what_is_checked() {
        let page = page(&Plan::REPORT, &[row()]);
        assert!(page.contains("100000 random shots") && page.contains("1 of 1 rows hold") && page.contains("50 ms"));
        let columns = |line: &str| line.matches('|').count();
        assert!(AUDIT.lines().all(|line| matches!(columns(line), 0 | 4)), "{AUDIT}");
    }

    #[test]
    fn a_row_says_what_it_is_and_whether_it_holds() {
        let good = row();
        let bad = Row { failed: 2, example: Some("a ball is outside".to_owned()), ..row() };
        let heads = heads();
        let lines = [heads.lines().last().unwrap(), &good.line(), &bad.line()];
        assert!(lines[1..].iter().all(|line| line.lines().count() == 1), "{lines:?}");
        let verdict = |line: &str| ["verdict", "holds", "2 fail"].iter().find_map(|word| line.find(word));
        let places = lines.each_ref().map(|line| verdict(line).map(|place| line[..place].chars().count()));
        assert!(places.iter().all(|place| *place == places[0]), "{lines:?}");
        let table = lines.concat();
        assert!(table.contains("a case") && table.contains("holds") && table.contains("2 fail: a ball is outside"));
        let table = markdown(&[good, bad]);
        assert!(table.lines().all(|line| line.matches('|').count() == COLUMNS + 2), "{table}");
    }
}
