//! The context, an optional input of the networks: the table's constants and the player's errors.

use glam::DVec2;

use super::{
    action::ActionSpace,
    features::{ACTION_FEATURES, STATE_FEATURES},
    first_contact::RAIL_FEATURES,
};
use crate::table::{Rail, RailModel, Rails, Table};

/// Number of the table's constants in the context.
const CONSTANTS: usize = 12;

/// Errors, in multiples of an expert's, that are the unit of the errors in the context (their logarithm is the feature). About a club
/// player's errors. Networks were trained with this value, so it must stay even if the levels of players change.
const REFERENCE_ERRORS: f64 = 3.7;

/// Numbers in the context: the constants, the table's laws, its tilt, and the player's errors.
pub const CONTEXT_FEATURES: usize = CONSTANTS + 2 + 2 + 2;

/// Tilt that counts as one unit, m/s².
const TILT_UNIT: f64 = 0.003;

/// Largest deviation from `match` in training, in units: `textbook` deviates by 2 in its rolling friction.
const MAX_DEVIATION: f64 = 2.5;

/// Selection of the networks' inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    pub space: ActionSpace,
    /// Whether the inputs include the context.
    pub context: bool,
    /// Whether the inputs include the consequences of an action up to the first ball, in closed form, in addition to the action itself.
    pub closed_form: bool,
    /// Whether the observations include paths to the first ball by a cushion.
    pub rails_first: bool,
}

impl Inputs {
    /// Number of the actor's inputs: the features of an observation.
    pub const fn actor(self) -> usize {
        STATE_FEATURES
            + if self.context { CONTEXT_FEATURES } else { 0 }
            + if self.rails_first { Rail::ALL.len() } else { 0 }
    }

    /// Number of the features of a stroke.
    pub const fn action(self) -> usize {
        ACTION_FEATURES + if self.rails_first { RAIL_FEATURES } else { 0 }
    }

    /// Number of the critic's inputs: the features of an observation and of a stroke.
    pub const fn critic(self) -> usize {
        self.actor() + self.action()
    }

    /// Returns the version of the features, which changes whenever they change: weights are valid for one version only.
    pub fn version(self) -> String {
        let Self { context, closed_form, rails_first, .. } = self;
        let further = [(context, "context-1"), (rails_first, "rails-1"), (!closed_form, "actions alone")];
        let further = further.into_iter().filter(|(has, _)| *has).map(|(_, name)| name);
        std::iter::once("final-course-1").chain(further).collect::<Vec<_>>().join(", ")
    }
}

/// Appends the context: [`CONTEXT_FEATURES`] numbers of the order of one. `mirror` is that of the observation; `errors` are the player's
/// as a multiple of an expert's ([`scale`](crate::player::Skill::scale)), 0 for a player without errors.
pub fn push_context(table: &Table, mirror: DVec2, errors: f64, out: &mut Vec<f32>) {
    let tilt = mirror * table.tilt / TILT_UNIT;
    let laws = [table.rail.model == RailModel::Equator, table.flight.is_some()].map(|law| f64::from(u8::from(law)));
    let player = if errors > 0.0 { [1.0, (errors / REFERENCE_ERRORS).ln()] } else { [0.0; 2] };
    let numbers = scaled_constants(table).into_iter().chain(laws).chain([tilt.x, tilt.y]).chain(player);
    out.extend(numbers.map(|number| number as f32));
}

/// Returns the table's constants as deviations from `match` in units; 0 for a constant that the table's laws do not use. Each row
/// contains the value, that of `match`, and the unit: twice the standard deviation among unknown tables (`unknown_doubt.toml`).
fn scaled_constants(table: &Table) -> [f64; CONSTANTS] {
    let rails = |own: fn(&Table, Rail) -> f64| Rail::ALL.into_iter().map(|rail| own(table, rail)).sum::<f64>() / 4.0;
    let constants = [
        (Some(rails(|table, rail| table.rail.overrides(rail).e.unwrap_or(table.rail_restitution))), 0.8505, 0.07),
        (Some(rails(Table::friction_of)), 0.3116, 0.12),
        (table.rail.height.filter(|_| table.rail.model != RailModel::Equator), 0.03736, 0.0036),
        (table.rail.kappa, 1.267, 0.36),
        (table.rail.fade.map(|fade| fade.slope), 0.02, 0.09),
        (Some(table.sliding_friction), 0.203, 0.04),
        (Some(table.rolling_friction), 0.00518, 0.0024),
        (Some(table.rolling_growth), 0.0155, 0.008),
        (Some(table.spinning_friction), 0.0078, 0.003),
        (Some(table.ball_restitution), 0.95, 0.04),
        (table.ball_slip_friction.map(|law| law.least + law.rise).or(table.ball_friction), 0.118, 0.06),
        (table.cue_end_mass, 0.005, 0.003),
    ];
    constants.map(|(value, usual, unit)| value.map_or(0.0, |value| (value - usual) / unit))
}

