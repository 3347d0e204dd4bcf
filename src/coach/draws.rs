//! Random attempts by which shots are compared and judged: execution errors, each on a possible real table.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::Doubt;
use crate::{
    player::{
        errors::{self, Errors, Halton, Streams},
        perturbed_layout,
    },
    table::{Layout, Table, TableDoubt, TableSampler},
};

/// Separates the random stream of the worlds from that of the errors.
const WORLD_STREAM: u64 = 0x776f_726c_6473;

/// Number of distinct worlds drawn for comparing shots; they repeat with other execution errors. Drawing one takes a
/// good part of the time of a simulation. The number is prime, so that attempts that share a world have little else in
/// common.
const MAX_WORLDS: usize = 509;

/// The size of an attempt's errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorSize {
    /// The player's own.
    Own,
    /// Larger ones. Among shots that hardly ever miss, these show which one is more forgiving.
    Larger,
}

impl ErrorSize {
    /// Returns the multiple of the player's own errors.
    pub const fn factor(self) -> f64 {
        match self {
            Self::Own => 1.0,
            // Three times the variance.
            Self::Larger => 1.732_050_807_568_877_2,
        }
    }
}

/// A possible reality: a table and ball positions, both slightly different from what the coach assumes.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// The table.
    pub table: Table,
    /// The ball positions.
    pub layout: Layout,
}

/// One random attempt.
#[derive(Clone, Copy, Debug)]
pub struct Draw<'a> {
    /// The execution errors.
    pub errors: &'a Errors,
    /// The real table and layout; `None` if they are just as the coach assumes.
    pub world: Option<&'a World>,
}

/// Many random attempts.
#[derive(Clone, Debug, Default)]
pub struct Draws {
    errors: Vec<Errors>,
    /// One per attempt, or fewer, which repeat; empty if nothing is in doubt.
    worlds: Vec<World>,
}

impl Draws {
    /// Draws independent attempts, for judging a shot.
    pub fn independent(count: usize, worlds: &Worlds, seed: u64) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ WORLD_STREAM);
        let real = |_| worlds.draw(|| errors::standard_normal(&mut rng));
        let worlds = if worlds.is_certain() { Vec::new() } else { (0..count).map(real).collect() };
        Self { errors: errors::independent(count, seed), worlds }
    }

    /// Returns the attempt with this index, if it exists.
    pub fn get(&self, index: usize) -> Option<Draw<'_>> {
        let world = self.worlds.get(index % self.worlds.len().max(1));
        Some(Draw { errors: self.errors.get(index)?, world })
    }

    /// Returns all attempts.
    pub fn iter(&self) -> impl Iterator<Item = Draw<'_>> {
        (0..self.len()).filter_map(|index| self.get(index))
    }

    /// Returns the number of attempts.
    pub const fn len(&self) -> usize {
        self.errors.len()
    }
}

/// Attempts from quasi-random sequences, which cover the possible errors more evenly than random numbers. Used for
/// comparing shots on the same attempts. They are drawn on demand: a search with little time ends before most of them.
#[derive(Debug)]
pub struct QuasiRandomDraws {
    size: ErrorSize,
    errors: Halton,
    streams: Streams,
    drawn: Draws,
}

impl QuasiRandomDraws {
    /// Creates sequences for errors of this size.
    pub fn new(size: ErrorSize, seed: u64) -> Self {
        Self { size, errors: Halton::new(seed), streams: Streams::new(seed ^ WORLD_STREAM), drawn: Draws::default() }
    }

    /// Draws attempts up to the `count`th.
    pub fn extend_to(&mut self, worlds: &Worlds, count: usize) {
        for n in self.drawn.len()..count {
            self.drawn.errors.push(self.errors.errors(n).map(|error| self.size.factor() * error));
            if !worlds.is_certain() && n < MAX_WORLDS {
                let mut stream = 0..;
                let number = || self.streams.number(stream.next().unwrap_or_default(), n);
                self.drawn.worlds.push(worlds.draw(number));
            }
        }
    }

    /// Returns the attempts drawn so far.
    pub const fn drawn(&self) -> &Draws {
        &self.drawn
    }
}

/// The distribution of worlds: what the coach assumes, and the uncertainty of it.
#[derive(Debug)]
pub struct Worlds {
    table: Table,
    layout: Layout,
    sampler: Option<TableSampler>,
    placing: f64,
}

impl Worlds {
    /// Creates a distribution around `table` and `layout`.
    pub fn new(table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        Self::with_table_doubt(TableDoubt::of, table, layout, doubt)
    }

    /// Like [`new`](Self::new), but without uncertainty about the table's tilt, for choosing between shots. A tilted
    /// table costs twice the time, and as the direction of the tilt is unknown, the choice hardly depends on it.
    pub fn level(table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        let known = |table: &Table| TableDoubt::of(table).without(|name| name.starts_with("tilt"));
        Self::with_table_doubt(known, table, layout, doubt)
    }

    fn with_table_doubt(known: fn(&Table) -> TableDoubt, table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        let sampler = if doubt.table > 0.0 { TableSampler::new(table, &known(table), doubt.table) } else { None };
        Self { table: table.clone(), layout: *layout, sampler, placing: doubt.placing }
    }

    /// Whether the only possible world is the assumed one.
    pub fn is_certain(&self) -> bool {
        self.sampler.is_none() && self.placing == 0.0
    }

    /// Draws one world, from standard normal numbers.
    pub fn draw(&self, mut normal: impl FnMut() -> f64) -> World {
        let layout = perturbed_layout(&self.table, &self.layout, self.placing, &mut normal);
        let table = self.sampler.as_ref().map_or_else(|| self.table.clone(), |sampler| sampler.draw(normal));
        World { table, layout }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn layout() -> Layout {
        Layout::new([DVec2::new(-0.8, 0.1), DVec2::new(0.4, 0.3), DVec2::new(0.9, -0.5)])
    }

    #[test]
    fn doubt_draws_valid_worlds_and_certainty_draws_none() {
        let table = Table::default();
        let none = Draws::independent(50, &Worlds::new(&table, &layout(), Doubt::NONE), 7);
        assert!(none.iter().all(|draw| draw.world.is_none()) && none.len() == 50);
        let close = Layout::new([
            DVec2::new(0.0, 0.0),
            DVec2::new(2.0 * table.radius, 0.0),
            DVec2::new(0.0, table.half_width()),
        ]);
        for layout in [layout(), close] {
            let worlds = Worlds::new(&table, &layout, Doubt::FULL);
            let draws = Draws::independent(50, &worlds, 7);
            let mut tables = Vec::new();
            for draw in draws.iter() {
                let world = draw.world.unwrap();
                world.layout.validate(&table).unwrap();
                tables.push(world.table.rail_restitution);
            }
            tables.dedup();
            assert_eq!(tables.len(), 50);
            let again = Draws::independent(50, &worlds, 7);
            assert!(draws.iter().zip(again.iter()).all(|(one, other)| one.world == other.world), "the same seed");
        }
    }
}
