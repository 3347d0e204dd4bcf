//! Uncertainty of a table: standard deviations and correlations of its constants, and alternative rail models.

use std::{collections::BTreeMap, sync::LazyLock};

use serde::{Deserialize, Serialize};

use super::{Rail, RailModel, RailOverrides, THESIS_PRESETS, Table, flaws::max_sliding_friction};
use crate::statistics::cholesky;

const MATCH: &str = include_str!("match_doubt.toml");
const UNKNOWN: &str = include_str!("unknown_doubt.toml");

/// Uncertainty of a table's constants: the TOML section `[doubt]`. The constants are normally distributed around the table's own values. A
/// constant that is not listed is certain.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableDoubt {
    /// Standard deviation by the name of the constant (`mu_s`, `rail.height`, …), in the units of the table's file.
    #[serde(default)]
    pub deviations: BTreeMap<String, f64>,
    /// Correlations of pairs of constants; 0 for pairs that are not listed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correlations: Vec<(String, String, f64)>,
    /// Rail models that the real rails may follow instead of the table's own model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub laws: Vec<AlternativeLaw>,
}

/// A rail model that the real rails may follow instead of the table's own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlternativeLaw {
    /// The model.
    pub model: RailModel,
    /// Probability of this model. The table's own model has the rest, up to a total of 1.
    pub weight: f64,
    /// Constants with which this model fits the known data of the table best. Constants that are not listed keep the table's own values.
    #[serde(default)]
    pub values: BTreeMap<String, f64>,
    /// Standard deviations that replace those of the table's own model. Constants that are not listed keep those.
    #[serde(default)]
    pub deviations: BTreeMap<String, f64>,
    /// Correlations; those of the table's own model do not apply.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correlations: Vec<(String, String, f64)>,
}

/// Smallest share of a constant's variance that the other constants must leave unexplained. Below it, the correlation matrix is not
/// accepted as positive definite.
const MIN_UNEXPLAINED: f64 = 1e-9;

/// A constant of a table that can be uncertain.
#[derive(Debug)]
pub(super) struct Constant {
    pub(super) name: &'static str,
    pub(super) get: fn(&Table) -> Option<f64>,
    set: fn(&mut Table, f64),
    /// Smallest and largest value that a draw can have.
    limits: (f64, f64),
}

/// Limits of one component of the tilt, m/s². Callers that draw or fit a tilt also keep it below the steepest slope that the table accepts.
const TILT_LIMITS: (f64, f64) = (-1.0, 1.0);

/// All constants that can be uncertain. A constant that a table's models do not have is skipped. A sampler draws them in this order, so
/// that new ones must be appended at the end.
pub(super) const CONSTANTS: [Constant; 22] = [
    constant("e_rail", |table| Some(table.rail_restitution), |table, value| table.rail_restitution = value, (0.0, 1.0)),
    constant("mu_rail", |table| Some(table.rail_friction), |table, value| table.rail_friction = value, (0.0, 0.99)),
    constant(
        "rail.height",
        |table| table.rail.height.filter(|_| table.rail.model != RailModel::Equator),
        |table, value| table.rail.height = Some(value.clamp(table.radius, 1.6 * table.radius)),
        (0.0, f64::MAX),
    ),
    constant("rail.kappa", |table| table.rail.kappa, |table, value| table.rail.kappa = Some(value), (0.05, 2.0)),
    constant(
        "rail.fade.slope",
        |table| table.rail.fade.map(|fade| fade.slope),
        |table, value| {
            if let Some(fade) = &mut table.rail.fade {
                fade.slope = value;
            }
        },
        (0.0, 10.0),
    ),
    constant(
        "mu_s",
        |table| Some(table.sliding_friction),
        |table, value| table.sliding_friction = value.min(max_sliding_friction(table.rail.model)),
        (0.01, 1e3),
    ),
    constant("mu_r", |table| Some(table.rolling_friction), |table, value| table.rolling_friction = value, (1e-3, 1e3)),
    constant("c1", |table| Some(table.rolling_growth), |table, value| table.rolling_growth = value, (0.0, 1.0)),
    constant(
        "mu_sp",
        |table| Some(table.spinning_friction),
        |table, value| table.spinning_friction = value,
        (0.0, 1e3),
    ),
    constant("tilt.x", |table| Some(table.tilt.x), |table, value| table.tilt.x = value, TILT_LIMITS),
    constant("tilt.y", |table| Some(table.tilt.y), |table, value| table.tilt.y = value, TILT_LIMITS),
    constant("e_ball", |table| Some(table.ball_restitution), |table, value| table.ball_restitution = value, (0.0, 1.0)),
    constant(
        "mu_b",
        |table| table.ball_slip_friction.map(|law| law.least + law.rise).or(table.ball_friction),
        |table, value| {
            table.ball_friction = Some(value);
            if let Some(law) = &mut table.ball_slip_friction {
                law.rise = (value - law.least).max(0.0);
            }
        },
        (0.0, 0.99),
    ),
    constant(
        "m_end",
        |table| table.cue_end_mass,
        |table, value| table.cue_end_mass = Some(value.min(table.cue_mass)),
        (1e-4, f64::MAX),
    ),
    single_rail::<0, false>("rail.left.e"),
    single_rail::<1, false>("rail.right.e"),
    single_rail::<2, false>("rail.bottom.e"),
    single_rail::<3, false>("rail.top.e"),
    single_rail::<0, true>("rail.left.mu"),
    single_rail::<1, true>("rail.right.mu"),
    single_rail::<2, true>("rail.bottom.mu"),
    single_rail::<3, true>("rail.top.mu"),
];

