//! Formats the study as text for people and as CSV for programs.

use std::fmt::Write;

use super::{
    precision::{Row, Study, Summary},
    reference_check::{GOAL_CONTACT, GOAL_MEDIAN, GOAL_P99, ReferenceRow},
    statistics::{Proportion, Spread},
};
use crate::platform::CLOCK_NAME;

/// Returns the report for people.
pub fn text(references: &[ReferenceRow], studies: &[Study]) -> String {
    let mut out = String::new();
    references_text(&mut out, references);
    for study in studies {
        study_text(&mut out, study);
    }
    out
}

fn references_text(out: &mut String, rows: &[ReferenceRow]) {
    let _ = writeln!(
        out,
        "Reference shots, computed by another program with 50 digits. Error at rest: median, p99, worst."
    );
    let _ = writeln!(out, "A unit is (1 + condition) 2^-53 m: what one rounding of the input does to the shot.\n");
    let _ = writeln!(
        out,
        "{:<9}{:>6}  {:<27}{:<27}{:<22}{:>9}",
        "file", "shots", "truth, m", "engine, m", "engine, units", "sequence"
    );
    for row in rows {
        let _ = writeln!(
            out,
            "{:<9}{:>6}  {:<27}{:<27}{:<22}{:>9}",
            row.file,
            row.shots,
            spread(row.truth_m),
            spread(row.engine_m),
            units(row.engine_units),
            if row.engine_wrong.total == 0 { "-".to_owned() } else { wrong(row.engine_wrong) },
        );
        if let (Some(engine), true) = (row.engine_to_truth_m, row.file == "contact") {
            let _ = writeln!(out, "{:17}engine to truth: {} m", "", spread(Some(engine)));
        }
    }
    let goal = |row: &ReferenceRow| {
        let is_near = row.file != "contact" || row.engine_to_truth_m.is_some_and(|errors| errors.worst <= GOAL_CONTACT);
        is_near
            && row.engine_units.is_none_or(|units| units.median <= GOAL_MEDIAN && units.p99 <= GOAL_P99)
            && row.engine_wrong.count == 0
            && row.truth_wrong.count == 0
            && row.unjudged == 0
    };
    let met = if rows.iter().all(goal) { "met" } else { "NOT met" };
    let _ = writeln!(
        out,
        "goal: median <= {GOAL_MEDIAN}, p99 <= {GOAL_P99} units, contact <= {GOAL_CONTACT:e} m, no wrong sequence, all judged: {met}\n"
    );
}

fn study_text(out: &mut String, study: &Study) {
    let Summary { table, steepest_deg, flies, judged, chatters, condition_m, truth_energy, truth_cost_us } =
        &study.summary;
    let _ = writeln!(
        out,
        "Table \"{table}\": {} random shots, the cue raised up to {steepest_deg:.0} degrees, the same for every method.",
        judged.total
    );
    if flies.count > 0 {
        let _ = writeln!(out, "Balls leave the cloth in {:.1} % of them.", percent(*flies));
    }
    let _ = writeln!(
        out,
        "Not judged and not timed, since the truth does not cover them: {} ({:.1} %){}{}",
        judged.total - judged.count,
        100.0 - percent(*judged),
        if study.unjudged.is_empty() { "" } else { ": " },
        study.why_unjudged()
    );
    let _ = writeln!(
        out,
        "Balls chatter or rest against something while they move in {:.1} % of the others.",
        percent(*chatters)
    );
    let _ = writeln!(out, "Condition, m: {} (median, p99, worst).", spread(*condition_m));
    let _ = writeln!(
        out,
        "Truth: the reference engine (32 digits), {truth_cost_us:.0} µs a shot with its two perturbed replays; its energy balance is off by {}.\n",
        spread(*truth_energy)
    );
    let _ = writeln!(
        out,
        "{:<METHOD$}{:>6}{:>11}  {:<27}{:<27}off by",
        "", "", "µs a shot", "error at rest, m", "in units"
    );
    let _ = writeln!(
        out,
        "{:<METHOD$}{:>6}{:>11}  {SPREAD_HEADER:<27}{SPREAD_HEADER:<27}> 1e-9 m",
        "method", "shots", "mean"
    );
    for row in &study.rows {
        let _ = writeln!(
            out,
            "{:<METHOD$}{:>6}{:>11.2}  {:<27}{:<27}{}",
            name(row),
            row.shots,
            row.cost_us,
            spread(row.rest_m),
            spread(row.rest_units),
            wrong(row.beyond_1e_9_m)
        );
    }
    let _ = writeln!(
        out,
        "\n{:<METHOD$}{:<27}{:>9}{:>7}  {:<27}",
        "", "event times, s", "wrong", "first", "energy balance"
    );
    let _ = writeln!(
        out,
        "{:<METHOD$}{SPREAD_HEADER:<27}{:>9}{:>7}  {SPREAD_HEADER:<27}gave up",
        "method", "sequence", "wrong"
    );
    for row in &study.rows {
        let _ = writeln!(
            out,
            "{:<METHOD$}{:<27}{:>9}{:>7}  {:<27}{}",
            name(row),
            spread(row.time_s),
            wrong(row.wrong_sequence),
            row.first_wrong.map_or_else(|| "-".to_owned(), |index| format!("{index:.0}")),
            spread(row.energy),
            row.failed
        );
    }
    let _ =
        writeln!(out, "\n{:<METHOD$}{:<33}{:<33}", "wrong outcome, 95 % interval", "straight rail", "three-cushion");
    for row in &study.rows {
        let _ = writeln!(
            out,
            "{:<METHOD$}{:<33}{:<33}",
            name(row),
            flips(row.flips_straight),
            flips(row.flips_three_cushion)
        );
    }
    if let Some(engine) = study.rows.first() {
        let _ = writeln!(out, "\nThe engine's worst shot by units:\n{}\n", engine.worst_shot);
    }
    let _ = writeln!(out, "Cost is {CLOCK_NAME}, the minimum of the rounds; the methods take turns every 16 shots.\n");
}

