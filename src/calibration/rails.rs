//! Rails that differ from each other: told apart where tests were played from both ends of the table.

use super::{
    belief::Belief,
    estimate::{Estimate, Trial, estimate},
};
use crate::table::{DoubtError, OneRail, Rail, Table, TableDoubt};

/// What a rail can have of its own: the name of the constant that all have, its own, and by how much rails of one table differ
/// in it (standard deviation). The latter are assumptions.
const OWN: [(&str, &str, f64); 2] = [("e_rail", "e", 0.02), ("mu_rail", "mu", 0.03)];

/// By how many times as much a rail is taken to differ that was told apart: it is not one of the many that are alike.
const WIDE: f64 = 3.0;

/// From so many deviations on, a rail has a value of its own. Of eight that are looked at, chance alone lets one come there in two
/// of a hundred tables.
const APART: f64 = 3.0;

/// How much of the variance of a difference may be left for it to be looked at.
const MOST_LEFT: f64 = 0.95;

/// The belief in which these rails have values of their own, before the trials as likely above as below the others', and differ
/// by so many times as much as usual.
fn with_own(table: &Table, doubt: &TableDoubt, rails: &[Rail], wide: f64) -> Result<Belief, DoubtError> {
    let (mut table, mut doubt) = (table.clone(), doubt.clone());
    for rail in rails {
        let OneRail { height, .. } = table.rail.own(*rail);
        let (e, mu) = (Some(table.rail_restitution), Some(table.rail_friction));
        *table.rail.own_mut(*rail) = Some(OneRail { e, mu, height });
        for (common, own, differ) in OWN {
            let Some(deviation) = doubt.deviations.get(common).copied() else { continue };
            let name = name(*rail, own);
            let whole = deviation.hypot(wide * differ);
            // What all rails have in common it shares with them, and with what that is correlated with.
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

/// The name of a constant that a rail has of its own.
fn name(rail: Rail, own: &str) -> String {
    format!("rail.{}.{own}", rail.name())
}

/// How many deviations a difference is from nought that was found to be `difference`, with this variance, where it was held before
/// to have the deviation `differ`. That draws it to nought: were there no difference, what is found would spread by less than
/// what is left open.
fn deviations(difference: f64, variance: f64, differ: f64) -> f64 {
    let left = (variance / (differ * differ)).clamp(1e-6, 1.0);
    // From marks that tell next to nothing nothing follows.
    if left > MOST_LEFT { 0.0 } else { difference.abs() / (variance * (1.0 - left)).sqrt() }
}

/// Looks for rails that differ from the others by more than the trials leave open; gives the belief in which they have values
/// of their own, with what the trials say then. `None` where there are none, where the table's file has some already, or where
/// all tests were played from one end.
pub fn told_apart(
    table: &Table,
    doubt: &TableDoubt,
    trials: &[Trial],
) -> Result<Option<(Belief, Estimate)>, DoubtError> {
    let is_both = trials.iter().any(|trial| trial.is_turned) && trials.iter().any(|trial| !trial.is_turned);
    let has_own = Rail::ALL.iter().any(|rail| table.rail.own(*rail) != OneRail::default());
    if !is_both || has_own {
        return Ok(None);
    }
    let belief = with_own(table, doubt, &Rail::ALL, 1.0)?;
    let found = estimate(&belief, trials);
    let (values, covariance) = (belief.values(&found.unknowns), belief.covariance(&found.covariance));
    let place = |name: &str| belief.told().position(|(told, ..)| told == name);
    let differs = |rail: &Rail| {
        OWN.iter().any(|(common, own, differ)| {
            let Some((all, one)) = place(common).zip(place(&name(*rail, own))) else { return false };
            let variance = covariance[one][one] + covariance[all][all] - 2.0 * covariance[one][all];
            deviations(values[one] - values[all], variance, *differ) > APART
        })
    };
    let rails: Vec<Rail> = Rail::ALL.into_iter().filter(differs).collect();
    if rails.is_empty() {
        return Ok(None);
    }
    let belief = with_own(table, doubt, &rails, WIDE)?;
    let found = estimate(&belief, trials);
    Ok(Some((belief, found)))
}
