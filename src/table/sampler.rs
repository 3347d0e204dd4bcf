//! Random tables drawn from the uncertainty of a table's constants.

use super::{
    Table, TableDoubt,
    doubt::{CONSTANTS, Constant},
    flaws::steepest_tilt,
};
use crate::statistics::{dot, normal_quantile};

/// Draws random tables around a table, according to its uncertainty.
#[derive(Debug)]
pub struct TableSampler {
    /// The table's own rail model, then the alternatives.
    laws: Vec<Distribution>,
    /// Thresholds for a standard normal number: above the first the second rail model is chosen, above the second the third, and so on.
    bounds: Vec<f64>,
}

/// A distribution of tables that share one rail model.
#[derive(Debug)]
struct Distribution {
    table: Table,
    constants: Vec<(&'static Constant, f64)>,
    factor: Vec<Vec<f64>>,
}

impl TableSampler {
    /// Creates a sampler around `table`, with `factor` times the standard deviations of `doubt`. An alternative rail model is drawn with
    /// its weight, times `factor` if that is less than 1. Returns `None` if there is nothing to draw.
    pub fn new(table: &Table, doubt: &TableDoubt, factor: f64) -> Option<Self> {
        if factor <= 0.0 {
            return None;
        }
        let table = Table { doubt: None, ..table.clone() };
        let mut laws = vec![Distribution::new(&table, doubt, factor)?];
        let mut bounds = Vec::new();
        let mut share = 1.0 - factor.min(1.0) * doubt.laws.iter().map(|law| law.weight).sum::<f64>();
        for law in &doubt.laws {
            let (table, doubt) = doubt.with_model(law, &table);
            laws.push(Distribution::new(&table, &doubt, factor)?);
            bounds.push(normal_quantile(share));
            share += factor.min(1.0) * law.weight;
        }
        (laws.len() > 1 || !laws[0].constants.is_empty()).then_some(Self { laws, bounds })
    }

    /// Draws one table from standard normal numbers.
    pub fn draw(&self, mut normal: impl FnMut() -> f64) -> Table {
        // With a single rail model, no number is drawn for the choice, so that all numbers serve the constants.
        let which = if self.bounds.is_empty() {
            0
        } else {
            let number = normal();
            self.bounds.iter().filter(|bound| number > **bound).count()
        };
        self.laws[which].draw(normal)
    }
}

impl Distribution {
    fn new(table: &Table, doubt: &TableDoubt, factor: f64) -> Option<Self> {
        let in_doubt = |constant: &&Constant| doubt.deviations.get(constant.name).is_some_and(|value| *value > 0.0);
        let constants: Vec<_> = CONSTANTS
            .iter()
            .filter(in_doubt)
            .filter_map(|constant| (constant.get)(table).map(|value| (constant, value)))
            .collect();
        let names: Vec<&str> = constants.iter().map(|(constant, _)| constant.name).collect();
        // A principal submatrix of a positive definite matrix is positive definite, too.
        let mut lines = doubt.factor(&names).ok()?;
        for entry in lines.iter_mut().flatten() {
            *entry *= factor;
        }
        Some(Self { table: table.clone(), constants, factor: lines })
    }

