//! The attempts at which shots are compared and judged: the errors of a hand, each on a table that may be the real one.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::Doubt;
use crate::{
    player::{
        errors::{self, Errors, Halton, Streams},
        misplaced,
    },
    table::{Layout, Table, TableDoubt, TableSampler},
};

/// Tells the numbers of worlds from those of errors.
const WORLDS: u64 = 0x776f_726c_6473;

/// Worlds that are drawn for comparing shots; then they come again with other errors of the hand. To draw one takes a good part of the time
/// of a simulation. A prime number: those that have the same world must not have much else in common.
const MOST_WORLDS: usize = 509;

/// How large the errors of an attempt are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorSize {
    /// The player's own.
    Own,
    /// Larger ones. Of shots that hardly ever miss, these tell apart the one that forgives more.
    Larger,
}

impl ErrorSize {
    /// How many times the player's own.
    pub const fn factor(self) -> f64 {
        match self {
            Self::Own => 1.0,
            // Three times the variance.
            Self::Larger => 1.732_050_807_568_877_2,
        }
    }
}

/// What is really there: a table and where the balls lie, either not quite as the coach believes.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// The table.
    pub table: Table,
    /// Where the balls lie.
    pub layout: Layout,
}

/// One attempt.
#[derive(Clone, Copy, Debug)]
pub struct Draw<'a> {
    /// The hand's errors.
    pub errors: &'a Errors,
    /// What is really there; `None` where it is just what the coach believes.
    pub world: Option<&'a World>,
}

/// Many attempts.
#[derive(Clone, Debug, Default)]
pub struct Draws {
    errors: Vec<Errors>,
    /// One an attempt, or fewer, that come again; none at all where nothing is in doubt.
    worlds: Vec<World>,
}

impl Draws {
    /// Independent attempts, for judging a shot.
    pub fn independent(count: usize, worlds: &Worlds, seed: u64) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ WORLDS);
        let real = |_| worlds.draw(|| errors::normal(&mut rng));
        let worlds = if worlds.is_certain() { Vec::new() } else { (0..count).map(real).collect() };
        Self { errors: errors::independent(count, seed), worlds }
    }

    /// Those in this range, fewer where there are not so many.
    pub fn range(&self, from: usize, to: usize) -> impl Iterator<Item = Draw<'_>> + Clone {
        let to = to.min(self.errors.len());
        let world = |index: usize| self.worlds.get(index % self.worlds.len().max(1));
        (from.min(to)..to).map(move |index| Draw { errors: &self.errors[index], world: world(index) })
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Draw<'_>> + Clone {
        self.range(0, self.len())
    }

    /// How many there are.
    pub const fn len(&self) -> usize {
        self.errors.len()
    }
}

/// Attempts from quasi-random sequences, which cover what may happen more evenly than chance, for comparing shots on the same
/// attempts. They are drawn when they are first needed: a search with little time ends before most of them.
#[derive(Debug)]
pub struct QuasiRandomDraws {
    size: ErrorSize,
    errors: Halton,
    streams: Streams,
    drawn: Draws,
}

impl QuasiRandomDraws {
    /// At errors of a hand that are so large.
    pub fn new(size: ErrorSize, seed: u64) -> Self {
        Self { size, errors: Halton::new(seed), streams: Streams::new(seed ^ WORLDS), drawn: Draws::default() }
    }

    /// Draws them up to the `count`th.
    pub fn extend_to(&mut self, worlds: &Worlds, count: usize) {
        for n in self.drawn.len()..count {
            self.drawn.errors.push(self.errors.errors(n).map(|error| self.size.factor() * error));
            if !worlds.is_certain() && n < MOST_WORLDS {
                let mut stream = 0..;
                let number = || self.streams.number(stream.next().unwrap_or_default(), n);
                self.drawn.worlds.push(worlds.draw(number));
            }
        }
    }

    /// Those that are drawn.
    pub const fn drawn(&self) -> &Draws {
        &self.drawn
    }
}

/// Where worlds are drawn from: what the coach believes, and how much of it is in doubt.
#[derive(Debug)]
pub struct Worlds {
    table: Table,
    layout: Layout,
    sampler: Option<TableSampler>,
    placing: f64,
}

impl Worlds {
    /// Around `table` and `layout`.
    pub fn new(table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        Self::known_as(&|| TableDoubt::of(table), table, layout, doubt)
    }

    /// The same on tables that lean no other way than this one, for choosing between shots: a table that leans costs
    /// twice the time, and as nobody knows which way it leans, which shot is the best hardly depends on it.
    pub fn level(table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        let known = || TableDoubt::of(table).without(|name| name.starts_with("tilt"));
        Self::known_as(&known, table, layout, doubt)
    }

    fn known_as(known: &dyn Fn() -> TableDoubt, table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        let sampler = if doubt.table > 0.0 { TableSampler::new(table, &known(), doubt.table) } else { None };
        Self { table: table.clone(), layout: *layout, sampler, placing: doubt.placing }
    }

    /// Whether the only world is the one that the coach believes in.
    pub fn is_certain(&self) -> bool {
        self.sampler.is_none() && self.placing == 0.0
    }

    /// One world, from standard normal numbers.
    pub fn draw(&self, mut normal: impl FnMut() -> f64) -> World {
        let layout = misplaced(&self.table, &self.layout, self.placing, &mut normal);
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
    fn nothing_in_doubt_draws_nothing_and_doubts_draw_valid_worlds() {
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
