//! Selects the system that describes a shot, and computes its correction for the player's table.

use glam::DVec2;
use serde::Serialize;

use super::{
    leg::Leg,
    lines::{Line, Mirror, metres, start_at},
    shift::ParallelShift,
    system::{Numbers, System},
};
use crate::{
    simulation::Recording,
    table::{Rail, Table},
};

/// Minimum side at the first cushion that counts as running, `R w / v`; a system without side requires less.
const MIN_RUNNING_SIDE: f64 = 0.15;
/// Maximum distance on the first cushion between the system's aim and the aim of a shot that it still describes,
/// diamonds. Tables differ by half a diamond from each other.
const MAX_AIM_DISTANCE: f64 = 1.0;
/// Position of the ball along the line of the example, as a share.
const EXAMPLE_POSITION: f64 = 0.25;
/// Number of intervals in which the first cushion is scanned.
const SCAN_INTERVALS: usize = 48;
/// Maximum change of the error between two neighbouring lines of the scan: of the arrival, diamonds, and of the third number.
const MAX_ERROR_STEPS: [f64; 2] = [0.7, 10.0];
/// Bisection steps between two lines: to a thousandth of a diamond or better.
const HALVINGS: u32 = 12;

/// What a player calculates for a shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Guide {
    /// The numbers of a system.
    System(Applied),
    /// A parallel shift of a neighbouring line, if no system applies.
    Shift(ParallelShift),
}

/// A system applied to one shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Applied {
    /// The system.
    #[serde(rename = "name")]
    pub system: System,
    /// The cushions that the ball hits, in order.
    pub rails: [Rail; 3],
    /// The numbers of the system's line from the start of the shot to where the shot arrives on the third cushion.
    #[serde(flatten)]
    pub numbers: Numbers,
    /// The first number that leads to this arrival on this table with the system's stroke; `None` if no number does.
    pub table_first: Option<f64>,
    /// The third number at which the ball arrives on this table if it is aimed by the system; `None` if it is outside
    /// the scale.
    pub table_third: Option<f64>,
    /// The first number at which the shot itself is aimed, with its own side and speed.
    pub shot_first: Option<f64>,
    /// How the table is mirrored relative to the system's standard orientation.
    #[serde(skip)]
    pub mirror: Mirror,
    /// The system's line, in its standard orientation.
    #[serde(skip)]
    pub line: Line,
    /// The arrival of the shot, in diamonds along the third cushion.
    #[serde(skip)]
    pub arrival: f64,
}

/// Maximum difference between a table's length and twice its width, in widths: on other tables the diamonds of long and
/// short rails have different spacings.
const ASPECT: f64 = 0.05;

/// Returns what a player calculates for a recorded shot. `None` if it has no three cushions in a row, no system is
/// near, or the table is not twice as long as wide.
pub fn guide(table: &Table, recording: &Recording) -> Option<Guide> {
    if (table.length / table.width - 2.0).abs() > ASPECT {
        return None;
    }
    let leg = Leg::of(table, recording)?;
    let system = System::ALL.into_iter().find_map(|system| Applied::of(system, table, &leg)).map(Guide::System);
    system.or_else(|| ParallelShift::of(table, &leg).map(Guide::Shift))
}

impl Guide {
    /// Returns the path on this table of a ball that is played by the guide, to the third cushion: the centres of the ball at
    /// the cushions, m.
    pub fn path(&self, table: &Table) -> Vec<DVec2> {
        match self {
            Self::System(applied) => applied.path(table),
            Self::Shift(shift) => shift.path.iter().map(|place| metres(table, *place)).collect(),
        }
    }
}

impl Applied {
    /// Applies `system` to the three cushions of a shot; `None` if it does not describe them.
    fn of(system: System, table: &Table, leg: &Leg) -> Option<Self> {
        let rails = leg.rails();
        let mirror = Mirror::ALL.into_iter().find(|mirror| rails.map(|rail| mirror.rail(rail)) == system.rails())?;
        if (leg.english > MIN_RUNNING_SIDE) != system.is_running() || leg.english < -MIN_RUNNING_SIDE {
            return None;
        }
        let place = |index: usize| mirror.apply(leg.hits[index].1);
        let arrival = system.arrival(table, place(1), place(2))?;
        let applied = Self::for_arrival(system, table, mirror, mirror.apply(leg.from), arrival)?;
        let shot = Line::between(applied.line.from, place(0));
        let (counted, played) = (system.first_along(&applied.line)?, system.first_along(&shot)?);
        let shot_first = system.numbers(&shot).map(|numbers| numbers.first);
        ((counted - played).abs() <= MAX_AIM_DISTANCE).then_some(Self { shot_first, ..applied })
    }

