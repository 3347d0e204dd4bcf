//! The result of a stroke, and its difference from the model shot, in players' words.

use super::{PlayedStroke, difference};
use crate::{
    coach::words::{LengthUnit, TipUnit, Units},
    physics::CueInputs,
    table::{CueBall, Table},
};

/// Minimum differences that are reported: aim in degrees, tip in mm, elevation in degrees, speed in m/s.
const MIN_CHANGES: (f64, f64, f64, f64) = (0.05, 0.5, 1.0, 0.1);
/// Difference in aim, degrees, beyond which it counts as a different shot.
const ANOTHER_SHOT: f64 = 12.0;

impl PlayedStroke {
    /// Whether it made the point, and what was missing otherwise, for a player with `cue_ball`.
    pub fn words(&self, cue_ball: CueBall, unit: LengthUnit) -> String {
        if self.miscue {
            return "No point: the tip slipped off the ball".to_owned();
        }
        self.verdict.words(cue_ball, unit)
    }
}

/// Describes the changes that a player must make to get from the stroke `from` to `to`, the most important first; empty
/// if the difference is too small to notice.
pub fn changes(table: &Table, from: &CueInputs, to: &CueInputs, units: Units) -> Vec<String> {
    let by = difference(to, from);
    let turn = by.phi.to_degrees();
    if turn.abs() > ANOTHER_SHOT {
        return vec!["another shot: aimed elsewhere".to_owned()];
    }
    // Includes a number that rounds to the minimum.
    let is_noticeable = |by: f64, least: f64| by.abs() > 0.999 * least;
    let change = |by: f64, least: f64, decimals: usize, symbol: &str, [more, less]: [&str; 2]| {
        let way = if by > 0.0 { more } else { less };
        is_noticeable(by, least).then(|| format!("{way} {:.decimals$}{symbol}", by.abs()))
    };
    let tip = |radii: f64, [more, less]: [&str; 2]| {
        let (way, millimetres) = (if radii > 0.0 { more } else { less }, 1000.0 * table.radius * radii);
        is_noticeable(millimetres, MIN_CHANGES.1).then(|| match units.tip {
            TipUnit::Tips => format!("{} {way}", units.tip.words(radii, table.radius).unwrap_or_default()),
            TipUnit::Mm => format!("tip {way} {:.1} mm", millimetres.abs()),
        })
    };
    let differences = [
        change(turn, MIN_CHANGES.0, 2, "°", ["aim left", "aim right"]),
        tip(by.b, ["up", "down"]),
        tip(by.a, ["left", "right"]),
        is_noticeable(by.speed, MIN_CHANGES.3).then(|| {
            let (in_a_metre, per_second) = units.length.speed();
            let way = if by.speed > 0.0 { "harder" } else { "softer" };
            format!("{way} {:.1} {per_second}", in_a_metre * by.speed.abs())
        }),
        change(by.theta.to_degrees(), MIN_CHANGES.2, 0, "°", ["cue up", "cue down"]),
    ];
    differences.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_state_direction_and_size_across_half_a_turn() {
        let table = Table::default();
        let cue = |a, b, theta: f64, phi: f64, speed| CueInputs {
            a: a * 0.001 / table.radius,
            b: b * 0.001 / table.radius,
            theta: theta.to_radians(),
            phi: phi.to_radians(),
            speed,
        };
        let from = cue(0.0, 0.0, 0.0, 179.9, 2.0);
        let to = cue(-2.0, 6.5, 3.0, -179.7, 1.7);
        let in_mm = Units { tip: TipUnit::Mm, ..Units::default() };
        let changes = |from: &CueInputs, to: &CueInputs| changes(&table, from, to, in_mm);
        let listed = changes(&from, &to);
        assert_eq!(listed, ["aim left 0.40°", "tip up 6.5 mm", "tip right 2.0 mm", "softer 0.3 m/s", "cue up 3°"]);
        let in_feet = Units { length: LengthUnit::Feet, ..Units::default() };
        let in_tips = super::changes(&table, &from, &to, in_feet);
        assert_eq!(in_tips[1..4], ["2.1 tips up", "0.7 tip right", "softer 1.0 ft/s"]);
        assert_eq!(changes(&to, &from)[0], "aim right 0.40°");
        assert_eq!(changes(&from, &cue(0.2, 0.0, 0.5, 179.91, 2.05)), Vec::<String>::new());
        assert_eq!(changes(&from, &cue(0.0, 0.0, 0.0, 90.0, 2.0)), ["another shot: aimed elsewhere"]);
    }
}
