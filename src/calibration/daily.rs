//! Changes from day to day: the constants that depend on the weather, and whether the table plays shorter or longer than before.

use super::{
    entries::Entries,
    forward::{STROKE_PARAMETERS, StrokeSpread},
    protocol::Test,
};
use crate::table::{Rail, Table, TableDoubt};

/// Standard deviations of the constants' changes from one day to the next, due to the humidity of cloth and rails. They are
/// assumptions. A rail's own values change by the same amount as, and together with, those of all rails.
const DAILY_CHANGES: [(&str, f64); 5] =
    [("mu_r", 0.0005), ("mu_s", 0.01), ("e_rail", 0.01), ("mu_rail", 0.03), ("rail.kappa", 0.05)];

/// Largest correlation of two constants that change together and are otherwise certain. With 1 they would be one constant, and no
/// distribution has such a covariance.
const MAX_CORRELATION: f64 = 0.99;

/// The tests of a daily check.
pub const DAILY_TESTS: [&str; 2] = ["lag", "corner-five"];

/// Returns the tests of a daily check that are not played yet, with one stroke each.
pub fn missing_daily_tests(entries: &Entries) -> Vec<(&'static Test, usize)> {
    let is_open = |name: &&str| entries.trials.iter().all(|entry| entry.test != **name);
    DAILY_TESTS.iter().filter(|name| is_open(name)).filter_map(|name| Some((Test::named(name)?, 1))).collect()
}

/// Returns the groups of constants that change together, with the deviation of the change: each constant of [`DAILY_CHANGES`] that the
/// table has, with those of its single rails.
fn daily_change_groups(table: &Table) -> [(f64, Vec<String>); DAILY_CHANGES.len()] {
    DAILY_CHANGES.map(|(name, change)| {
        let own: &[&str] = match name {
            "e_rail" => &["e"],
            "mu_rail" => &["mu"],
            _ => &[],
        };
        let own = own.iter().flat_map(|kind| Rail::ALL.map(|rail| format!("rail.{}.{kind}", rail.name())));
        let names = std::iter::once(name.to_owned()).chain(own);
        (change, names.filter(|name| TableDoubt::value(table, name).is_some()).collect())
    })
}

/// Returns the doubt about a table on the next day: the known doubt plus the possible changes since.
pub fn next_day_doubt(table: &Table, doubt: &TableDoubt) -> TableDoubt {
    let (mut after, groups) = (doubt.clone(), daily_change_groups(table));
    for (change, names) in &groups {
        for name in names {
            let deviation = after.deviations.entry(name.clone()).or_default();
            *deviation = deviation.hypot(*change);
        }
    }
    let deviations = &after.deviations;
    let share = |name: &String| doubt.deviations.get(name).map_or(0.0, |before| before / deviations[name]);
    after.correlations.iter_mut().for_each(|(one, other, value)| *value *= share(one) * share(other));
    for (change, names) in &groups {
        for (index, one) in names.iter().enumerate() {
            for other in &names[index + 1..] {
                let common = (change * change / (deviations[one] * deviations[other])).min(MAX_CORRELATION);
                let is_this_pair =
                    |(a, b, _): &&mut (String, String, f64)| (a, b) == (one, other) || (b, a) == (one, other);
                match after.correlations.iter_mut().find(is_this_pair) {
                    Some((_, _, value)) => *value += common,
                    None => after.correlations.push((one.clone(), other.clone(), common)),
                }
            }
        }
    }
    after
}

/// How a table plays: the results of the two daily tests with exactly the requested strokes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct TablePlay {
    /// Distance that a lag rolls, from the stroke to the stop, diamonds.
    pub lag: f64,
    /// Arrival of Corner-5 from 50 to 20 on the third rail, diamonds from the player's end.
    pub third_rail: f64,
}

impl TablePlay {
    /// Simulates the tests on `table`.
    pub fn of(table: &Table) -> Self {
        let mark = |test: &str, mark: &str| {
            let test = Test::named(test)?;
            let index = test.marks.iter().position(|one| one.name == mark)?;
            StrokeSpread::ASSUMED.simulate_marks(table, test, false, &[0.0; STROKE_PARAMETERS])[index]
        };
        let [lag, corner] = DAILY_TESTS;
        // 0 on a table on which the ball never gets there.
        let or_none = |mark: Option<f64>| mark.unwrap_or_default();
        // The mark counts from the player's end, and the ball does not begin there.
        let start = Test::named(lag).map_or(0.0, |test| test.balls[0][0]);
        Self { lag: or_none(mark(lag, "stop").map(|stop| stop - start)), third_rail: or_none(mark(corner, "third")) }
    }

    /// Describes the difference from an earlier day in words.
    pub fn describe_change_from(&self, before: &Self) -> String {
        let share = if before.lag > 0.0 { self.lag / before.lag - 1.0 } else { 0.0 };
        // Adding zero removes the sign of a negative zero.
        let further = (100.0 * share).round() + 0.0;
        let longer = before.third_rail - self.third_rail;
        let compare = |value: f64, least: f64, [less, more]: [&'static str; 2]| {
            if value.abs() < least {
                "as before"
            } else if value > 0.0 {
                more
            } else {
                less
            }
        };
        format!(
            "a lag rolls {} ({further:+.0} %), and three rails play {} (Corner-5 arrives at {:.1} on the third rail, before at {:.1})",
            compare(further, 1.0, ["shorter", "farther"]),
            compare(longer, 0.05, ["shorter", "longer"]),
            self.third_rail,
            before.third_rail,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        calibration::{forward::Observed, protocol::Quantity},
        physics::strike,
        simulation::watch,
    };

    #[test]
    fn lag_is_measured_from_where_the_ball_starts() {
        // With twenty times the friction the ball stops before the far rail.
        let table = Table::default();
        let slow = TableDoubt::with_value(&table, "mu_r", 20.0 * TableDoubt::value(&table, "mu_r").unwrap());
        let lag = Test::named("lag").unwrap();
        let (cue, layout) = StrokeSpread::ASSUMED.stroke(&slow, lag, &[0.0; STROKE_PARAMETERS]);
        let mut observed = Observed::new(&layout);
        watch(&slow, &layout, &strike(&slow, &cue), &mut observed);
        let way = observed.position(Quantity::StopAlong(0)).unwrap().x - layout.balls[0].x;
        let rolled = TablePlay::of(&slow).lag;
        assert!((rolled - way / table.diamond()).abs() < 1e-9 && rolled < 6.0, "{rolled}, {way} m");
    }

    #[test]
    fn change_of_the_lag_is_a_share_of_its_distance() {
        let play = |lag| TablePlay { lag, third_rail: 2.0 };
        let said = |now, before| play(now).describe_change_from(&play(before));
        assert!(said(11.0, 10.0).starts_with("a lag rolls farther (+10 %)"), "{}", said(11.0, 10.0));
        assert!(said(9.0, 10.0).starts_with("a lag rolls shorter (-10 %)"), "{}", said(9.0, 10.0));
        assert!(said(9.0, 0.0).starts_with("a lag rolls as before (+0 %)"), "{}", said(9.0, 0.0));
    }
}
