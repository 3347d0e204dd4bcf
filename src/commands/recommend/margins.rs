//! `carom recommend --margins`: tolerances of the inputs, and where to aim.

use std::io::{self, Write};

use serde::Serialize;

use crate::{
    coach::{Aim, Doubt, Input, Map, Margin, RailPoint, Sensitivity, aim, words::Units},
    game::Rule,
    physics::CueInputs,
    simulation::ShotError,
    table::{BALL_NAMES, Layout, Table},
};

/// Number of columns and rows of a map.
const CELLS: usize = 41;

/// Range of the tip map to each side, mm.
const TIP: f64 = 8.0;

/// Ranges of the direction and speed map to each side, degrees and m/s.
const DIRECTION: f64 = 1.5;
const SPEED: f64 = 1.5;

/// The aim, the tolerances and the maps of a shot.
#[derive(Serialize)]
pub struct Margins {
    aim: Aim,
    /// Present for a shot that makes the point.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[serde(rename = "margins")]
    inputs: Option<[Margin; 5]>,
    /// A map over the tip position, and one over direction and speed.
    maps: [Map; 2],
}

impl Margins {
    /// Computes the margins of one shot.
    pub fn of(rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs, doubt: Doubt) -> Result<Self, ShotError> {
        let sensitivity = Sensitivity::new(rule, table, layout, doubt);
        let draw = |across, up| sensitivity.map(cue, cue, across, up, CELLS);
        Ok(Self {
            aim: aim(table, layout, cue)?,
            inputs: sensitivity.margins(cue),
            maps: [
                draw((Input::Side, TIP), (Input::Height, TIP)),
                draw((Input::Direction, DIRECTION), (Input::Speed, SPEED)),
            ],
        })
    }

    /// Describes them as text, without the maps.
    pub fn describe(&self, out: &mut impl Write, table: &Table, units: Units) -> io::Result<()> {
        let Aim { ahead, behind, hit } = &self.aim;
        let place = |mark: &RailPoint| {
            format!("{} {}", mark.rail.name(), units.position.exact(mark.diamond, table.diamond(), 2))
        };
        write!(out, "aim from {} to {}", place(behind), place(ahead))?;
        match hit {
            Some(hit) => {
                let side = hit.side().map_or_else(String::new, |side| format!(", {side} side"));
                writeln!(out, ": hits {} {:.0} % full{side}", BALL_NAMES[hit.ball], 100.0 * hit.fullness)?;
            }
            None => writeln!(out)?,
        }
        if self.inputs.is_none() {
            writeln!(out, "no margins: played exactly, it misses on likely tables")?;
        }
        for margin in self.inputs.iter().flatten() {
            let (factor, symbol) = margin.input.display_unit(units.length);
            let end = |end: Option<f64>| end.map_or_else(|| "any".to_owned(), |end| format!("{:.3}", factor * end));
            let (name, less, more) = (margin.input.name(), end(margin.less), end(margin.more));
            writeln!(out, "{name:<6} {less:>8} less to {more:>8} more, {symbol}")?;
        }
        Ok(())
    }
}
