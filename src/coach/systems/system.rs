//! The systems: their numbers at the diamonds, their cushions, and the stroke that they assume.
//!
//! Each system is defined in its standard orientation, in which the line of aim leads up and to the left.
//! [`super::Mirror`] provides the other three orientations.

use std::fmt;

use glam::DVec2;
use serde::{Serialize, Serializer};

use super::{
    lines::{DIAMOND_SETBACK, Line, Mirror, edge, start_at},
    natural::NaturalStroke,
    plus,
    scale::Scale,
};
use crate::{simulation::Rail, table::Table};

/// A diamond system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum System {
    /// Long, short, long with running side: first = start − third.
    Corner5,
    /// Short, long, long with running side: third = start + first.
    Plus,
    /// Short, long, short without side: first = start × third.
    Seven,
}

/// The numbers of a line in a system.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Numbers {
    /// The start of the line.
    pub start: f64,
    /// The end of the line on the first cushion.
    pub first: f64,
    /// The arrival on the third cushion.
    pub third: f64,
}

/// Numbers and their positions, in diamonds, in the standard orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct Labels {
    /// Starts of the line of aim, at the diamonds behind the noses.
    pub start: Vec<(f64, DVec2)>,
    /// Ends of the line of aim on the first cushion.
    pub first: Vec<(f64, DVec2)>,
    /// Arrivals on the third cushion.
    pub third: Vec<(f64, DVec2)>,
}

/// Start numbers of Corner-5, along the diamonds of the lower and the right cushion.
const CORNER_5_START: Scale = Scale(&[
    (0.0, 0.0),
    (13.0, 1.0),
    (20.0, 2.0),
    (25.0, 3.0),
    (30.0, 4.0),
    (35.0, 5.0),
    (40.0, 6.0),
    (45.0, 7.0),
    (50.0, 8.225),
    (60.0, 9.45),
    (70.0, 10.45),
    (80.0, 10.95),
    (90.0, 11.45),
]);
/// First cushion of Corner-5: ten per diamond, and twenty from 50 on.
const CORNER_5_FIRST: Scale = Scale(&[(0.0, 0.0), (50.0, 5.0), (90.0, 7.0)]);
/// Third cushion of Corner-5, at the nose.
const CORNER_5_THIRD: Scale = Scale(&[
    (0.0, 0.2),
    (10.0, 1.0),
    (20.0, 2.0),
    (30.0, 2.9),
    (40.0, 3.7),
    (50.0, 4.4),
    (60.0, 5.0),
    (70.0, 5.5),
    (80.0, 6.0),
    (90.0, 6.5),
]);
/// Start numbers of Plus: the diamond, and 8 in the corner.
const PLUS_START: Scale = Scale(&[(2.0, 2.0), (7.0, 7.0), (8.0, 8.225)]);
/// Start numbers of Seven: half a number per diamond, from the third diamond on.
const SEVEN_START: Scale = Scale(&[(2.5, 3.0), (4.5, 7.0), (5.0, 8.225), (6.0, 9.45)]);
/// First cushion of Seven: ten per diamond.
const SEVEN_FIRST: Scale = Scale(&[(0.0, 0.0), (40.0, 4.0)]);
/// Third cushion of Seven, measured from the top down: see [`System::third_number`].
const SEVEN_THIRD: Scale =
    Scale(&[(4.0, 0.0), (5.0, 0.67), (6.0, 1.33), (7.0, 2.0), (8.0, 2.67), (9.0, 3.33), (10.0, 4.0)]);

impl System {
    /// All systems.
    pub const ALL: [Self; 3] = [Self::Corner5, Self::Plus, Self::Seven];

