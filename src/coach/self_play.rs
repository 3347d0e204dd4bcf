//! Innings that the coach plays against nobody: its shots, played with a player's errors, until one misses.

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Coach, Request, Skill, errors};
use crate::{
    game::{Rule, Tally},
    physics::{CueInputs, strike},
    simulation::{Event, Observer, simulate},
    table::{Layout, LayoutError, Table},
};

/// One inning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inning {
    /// Points, one a turn.
    pub points: u32,
    /// Whether it ended with a miss; if not, it was broken off.
    pub missed: bool,
    /// Shots simulated by the coach.
    pub simulations: u64,
    /// The longest that the coach took for a turn.
    pub slowest: Duration,
}

/// Plays from `layout` until a miss, `most` points or the time `until`. The coach gets `request` with another seed every
/// turn, and the errors of its shots are drawn from `rng`. `tell` hears of every turn.
///
/// # Errors
/// Where a layout is impossible: the first one, for those that a shot leaves are possible.
pub fn inning(
    coach: &Coach,
    layout: &Layout,
    request: &Request,
    most: u32,
    until: Instant,
    rng: &mut Xoshiro256PlusPlus,
    tell: &mut dyn FnMut(&Inning),
) -> Result<Inning, LayoutError> {
    let mut inning = Inning::default();
    let mut layout = layout.clone();
    while inning.points < most && Instant::now() < until {
        let request = Request { seed: request.seed.wrapping_add(u64::from(inning.points)), ..request.clone() };
        let advice = coach.recommend(&layout, &request)?;
        inning.simulations += advice.simulations;
        inning.slowest = inning.slowest.max(advice.elapsed);
        let end = turn(coach.table(), &layout, request.rule, &request.skill, &advice.cue, rng);
        let Some(end) = end else {
            inning.missed = true;
            break;
        };
        inning.points += 1;
        tell(&inning);
        layout = end;
    }
    Ok(inning)
}

/// Plays one stroke with a player's errors: where the balls come to rest if it makes the point, else `None`.
fn turn(
    table: &Table,
    layout: &Layout,
    rule: Rule,
    skill: &Skill,
    cue: &CueInputs,
    rng: &mut Xoshiro256PlusPlus,
) -> Option<Layout> {
    let stroke = skill.stroke(table.radius, cue, &errors::one(rng));
    if stroke.tip_offset_squared() > table.miscue_limit {
        return None;
    }
    let mut whole = Whole::default();
    let end = simulate(table, layout, &strike(table, &stroke), &mut whole);
    whole.tally.is_point(rule).then(|| end.layout())
}

/// Watches a shot to its end.
#[derive(Default)]
struct Whole {
    tally: Tally,
}

impl Observer for Whole {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.tally.note(&event);
        ControlFlow::Continue(())
    }
}
