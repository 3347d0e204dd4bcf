//! How well a table is known: standard deviations and correlations of its constants, and tables drawn from them.

use std::{collections::BTreeMap, sync::LazyLock};

use serde::{Deserialize, Serialize};

use super::{JUDGED, OneRail, Rail, RailModel, Table, flaws};

const MATCH: &str = include_str!("match_doubt.toml");
const UNKNOWN: &str = include_str!("unknown_doubt.toml");

/// How well a table's constants are known: the TOML section `[doubt]`. They are taken to be normally distributed around
/// the table's own values; a constant that is not named is certain.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableDoubt {
    /// Standard deviations by the names of the constants (`mu_s`, `rail.height`, …), in the units of the table's file.
    #[serde(default)]
    pub deviations: BTreeMap<String, f64>,
    /// Correlations of two of them; those that are not named are 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correlations: Vec<(String, String, f64)>,
}

/// A constant that can be in doubt.
#[derive(Debug)]
struct Constant {
    name: &'static str,
    get: fn(&Table) -> Option<f64>,
    set: fn(&mut Table, f64),
    /// Values that draws are kept within.
    limits: (f64, f64),
}

/// All of them. A constant that a table's model does not have is left out there. Draws take them in this order: new ones come
/// last.
const CONSTANTS: [Constant; 22] = [
    Constant {
        name: "e_rail",
        get: |table| Some(table.rail_restitution),
        set: |table, value| table.rail_restitution = value,
        limits: (0.0, 1.0),
    },
    Constant {
        name: "mu_rail",
        get: |table| Some(table.rail_friction),
        set: |table, value| table.rail_friction = value,
        limits: (0.0, 0.99),
    },
    Constant {
        name: "rail.height",
        get: |table| table.rail.height.filter(|_| table.rail.model != RailModel::Equator),
        set: |table, value| table.rail.height = Some(value.clamp(table.radius, 1.6 * table.radius)),
        limits: (0.0, f64::MAX),
    },
    Constant {
        name: "rail.kappa",
        get: |table| table.rail.kappa,
        set: |table, value| table.rail.kappa = Some(value),
        limits: (0.05, 2.0),
    },
    Constant {
        name: "rail.fade.slope",
        get: |table| table.rail.fade.map(|fade| fade.slope),
        set: |table, value| {
            if let Some(fade) = &mut table.rail.fade {
                fade.slope = value;
            }
        },
        limits: (0.0, 10.0),
    },
    Constant {
        name: "mu_s",
        get: |table| Some(table.sliding_friction),
        set: |table, value| table.sliding_friction = value,
        limits: (0.01, 1e3),
    },
    Constant {
        name: "mu_r",
        get: |table| Some(table.rolling_friction),
        set: |table, value| table.rolling_friction = value,
        limits: (1e-3, 1e3),
    },
    Constant {
        name: "c1",
        get: |table| Some(table.rolling_growth),
        set: |table, value| table.rolling_growth = value,
        limits: (0.0, 1.0),
    },
    Constant {
        name: "mu_sp",
        get: |table| Some(table.spinning_friction),
        set: |table, value| table.spinning_friction = value,
        limits: (0.0, 1e3),
    },
    Constant {
        name: "tilt.x",
        get: |table| Some(table.tilt.x),
        set: |table, value| table.tilt.x = value,
        limits: (-0.006, 0.006),
    },
    Constant {
        name: "tilt.y",
        get: |table| Some(table.tilt.y),
        set: |table, value| table.tilt.y = value,
        limits: (-0.006, 0.006),
    },
    Constant {
        name: "e_ball",
        get: |table| Some(table.ball_restitution),
        set: |table, value| table.ball_restitution = value,
        limits: (0.0, 1.0),
    },
    Constant {
        name: "mu_b",
        get: |table| table.ball_slip_friction.map(|law| law.least + law.rise).or(table.ball_friction),
        set: |table, value| {
            table.ball_friction = Some(value);
            if let Some(law) = &mut table.ball_slip_friction {
                law.rise = (value - law.least).max(0.0);
            }
        },
        limits: (0.0, 0.99),
    },
    Constant {
        name: "m_end",
        get: |table| table.cue_end_mass,
        set: |table, value| table.cue_end_mass = Some(value.min(table.cue_mass)),
        limits: (1e-4, f64::MAX),
    },
    own_restitution::<0>("rail.left.e"),
    own_restitution::<1>("rail.right.e"),
    own_restitution::<2>("rail.bottom.e"),
    own_restitution::<3>("rail.top.e"),
    own_friction::<0>("rail.left.mu"),
    own_friction::<1>("rail.right.mu"),
    own_friction::<2>("rail.bottom.mu"),
    own_friction::<3>("rail.top.mu"),
];