const fn constant(
    name: &'static str,
    get: fn(&Table) -> Option<f64>,
    set: fn(&mut Table, f64),
    limits: (f64, f64),
) -> Constant {
    Constant { name, get, set, limits }
}

/// Returns the constant for the friction or the restitution of one single rail; `RAIL` is its index in [`Rail::ALL`].
const fn single_rail<const RAIL: usize, const FRICTION: bool>(name: &'static str) -> Constant {
    const fn field<const FRICTION: bool>(own: &mut RailOverrides) -> &mut Option<f64> {
        if FRICTION { &mut own.mu } else { &mut own.e }
    }
    constant(
        name,
        |table| *field::<FRICTION>(&mut table.rail.overrides(Rail::ALL[RAIL])),
        |table, value| {
            let own = table.rail.overrides_mut(Rail::ALL[RAIL]).get_or_insert_default();
            *field::<FRICTION>(own) = Some(value);
        },
        (0.0, if FRICTION { 0.99 } else { 1.0 }),
    )
}

/// Why a `[doubt]` section is refused.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum DoubtError {
    /// The name of no known constant.
    #[error("the doubt names \"{0}\", which is not one of the constants; accepted are {accepted}", accepted = names())]
    Unknown(String),
    /// A negative or infinite standard deviation, or NaN.
    #[error("the doubt has {0} = {1}; accepted is a standard deviation of 0 or more in the unit of the table's file")]
    Deviation(String, f64),
    /// A value that the constant cannot have: the assignment and the accepted range, both as text.
    #[error("the doubt has {0} for another rail law; accepted are numbers {1}")]
    Value(String, String),
    /// The total weight of the alternative rail models. A weight is negative, or the total is not below 1.
    #[error("the weights of the rail laws in the doubt add up to {0}; accepted are weights from 0 with a sum below 1")]
    Weight(f64),
    /// Correlations that do not form a positive definite matrix.
    #[error("the correlations of the doubt contradict each other at \"{0}\"; accepted is a positive definite matrix")]
    Correlations(String),
}

fn names() -> String {
    CONSTANTS.map(|constant| constant.name).join(", ")
}

impl TableDoubt {
    /// Returns the uncertainty of `table`. If its file has a `[doubt]` section, that is used. Otherwise it is what the fit to the filmed
    /// shots leaves open for `match`, no uncertainty for the tables of the thesis' equations, and the spread among real tables for any
    /// other table.
    pub fn of(table: &Table) -> Self {
        // Parsed once, because the coach needs it for every query. A test parses all of them.
        static KNOWN: LazyLock<Vec<(Table, TableDoubt)>> = LazyLock::new(|| {
            let judged =
                THESIS_PRESETS.iter().filter_map(|name| Some((Table::preset(name).ok()?, TableDoubt::default())));
            judged.chain([(Table::default(), toml::from_str(MATCH).unwrap_or_default())]).collect()
        });
        static OTHER: LazyLock<TableDoubt> = LazyLock::new(|| toml::from_str(UNKNOWN).unwrap_or_default());
        let known = || KNOWN.iter().find(|(known, _)| known == table).map(|(_, doubt)| doubt);
        table.doubt.as_ref().or_else(known).unwrap_or(&OTHER).clone()
    }

    /// Returns the value of a constant; `None` if the table's models do not have it or the name is unknown.
    pub fn value(table: &Table, name: &str) -> Option<f64> {
        Constant::named(name).and_then(|constant| (constant.get)(table))
    }

