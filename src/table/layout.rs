//! Positions of the three balls, and the check that a layout is possible.

use glam::DVec2;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::{CueBall, Opening, Side, Table};
use crate::printing::parse_number;

/// Number of balls in carom billiards.
pub const BALLS: usize = 3;

/// Pairs of balls, in the order used everywhere.
pub const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Colours of the balls by index if white is the cue ball; [`super::CueBall`] has them for either player.
pub const BALL_NAMES: [&str; BALLS] = ["white", "yellow", "red"];

/// Largest accepted overlap of two balls, or of a ball and a cushion, in a layout, m. Rounding to the digits of a JSON file makes touching
/// balls overlap slightly; 1e-9 m is far below what can be seen or measured.
pub const TOUCHING_TOLERANCE: f64 = 1e-9;

/// Positions of the three balls' centres in metres, origin at the table's centre. Ball 0 is the cue ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Layout {
    /// Centres of the cue ball and the two object balls, m.
    pub balls: [DVec2; BALLS],
}

/// Why a layout cannot be played.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum LayoutError {
    /// A coordinate is NaN or infinite.
    #[error("{} is at ({x}, {y}); both coordinates must be finite numbers of metres", BALL_NAMES[*ball])]
    NotFinite {
        /// Index of the ball.
        ball: usize,
        /// Its x, m.
        x: f64,
        /// Its y, m.
        y: f64,
    },
    /// A ball is not on the table.
    #[error(
        "{} at ({x:.4}, {y:.4}) m is outside the table; accepted are |x| <= {max_x:.4} and |y| <= {max_y:.4} \
         in metres from the middle, or diamonds like 2d,0.5d",
        BALL_NAMES[*ball]
    )]
    Outside {
        /// Index of the ball.
        ball: usize,
        /// Its x, m.
        x: f64,
        /// Its y, m.
        y: f64,
        /// Largest |x|, m.
        max_x: f64,
        /// Largest |y|, m.
        max_y: f64,
    },
    /// Two balls overlap.
    #[error(
        "{} and {} are {} m apart; at least {} m is needed",
        BALL_NAMES[*first],
        BALL_NAMES[*second],
        with_distinct_digits(*distance, *least)[0],
        with_distinct_digits(*distance, *least)[1]
    )]
    Overlap {
        /// Index of one ball.
        first: usize,
        /// Index of the other.
        second: usize,
        /// Distance of their centres, m.
        distance: f64,
        /// Two ball radii, m.
        least: f64,
    },
    /// The text is not three positions.
    #[error(
        "\"{0}\" is not a layout; write three positions like \"-0.71,0.1825 -0.71,0 0.71,0\" in metres, in another \
         unit after each number (mm, cm, in, ft), or in diamonds from the lower left corner like \"2d,2d 6d,2d 2d,2.5d\""
    )]
    Text(String),
}

impl LayoutError {
    /// Returns the same error with the ball colours for a player whose cue ball, ball 0, is `cue_ball`.
    #[must_use]
    pub fn for_player(mut self, cue_ball: CueBall) -> Self {
        let colours = cue_ball.to_ball_order([0, 1, 2]);
        match &mut self {
            Self::NotFinite { ball, .. } | Self::Outside { ball, .. } => *ball = colours[*ball],
            Self::Overlap { first, second, .. } => (*first, *second) = (colours[*first], colours[*second]),
            Self::Text(_) => {}
        }
        self
    }
}

/// Formats two lengths in metres with 4 decimals, or with as many decimals as needed to make the texts differ.
fn with_distinct_digits(one: f64, other: f64) -> [String; 2] {
    let formatted = |decimals: usize| [one, other].map(|length| format!("{length:.decimals$}"));
    (4..15).map(formatted).find(|[one, other]| one != other).unwrap_or_else(|| formatted(15))
}

impl Layout {
    /// Creates a layout from three centres in metres. It is not checked: see [`Layout::validate`].
    pub const fn new(balls: [DVec2; BALLS]) -> Self {
        Self { balls }
    }

    /// Returns the opening position. Red is on the far spot. One of the cue ball (ball 0) and the opponent's ball (ball 1) is on the near
    /// spot, the other at a distance `d` next to it, according to the table's [`Opening`]. If the player may choose the side, the cue ball
    /// is on the left.
    pub fn opening(table: &Table) -> Self {
        Self::opening_on(table, Side::Left)
    }

