//! Fitting a table's constants to the film, with their uncertainties and correlations.

use glam::DVec2;
use serde::Serialize;

use super::{
    chains::{self, Chain},
    film::FilmedShot,
    motion::Motion,
};
use crate::{
    statistics::{fit, inverse},
    table::{Fade, RailModel, Table},
};

/// How many constants are fitted.
pub const COUNT: usize = 11;

/// Each constant's name in a table's file, what is known of it without this fit (a value and its standard deviation, from
/// direct measurements on the film and from the literature), and the step for derivatives.
const KNOWN: [(&str, f64, f64, f64); COUNT] = [
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

/// What a stretch of three to five rails is expected to be off by, m: how far a residual counts fully.
const EXPECTED: f64 = 0.003;

/// Rounds in which the constants are fitted for given beginnings of the stretches, and those sought anew.
const ROUNDS: usize = 4;

/// Constants that were fitted.
#[derive(Clone, Debug, Serialize)]
pub struct Fitted {
    /// The rail's model.
    pub model: RailModel,
    /// Stretches of the film that were used.
    pub stretches: usize,
    /// Name, value and standard deviation of each.
    pub constants: Vec<Constant>,
    /// Their correlations, rows one after another in the same order.
    pub correlations: Vec<Vec<f64>>,
    /// The table with these constants.
    #[serde(skip)]
    pub table: Table,
}

/// One of them.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Constant {
    /// As in the table's file.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Standard deviation, from the fit and from what was known before.
    pub deviation: f64,
}

/// `table` with these constants on rails of this model.
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
    table.rail.model = model;
    table.rail.height =
        Some(table.radius * (1.0 + if model == RailModel::Equator { 0.0 } else { height.clamp(0.0, 0.5) }));
    table.rail.kappa = (model == RailModel::Smooth).then_some(kappa.clamp(0.3, 2.0));
    table.rail.fade = Some(Fade { from: 2.5, slope: fade.clamp(0.0, 0.2), least: 0.6 });
    table
}

/// Fits the constants of cloth and rails to the rails that the film's balls met; balls, cue and sizes are `table`'s.
pub fn fit_constants(table: &Table, model: RailModel, film: &[FilmedShot]) -> Fitted {
    let stretches = chains::apart(table, film);
    let mut values = KNOWN.map(|(_, value, ..)| value);
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
        let found = fit(values, KNOWN.map(|(.., step)| step), 6, &mut |values, out| {
            out.clear();
            let table = with(table, model, values);
            for (stretch, motion) in stretches.iter().zip(&motions) {
                let (_, squares) = stretch.fit(&table, stretch.hits.len() - 1, Some(*motion));
                let rms = (squares / stretch.samples.len() as f64).sqrt();
                out.push((rms / EXPECTED).asinh());
            }
            out.extend(values.iter().zip(KNOWN).map(|(value, (_, known, deviation, _))| (value - known) / deviation));
        });
        (values, normal) = (found.parameters, found.normal);
        let table = with(table, model, &values);
        for (stretch, motion) in stretches.iter().zip(&mut motions) {
            *motion = begin(&table, stretch, Some(*motion));
        }
    }
    let covariance = inverse(&normal).unwrap_or(vec![vec![f64::NAN; COUNT]; COUNT]);
    let deviation = |index: usize| covariance[index][index].sqrt();
    let constants = (0..COUNT).map(|i| Constant { name: KNOWN[i].0, value: values[i], deviation: deviation(i) });
    let correlations =
        (0..COUNT).map(|i| (0..COUNT).map(|j| covariance[i][j] / (deviation(i) * deviation(j))).collect());
    Fitted {
        model,
        stretches: stretches.len(),
        constants: constants.collect(),
        correlations: correlations.collect(),
        // The film's table leans a little its own way: another one does not.
        table: Table { tilt: DVec2::ZERO, ..with(table, model, &values) },
    }
}
