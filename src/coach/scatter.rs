//! Resting positions of the balls when a player tries the same shot many times.

use std::sync::atomic::AtomicBool;

use glam::DVec2;

use super::{
    Shooter,
    draws::Draws,
    next::final_layout,
    trial::{CONTACT_STEPS, with_unlimited_task},
};
use crate::{
    game::Rule,
    physics::CueInputs,
    platform::{self, parallel},
    statistics::SuccessRate,
    table::{Layout, Table},
};

/// Results of many attempts at a shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// Positions of the balls at rest, m, for each attempt that makes the point.
    pub ends: Vec<Layout>,
    /// The share of attempts that make the point, except those whose balls still press each other after very many steps.
    pub made: SuccessRate,
}

impl Scatter {
    /// Returns the distance from `place`, m, within which `ball` comes to rest in half of the successful attempts; `None` if
    /// there are none.
    pub fn spread(&self, ball: usize, place: DVec2) -> Option<f64> {
        let mut distances: Vec<f64> = self.ends.iter().map(|end| end.balls[ball].distance(place)).collect();
        distances.sort_by(f64::total_cmp);
        distances.get(distances.len().saturating_sub(1) / 2).copied()
    }
}

/// Simulates `attempts` of a player at `cue`, on all cores. The same seed draws the same errors. If another thread sets
/// `cancel`, the remaining attempts count as missed.
#[expect(clippy::too_many_arguments, reason = "a question, a shot, and how it is to be tried")]
pub fn scatter(
    shooter: Shooter,
    rule: Rule,
    table: &Table,
    layout: &Layout,
    cue: &CueInputs,
    attempts: usize,
    seed: u64,
    cancel: &AtomicBool,
) -> Scatter {
    let ends = with_unlimited_task(table, layout, rule, shooter, CONTACT_STEPS, cancel, |task| {
        let draws = Draws::independent(attempts, task.worlds, seed);
        let draws: Vec<_> = draws.iter().collect();
        parallel::map(platform::thread_count(), &draws, |draw| {
            if task.clock.is_cancelled() { None } else { final_layout(task, cue, *draw) }
        })
    });
    let ends: Vec<Layout> = ends.into_iter().flatten().collect();
    let made = SuccessRate::new(ends.len(), attempts);
    Scatter { ends, made }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{Doubt, Skill, make_probability},
        simulation::Recording,
    };

    #[test]
    fn scatter_agrees_with_make_probability_and_grows_with_errors() {
        let table = Table::preset("textbook").unwrap();
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("-0.2,0.2,6,82.6,2.5").unwrap();
        let rule = Rule::StraightRail;
        let never = AtomicBool::new(false);
        let meant = Recording::new(&table, &layout, &cue).unwrap().final_layout();
        let mut before = 0.0;
        for skill in [Skill::PERFECT, Skill::EXPERT, Skill::CLUB] {
            let scatter = scatter(skill.into(), rule, &table, &layout, &cue, 200, 5, &never);
            // The same seed draws the same errors.
            assert_eq!(scatter.made, make_probability(skill, rule, &table, &layout, &cue, 200, 5));
            assert_eq!(scatter.ends.len(), scatter.made.successes);
            let spread = scatter.spread(0, meant.balls[0]).unwrap();
            assert!(spread > before || skill.is_perfect() && spread == 0.0, "{skill}: {spread} after {before}");
            before = spread;
        }
        let doubt = Shooter { skill: Skill::EXPERT, doubt: Doubt { placing: 0.02, ..Doubt::FULL } };
        let doubted = scatter(doubt, rule, &table, &layout, &cue, 200, 5, &never);
        assert_eq!(doubted.made, make_probability(doubt, rule, &table, &layout, &cue, 200, 5));
        let cancelled = scatter(Skill::EXPERT.into(), rule, &table, &layout, &cue, 200, 5, &AtomicBool::new(true));
        assert_eq!((cancelled.ends.len(), cancelled.spread(0, meant.balls[0])), (0, None));
    }
}
