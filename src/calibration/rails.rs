//! Detects rails that differ from the others, if tests were played from both ends of the table.

use super::{
    belief::Belief,
    estimate::{Estimate, Trial, estimate},
};
use crate::table::{DoubtError, Rail, RailOverrides, Table, TableDoubt};

/// Constants that a rail can have individually: name of the common constant, name of the rail's own, and the standard deviation between
/// the rails of one table, which is an assumption.
const RAIL_CONSTANTS: [(&str, &str, f64); 2] = [("e_rail", "e", 0.02), ("mu_rail", "mu", 0.03)];

/// Factor on the deviation of a detected rail: it is not one of the many similar ones.
const WIDE: f64 = 3.0;

/// Standard deviations from which a rail gets its own value. Among the eight values of a table, chance alone exceeds it in two
/// of a hundred tables.
const THRESHOLD: f64 = 3.0;

/// Largest remaining share of the prior variance of a difference at which the difference is tested.
const MAX_REMAINING: f64 = 0.95;

/// Returns the belief in which these rails have their own values, with those of the others as prior means, and with the deviations
/// between rails multiplied by `wide`.
fn with_rail_constants(table: &Table, doubt: &TableDoubt, rails: &[Rail], wide: f64) -> Result<Belief, DoubtError> {
    let (mut table, mut doubt) = (table.clone(), doubt.clone());
    for rail in rails {
        let RailOverrides { height, .. } = table.rail.overrides(*rail);
        let (e, mu) = (Some(table.rail_restitution), Some(table.rail_friction));
        *table.rail.overrides_mut(*rail) = Some(RailOverrides { e, mu, height });
        for (common, own, differ) in RAIL_CONSTANTS {
            let Some(deviation) = doubt.deviations.get(common).copied() else { continue };
            let name = name(*rail, own);
            let whole = deviation.hypot(wide * differ);
            // The common part is correlated with the constant of all rails, and with everything that this is correlated with.
            let share = deviation / whole;
            let others = doubt.correlations.iter().filter_map(|(one, other, value)| match () {
                () if one == common => Some((other.clone(), name.clone(), share * value)),
                () if other == common => Some((one.clone(), name.clone(), share * value)),
                () => None,
            });
            let others: Vec<_> = others.collect();
            doubt.correlations.extend(others);
            doubt.correlations.push((common.to_owned(), name.clone(), share));
            doubt.deviations.insert(name, whole);
        }
    }
    Belief::new(&table, &doubt)
}

/// Returns the name of a rail's own constant.
fn name(rail: Rail, own: &str) -> String {
    format!("rail.{}.{own}", rail.name())
}

/// Returns the significance of a difference, in standard deviations of its estimate without a true difference. `difference` and `variance`
/// are its posterior mean and variance, `differ` is its prior deviation. The prior pulls the estimate to zero, so without a true
/// difference the estimates spread by less than the posterior deviation.
fn deviations(difference: f64, variance: f64, differ: f64) -> f64 {
    let remaining = (variance / (differ * differ)).clamp(1e-6, 1.0);
    // Marks with hardly any information allow no conclusion.
    if remaining > MAX_REMAINING { 0.0 } else { difference.abs() / (variance * (1.0 - remaining)).sqrt() }
}

/// Looks for rails that differ significantly from the others. Returns the belief in which they have their own values, and the estimate
/// with it. `None` if there are no such rails, if the table's file already has individual rails, or if all tests were played from one
/// end.
pub fn distinct_rails(
    table: &Table,
    doubt: &TableDoubt,
    trials: &[Trial],
) -> Result<Option<(Belief, Estimate)>, DoubtError> {
    let is_both = trials.iter().any(|trial| trial.is_turned) && trials.iter().any(|trial| !trial.is_turned);
    let has_own = Rail::ALL.iter().any(|rail| table.rail.overrides(*rail) != RailOverrides::default());
    if !is_both || has_own {
        return Ok(None);
    }
    let belief = with_rail_constants(table, doubt, &Rail::ALL, 1.0)?;
    let found = estimate(&belief, trials);
    let (values, covariance) = (belief.values(&found.unknowns), belief.covariance(&found.covariance));
    let index_of = |name: &str| belief.constants().position(|(constant, ..)| constant == name);
    let differs = |rail: &Rail| {
        RAIL_CONSTANTS.iter().any(|(common, own, differ)| {
            let Some((all, one)) = index_of(common).zip(index_of(&name(*rail, own))) else { return false };
            let variance = covariance[one][one] + covariance[all][all] - 2.0 * covariance[one][all];
            deviations(values[one] - values[all], variance, *differ) > THRESHOLD
        })
    };
    let rails: Vec<Rail> = Rail::ALL.into_iter().filter(differs).collect();
    if rails.is_empty() {
        return Ok(None);
    }
    let belief = with_rail_constants(table, doubt, &rails, WIDE)?;
    let found = estimate(&belief, trials);
    Ok(Some((belief, found)))
}