/// Whether networks with a context are trained for tables like this one: it differs from `match` or `textbook` only in what the context
/// describes, and by no more than in training.
pub fn is_known_table(table: &Table) -> bool {
    let mut numbers = scaled_constants(table).into_iter().chain((table.tilt / TILT_UNIT).to_array());
    numbers.all(|number| number.abs() <= MAX_DEVIATION)
        && ["match", "textbook"].iter().any(|name| Table::preset(name).is_ok_and(|base| is_like(table, &base)))
}

/// Whether a table differs from `base` only in what the context describes.
fn is_like(table: &Table, base: &Table) -> bool {
    let without_context = Table {
        name: base.name.clone(),
        sliding_friction: base.sliding_friction,
        rolling_friction: base.rolling_friction,
        rolling_growth: base.rolling_growth,
        spinning_friction: base.spinning_friction,
        ball_restitution: base.ball_restitution,
        ball_friction: base.ball_friction,
        ball_slip_friction: table.ball_slip_friction.and(base.ball_slip_friction),
        rail_restitution: base.rail_restitution,
        rail_friction: base.rail_friction,
        cue_end_mass: base.cue_end_mass,
        tilt: base.tilt,
        opening: base.opening,
        opening_offset: base.opening_offset,
        flight: table.flight.or(base.flight),
        rail: Rails { model: table.rail.model, ..base.rail },
        doubt: None,
        ..table.clone()
    };
    without_context == *base
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{TableDoubt, TableSampler};

    #[test]
    fn only_presets_and_similar_tables_are_known() {
        let table = Table::default();
        assert!(is_known_table(&table) && is_known_table(&Table::preset("textbook").unwrap()));
        assert!(!is_known_table(&Table::preset("thesis").unwrap()));
        let mine = Table { name: "mine".into(), doubt: None, ..table.clone() };
        let sampler = TableSampler::new(&mine, &TableDoubt::of(&mine), 1.0).unwrap();
        for step in 0..20 {
            // Every constant is off by up to two standard deviations at the same time.
            let drawn = sampler.draw(|| 0.2 * f64::from(step) - 2.0);
            assert!(is_known_table(&drawn), "{drawn:?}");
        }
        assert!(
            is_known_table(&Table { flight: None, ..mine.clone() }),
            "a table that was saved before balls could fly"
        );
        assert!(!is_known_table(&Table { length: 2.54, width: 1.27, ..mine.clone() }));
        assert!(!is_known_table(&Table { rail_restitution: 0.6, ..mine.clone() }));
        assert!(!is_known_table(&Table { rail: Rails { model: RailModel::Nose, ..mine.rail }, ..mine }));
    }

    #[test]
    fn the_match_context_is_zero_and_tilts_are_mirrored() {
        let numbers = |table: &Table, mirror, errors| {
            let mut out = Vec::new();
            push_context(table, mirror, errors, &mut out);
            assert_eq!(out.len(), CONTEXT_FEATURES);
            out
        };
        let table = Table::default();
        let context = numbers(&table, DVec2::ONE, 0.0);
        assert!(context[..CONSTANTS].iter().all(|number| number.abs() < 0.05), "{context:?}");
        let tilted = Table { tilt: DVec2::new(0.003, -0.0015), ..table };
        let [one, other] = [DVec2::ONE, DVec2::new(-1.0, 1.0)].map(|mirror| numbers(&tilted, mirror, 3.7));
        assert_eq!((one[14], one[15]), (1.0, -0.5));
        assert_eq!((other[14], other[15]), (-1.0, -0.5));
        assert!(one[16] == 1.0 && one[17].abs() < 1e-6, "a club player: {one:?}");
    }
}
