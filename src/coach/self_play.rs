//! Innings that the coach plays alone: its shots, played with a player's errors until one misses.

use std::{
    sync::atomic::AtomicBool,
    time::{Duration, Instant},
};

use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    Coach, Doubt, Request, Shooter,
    draws::{Draw, Worlds},
    next::final_layout,
    trial::{UNLIMITED_STEPS, with_unlimited_task},
};
use crate::{
    physics::CueInputs,
    player::{
        errors::{self, Errors},
        perturbed_layout, re_aimed,
    },
    table::{Layout, LayoutError, Table},
};

/// One inning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inning {
    /// Points, one per turn.
    pub points: u32,
    /// Whether it ended with a miss; otherwise it was cut off.
    pub missed: bool,
    /// Shots simulated by the coach.
    pub simulations: u64,
    /// Total time that the coach took.
    pub elapsed: Duration,
    /// Longest time that the coach took for one turn.
    pub slowest: Duration,
}

/// Plays from `layout` until a miss, `most` points or the time `until`. The coach gets `request` with another seed
/// every turn, and the errors of its shots are drawn from `rng`.
/// If anything is in doubt, the inning is played on a table that is drawn for it, and the coach gets ball positions
/// with the placing errors of the doubt. Calls `on_point` after every point with the layout that it leaves.
///
/// # Errors
/// Fails if `layout` is impossible; later layouts come from simulated shots and are possible.
pub fn inning(
    coach: &Coach,
    layout: &Layout,
    request: &Request,
    most: u32,
    until: Instant,
    rng: &mut Xoshiro256PlusPlus,
    on_point: &mut dyn FnMut(&Inning, &Layout),
) -> Result<Inning, LayoutError> {
    // A perfect player has no doubts.
    let doubt = request.shooter().effective_doubt();
    let mut inning = Inning::default();
    let mut layout = *layout;
    let real = Worlds::new(coach.table(), &layout, Doubt { placing: 0.0, ..doubt })
        .draw(|| errors::standard_normal(rng))
        .table;
    while inning.points < most && Instant::now() < until {
        let request = Request { seed: request.seed.wrapping_add(u64::from(inning.points)), ..request.clone() };
        let reported = perturbed_layout(coach.table(), &layout, doubt.placing, || errors::standard_normal(rng));
        let advice = coach.recommend(&reported, &request)?;
        inning.simulations += advice.simulations;
        inning.elapsed += advice.elapsed;
        inning.slowest = inning.slowest.max(advice.elapsed);
        // The player aims at the balls as they really lie.
        let cue = re_aimed(coach.table(), &reported, &layout, &advice.cue);
        let Some(end) = turn(&real, &layout, &request, &cue, &errors::random(rng)) else {
            inning.missed = true;
            break;
        };
        inning.points += 1;
        layout = end;
        on_point(&inning, &layout);
    }
    Ok(inning)
}

/// Plays one stroke with a player's errors, on the real table and from the real layout, by which fouls are judged too.
/// Returns the layout at rest if it makes the point, else `None`.
fn turn(table: &Table, layout: &Layout, request: &Request, cue: &CueInputs, errors: &Errors) -> Option<Layout> {
    // The simulation of the real stroke has no limits.
    let shooter = Shooter { skill: request.skill, doubt: Doubt::NONE };
    with_unlimited_task(table, layout, request.rule, shooter, UNLIMITED_STEPS, &AtomicBool::new(false), |task| {
        final_layout(task, cue, Draw { errors, world: None })
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use rand::SeedableRng;

    use super::*;
    use crate::{coach::Skill, game::Rule};

    #[test]
    fn foul_of_a_touching_ball_is_judged_where_the_balls_really_lie() {
        // Yellow lies before the cue ball; red lies behind it, where draw takes the cue ball.
        let table = Table::default();
        let cue = CueInputs::parse("0,-0.4,5,0,3").unwrap();
        let request = Request { rule: Rule::StraightRail, skill: Skill::PERFECT, ..Request::default() };
        let end = |gap: f64| {
            let yellow = DVec2::new(2.0 * table.radius + gap, 0.0);
            let layout = Layout::new([DVec2::ZERO, yellow, DVec2::new(-0.3, 0.02)]);
            turn(&table, &layout, &request, &cue, &[0.0; 5])
        };
        assert_eq!(end(0.0), None, "a foul");
        assert!(end(1e-3).is_some());
    }

    #[test]
    fn perfect_player_is_unaffected_by_doubt() {
        let coach = Coach::without_policy(Table::default());
        let layout = Layout::opening(coach.table());
        let [certain, doubtful] = [Doubt::NONE, Doubt::FULL].map(|doubt| {
            let request =
                Request { skill: Skill::PERFECT, doubt, budget: Duration::from_secs(60), ..Request::default() };
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
            let until = Instant::now() + Duration::from_secs(600);
            let mut ends = Vec::new();
            let mut on_point = |_: &Inning, end: &Layout| ends.push(*end);
            let inning = inning(&coach, &layout, &request, 4, until, &mut rng, &mut on_point).unwrap();
            assert_eq!((inning.points, inning.missed), (4, false));
            ends
        });
        assert_eq!(certain, doubtful);
    }
}
