//! What networks may be told besides the layout: the table's constants and the player's errors.

use glam::DVec2;

use super::{
    action::ActionSpace,
    features::{ACTION_FEATURES, STATE_FEATURES},
    first_contact::RAIL_FEATURES,
};
use crate::table::{Rail, RailModel, Rails, Table};

/// Constants of a table that networks are told.
const CONSTANTS: usize = 12;

/// What errors are divided by before networks are told the logarithm, in multiples of an expert's: about a club player's errors. Networks
/// were trained with this number, so it stays when the levels of players change.
const USUAL_ERRORS: f64 = 3.7;

/// Numbers about a table and a player: the constants, which laws the table follows, the way it leans, and the errors.
pub const CONTEXT_FEATURES: usize = CONSTANTS + 2 + 2 + 2;

/// The lean that counts as one unit, m/s².
const LEAN: f64 = 0.003;

/// The furthest from `match` that networks have practised, in units: `textbook` is 2 away in its rolling friction.
const FURTHEST: f64 = 2.5;

/// What a network's input is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    pub space: ActionSpace,
    /// Whether the context is among it.
    pub context: bool,
    /// Whether of a stroke it has what follows in closed form up to the first ball, besides what is chosen.
    pub closed_form: bool,
    /// Whether ways to the first ball by a cushion are seen, too.
    pub rails_first: bool,
}

impl Inputs {
    /// Numbers about what is seen: inputs of the actor.
    pub const fn actor(self) -> usize {
        STATE_FEATURES
            + if self.context { CONTEXT_FEATURES } else { 0 }
            + if self.rails_first { Rail::ALL.len() } else { 0 }
    }

    /// Numbers about a stroke.
    pub const fn action(self) -> usize {
        ACTION_FEATURES + if self.rails_first { RAIL_FEATURES } else { 0 }
    }

    /// The same and those of a stroke: inputs of the critic.
    pub const fn critic(self) -> usize {
        self.actor() + self.action()
    }

    /// Changes whenever the features change: weights fit one version only.
    pub fn version(self) -> String {
        let Self { context, closed_form, rails_first, .. } = self;
        let further = [(context, "context-1"), (rails_first, "rails-1"), (!closed_form, "actions alone")];
        let further = further.into_iter().filter(|(has, _)| *has).map(|(_, name)| name);
        std::iter::once("final-course-1").chain(further).collect::<Vec<_>>().join(", ")
    }
}

/// Appends [`CONTEXT_FEATURES`] numbers of the order of one, for a table that is looked at in this mirror and a player whose
/// errors are so many times an expert's ([`scale`](crate::player::Skill::scale)), 0 for one who has none.
pub fn push_context(table: &Table, mirror: DVec2, errors: f64, out: &mut Vec<f32>) {
    let lean = mirror * table.tilt / LEAN;
    let laws = [table.rail.model == RailModel::Equator, table.flight.is_some()].map(|law| f64::from(u8::from(law)));
    let hand = if errors > 0.0 { [1.0, (errors / USUAL_ERRORS).ln()] } else { [0.0; 2] };
    let numbers = told(table).into_iter().chain(laws).chain([lean.x, lean.y]).chain(hand);
    out.extend(numbers.map(|number| number as f32));
}

/// The table's constants in units; 0 for one that its laws do not have. Beside each stands what it is on `match`, and by how much it
/// differs by one unit: twice what it differs by between tables of which nothing is known (`unknown_doubt.toml`).
fn told(table: &Table) -> [f64; CONSTANTS] {
    let rails = |own: fn(&Table, Rail) -> f64| Rail::ALL.into_iter().map(|rail| own(table, rail)).sum::<f64>() / 4.0;
    let constants = [
        (Some(rails(|table, rail| table.rail.own(rail).e.unwrap_or(table.rail_restitution))), 0.8505, 0.07),
        (Some(rails(|table, rail| table.rail.own(rail).mu.unwrap_or(table.rail_friction))), 0.3116, 0.12),
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

/// Whether networks with a context know tables like this one: `match` or `textbook` but for what they are told, and that not
/// further from `match` than what they have practised.
pub fn knows(table: &Table) -> bool {
    let is_near = told(table).into_iter().chain((table.tilt / LEAN).to_array()).all(|number| number.abs() <= FURTHEST);
    is_near
        && ["match", "textbook"]
            .into_iter()
            .filter_map(|name| Table::preset(name).ok())
            .any(|base| is_like(table, &base))
}

/// Whether a table differs from `base` in nothing but what networks are told.
fn is_like(table: &Table, base: &Table) -> bool {
    let untold = Table {
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
    untold == *base
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{TableDoubt, TableSampler};

    #[test]
    fn presets_and_drawn_tables_are_known_and_other_sizes_and_laws_are_not() {
        let table = Table::default();
        assert!(knows(&table) && knows(&Table::preset("textbook").unwrap()));
        assert!(!knows(&Table::preset("thesis").unwrap()));
        let mine = Table { name: "mine".into(), doubt: None, ..table.clone() };
        let sampler = TableSampler::new(&mine, &TableDoubt::of(&mine), 1.0).unwrap();
        for step in 0..20 {
            // Up to two standard deviations off in every constant at once.
            let drawn = sampler.draw(|| 0.2 * f64::from(step) - 2.0);
            assert!(knows(&drawn), "{drawn:?}");
        }
        assert!(knows(&Table { flight: None, ..mine.clone() }), "a table from before balls flew");
        assert!(!knows(&Table { length: 2.54, width: 1.27, ..mine.clone() }));
        assert!(!knows(&Table { rail_restitution: 0.6, ..mine.clone() }));
        assert!(!knows(&Table { rail: Rails { model: RailModel::Nose, ..mine.rail }, ..mine }));
    }

    #[test]
    fn what_is_told_of_match_is_nought_and_a_lean_turns_with_the_mirror() {
        let numbers = |table: &Table, mirror, errors| {
            let mut out = Vec::new();
            push_context(table, mirror, errors, &mut out);
            assert_eq!(out.len(), CONTEXT_FEATURES);
            out
        };
        let table = Table::default();
        let told = numbers(&table, DVec2::ONE, 0.0);
        assert!(told[..CONSTANTS].iter().all(|number| number.abs() < 0.05), "{told:?}");
        let leaning = Table { tilt: DVec2::new(0.003, -0.0015), ..table };
        let [one, other] = [DVec2::ONE, DVec2::new(-1.0, 1.0)].map(|mirror| numbers(&leaning, mirror, 3.7));
        assert_eq!((one[14], one[15]), (1.0, -0.5));
        assert_eq!((other[14], other[15]), (-1.0, -0.5));
        assert!(one[16] == 1.0 && one[17].abs() < 1e-6, "a club player: {one:?}");
    }
}
