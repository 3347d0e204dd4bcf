//! Observations of a layout: the object ball to hit first, the side to pass it and the path to it, mirrored to a common orientation.

use glam::DVec2;
use rand::{Rng, RngExt};

use crate::table::{Layout, Rail, Table};

/// An observation of a layout: the object ball to hit first, the side on which the cue ball passes it, and the cushion by which it comes
/// there, if any.
///
/// A mirrored shot with mirrored english is equivalent. So the layout is mirrored such that the cue ball always passes on the *left* of the
/// first ball and lies in the right half of the table (x >= 0): an agent then learns one kind of shot instead of eight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Centre of the cue ball in the mirrored frame, m.
    pub cue: DVec2,
    /// Centre of the object ball to hit first, m.
    pub first: DVec2,
    /// Centre of the other object ball, m.
    pub second: DVec2,
    /// The cushion to hit before the first ball, in the mirrored frame; `None` if the path to the ball is straight.
    pub rail: Option<Rail>,
    /// Mirrored axes: -1 for a mirrored one, else 1.
    pub(super) mirror: DVec2,
}

/// Number of observations of a layout with a straight path to the first ball: either object ball first, passed on either side.
pub const OBSERVATIONS: usize = 4;

/// Number of cushions that each of them is combined with: those of the shortest paths. Four of five of the strokes by a cushion that a
/// search finds best use one of these.
const RAILS: usize = 2;

impl Observation {
    /// Returns the observation `index` (below [`OBSERVATIONS`]) of a layout, with a straight path.
    pub fn new(layout: &Layout, index: usize) -> Self {
        let [cue, one, two] = layout.balls;
        let (first, second) = if index & 1 == 0 { (one, two) } else { (two, one) };
        let x = if cue.x < 0.0 { -1.0 } else { 1.0 };
        // Mirroring one axis swaps the sides; mirroring both axes, a half turn, does not.
        let mirror = if index & 2 == 0 { DVec2::new(x, x) } else { DVec2::new(x, -x) };
        Self { cue: mirror * cue, first: mirror * first, second: mirror * second, rail: None, mirror }
    }

    /// Returns all observations of a layout with a straight path to the first ball.
    pub fn all_straight(layout: &Layout) -> [Self; OBSERVATIONS] {
        std::array::from_fn(|index| Self::new(layout, index))
    }

    /// Returns all observations of a layout, including those by a cushion if `rails_first`.
    pub fn all(table: &Table, layout: &Layout, rails_first: bool) -> Vec<Self> {
        let straight = Self::all_straight(layout);
        let by_rail = straight.iter().filter(|_| rails_first).flat_map(|view| view.by_nearest_rails(table));
        straight.into_iter().chain(by_rail).collect()
    }

    /// Draws one of the observations; with `rails_first` half of them are by a cushion.
    pub fn random(table: &Table, layout: &Layout, rails_first: bool, rng: &mut (impl Rng + ?Sized)) -> Self {
        let straight = Self::new(layout, rng.random_range(0..OBSERVATIONS));
        let by_rail = rails_first && rng.random_bool(0.5);
        if by_rail { straight.by_nearest_rails(table)[rng.random_range(0..RAILS)] } else { straight }
    }

    /// Returns the same ball and side with the cushions of the shortest paths.
    fn by_nearest_rails(&self, table: &Table) -> [Self; RAILS] {
        let mut paths = Rail::ALL.map(|rail| Self { rail: Some(rail), ..*self });
        let length = |path: &Self| path.start(table).distance_squared(self.first);
        paths.sort_by(|a, b| length(a).total_cmp(&length(b)));
        std::array::from_fn(|index| paths[index])
    }

    /// Returns the start of the straight line on which the cue ball arrives at the first ball: the cue ball, or its image in the cushion.
    pub fn start(&self, table: &Table) -> DVec2 {
        self.rail.map_or(self.cue, |rail| rail.image(table.reach(), self.cue))
    }

    /// Converts a direction in this observation to an angle on the table, rad.
    pub fn angle_on_table(&self, direction: DVec2) -> f64 {
        (self.mirror * direction).to_angle()
    }

    /// Converts a tip position to the left of the centre from this observation to the table: mirroring one axis swaps left and right.
    pub fn side_on_table(&self, left: f64) -> f64 {
        self.mirror.x * self.mirror.y * left
    }

    /// Returns the lines from ball to ball; those of the cue ball begin at [`Observation::start`].
    pub fn lines(&self, table: &Table) -> Lines {
        let start = self.start(table);
        Lines {
            to_first: Line::between(start, self.first, table),
            to_second: Line::between(start, self.second, table),
            onward: Line::between(self.first, self.second, table),
        }
    }

    /// Returns the images of the second ball in the four cushions: the aiming points for a ball that rebounds from the cushion like light
    /// from a mirror.
    pub fn images(&self, table: &Table) -> [DVec2; 4] {
        [Rail::Right, Rail::Left, Rail::Top, Rail::Bottom].map(|rail| rail.image(table.reach(), self.second))
    }
}

/// The lines from [`Observation::start`] to both object balls, and from the first object ball to the second.
#[derive(Clone, Copy, Debug)]
pub struct Lines {
    pub to_first: Line,
    pub to_second: Line,
    pub onward: Line,
}

#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Length, m; at least one ball diameter.
    pub distance: f64,
    /// Unit vector.
    pub direction: DVec2,
}

impl Line {
    fn between(from: DVec2, to: DVec2, table: &Table) -> Self {
        let span = to - from;
        let distance = span.length().max(2.0 * table.radius);
        Self { distance, direction: span / distance }
    }
}

/// Returns the distance that a ball at `from` travels along the unit vector `direction` to the cushion, m.
pub fn free_path(table: &Table, from: DVec2, direction: DVec2) -> f64 {
    let along = |position: f64, slope: f64, reach: f64| {
        if slope == 0.0 { f64::INFINITY } else { ((reach.copysign(slope) - position) / slope).max(0.0) }
    };
    let reach = table.reach();
    along(from.x, direction.x, reach.x).min(along(from.y, direction.y, reach.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn observations_are_mirrored_and_keep_distances() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            for observation in Observation::all_straight(&layout) {
                assert!(observation.cue.x >= 0.0);
                assert!(
                    (observation.first.distance(observation.second) - layout.balls[1].distance(layout.balls[2])).abs()
                        < 1e-12
                );
            }
        }
    }

    #[test]
    fn mirrored_layouts_have_the_same_observations() {
        let table = Table::default();
        let layout = Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(4));
        for mirror in [DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0), DVec2::new(-1.0, -1.0)] {
            let mirrored = Layout::new(layout.balls.map(|ball| mirror * ball));
            for observation in Observation::all_straight(&layout) {
                let same = |other: &Observation| {
                    (other.cue, other.first, other.second) == (observation.cue, observation.first, observation.second)
                };
                assert!(Observation::all_straight(&mirrored).iter().any(same));
            }
        }
    }

    #[test]
    fn the_free_path_ends_at_the_nearest_cushion() {
        let table = Table::default();
        assert_eq!(free_path(&table, DVec2::ZERO, DVec2::X), table.half_length());
        assert_eq!(free_path(&table, DVec2::ZERO, DVec2::NEG_Y), table.half_width());
        assert_eq!(free_path(&table, table.reach(), DVec2::X), 0.0);
    }
}
