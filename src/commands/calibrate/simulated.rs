//! Measures the calibration on tables whose constants are known.

use serde_json::json;

use crate::{
    calibration::{Coverage, PROTOCOL, coverage},
    commands::{
        Failure,
        output::{json_line, print_line, print_table},
    },
    table::{Table, TableDoubt},
};

/// Measures how often the intervals contain the truth, and prints the result.
pub fn run(table: &Table, doubt: &TableDoubt, tables: u32, seed: u64, is_json: bool) -> Result<(), Failure> {
    let constants = coverage(table, doubt, tables as usize, seed).map_err(Failure::wrong_input)?;
    let strokes: usize = PROTOCOL.iter().map(|test| test.repetitions).sum();
    if is_json {
        return Ok(json_line(&json!({ "tables": tables, "seed": seed, "strokes": strokes, "constants": constants }))?);
    }
    let heads = ["constant", "95 % intervals with the truth", "deviation before", "after", "error"];
    let row = |one: &Coverage| {
        let share = 100.0 * one.held as f64 / f64::from(tables);
        [
            one.name.clone(),
            format!("{share:.1} %"),
            format!("{:.5}", one.before),
            format!("{:.5}", one.after),
            format!("{:.5}", one.error),
        ]
    };
    print_table(heads, constants.iter().map(row), &[1, 2, 3, 4])?;
    print_line(format_args!("{tables} tables, seed {seed}; {strokes} strokes of a club player on each"))
}
