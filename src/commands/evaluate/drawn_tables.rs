//! Tables as clubs have them, one for each layout.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    calibration::prior,
    coach::layout_seed,
    statistics::normal_pair,
    table::{Table, TableDoubt, TableSampler},
};

/// Tables around one.
#[derive(Debug)]
pub struct DrawnTables {
    around: Table,
    sampler: Option<TableSampler>,
    seed: u64,
}

impl DrawnTables {
    /// Tables that differ from `table` as tables do of which nothing is known. Each is then as well known as `match`, but that the
    /// law of its rails is not in doubt.
    pub fn around(table: &Table, seed: u64) -> Self {
        let known = TableDoubt { laws: Vec::new(), ..TableDoubt::of(&Table::default()) };
        let around = Table { name: format!("like {}", table.name), doubt: Some(known), ..table.clone() };
        Self { around, sampler: TableSampler::new(table, &prior(table), 1.0), seed }
    }

    /// That of the layout with this number.
    pub fn of(&self, index: u32) -> Table {
        let Self { around, sampler, seed } = self;
        let Some(sampler) = sampler else { return around.clone() };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(layout_seed(*seed, index));
        let drawn = sampler.draw(|| normal_pair(&mut rng)[0]);
        Table { name: around.name.clone(), doubt: around.doubt.clone(), ..drawn }
    }
}
