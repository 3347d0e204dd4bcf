//! The result of a stroke, and how it differs from the model shot, in words a player uses.

use super::{Played, difference};
use crate::{
    game::{Point, Rule, Tally},
    physics::CueInputs,
    table::{CueBall, Table},
};

/// Differences too small to see or to play: degrees of aim, mm of the tip, degrees of the cue, m/s.
const SEEN: (f64, f64, f64, f64) = (0.05, 0.5, 1.0, 0.1);
/// Degrees of aim beyond which it is another shot altogether.
const ANOTHER_SHOT: f64 = 12.0;

/// A number of cushions in words.
pub fn cushions(count: u32) -> String {
    match count {
        0 => "no cushion".to_owned(),
        1 => "1 cushion".to_owned(),
        _ => format!("{count} cushions"),
    }
}

/// What a shot lacks that makes no point, for who plays with `cue_ball`; `None` where it makes one.
pub fn missing(point: Point, tally: &Tally, cue_ball: CueBall) -> Option<String> {
    let (rule, names) = (point.rule, cue_ball.names());
    Some(match tally.met {
        [false, false] => "no ball was met".to_owned(),
        [met, _] if !tally.met_both() => {
            let [met, missed] = if met { [1, 2] } else { [2, 1] }.map(|ball| names[ball]);
            format!("{met} was met, {missed} was not")
        }
        _ if !tally.is_point(rule) => {
            let [made, wanted] = [tally.cushions_before_second, rule.cushions()];
            format!("{} before the second ball, {wanted} needed", cushions(made))
        }
        _ if !point.is_made(tally) => format!("{} was met first, a game opens with {}", names[1], names[2]),
        _ => return None,
    })
}

/// Whether a shot made the point, and what was missing if it did not, for who plays with `cue_ball`.
pub fn verdict(point: Point, tally: &Tally, cue_ball: CueBall) -> String {
    match missing(point, tally, cue_ball) {
        Some(missing) => format!("missed: {missing}"),
        None if point.rule == Rule::StraightRail => "made".to_owned(),
        None => format!("made, after {}", cushions(tally.cushions_before_second)),
    }
}

impl Played {
    /// Whether it made the point, and what was missing if it did not, for who plays with `cue_ball`.
    pub fn verdict(&self, cue_ball: CueBall) -> String {
        if self.miscue {
            return "missed: the tip slipped off the ball".to_owned();
        }
        verdict(self.point, &self.tally, cue_ball)
    }
}

/// What a player has to change to get from the stroke `from` to `to`, the most telling first; nothing where nobody could
/// tell them apart.
pub fn changes(table: &Table, from: &CueInputs, to: &CueInputs) -> Vec<String> {
    let by = difference(to, from);
    let turn = by.phi.to_degrees();
    if turn.abs() > ANOTHER_SHOT {
        return vec!["another shot: aimed elsewhere".to_owned()];
    }
    let millimetres = |radii: f64| 1000.0 * table.radius * radii;
    let differences = [
        (turn, SEEN.0, 2, "°", ["aim left", "aim right"]),
        (millimetres(by.b), SEEN.1, 1, " mm", ["tip up", "tip down"]),
        (millimetres(by.a), SEEN.1, 1, " mm", ["tip left", "tip right"]),
        (by.speed, SEEN.3, 1, " m/s", ["harder", "softer"]),
        (by.theta.to_degrees(), SEEN.2, 0, "°", ["cue up", "cue down"]),
    ];
    // A number that rounds to the smallest that counts does count.
    let told = differences.into_iter().filter(|(by, least, ..)| by.abs() > 0.999 * least);
    told.map(|(by, _, decimals, unit, [more, less])| {
        let way = if by > 0.0 { more } else { less };
        format!("{way} {:.decimals$}{unit}", by.abs())
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_miss_says_what_was_missing() {
        let said = |met, cushions_before_second, rule: Rule| {
            let tally = Tally { met, cushions: 4, cushions_before_second, ..Tally::default() };
            verdict(rule.into(), &tally, CueBall::White)
        };
        assert_eq!(said([false, false], 0, Rule::StraightRail), "missed: no ball was met");
        assert_eq!(said([false, true], 0, Rule::ThreeCushion), "missed: red was met, yellow was not");
        let short = said([true, true], 2, Rule::ThreeCushion);
        assert_eq!(short, "missed: 2 cushions before the second ball, 3 needed");
        assert_eq!(said([true, true], 2, Rule::StraightRail), "made");
        assert_eq!(said([true, true], 1, Rule::OneCushion), "made, after 1 cushion");
        let opening = Point { rule: Rule::ThreeCushion, red_first: true };
        let off_red = Tally { met: [true; 2], red_first: true, cushions_before_second: 3, ..Tally::default() };
        assert_eq!(verdict(opening, &off_red, CueBall::White), "made, after 3 cushions");
        let wrong = verdict(opening, &Tally { red_first: false, ..off_red }, CueBall::White);
        assert_eq!(wrong, "missed: yellow was met first, a game opens with red");
        let one = Tally { met: [true, false], ..Tally::default() };
        assert_eq!(verdict(opening, &one, CueBall::Yellow), "missed: white was met, red was not");
    }

    #[test]
    fn changes_say_which_way_and_how_far_across_the_half_turn_too() {
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
        let told = changes(&table, &from, &to);
        assert_eq!(told, ["aim left 0.40°", "tip up 6.5 mm", "tip right 2.0 mm", "softer 0.3 m/s", "cue up 3°"]);
        assert_eq!(changes(&table, &to, &from)[0], "aim right 0.40°");
        assert_eq!(changes(&table, &from, &cue(0.2, 0.0, 0.5, 179.91, 2.05)), Vec::<String>::new());
        assert_eq!(changes(&table, &from, &cue(0.0, 0.0, 0.0, 90.0, 2.0)), ["another shot: aimed elsewhere"]);
    }
}
