//! The uncertainty under which the coach chooses a shot: the table's constants and the exact ball positions.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

/// The amount of uncertainty. Its text form is `none`, `full`, or two numbers like `table=1,placing=3`, the second in mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Doubt {
    /// Multiple of the standard deviations of the table's constants ([`crate::table::TableDoubt`]).
    pub table: f64,
    /// Standard deviation of each coordinate of each ball, m: players report positions by sight.
    pub placing: f64,
}

/// Error: a text that cannot be parsed as a doubt.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error(
    "\"{0}\" is not accepted as doubt; use none, full, or two numbers like \"table=1,placing=3\": a multiple of the table's \
     uncertainty from 0 to 10, and the error of the ball positions from 0 to 50 mm"
)]
pub struct UnknownDoubt(String);

/// Maximum accepted values: multiple, and m.
const MAX_VALUES: [f64; 2] = [10.0, 0.05];

impl Doubt {
    /// The table and the ball positions are exactly as given.
    pub const NONE: Self = Self { table: 0.0, placing: 0.0 };

    /// The table as precisely as it is usually known, and balls within a few millimetres of the given positions.
    pub const FULL: Self = Self { table: 1.0, placing: 3e-3 };
}

impl Default for Doubt {
    fn default() -> Self {
        Self::FULL
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NONE => formatter.pad("none"),
            Self::FULL => formatter.pad("full"),
            // Twelve digits, so that a value read in mm is written unchanged.
            Self { table, placing } => {
                formatter.pad(&format!("table={table},placing={}", (placing * 1e15).round() / 1e12))
            }
        }
    }
}

impl FromStr for Doubt {
    type Err = UnknownDoubt;

    fn from_str(text: &str) -> Result<Self, UnknownDoubt> {
        let unknown = || UnknownDoubt(text.to_owned());
        match text {
            "none" => return Ok(Self::NONE),
            "full" => return Ok(Self::FULL),
            _ => {}
        }
        let mut numbers = [None; 2];
        for part in text.split(',') {
            let (name, number) = part.split_once('=').ok_or_else(unknown)?;
            let (index, unit) = match name.trim() {
                "table" => (0, 1.0),
                "placing" => (1, 1e-3),
                _ => return Err(unknown()),
            };
            let value = unit * number.trim().parse::<f64>().map_err(|_| unknown())?;
            if !(0.0..=MAX_VALUES[index]).contains(&value) || numbers[index].replace(value).is_some() {
                return Err(unknown());
            }
        }
        let [table, placing] = numbers;
        Ok(Self { table: table.unwrap_or(Self::FULL.table), placing: placing.unwrap_or(Self::FULL.placing) })
    }
}

impl From<Doubt> for String {
    fn from(doubt: Doubt) -> Self {
        doubt.to_string()
    }
}

impl TryFrom<String> for Doubt {
    type Error = UnknownDoubt;

    fn try_from(text: String) -> Result<Self, UnknownDoubt> {
        text.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubt_round_trips_through_text() {
        for (text, doubt) in [
            ("none", Doubt::NONE),
            ("full", Doubt::FULL),
            ("table=0.5,placing=2.5", Doubt { table: 0.5, placing: 2.5e-3 }),
            ("table=0,placing=3", Doubt { table: 0.0, ..Doubt::FULL }),
        ] {
            assert_eq!((text.parse(), doubt.to_string().as_str()), (Ok(doubt), text));
        }
        assert_eq!("placing=5".parse(), Ok(Doubt { placing: 5e-3, ..Doubt::FULL }));
        for bad in ["", "some", "table=-1", "placing=51", "table=1,table=1", "table=NaN", "hand=1"] {
            let said = bad.parse::<Doubt>().unwrap_err().to_string();
            assert!(said.contains(bad) && said.contains("table=1,placing=3"), "{said}");
        }
    }
}
