//! What is held of a table's constants: values, and a covariance by its factor, so that unknowns are independent numbers
//! with deviation 1.

use glam::DVec2;

use crate::{
    statistics::dot,
    table::{DoubtError, Table, TableDoubt, steepest_tilt},
};

/// A slope that nobody can see, m/s² along both sides: 0.02 mm a metre. Rolls on a level table are computed in another way,
/// with other roundings of up to half a percent: marks shall not jump where a slope comes to nothing.
const LEVEL: f64 = 2e-4;

/// The steepest slope that is considered, as a share of what a table may have.
const STEEPEST: f64 = 0.995;

/// Correlations up to this are left out of what is told.
const TOLD: f64 = 0.05;

/// Most times that correlations are made smaller by a hundredth; after that they are so small that they contradict nothing.
const MOST_SHRINKINGS: usize = 500;

/// A normal distribution of the constants that are in doubt.
#[derive(Clone, Debug)]
pub struct Belief {
    /// The table, without its doubt.
    table: Table,
    names: Vec<String>,
    means: Vec<f64>,
    /// The lower triangle L of the covariance `L Lᵀ`, by rows.
    factor: Vec<Vec<f64>>,
}

impl Belief {
    /// What `doubt` says around `table`.
    ///
    /// # Errors
    /// Where its correlations contradict each other.
    pub fn new(table: &Table, doubt: &TableDoubt) -> Result<Self, DoubtError> {
        let mut table = Table { doubt: None, ..table.clone() };
        let slope = |name: &str| {
            let may_be = doubt.deviations.get(name).is_some_and(|deviation| *deviation > 0.0);
            if may_be { LEVEL } else { 0.0 }
        };
        if table.tilt == DVec2::ZERO {
            table.tilt = DVec2::new(slope("tilt.x"), slope("tilt.y"));
        }
        let known = |(name, deviation): (&String, &f64)| {
            let value = TableDoubt::value(&table, name).filter(|_| *deviation > 0.0);
            value.map(|value| (name.clone(), value))
        };
        let (names, means): (Vec<_>, Vec<_>) = doubt.deviations.iter().filter_map(known).unzip();
        let factor = doubt.factor(&names.iter().map(String::as_str).collect::<Vec<_>>())?;
        Ok(Self { table, names, means, factor })
    }

    /// How many constants there are.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// The table with these unknowns, its constants within their limits.
    pub fn table(&self, unknowns: &[f64]) -> Table {
        let change = |table: Table, (name, value): (&String, f64)| TableDoubt::with_value(&table, name, value);
        let table = self.names.iter().zip(self.values(unknowns)).fold(self.table.clone(), change);
        // On a steeper one balls might never stop.
        let steepest = STEEPEST * steepest_tilt(&table);
        Table { tilt: table.tilt.clamp_length_max(steepest), ..table }
    }

    /// The constants' values with these unknowns, as they are before a table's limits.
    pub fn values(&self, unknowns: &[f64]) -> Vec<f64> {
        self.means.iter().zip(&self.factor).map(|(mean, row)| mean + dot(row, unknowns)).collect()
    }

    /// The likeliest unknowns with which a constant is so many deviations from its mean; `None` where it is not in doubt.
    pub fn unknowns_at(&self, name: &str, deviations: f64) -> Option<Vec<f64>> {
        let row = &self.factor[self.names.iter().position(|one| one == name)?];
        let whole = dot(row, row).sqrt();
        Some((0..self.count()).map(|index| row.get(index).map_or(0.0, |entry| deviations * entry / whole)).collect())
    }

    /// Name, value and deviation of each constant.
    pub fn told(&self) -> impl Iterator<Item = (&str, f64, f64)> {
        self.names
            .iter()
            .zip(&self.means)
            .zip(&self.factor)
            .map(|((name, mean), row)| (name.as_str(), *mean, dot(row, row).sqrt()))
    }

    /// The covariance of the constants where that of the unknowns is `covariance`.
    pub fn covariance(&self, covariance: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let line = |row: &Vec<f64>| -> Vec<f64> {
            let columns = 0..covariance.len();
            columns.map(|column| row.iter().zip(covariance).map(|(entry, line)| entry * line[column]).sum()).collect()
        };
        let half: Vec<Vec<f64>> = self.factor.iter().map(line).collect();
        half.iter().map(|one| self.factor.iter().map(|other| dot(one, other)).collect()).collect()
    }

    /// The doubt that a covariance of the constants is, under the table's own law of the rails: other laws that its file holds in
    /// doubt are not told apart and left out. Small correlations are left out, and what that leaves stays the
    /// covariance of something.
    pub fn doubt(&self, covariance: &[Vec<f64>]) -> TableDoubt {
        let deviation = |index: usize| covariance[index][index].max(0.0).sqrt();
        let deviations = self.names.iter().enumerate().map(|(index, name)| (name.clone(), deviation(index))).collect();
        let mut doubt = TableDoubt { deviations, ..TableDoubt::default() };
        for (row, line) in covariance.iter().enumerate() {
            for (column, entry) in line.iter().enumerate().take(row) {
                let value = entry / (deviation(row) * deviation(column));
                // What is certain has no correlation.
                if value.abs() > TOLD && value.is_finite() {
                    let rounded = (1e4 * value).round() / 1e4;
                    doubt.correlations.push((self.names[column].clone(), self.names[row].clone(), rounded));
                }
            }
        }
        for _ in 0..MOST_SHRINKINGS {
            if doubt.validate().is_ok() {
                break;
            }
            doubt.correlations.iter_mut().for_each(|(.., value)| *value *= 0.99);
        }
        doubt
    }
}