    /// Returns the name that players use.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Corner5 => "Corner-5",
            Self::Plus => "Plus",
            Self::Seven => "Seven",
        }
    }

    /// Returns the name in files and in JSON.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Corner5 => "corner5",
            Self::Plus => "plus",
            Self::Seven => "seven",
        }
    }

    /// Returns the system's arithmetic in words.
    pub const fn rule(self) -> &'static str {
        match self {
            Self::Corner5 => "first = start - third",
            Self::Plus => "first = third - start",
            Self::Seven => "first = start x third",
        }
    }

    /// Returns the cushions, in order.
    pub const fn rails(self) -> [Rail; 3] {
        match self {
            Self::Corner5 => [Rail::Top, Rail::Left, Rail::Bottom],
            Self::Plus => [Rail::Left, Rail::Top, Rail::Bottom],
            Self::Seven => [Rail::Left, Rail::Top, Rail::Right],
        }
    }

    /// Returns the kinds of the cushions, in order, in words.
    pub const fn track(self) -> &'static str {
        match self {
            Self::Corner5 => "long, short, long",
            Self::Plus => "short, long, long",
            Self::Seven => "short, long, short",
        }
    }

    /// Whether the system assumes running side; otherwise it assumes none.
    pub const fn is_running(self) -> bool {
        !matches!(self, Self::Seven)
    }

    /// Returns the stroke that the system assumes, one for all its lines. Fitted by `study::filmed` so that its arrivals are
    /// nearest to those on the `match` table.
    pub const fn natural_stroke(self) -> NaturalStroke {
        match self {
            Self::Corner5 => NaturalStroke { side: 0.99, roll: 1.27, speed: 3.0 },
            Self::Plus => NaturalStroke { side: 0.66, roll: 1.06, speed: 4.5 },
            Self::Seven => NaturalStroke { side: -0.13, roll: 1.48, speed: 2.7 },
        }
    }

    /// Returns the numbers of a line that leads up and to the left; `None` if its start, its end or its arrival is
    /// outside the scale.
    pub fn numbers(self, line: &Line) -> Option<Numbers> {
        let start = self.start_scale().number(line.start_along()?)?;
        let place = self.first_along(line)?;
        Some(match self {
            Self::Corner5 => {
                let first = CORNER_5_FIRST.number(place)?;
                let third = start - first;
                CORNER_5_THIRD.position(third)?;
                Numbers { start, first, third }
            }
            Self::Plus => {
                let third = plus::third(start, place)?;
                Numbers { start, first: third - start, third }
            }
            Self::Seven => {
                let first = SEVEN_FIRST.number(place)?;
                let third = first / start;
                SEVEN_THIRD.position(third)?;
                Numbers { start, first, third }
            }
        })
    }

    const fn start_scale(self) -> Scale {
        match self {
            Self::Corner5 => CORNER_5_START,
            Self::Plus => PLUS_START,
            Self::Seven => SEVEN_START,
        }
    }

    /// Returns where a line meets the diamonds of the first cushion, as the position along them.
    pub fn first_along(self, line: &Line) -> Option<f64> {
        line.at_rail(self.rails()[0])
    }

    /// Returns the position of a point at the first cushion's diamonds.
    pub const fn first_at(self, along: f64) -> DVec2 {
        edge(self.rails()[0], along)
    }

    /// Returns the range of positions on the first cushion that lines may lead to: low and high.
    pub fn first_ends(self) -> [f64; 2] {
        match self {
            Self::Corner5 => CORNER_5_FIRST.ends(),
            Self::Plus => plus::ENDS,
            Self::Seven => SEVEN_FIRST.ends(),
        }
    }

    /// Returns the arrival on the third cushion, in diamonds along it, of a ball whose centre moves from `before` to `place`.
    /// Measured at the nose, or at the diamonds towards which the ball would continue, depending on the system. `None`
    /// if the ball does not go there.
    pub fn arrival(self, table: &Table, before: DVec2, place: DVec2) -> Option<f64> {
        let leg = Line::between(before, place);
        let radius = 4.0 * table.radius / table.width;
        match self {
            Self::Corner5 => leg.at_y(radius).filter(|_| leg.direction.y < 0.0),
            Self::Plus => leg.at_rail(Rail::Bottom).filter(|_| leg.direction.y < 0.0),
            Self::Seven => leg.at_rail(Rail::Right).filter(|_| leg.direction.x > 0.0),
        }
    }

    /// Returns the number of an arrival, given in diamonds along the third cushion; `None` beyond the scale.
    pub fn third_number(self, along: f64) -> Option<f64> {
        match self {
            Self::Corner5 => CORNER_5_THIRD.number(along),
            Self::Plus => (0.0..=8.0 + DIAMOND_SETBACK).contains(&along).then_some(along),
            Self::Seven => SEVEN_THIRD.number(4.0 - along),
        }
    }

    /// Returns the arrival of a number, in diamonds along the third cushion.
    pub fn third_along(self, number: f64) -> Option<f64> {
        match self {
            Self::Corner5 => CORNER_5_THIRD.position(number),
            Self::Plus => (0.0..=8.0 + DIAMOND_SETBACK).contains(&number).then_some(number),
            Self::Seven => SEVEN_THIRD.position(number).map(|down| 4.0 - down),
        }
    }

    /// Simulates this `stroke` on `line` on the table mirrored by `mirror` and returns the arrival, in diamonds along
    /// the third cushion. `None` if the ball does not arrive there.
    pub fn simulated_arrival(self, table: &Table, mirror: Mirror, line: &Line, stroke: &NaturalStroke) -> Option<f64> {
        let [first, _, third] = self.rails();
        let hits = stroke.run(table, &mirror.line(line), mirror.rail(first));
        let hit = |index: usize| hits.get(index).map(|(rail, place)| (mirror.rail(*rail), mirror.apply(*place)));
        // Near a corner the third cushion may be hit before the second.
        let index = if hit(1)?.0 == third { 1 } else { 2 };
        self.arrival(table, hit(index - 1)?.1, hit(index)?.1)
    }

    /// Returns the system's textbook example.
    pub fn example(self) -> Line {
        match self {
            Self::Corner5 => Line::between(start_at(8.0 + DIAMOND_SETBACK), self.first_at(2.0)),
            Self::Plus => Line::between(start_at(4.0), self.first_at(3.0)),
            Self::Seven => Line::between(start_at(6.0), self.first_at(2.4)),
        }
    }

    /// Returns the numbers to display at the rails.
    pub fn labels(self) -> Labels {
        let [starts, firsts, thirds]: [&[f64]; 3] = match self {
            Self::Corner5 => [
                &[20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0],
                &[10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0],
                &[10.0, 20.0, 30.0, 40.0],
            ],
            Self::Plus => [&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], &[5.0, 4.0, 3.0, 2.0], &[4.0, 5.0, 6.0, 7.0, 8.0]],
            Self::Seven => [&[2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0], &[10.0, 20.0, 30.0], &[4.0, 5.0, 6.0, 7.0, 8.0, 9.0]],
        };
        let start = |number| self.start_scale().position(number).map(start_at);
        let first = |number| {
            let along = match self {
                Self::Corner5 => CORNER_5_FIRST.position(number),
                // For starts up to 5.
                Self::Plus => Some(4.5 - 0.5 * number),
                Self::Seven => SEVEN_FIRST.position(number),
            };
            along.map(|along| self.first_at(along))
        };
        let third = |number| {
            self.third_along(number).map(|along| match self {
                Self::Corner5 => DVec2::new(along, 0.0),
                Self::Plus | Self::Seven => edge(self.rails()[2], along),
            })
        };
        Labels { start: labels(starts, start), first: labels(firsts, first), third: labels(thirds, third) }
    }
}

