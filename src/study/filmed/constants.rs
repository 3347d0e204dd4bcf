//! Fits a table's constants to the film, with uncertainties and correlations.

use glam::DVec2;
use serde::Serialize;

use super::{
    chains::{self, Chain},
    film::FilmedShot,
    motion::Motion,
};
use crate::{
    statistics::{fit, inverse},
    table::{Fade, RailModel, Rails, Table},
};

/// Number of fitted constants.
pub const COUNT: usize = 11;

/// Name of each constant in a table file, its prior (mean and standard deviation, from direct measurements on the film and from
/// the literature), and the step for finite differences.
const PRIORS: [(&str, f64, f64, f64); COUNT] = [
    ("e_rail", 0.874, 0.016, 1e-3),
    ("mu_rail", 0.25, 0.05, 2e-3),
    ("(height - R)/R", 0.185, 0.03, 2e-3),
    ("kappa", 1.1, 0.2, 1e-2),
    ("fade.slope", 0.02, 0.02, 2e-3),
    ("mu_r", 0.0057, 0.0003, 5e-5),
    ("c1", 0.016, 0.002, 1e-3),
    ("mu_sp", 0.0119, 0.001, 2e-4),
    ("tilt x", 0.0, 1.5e-3, 1e-4),
    ("tilt y", 0.0, 1.5e-3, 1e-4),
    ("mu_s", 0.205, 0.005, 1e-3),
];

/// Expected rms residual of a stretch of three to five rails, m. Larger residuals count less than proportionally.
const EXPECTED_RMS: f64 = 0.003;

/// Number of rounds. Each fits the constants with fixed initial motions of the stretches, then fits these motions again.
const ROUNDS: usize = 4;

/// The result of a fit.
#[derive(Clone, Debug, Serialize)]
pub struct Fitted {
    /// The model of the rails.
    pub model: RailModel,
    /// Number of stretches of the film in the fit.
    pub stretches: usize,
    /// Name, value and standard deviation of each constant.
    pub constants: Vec<Constant>,
    /// Correlation matrix by rows, in the same order.
    pub correlations: Vec<Vec<f64>>,
    /// The table with the fitted constants, the slight slope of the filmed table included.
    #[serde(skip)]
    pub table: Table,
}

/// A fitted constant.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Constant {
    /// Its name in a table file.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Half the width of the range that agrees with the film about as well, from the curvature of the fit and the prior. It is no exact
    /// standard deviation, because a stretch has one residual: the root mean square of its distances.
    pub deviation: f64,
}

/// Returns `table` with these constants and this model of the rails; no rail has constants of its own.
fn with(table: &Table, model: RailModel, values: &[f64; COUNT]) -> Table {
    let [e, mu, height, kappa, fade, roll, growth, spin, tilt_x, tilt_y, slide] = *values;
    let mut table = Table {
        rail_restitution: e.clamp(0.3, 1.0),
        rail_friction: mu.clamp(0.01, 1.0),
        rolling_friction: roll.clamp(1e-3, 0.05),
        rolling_growth: growth.clamp(0.0, 0.1),
        spinning_friction: spin.clamp(1e-3, 0.05),
        tilt: DVec2::new(tilt_x, tilt_y),
        sliding_friction: slide.clamp(0.1, 0.4),
        ..table.clone()
    };
    let above = if model == RailModel::Equator { 0.0 } else { height.clamp(0.0, 0.5) };
    table.rail = Rails {
        model,
        height: Some(table.radius * (1.0 + above)),
        kappa: (model == RailModel::Smooth).then_some(kappa.clamp(0.3, 2.0)),
        fade: Some(Fade { from: 2.5, slope: fade.clamp(0.0, 0.2), least: 0.6 }),
        ..Rails::default()
    };
    table
}

/// Fits the constants of cloth and rails to the filmed rail impacts. Balls, cue and sizes are those of `table`.
pub fn fit_constants(table: &Table, model: RailModel, film: &[FilmedShot]) -> Fitted {
    let stretches = chains::disjoint(table, film);
    let mut values = PRIORS.map(|(_, value, ..)| value);
    let begin = |table: &Table, stretch: &Chain, known: Option<Motion>| {
        let last = stretch.hits.len() - 1;
        let anew = stretch.fit(table, last, None);
        let on = known.map(|known| stretch.fit(table, last, Some(known)));
        on.filter(|on| on.1 <= anew.1).unwrap_or(anew).0
    };
    let first = with(table, model, &values);
    let mut motions: Vec<Motion> = stretches.iter().map(|stretch| begin(&first, stretch, None)).collect();
    let mut normal = Vec::new();
    for _ in 0..ROUNDS {
        let found = fit(values, PRIORS.map(|(.., step)| step), 6, &mut |values, out| {
            out.clear();
            let table = with(table, model, values);
            for (stretch, motion) in stretches.iter().zip(&motions) {
                let (_, squares) = stretch.fit(&table, stretch.hits.len() - 1, Some(*motion));
                let rms = (squares / stretch.samples.len() as f64).sqrt();
                out.push((rms / EXPECTED_RMS).asinh());
            }
            out.extend(values.iter().zip(PRIORS).map(|(value, (_, known, deviation, _))| (value - known) / deviation));
        });
        (values, normal) = (found.parameters, found.normal);
        let table = with(table, model, &values);
        for (stretch, motion) in stretches.iter().zip(&mut motions) {
            *motion = begin(&table, stretch, Some(*motion));
        }
    }
    let covariance = inverse(&normal).unwrap_or(vec![vec![f64::NAN; COUNT]; COUNT]);
    let deviation = |index: usize| covariance[index][index].sqrt();
    let constants = (0..COUNT).map(|i| Constant { name: PRIORS[i].0, value: values[i], deviation: deviation(i) });
    let correlations =
        (0..COUNT).map(|i| (0..COUNT).map(|j| covariance[i][j] / (deviation(i) * deviation(j))).collect());
    Fitted {
        model,
        stretches: stretches.len(),
        constants: constants.collect(),
        correlations: correlations.collect(),
        table: with(table, model, &values),
    }
}
