//! The speed of a stroke in table lengths, as players gauge it.
//!
//! The reference is the lag: up the table and back is two lengths and called soft. One length more is called medium,
//! one less very soft.

use glam::DVec2;

use super::format_trimmed;
use crate::{
    physics::CueInputs,
    simulation::{EventKind, Rail, Recording},
    table::{Layout, Table},
};

/// Computes the number of table lengths, from cushion to cushion, that a ball runs if a level cue strikes its centre at
/// `speed`, m/s. A tilted table is treated as level. `None` if the table is too small for three balls, or the speed is
/// invalid.
pub fn table_lengths(table: &Table, speed: f64) -> Option<f64> {
    let level = Table { tilt: DVec2::ZERO, room: None, ..table.clone() };
    let (corner, start) = (level.reach(), DVec2::new(-0.25 * level.length, 0.0));
    let layout = Layout::new([start, corner, DVec2::new(corner.x, -corner.y)]);
    let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed };
    let recording = Recording::new(&level, &layout, &cue).ok()?;
    let (mut way, mut last) = (0.0, start.x);
    for event in recording.events() {
        if let EventKind::BallRail(0, rail) = event.kind {
            let place = if rail == Rail::Right { corner.x } else { -corner.x };
            way += (place - last).abs();
            last = place;
        }
    }
    way += (recording.final_layout().balls[0].x - last).abs();
    Some(way / (2.0 * corner.x))
}

/// Names of strokes of one table length, of two, and so on; longer ones have the last name.
pub const PACES: [&str; 5] = ["very soft", "soft", "medium", "hard", "very hard"];

/// Returns the name of a stroke of this number of table lengths, rounded to a tenth as it is reported.
pub fn pace_word(lengths: f64) -> &'static str {
    let reported = (10.0 * lengths).round() / 10.0;
    PACES[(reported.round() as usize).clamp(1, PACES.len()) - 1]
}

/// Formats a number of table lengths in words, to a tenth.
pub fn lengths_words(lengths: f64) -> String {
    let number = format_trimmed(lengths, 1);
    let plural = if number == "1" { "" } else { "s" };
    format!("{number} length{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_agrees_with_the_rounded_number() {
        assert_eq!([3.44, 3.46, 3.5].map(pace_word), ["medium", "hard", "hard"]);
    }

    #[test]
    fn one_length_is_singular() {
        assert_eq!([0.98, 1.04, 1.1, 0.5].map(lengths_words), ["1 length", "1 length", "1.1 lengths", "0.5 lengths"]);
    }

    #[test]
    fn table_lengths_increase_with_speed() {
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            let lengths: Vec<f64> =
                (1..=24).map(|step| table_lengths(&table, 0.25 * f64::from(step)).unwrap()).collect();
            assert!(lengths.is_sorted_by(|one, other| one < other), "{name}: {lengths:?}");
            assert!(lengths[0] > 0.0 && lengths[23] > 1.7, "{name}: {lengths:?}");
        }
        assert_eq!(table_lengths(&Table::default(), 0.0), None);
    }

    #[test]
    fn soft_stroke_length_equals_the_distance_run() {
        let table = Table { rolling_friction: 0.2, ..Table::default() };
        let lengths = table_lengths(&table, 0.5).unwrap();
        let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: 0.5 };
        let layout = Layout::parse("-0.71,0 1,0.5 1,-0.5", &table).unwrap();
        let end = Recording::new(&table, &layout, &cue).unwrap().final_layout().balls[0];
        assert!((lengths - (end.x + 0.71) / (table.length - 2.0 * table.radius)).abs() < 1e-9 && end.x < 1.0);
    }
}