    /// Returns `table` with a new value of a constant, clamped to its limits; unchanged if the table's models do not have it.
    #[must_use]
    pub fn with_value(table: &Table, name: &str, value: f64) -> Table {
        let mut table = table.clone();
        if let Some(constant) = Constant::named(name) {
            constant.change(&mut table, value);
        }
        table
    }

    /// Whether no constant and no rail model is uncertain.
    pub fn is_certain(&self) -> bool {
        self.laws.is_empty() && self.deviations.values().all(|deviation| *deviation == 0.0)
    }

    /// Returns the same uncertainty with the constants that `is_known` accepts made certain.
    #[must_use]
    pub fn without(&self, is_known: impl Fn(&str) -> bool) -> Self {
        let mut doubt = self.clone();
        let strip = |deviations: &mut BTreeMap<String, f64>, correlations: &mut Vec<(String, String, f64)>| {
            deviations.retain(|name, _| !is_known(name));
            correlations.retain(|(one, other, _)| !is_known(one) && !is_known(other));
        };
        strip(&mut doubt.deviations, &mut doubt.correlations);
        doubt.laws.iter_mut().for_each(|law| strip(&mut law.deviations, &mut law.correlations));
        doubt
    }

    /// Returns `table` with the alternative rail model `law`, and the uncertainty of that table's constants.
    pub(super) fn with_model(&self, law: &AlternativeLaw, table: &Table) -> (Table, Self) {
        let mut other = table.clone();
        other.rail.model = law.model;
        other.sliding_friction = table.sliding_friction.min(max_sliding_friction(law.model));
        other.rail.kappa = table.rail.kappa.filter(|_| law.model == RailModel::Smooth);
        for constant in &CONSTANTS {
            if let Some(value) = law.values.get(constant.name) {
                // The alternative model may have a constant that the table's own model lacks.
                constant.assign(&mut other, *value);
            }
        }
        (other, self.under(law))
    }

    /// Returns the uncertainty of the constants of a table with the alternative rail model `law`.
    fn under(&self, law: &AlternativeLaw) -> Self {
        let mut deviations = self.deviations.clone();
        deviations.extend(law.deviations.clone());
        Self { deviations, correlations: law.correlations.clone(), laws: Vec::new() }
    }

    /// Checks every name and number.
    ///
    /// # Errors
    /// The first name or number that is not accepted.
    pub fn validate(&self) -> Result<(), DoubtError> {
        let unknown = |name: &&String| Constant::named(name).is_none();
        let values = self.laws.iter().flat_map(|law| law.values.keys());
        if let Some(name) = self.deviations.keys().chain(values).find(unknown) {
            return Err(DoubtError::Unknown(name.clone()));
        }
        if let Some((name, deviation)) =
            self.deviations.iter().find(|(_, value)| !(0.0..f64::INFINITY).contains(*value))
        {
            return Err(DoubtError::Deviation(name.clone(), *deviation));
        }
        for (one, other, _) in &self.correlations {
            if let Some(name) = [one, other].into_iter().find(|name| !self.deviations.contains_key(*name)) {
                return Err(DoubtError::Correlations(name.clone()));
            }
        }
        let names: Vec<&str> = self.deviations.keys().map(String::as_str).collect();
        self.factor(&names)?;
        let others: f64 = self.laws.iter().map(|law| law.weight).sum();
        if !(0.0..1.0).contains(&others) || self.laws.iter().any(|law| law.weight < 0.0) {
            return Err(DoubtError::Weight(others));
        }
        self.laws.iter().try_for_each(|law| {
            for (name, value) in &law.values {
                let (low, high) = Constant::named(name).map_or((f64::MIN, f64::MAX), |constant| constant.limits);
                if !(low..=high).contains(value) {
                    let accepted =
                        if high < f64::MAX { format!("from {low} to {high}") } else { format!("from {low} on") };
                    return Err(DoubtError::Value(format!("{name} = {value}"), accepted));
                }
            }
            self.under(law).validate()
        })
    }

    /// Returns the lower triangular Cholesky factor `L` of the covariance matrix `L Lᵀ` of these constants, row by row.
    ///
    /// # Errors
    /// Fails if the correlation matrix is not positive definite.
    pub fn factor(&self, names: &[&str]) -> Result<Vec<Vec<f64>>, DoubtError> {
        let correlation = |row: usize, column: usize| {
            let (row, column) = (names[row], names[column]);
            let is_named = |(one, other, _): &&(String, String, f64)| {
                (one == row && other == column) || (one == column && other == row)
            };
            self.correlations.iter().find(is_named).map_or(0.0, |(.., value)| *value)
        };
        let entry = |row: usize, column: usize| if row == column { 1.0 } else { correlation(row, column) };
        let line = |row: usize| (0..names.len()).map(|column| entry(row, column)).collect();
        let matrix: Vec<Vec<f64>> = (0..names.len()).map(line).collect();
        let mut factor =
            cholesky(&matrix, MIN_UNEXPLAINED).map_err(|row| DoubtError::Correlations(names[row].to_owned()))?;
        for (line, name) in factor.iter_mut().zip(names) {
            for entry in line {
                *entry *= self.deviations[*name];
            }
        }
        Ok(factor)
    }
}

