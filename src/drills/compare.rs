//! Compares the player's intended stroke with the coach's.

use crate::{
    coach::{Coach, Request, Shooter, layout_number, layout_seed, make_probability},
    game::Rule,
    physics::{CueInputs, signed_angle},
    statistics::SuccessRate,
    table::{Layout, LayoutError, Table},
};

/// Simulated attempts at a stroke: the standard error of its make probability is at most 1.6 %.
const ATTEMPTS: usize = 1000;

/// Seed of the errors, combined with that of the layout. It is the same for all strokes from the same layout, so that
/// luck does not affect their comparison, and differs between layouts, so that luck on one does not repeat on others.
const SEED: u64 = 0x636f_6d70_6172_6521;

/// Estimates how often a player makes the point with `cue`.
pub fn chance(shooter: Shooter, rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs) -> SuccessRate {
    make_probability(shooter, rule, table, layout, cue, ATTEMPTS, layout_seed(SEED, layout_number(layout)))
}

/// The coach's stroke and how often the player makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advice {
    /// The stroke.
    pub cue: CueInputs,
    /// Whether it makes the point when it is played as intended.
    pub solved: bool,
    /// Make probability from the attempts of [`chance`].
    pub chance: SuccessRate,
}

/// Returns the coach's stroke under the request's doubt. `None` if it finds no point, unless the coach is to play the shot
/// itself: then it is its best attempt.
///
/// # Errors
/// Fails if the layout is impossible.
pub fn advise(
    coach: &Coach,
    layout: &Layout,
    request: &Request,
    is_to_play: bool,
) -> Result<Option<Advice>, LayoutError> {
    let answer = coach.recommend(layout, request)?;
    let chance = |cue| chance(request.shooter(), request.rule, coach.table(), layout, &cue);
    let is_told = answer.solved || is_to_play;
    Ok(is_told.then(|| Advice { cue: answer.cue, solved: answer.solved, chance: chance(answer.cue) }))
}

/// Returns the difference `intended` - `advised` in every input. The difference in direction is the smaller angle, from -π to π.
pub fn difference(intended: &CueInputs, advised: &CueInputs) -> CueInputs {
    CueInputs {
        a: intended.a - advised.a,
        b: intended.b - advised.b,
        theta: intended.theta - advised.theta,
        phi: signed_angle(advised.phi, intended.phi),
        speed: intended.speed - advised.speed,
    }
}

#[cfg(test)]
mod tests {
    use std::{f64::consts::PI, time::Duration};

    use super::*;
    use crate::coach::{Doubt, Skill};

    #[test]
    fn direction_difference_is_the_smaller_angle() {
        let cue = |degrees: f64| CueInputs { a: 0.1, b: 0.0, theta: 0.0, phi: degrees.to_radians(), speed: 2.0 };
        for (intended, advised, turn) in
            [(179.0, -179.0, -2.0), (-179.0, 179.0, 2.0), (350.0, -20.0, 10.0), (5.0, 5.0, 0.0)]
        {
            let difference = difference(&cue(intended), &cue(advised));
            assert!((difference.phi.to_degrees() - turn).abs() < 1e-9, "{intended} against {advised}: {difference:?}");
            assert_eq!((difference.a, difference.speed), (0.0, 0.0));
        }
    }

    #[test]
    fn coach_makes_more_points_than_an_arbitrary_stroke() {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 0,0 0.5,0.03", &table).unwrap();
        let coach = Coach::new(table.clone());
        let skill = Skill::CLUB;
        let request = Request { skill, doubt: Doubt::FULL, budget: Duration::from_secs(2), ..Request::default() };
        let advice = advise(&coach, &layout, &request, false).unwrap().unwrap();
        let away = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: PI, speed: 0.3 };
        assert_eq!(chance(request.shooter(), request.rule, &table, &layout, &away).rate, 0.0);
        assert!(advice.chance.rate > 0.3, "{advice:?}");
        // The reported rate includes the doubt about table and positions; it is not that of the nominal table.
        assert_eq!(advice.chance, chance(request.shooter(), request.rule, &table, &layout, &advice.cue));
        assert_ne!(advice.chance, chance(skill.into(), request.rule, &table, &layout, &advice.cue));
    }
}