    /// Returns the opening position with the cue ball on `side`, which has no effect if the table's opening leaves no choice.
    pub fn opening_on(table: &Table, side: Side) -> Self {
        let spot = 0.25 * table.length;
        let (near, red) = (DVec2::new(-spot, 0.0), DVec2::new(spot, 0.0));
        // For a player who looks along the table, the upper long rail is on the left.
        let beside = |side| match side {
            Side::Left => near + DVec2::new(0.0, table.opening_offset),
            Side::Right => near - DVec2::new(0.0, table.opening_offset),
        };
        match table.opening {
            Opening::Thesis => Self::new([near, beside(Side::Left), red]),
            Opening::Umb => Self::new([beside(side), near, red]),
        }
    }

    /// Returns the side of the cue ball if this is the opening position within [`TOUCHING_TOLERANCE`]; `None` otherwise.
    pub fn opening_side(&self, table: &Table) -> Option<Side> {
        self.opening_within(table, TOUCHING_TOLERANCE)
    }

    /// Whether this is the opening position to within a quarter of a ball radius: people do not type positions to the millimetre, and write
    /// 2.5 diamonds for 2.51.
    pub fn is_opening(&self, table: &Table) -> bool {
        self.opening_within(table, 0.25 * table.radius).is_some()
    }

    fn opening_within(&self, table: &Table, tolerance: f64) -> Option<Side> {
        let is_there = |side: &Side| {
            let places = Self::opening_on(table, *side).balls;
            self.balls.iter().zip(places).all(|(ball, place)| ball.distance(place) <= tolerance)
        };
        [Side::Left, Side::Right].into_iter().find(is_there)
    }

    /// Returns the layout for the other player: the indices of the two cue balls are exchanged, and no ball moves.
    #[must_use]
    pub const fn for_the_opponent(&self) -> Self {
        let [cue_ball, other, red] = self.balls;
        Self::new([other, cue_ball, red])
    }

    /// Returns the layout after balls have left the table and are spotted by the UMB rules of three-cushion. The red ball goes on the far
    /// spot, ball 1 (the cue ball of the next player) on the near spot, and ball 0 on the middle of the table. If another ball blocks that
    /// spot, the ball goes on the blocking ball's own spot.
    #[must_use]
    pub fn with_spotted(&self, length: f64, radius: f64, off_table: [bool; BALLS]) -> Self {
        let spots = [0.0, -0.25 * length, 0.25 * length].map(|x| DVec2::new(x, 0.0));
        let (mut layout, mut waiting) = (*self, off_table);
        for ball in [2, 1, 0].into_iter().filter(|&ball| off_table[ball]) {
            let mask = |spot: usize| {
                (0..BALLS).find(|&other| !waiting[other] && layout.balls[other].distance(spots[spot]) < 2.0 * radius)
            };
            // Two balls cannot block all three spots: on every table that is accepted, these are at least four radii apart.
            let places = [ball, mask(ball).unwrap_or(ball), 0, 1, 2];
            let place = places.into_iter().find(|&spot| mask(spot).is_none()).unwrap_or(ball);
            layout.balls[ball] = spots[place];
            waiting[ball] = false;
        }
        layout
    }

    /// Draws a layout uniformly from all layouts that are possible on `table`.
    pub fn random(table: &Table, rng: &mut (impl Rng + ?Sized)) -> Self {
        let reach = table.reach();
        loop {
            let layout = Self::new(std::array::from_fn(|_| {
                DVec2::new(rng.random_range(-reach.x..=reach.x), rng.random_range(-reach.y..=reach.y))
            }));
            if layout.validate(table).is_ok() {
                return layout;
            }
        }
    }

    /// Checks that all balls lie on the table and that no balls overlap, each within [`TOUCHING_TOLERANCE`].
    ///
    /// # Errors
    /// The first problem found.
    pub fn validate(&self, table: &Table) -> Result<(), LayoutError> {
        for (ball, centre) in self.balls.iter().enumerate() {
            let (x, y) = (centre.x, centre.y);
            if !centre.is_finite() {
                return Err(LayoutError::NotFinite { ball, x, y });
            }
            let (max_x, max_y) = (table.half_length(), table.half_width());
            if x.abs() > max_x + TOUCHING_TOLERANCE || y.abs() > max_y + TOUCHING_TOLERANCE {
                return Err(LayoutError::Outside { ball, x, y, max_x, max_y });
            }
        }
        for (first, second) in PAIRS {
            let distance = self.balls[first].distance(self.balls[second]);
            let least = 2.0 * table.radius;
            if distance < least - TOUCHING_TOLERANCE {
                return Err(LayoutError::Overlap { first, second, distance, least });
            }
        }
        Ok(())
    }

