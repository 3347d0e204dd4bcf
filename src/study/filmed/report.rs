//! Formats the evaluation of table models on the film, as text and CSV.

use std::fmt::Write;

use super::{constants::Fitted, evaluation::ModelErrors};
use crate::{
    study::report::csv_text,
    table::{RailModel, Table},
};

/// Rail models to compare with that of the `match` table, with constants fitted to the whole film by `--fit`: name, model,
/// `e_rail`, `mu_rail`, (height - R)/R.
const RIVALS: [(&str, RailModel, f64, f64, f64); 3] = [
    ("match, rails at the equator", RailModel::Equator, 0.9153, 0.2606, 0.0),
    ("match, sharp nose", RailModel::Nose, 0.8748, 0.2551, 0.2215),
    ("match, Mathavan's rails", RailModel::Mathavan, 0.889, 0.213, 0.202),
];

/// Returns the compared models: `textbook`, the rivals, and `match`.
pub fn models() -> Vec<(String, Table)> {
    let table = Table::default();
    let rivals = RIVALS.map(|(name, model, e, mu, sine)| {
        let mut rival = Table { rail_restitution: e, rail_friction: mu, ..table.clone() };
        rival.rail.model = model;
        rival.rail.kappa = None;
        rival.rail.height = Some(rival.radius * (1.0 + sine));
        (name.to_owned(), rival)
    });
    let textbook = Table::preset("textbook").ok().map(|table| (table.name.clone(), table));
    textbook.into_iter().chain(rivals).chain([(table.name.clone(), table)]).collect()
}

/// Returns the median, `None` if there is no case.
fn finite(median: f64) -> Option<f64> {
    Some(median).filter(|median| !median.is_nan())
}

/// Formats the median for people.
fn format_median(median: f64, format: fn(f64) -> String) -> String {
    finite(median).map_or_else(|| "-".to_owned(), format)
}

/// Returns the report for people.
pub fn text(rows: &[ModelErrors]) -> String {
    let mut out = String::from(
        "Rails: the motion of a ball that leaves a rail is fitted up to the second rail after; the next two are predicted.\n\
         Whole shots: the stroke is fitted to the first two seconds. Systems: one natural stroke each, rms.\n\n",
    );
    let _ = writeln!(
        out,
        "{:<28} {:>16} {:>16} {:>15} {:>22} {:>20} {:>9}",
        "model", "next, diamonds", "after, diamonds", "late, s", "at 3, 4, 5 s, cm", "systems, diamonds", "impact"
    );
    for row in rows {
        let systems: Vec<_> = row.systems.iter().map(|system| format!("{:.2}", system.rms)).collect();
        let [next, after] = [row.next_rail, row.rail_after]
            .map(|(count, median)| format!("{} ({count})", format_median(median, |median| format!("{median:.3}"))));
        let [next_late, after_late] = row.late_s.map(|late| format_median(late, |late| format!("{late:+.3}")));
        let [a, b, c] = row.whole_cm.1.map(|cm| format_median(cm, |cm| format!("{cm:.1}")));
        let _ = writeln!(
            out,
            "{:<28} {:>16} {:>16} {:>15} {:>22} {:>20} {:>9}",
            row.model,
            next,
            after,
            format!("{next_late} {after_late}"),
            format!("{a} {b} {c} ({})", row.whole_cm.0),
            systems.join(" "),
            format!("{:.0} ns", row.impact_ns),
        );
    }
    out.push_str("\nMedians; the number of cases in parentheses. The constants of `match` are fitted to the same film: --fit also fits each half and predicts the other.\n");
    out
}

/// Returns the report as CSV.
pub fn csv(rows: &[ModelErrors]) -> String {
    let mut out = String::from(
        "model,chains_of_four,next_rail_diamonds,chains_of_five,rail_after_diamonds,late_next_s,late_after_s,\
         whole_shots,cm_at_3_s,cm_at_4_s,cm_at_5_s,corner5_diamonds,plus_diamonds,seven_diamonds,impact_ns\n",
    );
    for row in rows {
        let (count, cm) = row.whole_cm;
        let field = |value: f64| finite(value).map_or_else(String::new, |value| value.to_string());
        let cm = cm.map(field);
        let systems: Vec<_> = row.systems.iter().map(|system| system.rms.to_string()).collect();
        let ModelErrors { model, next_rail, rail_after, late_s, impact_ns, .. } = row;
        let _ = writeln!(
            out,
            "{},{},{},{},{},{},{},{count},{},{},{impact_ns:.1}",
            csv_text(model),
            next_rail.0,
            field(next_rail.1),
            rail_after.0,
            field(rail_after.1),
            field(late_s[0]),
            field(late_s[1]),
            cm.join(","),
            systems.join(","),
        );
    }
    out
}

/// Returns the result of a fit for people.
pub fn fit_text(fitted: &Fitted, used: &str) -> String {
    let mut out =
        format!("{:?} rails, fitted to {used}: {} stretches of three to five rails\n", fitted.model, fitted.stretches);
    for (index, constant) in fitted.constants.iter().enumerate() {
        let with =
            fitted.correlations[index].iter().enumerate().filter(|(other, value)| *other != index && value.abs() > 0.4);
        let with: Vec<_> = with.map(|(other, value)| format!("{} {value:+.2}", fitted.constants[other].name)).collect();
        let with = if with.is_empty() { String::new() } else { format!("   correlated with {}", with.join(", ")) };
        let _ = writeln!(out, "  {:<15} {:>9.5} ± {:.5}{with}", constant.name, constant.value, constant.deviation);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::filmed::evaluate_model;

    #[test]
    fn measures_without_cases_have_no_number() {
        let row = evaluate_model("match", &Table::default(), &[]);
        assert!(row.next_rail.0 == 0 && row.whole_cm.0 == 0);
        let (text, csv) = (text(std::slice::from_ref(&row)), csv(&[row]));
        assert!(text.contains("- (0)") && text.contains("- - - (0)") && !text.contains("NaN"), "{text}");
        assert!(csv.contains("\"match\",0,,0,,,,0,,,,") && !csv.contains("NaN"), "{csv}");
    }
}
