//! The calibration measured on tables that are known.

use serde::Serialize;

use crate::{
    calibration::{Coverage, PROTOCOL, coverage},
    commands::{
        Failure,
        output::{columns, json_line, line},
    },
    table::{Table, TableDoubt},
};

/// What is printed with `--json`.
#[derive(Serialize)]
struct Measured {
    tables: u32,
    seed: u64,
    strokes: usize,
    constants: Vec<Coverage>,
}

/// Measures and tells.
pub fn run(table: &Table, doubt: &TableDoubt, tables: u32, seed: u64, is_json: bool) -> Result<(), Failure> {
    let constants = coverage(table, doubt, tables as usize, seed).map_err(Failure::wrong_input)?;
    let strokes = PROTOCOL.iter().map(|test| test.times).sum();
    if is_json {
        return Ok(json_line(&Measured { tables, seed, strokes, constants })?);
    }
    let heads = ["constant", "95 % intervals that hold", "deviation before", "after", "error"].map(str::to_owned);
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
    let rows: Vec<_> = std::iter::once(heads).chain(constants.iter().map(row)).collect();
    columns(&rows, &[1, 2, 3, 4]).iter().try_for_each(line)?;
    line(format_args!("{tables} tables, seed {seed}; {strokes} strokes of a club player on each"))
}