    /// Parses `"x,y x,y x,y"` in metres from the middle, in another unit of length (`mm`, `cm`, `m`, `in`, `ft` after each number), or in
    /// diamonds (`d`). Diamonds count from the lower left corner of the playing area: 8 along the length and 4 along the width. A ball that
    /// would be nearer to a cushion than its radius touches the cushion instead.
    ///
    /// # Errors
    /// [`LayoutError::Text`]; the positions are not checked against the table.
    pub fn parse(text: &str, table: &Table) -> Result<Self, LayoutError> {
        let refuse = || LayoutError::Text(text.to_owned());
        let mut balls = [DVec2::ZERO; BALLS];
        let mut words = text.split_whitespace();
        for ball in &mut balls {
            let [x, y] = words.next().and_then(coordinates).ok_or_else(refuse)?[..] else { return Err(refuse()) };
            *ball = position_of(x, y, table).ok_or_else(refuse)?;
        }
        if words.next().is_some() { Err(refuse()) } else { Ok(Self::new(balls)) }
    }
}

/// A number of a typed position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Coordinate {
    /// A number without a unit.
    Bare(f64),
    /// Diamonds from the lower left corner.
    Diamonds(f64),
    /// Metres from the middle of the table.
    Metres(f64),
}

/// Units of lengths, and their sizes, m. A unit stands before those that end like it.
const LENGTH_UNITS: [(&str, f64); 5] = [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("in", 0.0254), ("ft", 0.3048)];

impl Coordinate {
    /// Parses a number with or without a unit.
    fn parse(text: &str) -> Option<Self> {
        if let Some(number) = text.strip_suffix('d') {
            return parse_number(number).map(Self::Diamonds);
        }
        match LENGTH_UNITS.iter().find_map(|(unit, size)| Some((text.strip_suffix(unit)?, size))) {
            Some((number, size)) => parse_number(number).map(|number| Self::Metres(number * size)),
            None => parse_number(text).map(Self::Bare),
        }
    }
}

/// Parses the comma-separated numbers of a word. A comma is a decimal comma only if the text has no other meaning: if there are units, a unit
/// ends each number; without them, four parts are two numbers with decimal commas.
pub(super) fn coordinates(word: &str) -> Option<Vec<Coordinate>> {
    let parts: Vec<&str> = word.trim_matches(',').split(',').collect();
    let has_unit = |part: &str| part.ends_with('d') || LENGTH_UNITS.iter().any(|(unit, _)| part.ends_with(unit));
    let numbers: Vec<String> = match parts.len() {
        _ if has_unit(parts.last()?) => {
            parts.split_inclusive(|part| has_unit(part)).map(|parts| parts.join(",")).collect()
        }
        _ if parts.iter().any(|part| has_unit(part)) => return None,
        1 | 2 => parts.into_iter().map(str::to_owned).collect(),
        4 => parts.chunks(2).map(|parts| parts.join(",")).collect(),
        _ => return None,
    };
    numbers.iter().map(|text| Coordinate::parse(text)).collect()
}

