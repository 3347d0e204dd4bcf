//! Models that a table may choose: a slope, and other laws of a cushion than those of the bundled tables.

use glam::DVec2;

use super::{Case, CaseKind, THESIS_PRESETS, variant};
use crate::{
    study::stability::random,
    table::{RailModel, Table, steepest_tilt},
};

pub const CASES: &[Case] = &[
    Case::new("random shots on the steepest accepted slope", on_a_slope, random::shot)
        .with_requirement("energies are not audited: on a slope, free motion is only right to the first order")
        .of_kind(CaseKind::Adversarial),
    Case::new("random shots, rails at the height of the centre or of the nose", simple_rails, random::shot)
        .of_kind(CaseKind::Adversarial),
    Case::new("random shots, rails by Mathavan", integrated_rails, random::shot)
        .with_requirement("impacts on these rails must not gain energy; their losses are not audited")
        .of_kind(CaseKind::Adversarial),
];

/// Direction of the slope, rad: along no axis of the table.
const DOWNHILL: f64 = 0.7;

fn on_a_slope() -> Vec<Table> {
    // Slightly less than the limit, which rounding would exceed.
    let lean = |table: &mut Table| table.tilt = (1.0 - 1e-9) * steepest_tilt(table) * DVec2::from_angle(DOWNHILL);
    THESIS_PRESETS.iter().chain(&["match"]).filter_map(|name| variant(name, "steepest slope", lean)).collect()
}

/// Returns the table `match` with another rail model, with balls that fly and with balls that stay on the cloth.
fn rails(model: RailModel) -> Vec<Table> {
    let with = |what: &str, change: fn(&mut Table)| {
        variant("match", &format!("rail model {model:?}{what}"), |table| {
            table.rail.model = model;
            change(table);
        })
    };
    [with("", |_| ()), with(", no flight", |table| table.flight = None)].into_iter().flatten().collect()
}

fn simple_rails() -> Vec<Table> {
    [rails(RailModel::Equator), rails(RailModel::Nose)].concat()
}

fn integrated_rails() -> Vec<Table> {
    rails(RailModel::Mathavan)
}