    /// Applies `system` to a ball centred at `from` that should arrive at `arrival` on the third cushion, both in
    /// diamonds in the standard orientation. `None` if the system has no line for it.
    fn for_arrival(system: System, table: &Table, mirror: Mirror, from: DVec2, arrival: f64) -> Option<Self> {
        let wanted = system.third_number(arrival)?;
        let aimed = |along: f64| Line::between(from, system.first_at(along));
        let [low, _] = system.first_ends();
        let third_off = |along: f64| Some(system.numbers(&aimed(along))?.third - wanted);
        let counted = solve(system, low, MAX_ERROR_STEPS[1], third_off)?;
        let line = aimed(counted);
        let played = |line: &Line| system.simulated_arrival(table, mirror, line, &system.natural_stroke());
        let on_table =
            solve(system, counted, MAX_ERROR_STEPS[0], |along| Some(played(&aimed(along))? - arrival)).map(aimed);
        Some(Self {
            system,
            rails: system.rails().map(|rail| mirror.rail(rail)),
            numbers: system.numbers(&line)?,
            table_first: on_table.and_then(|line| system.numbers(&line)).map(|numbers| numbers.first),
            table_third: played(&line).and_then(|along| system.third_number(along)),
            shot_first: None,
            mirror,
            line,
            arrival,
        })
    }

    /// Returns the system's textbook example, on this table.
    pub fn example(system: System, table: &Table) -> Option<Self> {
        let line = system.example();
        let from = line.from + EXAMPLE_POSITION * line.direction;
        Self::for_arrival(system, table, Mirror::default(), from, system.third_along(system.numbers(&line)?.third)?)
    }

    /// Returns the path of the system's natural stroke on the system's line, as this table plays it, from the diamond
    /// behind it to the third cushion: the centres of the ball at the cushions, m.
    pub fn path(&self, table: &Table) -> Vec<DVec2> {
        let Self { system, mirror, line, .. } = self;
        let turned = |place: DVec2| metres(table, mirror.apply(place));
        let hits = system.natural_stroke().run(table, &mirror.line(line), mirror.rail(system.rails()[0]));
        let behind = line.start_along().map(|along| turned(start_at(along)));
        let hits = hits.into_iter().take(3).map(|(_, place)| metres(table, place));
        behind.into_iter().chain([turned(line.from)]).chain(hits).collect()
    }
}

