//! Scores and positions in the form in which they are printed.

use serde::Serialize;

use crate::{
    coach::words::format_trimmed,
    commands::output::plural,
    drills::Record,
    printing::format_utc,
    table::{CueBall, Layout, Table},
};

/// A record in JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Score {
    tried: usize,
    made: usize,
    /// Absent before the first attempt.
    #[serde(skip_serializing_if = "Option::is_none")]
    rate: Option<f64>,
    /// The 95 % interval of the rate.
    interval: [f64; 2],
    innings: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    average: Option<f64>,
    high_run: u32,
    helped: usize,
    /// Time of the last attempt.
    #[serde(skip_serializing_if = "Option::is_none")]
    last: Option<String>,
}

impl From<Record> for Score {
    fn from(record: Record) -> Self {
        Self {
            tried: record.tried,
            made: record.made,
            rate: (record.tried > 0).then_some(record.rate.rate),
            interval: [record.rate.low, record.rate.high],
            innings: record.innings,
            average: record.average,
            high_run: record.high_run,
            helped: record.helped,
            last: record.last.map(format_utc),
        }
    }
}

/// Describes a record in a sentence.
pub fn words(record: &Record) -> String {
    if record.tried == 0 {
        return "not tried yet".to_owned();
    }
    let average = record.average.map_or_else(String::new, |average| {
        let of = if record.has_unordered { " of those logged one by one" } else { "" };
        format!(", average {average:.2} in {}, high run {}{of}", plural(record.innings, "inning"), record.high_run)
    });
    let helped = if record.helped > 0 { format!(", {} with a hint", record.helped) } else { String::new() };
    format!(
        "{} of {} made, {:.0} % ({:.0} to {:.0} %){average}{helped}",
        record.made,
        record.tried,
        100.0 * record.rate.rate,
        100.0 * record.rate.low,
        100.0 * record.rate.high
    )
}

/// Names the balls and their positions in diamonds, cue ball first.
pub fn positions_text(table: &Table, layout: &Layout, cue_ball: CueBall) -> String {
    let place = |(name, ball)| {
        let [along, up] = table.to_diamonds(ball).to_array().map(|diamonds| format_trimmed(diamonds, 2));
        format!("{name} {along}d,{up}d")
    };
    cue_ball.names().into_iter().zip(layout.balls).map(place).collect::<Vec<_>>().join("  ")
}