/// Returns the position of two coordinates, m from the middle; `None` if only one of them has a unit, or is in diamonds. Numbers without a
/// unit are metres.
pub(super) fn position_of(x: Coordinate, y: Coordinate, table: &Table) -> Option<DVec2> {
    let diamonds = match (x, y) {
        (Coordinate::Diamonds(x), Coordinate::Diamonds(y)) => DVec2::new(x, y),
        (Coordinate::Metres(x), Coordinate::Metres(y)) | (Coordinate::Bare(x), Coordinate::Bare(y)) => {
            return Some(DVec2::new(x, y));
        }
        _ => return None,
    };
    let (half, reach) = (0.5 * DVec2::new(table.length, table.width), table.reach());
    let at = diamonds * table.diamond() - half;
    // A ball nearer to the rail's diamonds than its radius, or on them, touches the cushion.
    let touching = |at: f64, half: f64, reach: f64| if at.abs() <= half { at.clamp(-reach, reach) } else { at };
    Some(DVec2::new(touching(at.x, half.x, reach.x), touching(at.y, half.y, reach.y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_opening_position_is_possible_on_every_preset() {
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            Layout::opening(&table).validate(&table).unwrap();
        }
    }

    #[test]
    fn umb_opening_has_the_opponents_ball_on_the_spot() {
        let thesis = Table { opening: Opening::Thesis, ..Table::default() };
        let umb = Table { opening: Opening::Umb, ..Table::default() };
        let (spot, d) = (0.25 * umb.length, umb.opening_offset);
        for (side, y) in [(Side::Left, d), (Side::Right, -d)] {
            let layout = Layout::opening_on(&umb, side);
            layout.validate(&umb).unwrap();
            assert_eq!(layout.balls, [DVec2::new(-spot, y), DVec2::new(-spot, 0.0), DVec2::new(spot, 0.0)]);
            assert_eq!((layout.opening_side(&umb), layout.opening_side(&thesis)), (Some(side), None));
        }
        let only = Layout::opening(&thesis);
        assert_eq!(only.balls[0], DVec2::new(-spot, 0.0));
        assert_eq!(Layout::opening_on(&thesis, Side::Right), only);
        assert_eq!(only.opening_side(&umb), None);
        // As players type it, to tenths of diamonds. A position that is only similar is not the opening.
        let typed = |words| Layout::parse(words, &umb).unwrap().is_opening(&umb);
        assert!(typed("2d,2.5d 2d,2d 6d,2d") && !typed("2d,2.4d 2d,2d 6d,2d"));
        let moved = |by: f64| {
            let mut layout = Layout::opening(&umb);
            layout.balls[2].x += by * umb.radius;
            (layout.is_opening(&umb), layout.opening_side(&umb).is_some())
        };
        assert_eq!([0.0, 0.24, 0.26].map(moved), [(true, true), (true, false), (false, false)]);
    }

    #[test]
    fn random_layouts_are_possible() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        for _ in 0..1000 {
            Layout::random(&table, &mut rng).validate(&table).unwrap();
        }
    }

    #[test]
    fn a_ball_on_a_rails_diamonds_touches_the_cushion() {
        let table = Table::default();
        let reach = table.reach();
        let layout = Layout::parse("0d,2d 6d,4d 7.95d,0.01d", &table).unwrap();
        layout.validate(&table).unwrap();
        assert_eq!((layout.balls[0].x, layout.balls[1].y), (-reach.x, reach.y));
        assert_eq!(layout.balls[2], DVec2::new(reach.x, -reach.y));
        assert!(Layout::parse("0d,2d 6d,4.1d 7d,1d", &table).unwrap().validate(&table).is_err());
    }

    #[test]
    fn metres_and_diamonds_give_the_same_position() {
        let table = Table::default();
        let metres = Layout::parse("-0.71,0 0.71,0 -0.71,0.355", &table).unwrap();
        let diamonds = Layout::parse("2d,2d 6d,2d 2d,3d", &table).unwrap();
        for (m, d) in metres.balls.iter().zip(diamonds.balls) {
            assert!(m.distance(d) < 1e-15);
        }
    }

    #[test]
    fn layout_errors_name_invalid_text_and_positions() {
        let table = Table::default();
        for text in ["", "0,0", "0,0 1,0 0;1", "0,0 1,0 0,0.5 0,0.6", "a,0 1,0 0,0.5", "2d,2 6d,2d 2d,3d"] {
            assert_eq!(Layout::parse(text, &table), Err(LayoutError::Text(text.to_owned())));
        }
        let check = |text: &str| Layout::parse(text, &table).unwrap().validate(&table).unwrap_err().to_string();
        assert!(check("NaN,0 1,0 0,0.5").contains("NaN"));
        assert!(check("9,0 1,0 0,0.5").contains("9.0000"));
        assert!(check("0,0 0.05,0 0,0.5").contains("0.0500"));
    }

    #[test]
    fn ball_off_the_table_takes_its_or_the_blockers_spot() {
        let (length, radius) = (2.84, 0.03075);
        let [middle, near, far] = [0.0, -0.71, 0.71].map(|x| DVec2::new(x, 0.0));
        let (away, outside) = (DVec2::new(1.0, 0.5), DVec2::new(1.6, 0.0));
        let spotted = |balls, off| Layout::new(balls).with_spotted(length, radius, off).balls;
        assert_eq!(spotted([away, outside, middle], [false, true, false]), [away, near, middle]);
        assert_eq!(spotted([away, near, outside], [false, false, true]), [away, near, far]);
        // The cue ball of the last player blocks the red ball's spot, so red goes on that ball's spot.
        let masks = far + DVec2::new(0.05, 0.0);
        assert_eq!(spotted([masks, away, outside], [false, false, true]), [masks, away, middle]);
        assert_eq!(spotted([outside, outside, far], [true, true, false]), [middle, near, far]);
        let all = spotted([outside; BALLS], [true; BALLS]);
        assert_eq!(all, [middle, near, far]);
    }
}
