//! Jumps in words: their height and distance.

use super::{LengthUnit, format_trimmed};
use crate::{simulation::Jump, table::Table};

/// Formats a height in the unit for small lengths: "12 mm", "0.5 in".
pub fn height_words(metres: f64, unit: LengthUnit) -> String {
    match unit {
        // A hop is never displayed as zero.
        LengthUnit::Metres if metres < 0.000_95 => format!("{} mm", format_trimmed(1e3 * metres.max(1e-5), 2)),
        LengthUnit::Metres if metres < 0.009_95 => format!("{} mm", format_trimmed(1e3 * metres, 1)),
        LengthUnit::Metres if metres < 0.0995 => format!("{:.0} mm", 1e3 * metres),
        unit => unit.words(metres),
    }
}

/// Describes the height and the distance of a jump: "12 mm high, 31 cm far".
pub fn jump_words(jump: &Jump, unit: LengthUnit) -> String {
    format!("{} high, {} far", height_words(jump.height, unit), unit.words(jump.distance))
}

/// Explains why a shot shows no jump.
pub const fn no_jump_words(table: &Table) -> &'static str {
    if table.flight.is_none() {
        "no ball leaves this table's cloth: its file has no section [flight]"
    } else {
        "no ball rises 2 mm in this shot"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_switch_units_by_size() {
        let told =
            |height: f64, unit| jump_words(&Jump { ball: 0, start: 0.0, end: 0.1, height, distance: 0.31 }, unit);
        assert_eq!(told(0.000_04, LengthUnit::Metres), "0.04 mm high, 31 cm far");
        assert_eq!(told(0.0024, LengthUnit::Metres), "2.4 mm high, 31 cm far");
        assert_eq!(told(0.012, LengthUnit::Metres), "12 mm high, 31 cm far");
        assert_eq!(told(0.13, LengthUnit::Metres), "13 cm high, 31 cm far");
        assert_eq!(told(0.0127, LengthUnit::Feet), "0.5 in high, 12.2 in far");
    }
}
