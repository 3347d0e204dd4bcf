//! `carom bench`: measures the speed of this machine.

use std::{io::Write, time::Duration};

use indicatif::HumanCount;
use serde_json::json;

use super::{Failure, output::plural};
use crate::{
    printing::{self, VERSION, number},
    study::throughput::{Figure, Machine, measure},
};

/// Measure the speed of this machine.
///
/// The figures are shots, recommendations and network updates per second. This takes about twenty seconds.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Seconds of measurement for each figure.
    #[arg(long, default_value_t = 1.0)]
    seconds: f64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Longest measurement of a figure, s.
const MAX_SECONDS: f64 = 3600.0;

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let accepted = args.seconds > 0.0 && args.seconds <= MAX_SECONDS;
    let time = Duration::try_from_secs_f64(args.seconds).ok().filter(|_| accepted).ok_or_else(|| {
        Failure::wrong_input(format_args!(
            "--seconds {} is not a valid time; accepted is above 0 and at most {MAX_SECONDS}",
            number(args.seconds)
        ))
    })?;
    let machine = Machine::this();
    let mut out = printing::stdout().exact(args.json);
    if !args.json {
        writeln!(out, "{}, {} threads, {}", machine.cpu, machine.threads, machine.os)?;
    }
    // A closed pipe is reported after the measurement.
    let mut written = Ok(());
    let figures = measure(time, |figure| {
        if !args.json && written.is_ok() {
            written = writeln!(out, "{}", words(figure));
        }
    })
    .map_err(|error| Failure::failed(format_args!("the networks cannot be measured: {error}")))?;
    written?;
    if args.json {
        let report = json!({ "version": VERSION, "machine": machine, "seconds": args.seconds, "figures": figures });
        printing::json_line(&mut out, &report)?;
    }
    Ok(())
}

/// Formats a figure as a line of text.
fn words(figure: &Figure) -> String {
    let threads = plural(figure.threads, "thread");
    let line =
        format!("{:<18} {:<7} {threads:<10} {:>12} /s", figure.operation, figure.table, grouped(figure.per_second));
    figure.sizes.as_ref().map_or_else(|| line.clone(), |sizes| format!("{line}  {sizes}"))
}

/// Formats a number with spaces between thousands.
fn grouped(number: f64) -> String {
    HumanCount(number.round() as u64).to_string().replace(',', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_separated() {
        assert_eq!(
            [grouped(7.2), grouped(812.0), grouped(1234.4), grouped(1_234_567.0)],
            ["7", "812", "1 234", "1 234 567"]
        );
    }
}