/// Width of the method column.
const METHOD: usize = 44;

/// Header of a spread's three columns.
const SPREAD_HEADER: &str = "median    p99     worst";

/// Returns a method's name with its time step.
pub fn name(row: &Row) -> String {
    row.dt.map_or_else(|| row.description.to_owned(), |dt| format!("{}, dt {dt:.0e} s", row.description))
}

fn spread(spread: Option<Spread>) -> String {
    spread.map_or_else(
        || "-".to_owned(),
        |Spread { median, p99, worst }| format!("{median:<8.1e}{p99:<8.1e}{worst:<8.1e}").trim_end().to_owned(),
    )
}

fn units(spread: Option<Spread>) -> String {
    spread.map_or_else(
        || "-".to_owned(),
        |Spread { median, p99, worst }| format!("{median:<7.2}{p99:<7.1}{worst:<7.1}").trim_end().to_owned(),
    )
}

fn percent(share: Proportion) -> f64 {
    100.0 * share.count as f64 / share.total.max(1) as f64
}

fn wrong(share: Proportion) -> String {
    format!("{}/{}", share.count, share.total)
}

fn flips(share: Proportion) -> String {
    format!("{} ({:.2} % to {:.2} %)", wrong(share), 100.0 * share.low, 100.0 * share.high)
}

/// Quotes a text as a CSV field.
pub fn csv_text(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// Returns the study as CSV with one line for each table and method.
pub fn csv(studies: &[Study]) -> String {
    let spreads = ["cost_us", "rest_m", "rest_units", "time_s", "time_units", "energy"];
    let shares = ["beyond_1e_9_m", "wrong_sequence", "flips_straight", "flips_three_cushion"];
    let mut out = "table,steepest_deg,method,dt_s,shots,failed,mean_cost_us".to_owned();
    for name in spreads {
        let _ = write!(out, ",{name}_median,{name}_p99,{name}_worst");
    }
    for name in shares {
        let _ = write!(out, ",{name},{name}_of,{name}_low,{name}_high");
    }
    out.push('\n');
    for row in studies.iter().flat_map(|study| &study.rows) {
        let dt = row.dt.map_or_else(String::new, |dt| format!("{dt:e}"));
        let Row { table, steepest_deg, method, shots, failed, cost_us, .. } = row;
        let [table, method] = [table.as_str(), *method].map(csv_text);
        let _ = write!(out, "{table},{steepest_deg:.0},{method},{dt},{shots},{failed},{cost_us:.3}");
        let spreads = [row.cost_spread_us, row.rest_m, row.rest_units, row.time_s, row.time_units, row.energy];
        for spread in spreads {
            let _ = match spread {
                Some(Spread { median, p99, worst }) => write!(out, ",{median:.4e},{p99:.4e},{worst:.4e}"),
                None => write!(out, ",,,"),
            };
        }
        for share in [row.beyond_1e_9_m, row.wrong_sequence, row.flips_straight, row.flips_three_cushion] {
            let _ = write!(out, ",{},{},{:.5},{:.5}", share.count, share.total, share.low, share.high);
        }
        out.push('\n');
    }
    out
}
