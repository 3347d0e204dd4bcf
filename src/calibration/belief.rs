//! The prior belief about a table's constants: a normal distribution, stored by the factor of its covariance, so that the unknowns are
//! independent numbers with standard deviation 1.

use glam::DVec2;

use crate::{
    statistics::dot,
    table::{DoubtError, Table, TableDoubt, steepest_tilt},
};

/// A negligible tilt, m/s² along both sides: 0.02 mm per metre. It replaces zero, because rolls on a level table are computed in another
/// way, with different rounding of up to half a percent: marks must not jump where the tilt passes through zero.
const LEVEL: f64 = 2e-4;

/// A slope below this share of its standard deviation is negligible.
const NEGLIGIBLE_SLOPE: f64 = 0.1;

/// Limit on the tilt, as a share of the largest tilt that a table may have.
const MAX_TILT_SHARE: f64 = 0.995;

/// Smallest absolute correlation that the resulting doubt contains.
const MIN_CORRELATION: f64 = 0.05;

/// Limit on the steps that shrink the correlations by one hundredth; after these they are too small to contradict each other.
const MAX_SHRINKS: usize = 500;

/// A normal distribution of the uncertain constants.
#[derive(Clone, Debug)]
pub struct Belief {
    /// The table, without its doubt.
    table: Table,
    /// The part of its slope that stands for zero, m/s².
    level: DVec2,
    names: Vec<String>,
    means: Vec<f64>,
    /// The lower triangular factor L of the covariance `L Lᵀ`, by rows.
    factor: Vec<Vec<f64>>,
}

impl Belief {
    /// Creates the belief with the constants of `table` as means and the deviations and correlations of `doubt`.
    ///
    /// # Errors
    /// Fails if the correlations contradict each other.
    pub fn new(table: &Table, doubt: &TableDoubt) -> Result<Self, DoubtError> {
        let mut table = Table { doubt: None, ..table.clone() };
        let tilt = |name: &str| {
            let is_uncertain = doubt.deviations.get(name).is_some_and(|deviation| *deviation > 0.0);
            if is_uncertain { LEVEL } else { 0.0 }
        };
        let mut level = DVec2::ZERO;
        if table.tilt == DVec2::ZERO {
            level = DVec2::new(tilt("tilt.x"), tilt("tilt.y"));
            table.tilt = level;
        }
        let known = |(name, deviation): (&String, &f64)| {
            let value = TableDoubt::value(&table, name).filter(|_| *deviation > 0.0);
            value.map(|value| (name.clone(), value))
        };
        let (names, means): (Vec<_>, Vec<_>) = doubt.deviations.iter().filter_map(known).unzip();
        let factor = doubt.factor(&names.iter().map(String::as_str).collect::<Vec<_>>())?;
        Ok(Self { table, level, names, means, factor })
    }

    /// Number of uncertain constants.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Returns the table for these unknowns, with its constants clamped to their limits.
    pub fn table(&self, unknowns: &[f64]) -> Table {
        let change = |table: Table, (name, value): (&String, f64)| TableDoubt::with_value(&table, name, value);
        let table = self.names.iter().zip(self.values(unknowns)).fold(self.table.clone(), change);
        // On a steeper table balls might never stop.
        let limit = MAX_TILT_SHARE * steepest_tilt(&table);
        Table { tilt: table.tilt.clamp_length_max(limit), ..table }
    }

    /// Returns an estimated table without the part of its slope that stands for zero. A slope that remains negligible beside its `doubt` is
    /// zero: shots on a level table are simpler.
    pub fn without_level(&self, table: Table, doubt: &TableDoubt) -> Table {
        let share = |name: &str, tilt: f64, level: f64| {
            let deviation = doubt.deviations.get(name).copied().unwrap_or(0.0);
            if (tilt - level).abs() < NEGLIGIBLE_SLOPE * deviation { 0.0 } else { tilt - level }
        };
        let tilt = DVec2::new(share("tilt.x", table.tilt.x, self.level.x), share("tilt.y", table.tilt.y, self.level.y));
        Table { tilt, ..table }
    }