/// What a rail gives back that has a value of its own, by its place in [`Rail::ALL`].
const fn own_restitution<const RAIL: usize>(name: &'static str) -> Constant {
    Constant {
        name,
        get: |table| table.rail.own(Rail::ALL[RAIL]).e,
        set: |table, value| {
            let own = table.rail.own_mut(Rail::ALL[RAIL]);
            *own = Some(OneRail { e: Some(value), ..own.unwrap_or_default() });
        },
        limits: (0.0, 1.0),
    }
}

/// The same of its friction.
const fn own_friction<const RAIL: usize>(name: &'static str) -> Constant {
    Constant {
        name,
        get: |table| table.rail.own(Rail::ALL[RAIL]).mu,
        set: |table, value| {
            let own = table.rail.own_mut(Rail::ALL[RAIL]);
            *own = Some(OneRail { mu: Some(value), ..own.unwrap_or_default() });
        },
        limits: (0.0, 0.99),
    }
}

/// Why a doubt is refused.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum DoubtError {
    /// A name that no constant has.
    #[error("the doubt names \"{0}\", which is no constant that can be in doubt; accepted are {accepted}", accepted = names())]
    Unknown(String),
    /// A standard deviation that is none.
    #[error("the doubt has {0} = {1}; accepted is a standard deviation from 0 in the unit of the table's file")]
    Deviation(String, f64),
    /// Correlations that no distribution has.
    #[error("the correlations of the doubt contradict each other at \"{0}\"; accepted is a positive definite matrix")]
    Correlations(String),
}

fn names() -> String {
    CONSTANTS.map(|constant| constant.name).join(", ")
}

impl TableDoubt {
    /// What is not known of `table`: what its file says, or else for `match` what the fit to the film has left open, nothing
    /// for the tables of the thesis' equations, and for any other what real tables differ by.
    pub fn of(table: &Table) -> Self {
        // Read once: the coach asks at every question. A test reads them all.
        static KNOWN: LazyLock<Vec<(Table, TableDoubt)>> = LazyLock::new(|| {
            let judged = JUDGED.iter().filter_map(|name| Some((Table::preset(name).ok()?, TableDoubt::default())));
            judged.chain([(Table::default(), toml::from_str(MATCH).unwrap_or_default())]).collect()
        });
        static OTHER: LazyLock<TableDoubt> = LazyLock::new(|| toml::from_str(UNKNOWN).unwrap_or_default());
        let known = || KNOWN.iter().find(|(known, _)| known == table).map(|(_, doubt)| doubt);
        table.doubt.as_ref().or_else(known).unwrap_or(&OTHER).clone()
    }

    /// The value of a constant; `None` where the table's models do not have it, or the name is unknown.
    pub fn value(table: &Table, name: &str) -> Option<f64> {
        CONSTANTS.iter().find(|constant| constant.name == name).and_then(|constant| (constant.get)(table))
    }

    /// `table` with this value of a constant, kept within its limits; unchanged where its models do not have it.
    #[must_use]
    pub fn with_value(table: &Table, name: &str, value: f64) -> Table {
        let mut table = table.clone();
        if let Some(constant) = CONSTANTS.iter().find(|constant| constant.name == name) {
            constant.change(&mut table, value);
        }
        table
    }

    /// Whether nothing is in doubt.
    pub fn is_certain(&self) -> bool {
        self.deviations.values().all(|deviation| *deviation == 0.0)
    }

    /// Checks every name and number.
    ///
    /// # Errors
    /// Where one cannot be.
    pub fn validate(&self) -> Result<(), DoubtError> {
        for (name, deviation) in &self.deviations {
            if !CONSTANTS.iter().any(|constant| constant.name == name) {
                return Err(DoubtError::Unknown(name.clone()));
            }
            if !(0.0..f64::INFINITY).contains(deviation) {
                return Err(DoubtError::Deviation(name.clone(), *deviation));
            }
        }
        for (one, other, _) in &self.correlations {
            if let Some(name) = [one, other].into_iter().find(|name| !self.deviations.contains_key(*name)) {
                return Err(DoubtError::Correlations(name.clone()));
            }
        }
        let names: Vec<&str> = self.deviations.keys().map(String::as_str).collect();
        self.factor(&names).map(|_| ())
    }

    /// The lower triangle L of the covariance `L Lᵀ` of these constants by rows (Cholesky).
    ///
    /// # Errors
    /// Where the correlations contradict each other.
    pub fn factor(&self, names: &[&str]) -> Result<Vec<Vec<f64>>, DoubtError> {
        let correlation = |row: &str, column: &str| {
            let is_named = |(one, other, _): &&(String, String, f64)| {
                (one == row && other == column) || (one == column && other == row)
            };
            self.correlations.iter().find(is_named).map_or(0.0, |(.., value)| *value)
        };
        let mut factor: Vec<Vec<f64>> = Vec::with_capacity(names.len());
        for (row, name) in names.iter().enumerate() {
            let mut line: Vec<f64> = Vec::with_capacity(row + 1);
            for column in 0..row {
                let inner: f64 = (0..column).map(|k| line[k] * factor[column][k]).sum();
                line.push((correlation(name, names[column]) - inner) / factor[column][column]);
            }
            let rest = 1.0 - line.iter().map(|entry| entry * entry).sum::<f64>();
            if rest.is_nan() || rest <= 1e-9 {
                return Err(DoubtError::Correlations((*name).to_owned()));
            }
            line.push(rest.sqrt());
            factor.push(line);
        }
        for (line, name) in factor.iter_mut().zip(names) {
            for entry in line {
                *entry *= self.deviations[*name];
            }
        }
        Ok(factor)
    }
}

