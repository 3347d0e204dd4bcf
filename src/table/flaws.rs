//! Validation of the constants of a table's models.

use super::{Rail, RailModel, Table, models::Fade};

/// Steepest accepted slope, as a share of `mu_r g` and of `mu_s g`. At `mu_r g` balls would start to roll by themselves; the limit of
/// `mu_s g` keeps slides far from an endless one.
const MAX_TILT_SHARE: f64 = 0.2;

/// Whether `value` is an acceptable coefficient of friction of a cushion or between two balls.
///
/// Consider a ball that the cloth does not let slip, with a push `N` on its side and vertical friction `f` at that contact. They act like
/// `5/7 (N ± f)`: from `f = N` on, friction presses the contact together more strongly than the push separates it. Contact forces that obey
/// all laws are then not unique or do not exist (Painlevé's paradox, 1895).
pub(super) fn is_accepted_friction(value: f64) -> bool {
    (0.0..1.0).contains(&value)
}

/// The values that [`is_accepted_friction`] accepts, for error messages.
pub(super) const ACCEPTED_FRICTION: &str = "0 to below 1, where the forces of a contact are unique";

/// Returns the largest `mu_s` that is accepted with this rail model. From 0.9 on, the few integration steps of Mathavan's model would let a
/// ball gain energy at a rail with the largest restitution and friction.
pub const fn max_sliding_friction(model: RailModel) -> f64 {
    if matches!(model, RailModel::Mathavan) { 0.8 } else { f64::INFINITY }
}

/// Returns the steepest accepted slope, m/s².
pub fn steepest_tilt(table: &Table) -> f64 {
    MAX_TILT_SHARE * table.rolling_friction.min(table.sliding_friction) * table.gravity
}

/// TOML keys of the constants that a single rail can override.
const OVERRIDES: [(Rail, [&str; 3]); 4] = [
    (Rail::Left, ["rail.left.e", "rail.left.mu", "rail.left.height"]),
    (Rail::Right, ["rail.right.e", "rail.right.mu", "rail.right.height"]),
    (Rail::Bottom, ["rail.bottom.e", "rail.bottom.mu", "rail.bottom.height"]),
    (Rail::Top, ["rail.top.e", "rail.top.mu", "rail.top.height"]),
];

/// A check of a value: its TOML key, the value, whether it is accepted, and what would be accepted.
pub(super) type Check = (&'static str, f64, bool, &'static str);

/// Checks the constants of the models.
pub(super) fn checks(table: &Table) -> Vec<Check> {
    let Table { rail, radius, .. } = table;
    let restitution = |value: f64| (0.0..=1.0).contains(&value);
    let fade = |fade: &Fade| {
        let Fade { from, slope, least } = *fade;
        (0.0..=100.0).contains(&from) && (0.0..=10.0).contains(&slope) && restitution(least)
    };
    // The nose touches the ball between the equator and a height well below the ball's top.
    let height = |value: f64| (*radius..=1.6 * *radius).contains(&value);
    let mut checks = vec![
        (
            "mu_s",
            table.sliding_friction,
            table.sliding_friction <= max_sliding_friction(rail.model),
            "0.0001 to 0.8 with the rail model mathavan",
        ),
        ("c1", table.rolling_growth, (0.0..=1.0).contains(&table.rolling_growth), "0 to 1 per second"),
        (
            "tilt",
            table.tilt.length(),
            // Trajectories on a slope are correct to first order in the slope: at this limit to 0.2 % of the path length.
            table.tilt.length() <= steepest_tilt(table),
            "at most a fifth of mu_r g and of mu_s g in m/s²; a table that slopes by 1 mm a metre has 0.0098",
        ),
    ];
    if let Some(kappa) = rail.kappa {
        checks.push(("rail.kappa", kappa, kappa > 0.0 && kappa <= 2.0, "above 0 and at most 2"));
    }
    if let Some(value) = rail.height {
        checks.push(("rail.height", value, height(value), "from R to 1.6 R, in metres"));
    }
    for (which, [e, mu, high]) in OVERRIDES {
        let own = rail.overrides(which);
        checks.extend(own.e.map(|value| (e, value, restitution(value), "0 to 1")));
        checks.extend(own.mu.map(|value| (mu, value, is_accepted_friction(value), ACCEPTED_FRICTION)));
        checks.extend(own.height.map(|value| (high, value, height(value), "from R to 1.6 R, in metres")));
    }
    let fades = [("rail.fade", rail.fade), ("e_ball_fade", table.ball_fade)];
    for (key, value) in fades.into_iter().filter_map(|(key, value)| value.map(|value| (key, value))) {
        let accepted = "from 0 to 100 m/s, slope 0 to 10, least 0 to 1";
        checks.push((key, value.slope, fade(&value), accepted));
    }
    if let Some(law) = table.ball_slip_friction {
        let holds = law.least >= 0.0
            && law.rise >= 0.0
            && is_accepted_friction(law.least + law.rise)
            && (0.0..=1e3).contains(&law.fade);
        checks.push((
            "mu_b_slip",
            law.least,
            holds,
            "least and rise from 0, together below 1, and fade from 0 to 1000",
        ));
    }
    if let Some(mass) = table.cue_end_mass {
        checks.push(("m_end", mass, mass > 0.0 && mass <= table.cue_mass, "above 0 and at most M"));
    }
    checks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::TableError;

    #[test]
    fn invalid_constants_of_models_are_refused_by_name_and_value() {
        let text = toml::to_string(&Table::default()).unwrap();
        for (from, to, key) in [
            ("height = 0.03736", "height = 0.08", "rail.height"),
            ("height = 0.03736", "height = nan", "rail.height"),
            ("kappa = 1.267", "kappa = 3", "rail.kappa"),
            ("c1 = 0.0155", "c1 = -1", "c1"),
            ("m_end = 0.005", "m_end = 0", "m_end"),
            ("slope = 0.02", "slope = inf", "rail.fade"),
            ("rise = 0.108", "rise = -1", "mu_b_slip"),
            ("[rail.fade]", "[rail.left]\ne = 1.5\n\n[rail.fade]", "rail.left.e"),
            ("[rail.fade]", "[rail.top]\nmu = 1\n\n[rail.fade]", "rail.top.mu"),
            ("[rail.fade]", "[rail.bottom]\nheight = 0.01\n\n[rail.fade]", "rail.bottom.height"),
            ("name = \"match\"", "name = \"leaning\"\ntilt = [0.5, 0.0]", "tilt"),
            ("name = \"match\"", "name = \"leaning\"\ntilt = [0.0, -0.0102]", "tilt"),
            ("name = \"match\"", "name = \"leaning\"\ntilt = [nan, 0.0]", "tilt"),
        ] {
            assert!(text.contains(from), "{from} in {text}");
            let refused = Table::from_toml(&text.replacen(from, to, 1)).unwrap_err();
            assert!(matches!(refused, TableError::Value { key: found, .. } if found == key), "{to}: {refused}");
        }
        let mathavan = text.replace("model = \"smooth\"", "model = \"mathavan\"");
        assert!(Table::from_toml(&mathavan).is_ok());
        let rough = Table::from_toml(&mathavan.replace("mu_s = 0.203", "mu_s = 1.1")).unwrap_err().to_string();
        assert!(rough.contains("mu_s = 1.1; accepted is 0.0001 to 0.8 with the rail model mathavan"), "{rough}");
        let unknown = text.replace("model = \"smooth\"", "model = \"rubber\"");
        let message = Table::from_toml(&unknown).unwrap_err().to_string();
        assert!(message.contains("rubber") && message.contains("mathavan"), "{message}");
    }
}
