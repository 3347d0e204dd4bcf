//! The layout as an agent sees it: which object ball to meet first, on which side and by which way, mirrored so that all look alike.

use glam::DVec2;
use rand::{Rng, RngExt};

use crate::table::{Layout, Rail, Table};

/// One way to look at a layout: a first object ball, the side of it on which the cue ball shall pass, and the cushion by which it shall
/// come there, if any.
///
/// A shot plays the same in a mirror that swaps the sides of its english, too. So the layout is mirrored until the cue ball always passes on
/// the *left* of the first ball and lies in the right half of the table (x >= 0): an agent then learns one kind of
/// shot instead of eight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Centre of the cue ball in the mirrored frame, m.
    pub cue: DVec2,
    /// Centre of the object ball that is met first, m.
    pub first: DVec2,
    /// Centre of the other object ball, m.
    pub second: DVec2,
    /// The cushion that is met before the first ball, in the mirrored frame; none where the way to the ball is straight.
    pub rail: Option<Rail>,
    /// Which axes were mirrored: -1 or 1 each.
    pub(super) mirror: DVec2,
}

/// Number of observations of a layout with a straight way to the first ball: either object ball first, passed on either side.
pub const OBSERVATIONS: usize = 4;

/// Cushions by which each of them is looked at, too: those by which the way is shortest. Four of five of the strokes by a cushion that a
/// search finds best go by one of these.
const RAILS: usize = 2;

impl Observation {
    /// The observation number `index` (below [`OBSERVATIONS`]) of a layout.
    pub fn new(layout: &Layout, index: usize) -> Self {
        let [cue, one, two] = layout.balls;
        let (first, second) = if index & 1 == 0 { (one, two) } else { (two, one) };
        let x = if cue.x < 0.0 { -1.0 } else { 1.0 };
        // Mirroring one axis swaps the sides; mirroring both, a half turn, does not.
        let mirror = if index & 2 == 0 { DVec2::new(x, x) } else { DVec2::new(x, -x) };
        Self { cue: mirror * cue, first: mirror * first, second: mirror * second, rail: None, mirror }
    }

    /// All observations of a layout with a straight way to the first ball.
    pub fn all(layout: &Layout) -> [Self; OBSERVATIONS] {
        std::array::from_fn(|index| Self::new(layout, index))
    }

    /// All observations of a layout, those by a cushion too where `rails_first`.
    pub fn every(table: &Table, layout: &Layout, rails_first: bool) -> Vec<Self> {
        let straight = Self::all(layout);
        let by_rail = straight.iter().filter(|_| rails_first).flat_map(|view| view.by_nearest_rails(table));
        straight.into_iter().chain(by_rail).collect()
    }

    /// One of the observations by chance, half of them by a cushion where `rails_first`.
    pub fn random(table: &Table, layout: &Layout, rails_first: bool, rng: &mut (impl Rng + ?Sized)) -> Self {
        let straight = Self::new(layout, rng.random_range(0..OBSERVATIONS));
        let by_rail = rails_first && rng.random_bool(0.5);
        if by_rail { straight.by_nearest_rails(table)[rng.random_range(0..RAILS)] } else { straight }
    }

    /// The same ball and side by the cushions by which the way is shortest.
    fn by_nearest_rails(&self, table: &Table) -> [Self; RAILS] {
        let mut ways = Rail::ALL.map(|rail| Self { rail: Some(rail), ..*self });
        let length = |way: &Self| way.start(table).distance_squared(self.first);
        ways.sort_by(|a, b| length(a).total_cmp(&length(b)));
        std::array::from_fn(|index| ways[index])
    }

    /// Where the cue ball's last straight way to the first ball begins: at itself, or at its image in the cushion.
    pub fn start(&self, table: &Table) -> DVec2 {
        self.rail.map_or(self.cue, |rail| rail.image(table.reach(), self.cue))
    }

    /// A direction of this observation as an angle on the table, rad.
    pub fn angle_on_table(&self, direction: DVec2) -> f64 {
        (self.mirror * direction).to_angle()
    }

    /// A tip position to the left of the centre, as seen in this observation, on the table: a mirror swaps left and right.
    pub fn side_on_table(&self, left: f64) -> f64 {
        self.mirror.x * self.mirror.y * left
    }

    /// The lines from ball to ball, those of the cue ball from where its last straight way begins.
    pub fn lines(&self, table: &Table) -> Lines {
        let start = self.start(table);
        Lines {
            to_first: Line::between(start, self.first, table),
            to_second: Line::between(start, self.second, table),
            onward: Line::between(self.first, self.second, table),
        }
    }

    /// Images of the second ball in the four cushions: where a ball that rebounds from a cushion like light from a
    /// mirror must aim to meet it.
    pub fn images(&self, table: &Table) -> [DVec2; 4] {
        [Rail::Right, Rail::Left, Rail::Top, Rail::Bottom].map(|rail| rail.image(table.reach(), self.second))
    }
}

/// From where the cue ball's last straight way begins to both object balls, and from the first of these onward to the second.
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

/// How far a ball at `from` travels along the unit vector `direction` until it meets a cushion, m.
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
    fn the_cue_ball_always_lies_on_the_right_and_distances_stay() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            for observation in Observation::all(&layout) {
                assert!(observation.cue.x >= 0.0);
                assert!(
                    (observation.first.distance(observation.second) - layout.balls[1].distance(layout.balls[2])).abs()
                        < 1e-12
                );
            }
        }
    }

    #[test]
    fn mirrored_layouts_have_the_same_views() {
        let table = Table::default();
        let layout = Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(4));
        for mirror in [DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0), DVec2::new(-1.0, -1.0)] {
            let mirrored = Layout::new(layout.balls.map(|ball| mirror * ball));
            for observation in Observation::all(&layout) {
                let same = |other: &Observation| {
                    (other.cue, other.first, other.second) == (observation.cue, observation.first, observation.second)
                };
                assert!(Observation::all(&mirrored).iter().any(same));
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