impl Constant {
    fn change(&self, table: &mut Table, value: f64) {
        if (self.get)(table).is_some() {
            (self.set)(table, value.clamp(self.limits.0, self.limits.1));
        }
    }
}

/// Draws tables from a table and its doubt.
#[derive(Debug)]
pub struct TableSampler {
    table: Table,
    constants: Vec<(&'static Constant, f64)>,
    factor: Vec<Vec<f64>>,
}

impl TableSampler {
    /// Tables around `table`, with `factor` times the standard deviations of `doubt`; `None` where there is nothing to draw.
    pub fn new(table: &Table, doubt: &TableDoubt, factor: f64) -> Option<Self> {
        let in_doubt = |constant: &&Constant| doubt.deviations.get(constant.name).is_some_and(|value| *value > 0.0);
        let constants: Vec<_> = CONSTANTS
            .iter()
            .filter(in_doubt)
            .filter_map(|constant| (constant.get)(table).map(|value| (constant, value)))
            .collect();
        let names: Vec<&str> = constants.iter().map(|(constant, _)| constant.name).collect();
        // Part of a positive definite matrix is one, too.
        let mut lines = doubt.factor(&names).ok()?;
        for entry in lines.iter_mut().flatten() {
            *entry *= factor;
        }
        let table = Table { doubt: None, ..table.clone() };
        (factor > 0.0 && !constants.is_empty()).then_some(Self { table, constants, factor: lines })
    }

    /// One table, from standard normal numbers.
    pub fn draw(&self, mut normal: impl FnMut() -> f64) -> Table {
        let mut table = self.table.clone();
        let numbers: Vec<f64> = self.constants.iter().map(|_| normal()).collect();
        for ((constant, mean), line) in self.constants.iter().zip(&self.factor) {
            let off: f64 = line.iter().zip(&numbers).map(|(entry, number)| entry * number).sum();
            constant.change(&mut table, mean + off);
        }
        table.tilt = table.tilt.clamp_length_max(0.99 * flaws::steepest(&table));
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::PRESETS;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn every_table_has_a_doubt_that_can_be_drawn_from() {
        for text in [MATCH, UNKNOWN] {
            let doubt: TableDoubt = toml::from_str(text).unwrap();
            doubt.validate().unwrap();
            assert!(!doubt.is_certain());
        }
        for name in PRESETS {
            let table = Table::preset(name).unwrap();
            assert_eq!(TableDoubt::of(&table).is_certain(), JUDGED.contains(&name), "{name}");
        }
        let own = Table { name: "ours".into(), rail_restitution: 0.8, ..Table::default() };
        assert_eq!(TableDoubt::of(&own), toml::from_str(UNKNOWN).unwrap());
        let doubt = TableDoubt { deviations: [("mu_s".to_owned(), 0.01)].into(), correlations: Vec::new() };
        assert_eq!(TableDoubt::of(&Table { doubt: Some(doubt.clone()), ..own }), doubt);
    }

    #[test]
    fn drawn_tables_are_valid_and_have_the_deviations_and_correlations_of_the_doubt() {
        let table = Table::default();
        let doubt = TableDoubt::of(&table);
        let sampler = TableSampler::new(&table, &doubt, 1.0).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        // The sum of twelve uniform numbers is nearly normal.
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
    fn a_doubt_that_cannot_be_is_refused_by_name() {
        let doubt = |text: &str| toml::from_str::<TableDoubt>(text).unwrap().validate().unwrap_err().to_string();
        let said = doubt("deviations = { mu_x = 0.1 }");
        assert!(said.contains("mu_x") && said.contains("mu_rail"), "{said}");
        assert!(doubt("deviations = { mu_s = -0.1 }").contains("mu_s = -0.1"));
        assert!(doubt("deviations = { mu_s = nan }").contains("mu_s = NaN"));
        let pair = "deviations = { mu_s = 0.1, mu_r = 0.1 }\ncorrelations = [[\"mu_s\", \"mu_r\", ";
        assert!(doubt(&format!("{pair}1.5]]")).contains("mu_s"));
        assert!(doubt("deviations = { mu_s = 0.1 }\ncorrelations = [[\"mu_s\", \"c1\", 0.1]]").contains("c1"));
    }
}
