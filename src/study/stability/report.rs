//! The stability table, with one row per case, and its output.

use std::fmt::Write as _;

use serde::Serialize;

use super::{Case, Figures, Finding, Limits, Progress, SweepResult, cases};
use crate::printing::ProgressLine;

/// Number of shots to play on each table of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Random shots.
    pub random: u64,
    /// Adversarial shots.
    pub adversarial: u64,
    /// Shots of each stiff or extreme case.
    pub each_case: u64,
    /// Base seed of all shots.
    pub seed: u64,
}

impl Plan {
    /// The plan of the report.
    pub const REPORT: Self = Self { random: 100_000, adversarial: 10_000, each_case: 1_000, seed: 1 };

    /// A tenth of the report.
    pub const QUICK: Self = Self { random: 10_000, adversarial: 1_000, each_case: 100, seed: 1 };

    /// Returns the number of shots of a case.
    pub const fn shots(&self, case: &Case) -> u64 {
        match case.kind {
            super::CaseKind::Random => self.random,
            super::CaseKind::Adversarial => self.adversarial,
            super::CaseKind::Case => self.each_case,
        }
    }
}

/// One row of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the case.
    pub name: &'static str,
    /// What is checked in addition to the invariants, and what is not.
    pub checked: String,
    /// The largest errors.
    pub figures: Figures,
    /// Number of failed shots.
    pub failed: u64,
    /// First violation of the first failed shot.
    pub example: Option<String>,
    /// The first failed shot, with its table.
    pub finding: Option<Finding>,
}

impl Row {
    /// Plays a case; `watch` receives the progress.
    pub fn of(case: &Case, plan: &Plan, watch: impl FnMut(Progress) + Send) -> Self {
        let SweepResult { figures, findings: failed, first } = case.run(plan.shots(case), plan.seed, watch);
        let example = first.as_ref().and_then(|finding| finding.violations.first()).map(ToString::to_string);
        let unlimited = (case.limits == Limits::ANY_EVENTS).then_some("any number of events");
        let parts = [Some(case.requirement).filter(|words| !words.is_empty()), unlimited];
        let checked = parts.into_iter().flatten().collect::<Vec<_>>().join("; ");
        Self { name: case.name, checked, figures, failed, example, finding: first }
    }

    /// Whether no shot failed.
    pub const fn passed(&self) -> bool {
        self.failed == 0
    }

    /// Returns the largest of all position errors, m.
    pub fn distance(&self) -> f64 {
        let Figures { overlap, outside, jump, contact_gap, .. } = self.figures;
        // Balls that stay apart have no error.
        [overlap, outside, jump, contact_gap].iter().fold(0.0, |worst, figure| figure.value.max(worst))
    }

    fn verdict(&self) -> String {
        match &self.example {
            None => "holds".to_owned(),
            Some(example) => format!("{} fail: {example}", self.failed),
        }
    }

    /// Returns the row for the table on a terminal.
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
            format!("{:.1e}", self.figures.unexplained_energy.value.max(0.0)),
            self.figures.events.to_string(),
            format!("{:.1}", 1e3 * self.figures.seconds),
            self.verdict(),
        ]
    }
}

/// Formats a multiple of the allowed value; NaN stays visible.
fn multiple(value: f64) -> String {
    if value > 1e4 { format!("{value:.1e}") } else { format!("{:.2}", if value < 0.0 { 0.0 } else { value }) }
}

/// Columns of the table.
const COLUMNS: usize = 9;

/// Width of a column of numbers, enough for ten million shots.
const NUMBER: usize = 8;

const HEADINGS: [&str; COLUMNS] = [
    "case",
    "shots",
    "worst overlap, escape, jump or gap, m",
    "energy gained / tolerance",
    "energy unexplained / tolerance",
    "energy unexplained, m²/s²",
    "most events",
    "longest, ms",
    "verdict",
];

/// Plays the rows in order and returns each as soon as it is complete, with a progress line.
pub fn rows(plan: &Plan) -> impl Iterator<Item = Row> {
    cases().into_iter().map(|case| {
        let mut line = ProgressLine::default();
        let row = Row::of(&case, plan, |progress| line.show(format_args!("{}: {progress}", case.name)));
        line.clear();
        row
    })
}

/// Headings of the table on a terminal, which has little room.
const SHORT_HEADINGS: [&str; COLUMNS] =
    ["case", "shots", "apart, m", "gained", "missing", "m²/s²", "events", "ms", "verdict"];

/// Returns the headings of the table on a terminal, and their meaning.
pub fn headings() -> String {
    format!(
        "apart: worst overlap, escape, jump or gap; gained: energy gain / tolerance; missing: unexplained energy / tolerance \
         and in m²/s²; events: most of a shot; ms: slowest shot\n\n{}",
        line(&SHORT_HEADINGS.map(str::to_owned))
    )
}

/// Formats one line of that table: text left-aligned, numbers right-aligned.
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

