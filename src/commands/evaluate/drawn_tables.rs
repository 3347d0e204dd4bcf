//! Random tables like those in clubs, one for each layout.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    calibration::prior,
    coach::layout_seed,
    statistics::normal_pair,
    table::{Table, TableDoubt, TableSampler},
};

/// A distribution of tables around a given one.
#[derive(Debug)]
pub struct DrawnTables {
    around: Table,
    sampler: Option<TableSampler>,
    seed: u64,
}

impl DrawnTables {
    /// Creates tables that differ from `table` as unknown tables do. The player knows each of them as well as `match`, except that the rail
    /// model is certain.
    pub fn around(table: &Table, seed: u64) -> Self {
        let known = TableDoubt { laws: Vec::new(), ..TableDoubt::of(&Table::default()) };
        let around = Table { name: format!("like {}", table.name), doubt: Some(known), ..table.clone() };
        Self { around, sampler: TableSampler::new(table, &prior(table), 1.0), seed }
    }

    /// Returns the table of the layout with this number.
    pub fn of(&self, index: u32) -> Table {
        let Self { around, sampler, seed } = self;
        let Some(sampler) = sampler else { return around.clone() };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(layout_seed(*seed, index));
        let drawn = sampler.draw(|| normal_pair(&mut rng)[0]);
        Table { name: around.name.clone(), doubt: around.doubt.clone(), ..drawn }
    }
}
