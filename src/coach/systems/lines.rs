//! The table in diamonds: lines of aim, and where they meet the diamonds.
//!
//! Positions are measured from the lower left corner of the noses, 8 along the length and 4 along the width.

use glam::DVec2;

use crate::{simulation::Rail, table::Table};

/// Distance of the diamonds behind the noses, in diamonds: 80 mm on a match table.
pub const DIAMOND_SETBACK: f64 = 0.225;

/// Diamonds along the length and along the width.
pub const SIZE: DVec2 = DVec2::new(8.0, 4.0);

/// Converts a position from metres, relative to the centre of `table`, to diamonds.
pub fn diamonds(table: &Table, place: DVec2) -> DVec2 {
    (place / DVec2::new(table.length, table.width) + 0.5) * SIZE
}

/// Converts a position from diamonds to metres, relative to the centre of `table`.
pub fn metres(table: &Table, place: DVec2) -> DVec2 {
    (place / SIZE - 0.5) * DVec2::new(table.length, table.width)
}

/// A mirror image of the table that brings a shot into its system's standard orientation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mirror {
    /// Whether left and right are swapped.
    pub x: bool,
    /// Whether top and bottom are swapped.
    pub y: bool,
}

impl Mirror {
    /// All four combinations.
    pub const ALL: [Self; 4] = [
        Self { x: false, y: false },
        Self { x: true, y: false },
        Self { x: false, y: true },
        Self { x: true, y: true },
    ];

    /// Mirrors a position in diamonds. This is its own inverse.
    pub fn apply(self, place: DVec2) -> DVec2 {
        DVec2::select(glam::BVec2::new(self.x, self.y), SIZE - place, place)
    }

    /// Mirrors a line.
    pub fn line(self, line: &Line) -> Line {
        Line::between(self.apply(line.from), self.apply(line.from + line.direction))
    }

    /// Mirrors a cushion.
    pub const fn rail(self, rail: Rail) -> Rail {
        match rail {
            Rail::Left if self.x => Rail::Right,
            Rail::Right if self.x => Rail::Left,
            Rail::Top if self.y => Rail::Bottom,
            Rail::Bottom if self.y => Rail::Top,
            rail => rail,
        }
    }
}

/// A line along which the centre of a ball moves, in diamonds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// A point on it.
    pub from: DVec2,
    /// Its direction, of any length except zero.
    pub direction: DVec2,
}

impl Line {
    /// Creates the line from one position to another.
    pub fn between(from: DVec2, to: DVec2) -> Self {
        Self { from, direction: to - from }
    }

    /// Returns the `y` of the intersection with the vertical line at `x`; `None` if the lines are parallel.
    pub fn at_x(&self, x: f64) -> Option<f64> {
        let y = self.from.y + (x - self.from.x) / self.direction.x * self.direction.y;
        y.is_finite().then_some(y)
    }

    /// Returns the `x` of the intersection with the horizontal line at `y`; `None` if the lines are parallel.
    pub fn at_y(&self, y: f64) -> Option<f64> {
        let x = self.from.x + (y - self.from.y) / self.direction.y * self.direction.x;
        x.is_finite().then_some(x)
    }

    /// Returns the intersection with the line of a cushion's diamonds, as the position along the cushion.
    pub fn at_rail(&self, rail: Rail) -> Option<f64> {
        match rail {
            Rail::Top => self.at_y(4.0 + DIAMOND_SETBACK),
            Rail::Bottom => self.at_y(-DIAMOND_SETBACK),
            Rail::Left => self.at_x(-DIAMOND_SETBACK),
            Rail::Right => self.at_x(8.0 + DIAMOND_SETBACK),
        }
    }

    /// Returns the start of a line that leads up and to the left, measured along the diamonds of the lower cushion to
    /// the right and on up those of the right cushion; their corner is at 8.225.
    pub fn start_along(&self) -> Option<f64> {
        if self.direction.x >= 0.0 || self.direction.y <= 0.0 {
            return None;
        }
        let corner = 8.0 + DIAMOND_SETBACK;
        match self.at_y(-DIAMOND_SETBACK)? {
            x if x <= corner => Some(x),
            _ => Some(corner + self.at_x(corner)? + DIAMOND_SETBACK),
        }
    }
}

/// Returns the position at the diamonds of a cushion, `along` diamonds along it.
pub const fn edge(rail: Rail, along: f64) -> DVec2 {
    match rail {
        Rail::Top => DVec2::new(along, 4.0 + DIAMOND_SETBACK),
        Rail::Bottom => DVec2::new(along, -DIAMOND_SETBACK),
        Rail::Left => DVec2::new(-DIAMOND_SETBACK, along),
        Rail::Right => DVec2::new(8.0 + DIAMOND_SETBACK, along),
    }
}

/// Returns the position at the diamonds for a value of [`Line::start_along`].
pub fn start_at(along: f64) -> DVec2 {
    let corner = 8.0 + DIAMOND_SETBACK;
    if along <= corner {
        DVec2::new(along, -DIAMOND_SETBACK)
    } else {
        DVec2::new(corner, along - corner - DIAMOND_SETBACK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn start_along_and_start_at_are_inverse() {
        for along in [0.5, 4.0, 8.0, 8.225, 8.5, 10.4] {
            let line = Line::between(start_at(along), DVec2::new(0.3, 4.1));
            assert!((line.start_along().unwrap() - along).abs() < 1e-12, "{along}");
        }
        assert_eq!(Line::between(DVec2::ZERO, DVec2::ONE).start_along(), None);
    }

    #[test]
    fn line_to_a_diamond_intersects_the_rail_there() {
        for rail in Rail::ALL {
            let line = Line::between(DVec2::new(3.1, 1.7), edge(rail, 2.5));
            assert!((line.at_rail(rail).unwrap() - 2.5).abs() < 1e-12, "{rail:?}");
        }
    }

    #[test]
    fn mirroring_twice_restores_the_position() {
        let table = Table::default();
        let place = DVec2::new(1.5, 3.25);
        for mirror in Mirror::ALL {
            assert_eq!(mirror.apply(mirror.apply(place)), place);
            for rail in Rail::ALL {
                assert_eq!(mirror.rail(mirror.rail(rail)), rail);
            }
        }
        assert!(diamonds(&table, metres(&table, place)).distance(place) < 1e-12);
    }
}