/// Returns the numbers that have a position.
fn labels(numbers: &[f64], place: impl Fn(f64) -> Option<DVec2>) -> Vec<(f64, DVec2)> {
    numbers.iter().filter_map(|&number| Some((number, place(number)?))).collect()
}

impl fmt::Display for System {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl Serialize for System {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_outside_a_system_has_no_numbers() {
        let line = |from: [f64; 2], to: [f64; 2]| Line::between(DVec2::from(from), DVec2::from(to));
        let steep = line([0.5, 0.5], [0.45, 3.0]);
        assert_eq!(System::Seven.numbers(&steep), None);
        assert_eq!(System::Corner5.numbers(&line([1.0, 1.0], [2.0, 3.0])), None, "it leads to the right");
        assert_eq!(System::Plus.numbers(&line([8.225, 1.0], [-0.225, 3.5])), None);
    }

    #[test]
    fn mirrored_table_gives_the_same_arrival() {
        let table = Table::default();
        let line = Line::between(DVec2::new(5.0, 0.6), DVec2::new(2.0, 4.225));
        let played = |mirror| {
            System::Corner5.simulated_arrival(&table, mirror, &line, &System::Corner5.natural_stroke()).unwrap()
        };
        for mirror in Mirror::ALL {
            assert!((played(mirror) - played(Mirror::default())).abs() < 1e-6, "{mirror:?}");
        }
    }

    #[test]
    fn labels_are_at_the_positions_of_their_numbers() {
        for system in System::ALL {
            let labels = system.labels();
            let mut counted = 0;
            for (start, from) in &labels.start {
                for (first, to) in &labels.first {
                    if let Some(numbers) = system.numbers(&Line::between(*from, *to)) {
                        counted += 1;
                        assert!((numbers.start - start).abs() < 1e-9, "{system}");
                        // From start 6 on, Plus has other numbers on the first cushion.
                        assert!(
                            system == System::Plus && *start > 5.0 || (numbers.first - first).abs() < 1e-9,
                            "{system}"
                        );
                    }
                }
            }
            assert!(counted > 10, "{system}: {counted}");
            assert!(labels.third.len() >= 4);
        }
    }
}