/// Finds the position on a system's first cushion at which `error` is zero; the one nearest to `near` if there are
/// several. A change by `jump` or more between two neighbouring lines means that the ball takes another cushion, and is
/// not a solution.
fn solve(system: System, near: f64, jump: f64, error: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let [low, high] = system.first_ends();
    let at = |step: usize| low + (high - low) * step as f64 / SCAN_INTERVALS as f64;
    let errors: Vec<Option<f64>> = (0..=SCAN_INTERVALS).map(|step| error(at(step))).collect();
    let exact = |step: usize| errors[step].filter(|error| error.abs() < ZERO_ERROR).map(|_| (at(step), None));
    let crossed = |step: usize| match (errors[step], errors.get(step + 1).copied().flatten()) {
        (Some(one), Some(other)) if one * other < 0.0 && (one - other).abs() < jump => {
            Some((at(step), Some(one < 0.0)))
        }
        _ => None,
    };
    let found = (0..=SCAN_INTERVALS).filter_map(|step| exact(step).or_else(|| crossed(step)));
    let (mut low, below) = found.min_by(|one, other| (one.0 - near).abs().total_cmp(&(other.0 - near).abs()))?;
    let Some(below) = below else { return Some(low) };
    let mut high = low + at(1) - at(0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (error(middle)? < 0.0) == below { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

/// An error below this is zero up to rounding.
const ZERO_ERROR: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{physics::CueInputs, table::Layout};

    fn guided(layout: &str, cue: &str) -> Option<Guide> {
        let table = Table::default();
        let layout = Layout::parse(layout, &table).unwrap();
        guide(&table, &Recording::new(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap())
    }

    #[test]
    fn textbook_examples_match_and_are_corrected_for_the_table() {
        let table = Table::default();
        for (system, numbers) in
            [(System::Corner5, [50.0, 20.0, 30.0]), (System::Plus, [4.0, 3.0, 7.0]), (System::Seven, [4.0, 24.0, 6.0])]
        {
            let applied = Applied::example(system, &table).unwrap();
            let Numbers { start, first, third } = applied.numbers;
            assert!(
                [start, first, third].iter().zip(numbers).all(|(one, other)| (one - other).abs() < 0.1),
                "{applied:?}"
            );
            // With the table's own number, the natural stroke must arrive there.
            let on_table = Line::between(applied.line.from, system.first_at(first_along(system, &applied)));
            let arrival =
                system.simulated_arrival(&table, applied.mirror, &on_table, &system.natural_stroke()).unwrap();
            assert!((arrival - applied.arrival).abs() < 0.02, "{system}: {arrival} for {}", applied.arrival);
            assert_eq!(applied.path(&table).len(), 5, "{system}");
        }
    }

    /// The position on the first cushion of the table's first number.
    fn first_along(system: System, applied: &Applied) -> f64 {
        let aimed = |along: f64| Line::between(applied.line.from, system.first_at(along));
        let first = applied.table_first.unwrap();
        let near = system.first_along(&applied.line).unwrap();
        solve(system, near, 10.0, |along| Some(system.numbers(&aimed(along))?.first - first)).unwrap()
    }

    #[test]
    fn running_bank_uses_corner_5_in_every_orientation() {
        // From the lower right corner to the upper long cushion, and its three mirror images.
        let mut told = Vec::new();
        for (layout, cue) in [
            ("6d,1d 7d,3.5d 0.5d,0.5d", "0.4,0.3,0,133,4"),
            ("2d,1d 1d,3.5d 7.5d,0.5d", "-0.4,0.3,0,47,4"),
            ("6d,3d 7d,0.5d 0.5d,3.5d", "-0.4,0.3,0,227,4"),
            ("2d,3d 1d,0.5d 7.5d,3.5d", "0.4,0.3,0,313,4"),
        ] {
            let Some(Guide::System(applied)) = guided(layout, cue) else {
                panic!("{layout} {:?}", guided(layout, cue))
            };
            assert_eq!(applied.system, System::Corner5);
            told.push(applied.to_string());
        }
        assert!(told[0].starts_with("Corner-5: ") && told.iter().all(|words| *words == told[0]), "{told:?}");
    }

    /// Each number is rounded as it is displayed, and the sum is computed from the displayed numbers.
    #[test]
    fn aim_number_equals_the_displayed_sum() {
        let example = Applied::example(System::Corner5, &Table::preset("textbook").unwrap()).unwrap();
        let numbers = Numbers { start: 65.6, first: 30.3, third: 35.3 };
        let applied = Applied { numbers, table_first: None, table_third: None, ..example };
        assert_eq!(applied.to_string(), "Corner-5: 66 - 35 = 31, aim at 31 on the wood");
        let on_table = |third| Applied { table_third: Some(third), ..applied.clone() }.correction();
        assert_eq!(on_table(35.4), "the same on this table");
        assert_eq!(on_table(41.0), "on this table it comes to 41 instead of 35");
        let unusual = Applied { numbers: Numbers { start: 84.0, first: 66.0, third: 18.0 }, ..applied.clone() };
        assert!(unusual.to_string().ends_with("aim at 66 on the wood; outside the usual range of the system"));
    }

    #[test]
    fn differing_shot_number_is_displayed() {
        let example = Applied::example(System::Corner5, &Table::default()).unwrap();
        let numbers = Numbers { start: 50.0, first: 20.0, third: 30.0 };
        let said = |table_first, shot_first| {
            Guide::System(Applied { numbers, table_first, table_third: None, shot_first, ..example.clone() })
                .shot_words()
        };
        let aim = "Corner-5: 50 - 30 = 20, aim at 20 on the wood";
        assert_eq!(said(Some(19.0), Some(17.2)), format!("{aim}; on this table 19, this shot at 17"));
        assert_eq!(said(Some(20.1), Some(17.2)), format!("{aim}; the same on this table, this shot at 17"));
        assert_eq!(said(None, Some(17.2)), format!("{aim}, this shot at 17"));
        assert_eq!(said(Some(19.0), Some(19.2)), format!("{aim}; on this table 19"));
        assert_eq!(said(Some(19.0), None), format!("{aim}; on this table 19"));
    }

    #[test]
    fn no_system_without_running_side_or_three_cushions() {
        assert_eq!(guided("6d,1d 7d,3.5d 0.5d,0.5d", "0,0,0,133,0.6"), None);
        let reverse = guided("6d,1d 7d,3.5d 0.5d,0.5d", "-0.4,0.3,0,133,4");
        assert!(!matches!(reverse, Some(Guide::System(_))), "{reverse:?}");
    }

    #[test]
    fn line_outside_all_systems_uses_the_parallel_shift() {
        // Three times across the table: long cushion, opposite long cushion, first long cushion.
        let Some(Guide::Shift(shift)) = guided("2.3d,1d 7d,3.5d 0.5d,0.5d", "0,0.2,0,75,4") else { panic!() };
        assert_eq!(shift.rails, [crate::simulation::Rail::Top; 2]);
        assert!((shift.third - shift.table_third).abs() < 0.1 && shift.by.abs() <= 0.5, "{shift:?}");
        assert!(shift.to_string().starts_with("Parallel shift: aimed at diamond 3 of the top rail, "), "{shift}");
    }
}