impl Constant {
    fn named(name: &str) -> Option<&'static Self> {
        CONSTANTS.iter().find(|constant| constant.name == name)
    }

    /// Sets the constant to `value`, clamped to the limits. Does nothing if the table's models do not have the constant.
    pub(super) fn change(&self, table: &mut Table, value: f64) {
        if (self.get)(table).is_some() {
            self.assign(table, value);
        }
    }

    /// Sets the constant to `value`, clamped to the limits. If the table's present value lies outside them, the range extends to that
    /// value.
    fn assign(&self, table: &mut Table, value: f64) {
        let own = (self.get)(table).unwrap_or(value);
        (self.set)(table, value.clamp(self.limits.0.min(own), self.limits.1.max(own)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::PRESETS;

    #[test]
    fn every_table_has_a_doubt_that_can_be_drawn_from() {
        for text in [MATCH, UNKNOWN] {
            let doubt: TableDoubt = toml::from_str(text).unwrap();
            doubt.validate().unwrap();
            assert!(!doubt.is_certain());
        }
        for name in PRESETS {
            let table = Table::preset(name).unwrap();
            assert_eq!(TableDoubt::of(&table).is_certain(), THESIS_PRESETS.contains(&name), "{name}");
        }
        let own = Table { name: "ours".into(), rail_restitution: 0.8, ..Table::default() };
        assert_eq!(TableDoubt::of(&own), toml::from_str(UNKNOWN).unwrap());
        let doubt = TableDoubt { deviations: [("mu_s".to_owned(), 0.01)].into(), ..TableDoubt::default() };
        assert_eq!(TableDoubt::of(&Table { doubt: Some(doubt.clone()), ..own }), doubt);
    }

    #[test]
    fn an_invalid_doubt_is_refused_by_name() {
        let doubt = |text: &str| toml::from_str::<TableDoubt>(text).unwrap().validate().unwrap_err().to_string();
        let message = doubt("deviations = { mu_x = 0.1 }");
        assert!(message.contains("mu_x") && message.contains("mu_rail"), "{message}");
        assert!(doubt("deviations = { mu_s = -0.1 }").contains("mu_s = -0.1"));
        assert!(doubt("deviations = { mu_s = nan }").contains("mu_s = NaN"));
        let pair = "deviations = { mu_s = 0.1, mu_r = 0.1 }\ncorrelations = [[\"mu_s\", \"mu_r\", ";
        assert!(doubt(&format!("{pair}1.5]]")).contains("mu_s"));
        assert!(doubt("deviations = { mu_s = 0.1 }\ncorrelations = [[\"mu_s\", \"c1\", 0.1]]").contains("c1"));
        let law = |rest: &str| doubt(&format!("[deviations]\nmu_s = 0.1\n[[laws]]\nmodel = \"nose\"\n{rest}"));
        assert!(law("weight = 1.5").contains("1.5") && law("weight = -0.1").contains("-0.1"));
        assert!(law("weight = 0.5\nvalues = { mu_x = 0.1 }").contains("mu_x"));
        assert!(law("weight = 0.5\ndeviations = { mu_r = -1 }").contains("mu_r = -1"));
        assert!(law("weight = 0.5\nvalues = { e_rail = inf }").contains("e_rail = inf"));
        assert!(law("weight = 0.5\nvalues = { e_rail = 5.0 }").contains("accepted are numbers from 0 to 1"));
        assert!(law("weight = 0.5\nvalues = { mu_r = -3 }").contains("accepted are numbers from 0."));
    }

    #[test]
    fn alternative_law_has_constants_that_the_table_lacks() {
        let mut table = Table::default();
        (table.rail.model, table.rail.kappa) = (RailModel::Nose, None);
        let text = "[[laws]]\nmodel = \"smooth\"\nweight = 0.5\nvalues = { \"rail.kappa\" = 1.2 }";
        let doubt: TableDoubt = toml::from_str(text).unwrap();
        assert_eq!(doubt.with_model(&doubt.laws[0], &table).0.rail.kappa, Some(1.2));
    }
}