    /// Returns the mean of a constant before the calibration, without the part of a slope that stands for zero.
    pub fn mean_before(&self, name: &str, mean: f64) -> f64 {
        match name {
            "tilt.x" => mean - self.level.x,
            "tilt.y" => mean - self.level.y,
            _ => mean,
        }
    }

    /// Returns the values of the constants for these unknowns, before they are clamped to the table's limits.
    pub fn values(&self, unknowns: &[f64]) -> Vec<f64> {
        self.means.iter().zip(&self.factor).map(|(mean, row)| mean + dot(row, unknowns)).collect()
    }

    /// Returns the most probable unknowns with which a constant is `deviations` standard deviations from its mean; `None` if the constant
    /// is not uncertain.
    pub fn unknowns_at(&self, name: &str, deviations: f64) -> Option<Vec<f64>> {
        let row = &self.factor[self.names.iter().position(|one| one == name)?];
        let deviation = dot(row, row).sqrt();
        Some(
            (0..self.count()).map(|index| row.get(index).map_or(0.0, |entry| deviations * entry / deviation)).collect(),
        )
    }

    /// Iterates over the name, mean and standard deviation of each constant.
    pub fn constants(&self) -> impl Iterator<Item = (&str, f64, f64)> {
        self.names
            .iter()
            .zip(&self.means)
            .zip(&self.factor)
            .map(|((name, mean), row)| (name.as_str(), *mean, dot(row, row).sqrt()))
    }

    /// Returns the covariance of the constants if that of the unknowns is `covariance`.
    pub fn covariance(&self, covariance: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let line = |row: &Vec<f64>| -> Vec<f64> {
            let columns = 0..covariance.len();
            columns.map(|column| row.iter().zip(covariance).map(|(entry, line)| entry * line[column]).sum()).collect()
        };
        let half: Vec<Vec<f64>> = self.factor.iter().map(line).collect();
        half.iter().map(|one| self.factor.iter().map(|other| dot(one, other)).collect()).collect()
    }

    /// Converts a covariance of the constants to a doubt, with the table's own law of the rails: the calibration does not distinguish
    /// other laws in the table's file, so they are left out. Small correlations are left out, too; the others are shrunk if necessary, so
    /// that the result remains a valid covariance.
    pub fn doubt(&self, covariance: &[Vec<f64>]) -> TableDoubt {
        let deviation = |index: usize| covariance[index][index].max(0.0).sqrt();
        let deviations = self.names.iter().enumerate().map(|(index, name)| (name.clone(), deviation(index))).collect();
        let mut doubt = TableDoubt { deviations, ..TableDoubt::default() };
        for (row, line) in covariance.iter().enumerate() {
            for (column, entry) in line.iter().enumerate().take(row) {
                let value = entry / (deviation(row) * deviation(column));
                // A certain constant has no correlation: the quotient is not finite.
                if value.abs() > MIN_CORRELATION && value.is_finite() {
                    let rounded = (1e4 * value).round() / 1e4;
                    doubt.correlations.push((self.names[column].clone(), self.names[row].clone(), rounded));
                }
            }
        }
        for _ in 0..MAX_SHRINKS {
            if doubt.validate().is_ok() {
                break;
            }
            doubt.correlations.iter_mut().for_each(|(.., value)| *value *= 0.99);
        }
        doubt
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_table_stays_level_if_nothing_tells_of_its_slope() {
        let table = Table { tilt: DVec2::ZERO, ..Table::default() };
        let doubt = TableDoubt::of(&table);
        let belief = Belief::new(&table, &doubt).unwrap();
        let before = belief.table(&vec![0.0; belief.count()]);
        assert_eq!((before.tilt, belief.mean_before("tilt.x", before.tilt.x)), (DVec2::splat(LEVEL), 0.0));
        assert_eq!(belief.without_level(before.clone(), &doubt).tilt, DVec2::ZERO);
        // A slope of a standard deviation along one side is found.
        let along = doubt.deviations["tilt.x"];
        let sloping = Table { tilt: before.tilt + DVec2::new(along, 0.0), ..before };
        let found = belief.without_level(sloping, &doubt).tilt;
        assert!((found.x - along).abs() < 1e-15 && found.y == 0.0, "{found}");
    }
}