/// Returns the table in Markdown, with what each row checks.
fn markdown(rows: &[Row]) -> String {
    let mut text = format!("| {} | what must hold in addition to the invariants |\n", HEADINGS.join(" | "));
    text.push_str("|---|---:|---:|---:|---:|---:|---:|---:|---|---|\n");
    for row in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {} | {} |", row.cells().join(" | "), row.checked);
    }
    text
}

/// The page's section on energy.
const AUDIT: &str = "\
Energy is audited in both directions. It never grows, at an event or between events, beyond rounding (32 ε of the energy, and frictions times the rounding of time); while a contact rests, errors of 1e-10 m/s are accepted too, and on tables without `mu_b` the energy that separates balls which no forces hold together. And every loss is explained by a friction or an impact, which dissipate no less:

| what dissipates energy | law | tolerance |
|---|---|---|
| sliding, rolling and spinning | their closed forms | rounding |
| a single impact | the formulas of restitution and Coulomb's friction, implemented independently of the engine | rounding |
| several simultaneous impacts, or impacts on balls that rest against something | the change is the work of impulses in closed contacts, which only push and rub no more than Coulomb allows | errors of 1e-10 m/s, also times the slip; for balls that rest or touch also the friction of an impulse of 2e-8 √(g R), the speed at which chatters of several contacts end; impulses that the velocity change barely determines (balls almost in a row) are known only to rounding, divided by how independent they are |
| a ball pressed against one cushion | its equations, integrated | errors of 1e-10 m/s, of 1e-10 m and of 1e-5 of the work |
| other resting contacts | the accelerations of the recorded course, if the contacts push | the same, and 1e-3 of the work; up to 1e-2 for a piece whose course obeys the laws at both ends but not between |
| a ball at the edge of sliding, its slip below 2e-5 √(g R) | its rolling resistance may be partial if that explains its course and the cloth's friction is at its limit | if more than 1e-2 of its accelerations stays unexplained, that friction may have another direction than the slip |
| a chatter that becomes a resting contact | the energy of its bounces, if the contact lasts as long as they would | |
| balls that never slip | their slip ends when they begin to press each other, or when an impact makes them slip while they press, as in an impact | the energy that separates balls which no forces hold together, at 8e-10 √(g R) |
| impacts slower than 1e-3 √(g R) | they may lose nothing along their normal, in shots past the work limit after which no contact may rest | |
| motion that is stopped | speeds below 1e-7 m/s | 1e-14 m²/s² a ball, and the friction of the impulses in closed contacts that stop it |
| bodies that touch without a collision | nothing | errors of 1e-10 m/s, of 1e-10 m and of 1e-5 of the work |
| a landing, potential energy included | the cloth's restitution and friction, computed hop by hop | rounding |
| an impact of balls in the air | the formulas of the reference engine: impacts at the same moment together, as on the cloth; slow ones in the air, with which a ball slides off, one after another | the overlap of the two bodies over a ball's diameter, which makes the direction uncertain |
| a ball that leaves the table | its whole energy | |

The columns below contain the largest residual at an event or between events, as a multiple of the tolerance and in m²/s² (energy over a ball's mass); the latter also of a whole shot.";

/// Returns the Markdown page with the table.
pub fn page(plan: &Plan, rows: &[Row]) -> String {
    let Plan { random, adversarial, each_case, seed } = plan;
    let held = rows.iter().filter(|row| row.passed()).count();
    format!(
        "# Stability on stiff and extreme cases\n\n\
        This page is for readers who want to judge the simulator: it lists the stiff and extreme cases on which it is tested, what is \
        checked on every shot, and the largest errors.\n\n\
        The page is generated by `carom accuracy --stability` with seed {seed}: {random} random shots, {adversarial} adversarial ones and \
        {each_case} of each case, on each table of a row. A row that names no table plays on `textbook` and `thesis`, whose contacts rest \
        longest, or on tables made from them; rows with the same kind of shots draw the same ones. {held} of {} rows hold.\n\n\
        Every shot is checked on its whole course, not at samples: all numbers finite, no ball outside the table or overlapping another by \
        more than 1e-9 m, between events either (in proportion to the length on tables longer than 2.84 m), no jump between the \
        pieces of a course, no collision across a gap, no time that runs backwards, at most 500 events unless the row says otherwise, an \
        end that is not forced because of too much work, and at most 50 ms of computing. A failed row states the number of failed shots and the violation in the first.\n\n\
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
        Row { name: "a case", checked: "something".to_owned(), figures, failed: 0, example: None, finding: None }
    }

    #[test]
    fn page_describes_the_checks() {
        let page = page(&Plan::REPORT, &[row()]);
        assert!(page.contains("100000 random shots") && page.contains("1 of 1 rows hold") && page.contains("50 ms"));
        let columns = |line: &str| line.matches('|').count();
        assert!(AUDIT.lines().all(|line| matches!(columns(line), 0 | 4)), "{AUDIT}");
    }

    #[test]
    fn row_shows_its_case_and_verdict() {
        let good = row();
        let bad = Row { failed: 2, example: Some("a ball is outside".to_owned()), ..row() };
        let headings = headings();
        let lines = [headings.lines().last().unwrap(), &good.line(), &bad.line()];
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
