//! Which system describes a shot, and what it says on the player's table.

use serde::Serialize;

use super::{
    leg::Leg,
    lines::{Line, Mirror},
    shift::Shift,
    system::{Numbers, System},
};
use crate::{simulation::Recording, table::Table};

/// Least side at the first cushion that is running side, `R w / v`; where a system supposes none it is less.
const RUNNING: f64 = 0.15;
/// How far from the system's aim on the first cushion a shot's may be that it still describes, diamonds. Tables differ by
/// half a diamond from each other.
const NEAR: f64 = 1.0;
/// Lines that are tried on the first cushion.
const TRIED: u32 = 48;
/// Halvings of the distance between two of them: to a thousandth of a diamond and further.
const HALVINGS: u32 = 12;

/// What a player counts for a shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Guide {
    /// A system's numbers.
    System(Applied),
    /// A line beside it, where no system has it.
    Shift(Shift),
}

/// A system for one shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Applied {
    /// The system.
    #[serde(rename = "name")]
    pub system: System,
    /// The numbers of the line that the system gives from where the ball comes from to where it is to arrive: where the shot
    /// arrives on the third cushion.
    #[serde(flatten)]
    pub numbers: Numbers,
    /// What the first number must be on this table for that arrival with the system's stroke; `None` where none brings it there.
    pub table_first: Option<f64>,
    /// Where the ball arrives on this table if it is aimed as the system says; `None` where it has no number there.
    pub table_third: Option<f64>,
    /// The first number at which the shot itself is aimed, with its own side and speed.
    pub shot_first: Option<f64>,
    /// How the table is turned over against the way in which the system is taught.
    #[serde(skip)]
    pub mirror: Mirror,
    /// The system's line, as it is taught.
    #[serde(skip)]
    pub line: Line,
    /// Where the shot arrives, in diamonds along the third cushion.
    #[serde(skip)]
    pub arrival: f64,
}

/// What a player counts for a recorded shot; `None` where it has no three cushions in a row, or no system is near.
pub fn guide(table: &Table, recording: &Recording) -> Option<Guide> {
    let leg = Leg::of(table, recording)?;
    let system = System::ALL.into_iter().find_map(|system| Applied::of(system, table, &leg)).map(Guide::System);
    system.or_else(|| Shift::of(table, &leg).map(Guide::Shift))
}

impl Applied {
    /// `system` for the three cushions of a shot; `None` where it does not describe them.
    fn of(system: System, table: &Table, leg: &Leg) -> Option<Self> {
        let rails = leg.rails();
        let mirror = Mirror::ALL.into_iter().find(|mirror| rails.map(|rail| mirror.rail(rail)) == system.rails())?;
        if (leg.english > RUNNING) != system.is_running() || leg.english < -RUNNING {
            return None;
        }
        let place = |index: usize| mirror.place(leg.hits[index].1);
        let arrival = system.arrival(table, place(1), place(2))?;
        let wanted = system.third_number(arrival)?;
        let from = mirror.place(leg.from);
        let aimed = |along: f64| Line::between(from, system.first_at(along));
        let line = solve(system, |along| Some(system.numbers(&aimed(along))?.third - wanted)).map(aimed)?;
        let shot = Line::between(from, place(0));
        let (system_along, shot_along) = (system.first_along(&line)?, system.first_along(&shot)?);
        if (system_along - shot_along).abs() > NEAR {
            return None;
        }
        let played = |line: &Line| system.played(table, mirror, line, &system.natural());
        let on_table = solve(system, |along| Some(played(&aimed(along))? - arrival)).map(aimed);
        Some(Self {
            system,
            numbers: system.numbers(&line)?,
            table_first: on_table.and_then(|line| system.numbers(&line)).map(|numbers| numbers.first),
            table_third: played(&line).and_then(|along| system.third_number(along)),
            shot_first: system.numbers(&shot).map(|numbers| numbers.first),
            mirror,
            line,
            arrival,
        })
    }
}

/// The place on a system's first cushion at which `error` is nought, of several the first from the corner on.
fn solve(system: System, error: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let [low, high] = system.first_ends();
    let at = |step: u32| low + (high - low) * f64::from(step) / f64::from(TRIED);
    let errors: Vec<Option<f64>> = (0..=TRIED).map(|step| error(at(step))).collect();
    let (step, below) = errors.windows(2).enumerate().find_map(|(step, pair)| match *pair {
        // Where the course changes the arrival jumps; that is no solution.
        [Some(one), Some(other)] if one * other <= 0.0 && (one - other).abs() < JUMP * scale(system) => {
            Some((step as u32, one <= 0.0))
        }
        _ => None,
    })?;
    let (mut low, mut high) = (at(step), at(step + 1));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (error(middle)? <= 0.0) == below {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// Two diamonds between two lines that are next to each other are a jump.
const JUMP: f64 = 2.0;

/// What a diamond is in a system's numbers, roughly and at most.
const fn scale(system: System) -> f64 {
    match system {
        System::Corner5 => 10.0,
        System::Plus | System::Seven => 1.5,
    }
}