    fn draw(&self, mut normal: impl FnMut() -> f64) -> Table {
        let mut table = self.table.clone();
        let numbers: Vec<f64> = self.constants.iter().map(|_| normal()).collect();
        for ((constant, mean), line) in self.constants.iter().zip(&self.factor) {
            constant.change(&mut table, mean + dot(line, &numbers));
        }
        table.tilt = table.tilt.clamp_length_max(0.99 * steepest_tilt(&table));
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::RailModel;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn value_outside_the_draw_limits_is_kept() {
        let table = Table { tilt: glam::DVec2::new(0.0, 0.0098), sliding_friction: 0.0095, ..Table::default() };
        let deviations = [("tilt.y".to_owned(), 1e-9), ("mu_s".to_owned(), 1e-9)].into();
        let doubt = TableDoubt { deviations, laws: Vec::new(), correlations: Vec::new() };
        let drawn = TableSampler::new(&table, &doubt, 1.0).unwrap().draw(|| 0.5);
        assert!(drawn.tilt.distance(table.tilt) < 1e-8 && (drawn.sliding_friction - 0.0095).abs() < 1e-8, "{drawn:?}");
    }

    #[test]
    fn drawn_tables_are_valid_with_given_deviations_and_correlations() {
        let table = Table::default();
        let doubt = TableDoubt { laws: Vec::new(), ..TableDoubt::of(&table) };
        let sampler = TableSampler::new(&table, &doubt, 1.0).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        // The sum of twelve uniform numbers is approximately normal.
        let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
        let drawn: Vec<Table> = (0..4000).map(|_| sampler.draw(&mut normal)).collect();
        let column = |name: &str| -> Vec<f64> {
            let mean = TableDoubt::value(&table, name).unwrap();
            drawn
                .iter()
                .map(|table| (TableDoubt::value(table, name).unwrap() - mean) / doubt.deviations[name])
                .collect()
        };
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / a.len() as f64;
        for name in ["e_rail", "mu_rail", "rail.height", "rail.kappa", "mu_s", "mu_r", "m_end", "tilt.y"] {
            let column = column(name);
            assert!((product(&column, &column) - 1.0).abs() < 0.12, "{name}: {}", product(&column, &column));
        }
        let correlation = product(&column("mu_rail"), &column("rail.kappa"));
        assert!((correlation + 0.72).abs() < 0.06, "{correlation}");
        for table in drawn.iter().step_by(40) {
            assert_eq!(Table::from_toml(&toml::to_string(table).unwrap()).unwrap(), *table);
        }
        assert!(TableSampler::new(&table, &doubt, 0.0).is_none());
        assert!(TableSampler::new(&table, &TableDoubt::default(), 1.0).is_none());
    }

    #[test]
    fn alternative_law_is_drawn_by_weight_with_its_constants() {
        let table = Table::default();
        let text = "deviations = { mu_rail = 0.02, \"rail.kappa\" = 0.1, mu_s = 0.01 }\n\
            [[laws]]\nmodel = \"mathavan\"\nweight = 0.3\nvalues = { mu_rail = 0.2 }\ndeviations = { mu_rail = 0.005 }";
        let doubt: TableDoubt = toml::from_str(text).unwrap();
        doubt.validate().unwrap();
        assert_eq!(toml::from_str::<TableDoubt>(&toml::to_string(&doubt).unwrap()).unwrap(), doubt);
        let drawn = |factor: f64| -> Vec<Table> {
            let sampler = TableSampler::new(&table, &doubt, factor).unwrap();
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(6);
            let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
            // The first number of each draw selects the rail model: evenly spaced quantiles from the lowest to the highest.
            let of = |share: f64| {
                let mut first = Some(normal_quantile(share));
                sampler.draw(|| first.take().unwrap_or_else(&mut normal))
            };
            (0..4000).map(|index| (f64::from(index) + 0.5) / 4000.0).map(of).collect()
        };
        let (others, own): (Vec<Table>, Vec<Table>) =
            drawn(1.0).into_iter().partition(|table| table.rail.model == RailModel::Mathavan);
        assert_eq!(others.len(), 1200);
        let moments = |tables: &[Table], value: fn(&Table) -> f64| {
            let mean = tables.iter().map(value).sum::<f64>() / tables.len() as f64;
            let variance = tables.iter().map(|table| (value(table) - mean).powi(2)).sum::<f64>() / tables.len() as f64;
            (mean, variance.sqrt())
        };
        for (tables, mean, deviation) in [(&others, 0.2, 0.005), (&own, table.rail_friction, 0.02)] {
            let (found, wide) = moments(tables, |table| table.rail_friction);
            assert!((found - mean).abs() < 0.002 && (wide / deviation - 1.0).abs() < 0.08, "{found} {wide}");
            let (found, wide) = moments(tables, |table| table.sliding_friction);
            assert!(
                (found - table.sliding_friction).abs() < 0.002 && (wide / 0.01 - 1.0).abs() < 0.08,
                "{found} {wide}"
            );
        }
        assert!(
            others.iter().all(|table| table.rail.kappa.is_none()) && own.iter().all(|table| table.rail.kappa.is_some())
        );
        for table in others.iter().step_by(100) {
            assert_eq!(Table::from_toml(&toml::to_string(table).unwrap()).unwrap(), *table);
        }
        // At half the uncertainty, the alternative model is half as likely.
        let half = drawn(0.5).iter().filter(|table| table.rail.model == RailModel::Mathavan).count();
        assert_eq!(half, 600);
    }
}
