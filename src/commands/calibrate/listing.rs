//! The calibration tests as a list, and as a file of entries to fill in.

use serde::Serialize;

use crate::{
    calibration::{Mark, PROTOCOL, RAILS, Test, Unit},
    commands::{
        Failure,
        output::{json_line, print_line},
    },
    physics::CueInputs,
    table::{Layout, Table},
};

/// A test in JSON.
#[derive(Serialize)]
struct TestLine {
    test: &'static str,
    title: &'static str,
    place: &'static str,
    strike: &'static str,
    times: usize,
    /// Positions of the balls that take part, m.
    layout: Vec<[f64; 2]>,
    cue: CueInputs,
    marks: Vec<MarkLine>,
    /// The mark that counts rails, in tests that have it.
    #[serde(skip_serializing_if = "Option::is_none")]
    rails: Option<RailsLine>,
}

#[derive(Serialize)]
struct MarkLine {
    mark: &'static str,
    words: &'static str,
    unit: Unit,
    sure: f64,
}

/// The number of short rails that the ball has met: a whole number.
#[derive(Serialize)]
struct RailsLine {
    words: &'static str,
    /// The value that is assumed if the mark is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    usual: Option<usize>,
}

/// Prints the protocol: all tests.
pub fn tests(table: &Table, is_json: bool) -> Result<(), Failure> {
    for (number, test) in (1..).zip(PROTOCOL) {
        if is_json {
            json_line(&TestLine::of(test, table))?;
            continue;
        }
        for text in words(number, test) {
            print_line(text)?;
        }
        print_line("")?;
    }
    if !is_json {
        let strokes: usize = PROTOCOL.iter().map(|test| test.repetitions).sum();
        print_line(format_args!(
            "{COUNTING} {strokes} strokes in all; any test may be left out or played more often."
        ))?;
    }
    Ok(())
}

/// How positions are measured.
const COUNTING: &str = "Places are in diamonds: along the table from your own short rail (0) to the far one (8), across it from \
                        the long rail on your right (0) to that on your left (4); the rubber's edge counts, not the wood.";

/// Describes a test for a player.
pub fn words(number: usize, test: &Test) -> Vec<String> {
    let times = match test.repetitions {
        0 => "if you like".to_owned(),
        1 => "once".to_owned(),
        times => format!("{times} times"),
    };
    let mut lines = vec![
        format!("{number}. {} ({times}): {}", test.name, test.title),
        format!("   put     {}", test.placement),
        format!("   strike  {}", test.strike),
    ];
    lines.extend(test.marks.iter().map(|Mark { name, words, .. }| format!("   mark    {name}: {words}")));
    if counts_rails(test) {
        lines.push(format!("   mark    {RAILS}: {MET}{}", usual(test)));
    }
    lines
}

/// Description of the mark that counts rails.
const MET: &str = "how many short rails it has met";

fn counts_rails(test: &Test) -> bool {
    test.field_names().any(|name| name == RAILS)
}

fn usual(test: &Test) -> String {
    test.rails.map_or(String::new(), |rails| format!(", if not {rails}"))
}

/// Returns a file of entries to fill in.
pub fn template() -> String {
    let mut text = format!(
        "# Measurements at a table, for carom calibrate.\n\
         # {COUNTING}\n\
         # A number may have a unit: \"412 mm\" (with a tape, from the same rails) is more exact than 1.2 by eye. The uncertainty\n\
         # of a mark can be given: sure = {{ stop = 0.2 }}. Leave out unknown values; tests may be left out or repeated.\n\n\
         name = \"own\"\n"
    );
    for (number, test) in (1..).zip(PROTOCOL) {
        text += "\n";
        for line in words(number, test) {
            text.extend(["# ", &line, "\n"]);
        }
        for _ in 0..test.repetitions {
            text.extend(["# [[trial]]\n# test = \"", test.name, "\"\n"]);
            for mark in test.marks {
                text.extend(["# ", mark.name, " =\n"]);
            }
            if test.rails.is_none() {
                text += "# rails =\n";
            }
        }
    }
    text
}

impl TestLine {
    fn of(test: &Test, table: &Table) -> Self {
        let Layout { balls } = test.layout(table, 0.0);
        let taking_part = if test.frozen.is_some() { 3 } else { test.balls.len() };
        let [a, b, theta, phi, speed] = test.cue;
        Self {
            test: test.name,
            title: test.title,
            place: test.placement,
            strike: test.strike,
            times: test.repetitions,
            layout: balls[..taking_part].iter().map(glam::DVec2::to_array).collect(),
            cue: CueInputs { a, b, theta: theta.to_radians(), phi: phi.to_radians(), speed },
            marks: test
                .marks
                .iter()
                .map(|mark| MarkLine {
                    mark: mark.name,
                    words: mark.words,
                    unit: mark.unit(),
                    sure: mark.standard_error,
                })
                .collect(),
            rails: counts_rails(test).then_some(RailsLine { words: MET, usual: test.rails }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::Entries;

    #[test]
    fn the_template_parses_with_and_without_comments() {
        let entries = Entries::parse(&template()).unwrap();
        assert_eq!((entries.name.as_deref(), entries.trials.len()), (Some("own"), 0));
        let filled: String = template()
            .lines()
            .map(|line| match line.strip_prefix("# ").unwrap_or(line) {
                entry if entry.ends_with(" =") => format!("{entry} 2\n"),
                entry if entry.starts_with("[[trial]]") || entry.starts_with("test = ") => format!("{entry}\n"),
                _ => format!("{line}\n"),
            })
            .collect();
        let entries = Entries::parse(&filled).unwrap();
        let strokes: usize = PROTOCOL.iter().map(|test| test.repetitions).sum();
        assert_eq!((entries.trials.len(), entries.missing().len()), (strokes, 0));
        assert_eq!(entries.trials(&Table::default()).1, []);
    }
}
