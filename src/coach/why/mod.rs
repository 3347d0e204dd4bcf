//! Why a shot leads: its margin, the kiss that lies in wait, what it leaves, and how the next best differs.

mod words;

use std::{ops::ControlFlow, sync::atomic::AtomicBool};

use glam::DVec2;
use serde::Serialize;

use super::{
    Alternative, Input, Pattern, Recommendation, Sensitivity, Shooter, Skill, Technique,
    draws::Draws,
    trial::{CONTACT_STEPS, Task, unhurried},
    words::table_lengths,
};
use crate::{
    game::{Rule, Tally},
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Recording, ShotError, StepBudget, watch},
    statistics::{SuccessRate, quantile},
    table::{Layout, Table},
};

/// Attempts among which kisses are counted.
const ATTEMPTS: usize = 200;

/// Share of the attempts from which on a kiss is named.
const NAMED: f64 = 0.02;

/// A width is told only if it is at least this share of the window in which the player's direction would have to stay to make the
/// shot as often as it is made.
const EXPLAINED: f64 = 0.8;

/// Two balls that meet again within this time have met once, s: a ball that follows another through runs on to it.
const SAME: f64 = 0.1;

/// Two balls that meet where they should not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Kiss {
    /// Share of the player's attempts that it spoils.
    pub share: f64,
    /// The balls.
    pub balls: [usize; 2],
    /// Where they meet, m, in the first such attempt.
    pub place: DVec2,
}

/// How the second-best shot differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// What it is called.
    pub pattern: Option<&'static str>,
    /// Its first ball, where that is another.
    pub first_ball: Option<usize>,
    /// How much more of the same first ball it hits; less is thinner.
    pub fuller: f64,
    /// How many table lengths harder it is; less is softer.
    pub harder: f64,
    /// How often it is made.
    pub make_probability: Option<f64>,
    /// By how much its direction may be off in all, degrees; `None` where there is no end to that, or it does not tell how often the shot
    /// is made.
    pub aim_deg: Option<f64>,
    /// Probability of the point after it, where that counts too.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next_probability: Option<f64>,
}

/// Why a shot leads.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Why {
    /// How often it is made.
    pub make_probability: Option<f64>,
    /// By how much its direction may be off in all, degrees; `None` where there is no end to that, it makes no point, or that does not tell
    /// how often the shot is made.
    pub aim_deg: Option<f64>,
    /// The kiss that spoils most attempts.
    pub kiss: Option<Kiss>,
    /// Probability of the next point.
    pub next_probability: Option<f64>,
    /// The next best shot.
    pub second: Option<Difference>,
    /// The numbers of the shots that seem to be made more often than the first, from 2, which luck may explain: their intervals overlap.
    #[serde(skip)]
    unsure: Vec<usize>,
    /// Whether the shots are ranked by this point and the next.
    #[serde(skip)]
    is_planned: bool,
    /// Whether the first shot that makes the point was taken, and no other looked for.
    #[serde(skip)]
    is_the_first: bool,
    /// A diamond, m, and the middle of the table from its lower left corner.
    #[serde(skip)]
    scale: (f64, DVec2),
}

/// Why the recommended shot leads. It takes some hundred simulations; the same seed draws the same attempts.
///
/// # Errors
/// What is wrong with the layout or the stroke.
pub fn why(
    shooter: impl Into<Shooter>,
    rule: Rule,
    table: &Table,
    layout: &Layout,
    advice: &Recommendation,
    seed: u64,
) -> Result<Why, ShotError> {
    let shooter = shooter.into();
    let technique = Technique::of(table, layout, &advice.cue)?;
    let sensitivity = Sensitivity::new(rule, table, layout, shooter.doubts());
    let second = advice.alternatives.first().map(|other| -> Result<Difference, ShotError> {
        let its = Technique::of(table, layout, &other.cue)?;
        let [ball, its_ball] = [&technique, &its].map(|technique| technique.first.map(|hit| hit.ball));
        let lengths = |cue: &CueInputs| table_lengths(table, cue.speed).unwrap_or_default();
        Ok(Difference {
            pattern: Pattern::of(&its).map(|pattern| pattern.name),
            first_ball: its_ball.filter(|_| its_ball != ball),
            fuller: if its_ball == ball { its.fullness() - technique.fullness() } else { 0.0 },
            harder: lengths(&other.cue) - lengths(&advice.cue),
            make_probability: other.make_probability.map(|rate| rate.rate),
            aim_deg: aim_width(&sensitivity, &other.cue, shooter.skill, other.make_probability),
            next_probability: other.next_probability,
        })
    });
    let is_unsure = |other: &Alternative| {
        let rates = other.make_probability.zip(advice.make_probability);
        rates.is_some_and(|(its, own)| its.rate > own.rate && its.low <= own.high)
    };
    let numbered = (2..).zip(&advice.alternatives);
    Ok(Why {
        make_probability: advice.make_probability.map(|rate| rate.rate),
        aim_deg: aim_width(&sensitivity, &advice.cue, shooter.skill, advice.make_probability),
        kiss: kiss(shooter, rule, table, layout, &advice.cue, seed),
        next_probability: advice.next_probability,
        second: second.transpose()?,
        unsure: numbered.filter(|(_, other)| is_unsure(other)).map(|(number, _)| number).collect(),
        is_planned: advice.is_planned,
        is_the_first: shooter.skill.is_perfect(),
        scale: (table.diamond(), 0.5 * DVec2::new(table.length, table.width)),
    })
}

/// By how much the direction may be off to both sides together, degrees; `None` where a player of this skill makes the shot much more often
/// than his direction stays within that: other directions make it, too.
fn aim_width(sensitivity: &Sensitivity, cue: &CueInputs, skill: Skill, made: Option<SuccessRate>) -> Option<f64> {
    let margin = sensitivity.margin(Input::Direction, cue)?;
    let width = margin.less? + margin.more?;
    // Of all windows so wide, errors stay most often within the one around nought.
    let least = |rate: f64| 2.0 * skill.at(cue).phi.to_degrees() * quantile(0.5 * (1.0 + rate));
    let explains = made.is_none_or(|made| made.rate >= 1.0 || width > EXPLAINED * least(made.rate));
    explains.then_some(width)
}

/// The kiss that spoils most of the player's attempts; `None` where none spoils two of a hundred.
fn kiss(shooter: Shooter, rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs, seed: u64) -> Option<Kiss> {
    if shooter.skill.is_perfect() {
        return None;
    }
    unhurried(table, layout, rule, shooter, CONTACT_STEPS, &AtomicBool::new(false), |task| worst_kiss(task, cue, seed))
}

fn worst_kiss(task: &Task, cue: &CueInputs, seed: u64) -> Option<Kiss> {
    let meant = Contacts::of(task.table, task.layout, cue, f64::INFINITY);
    if !task.point().is_made(&meant.tally) {
        return None;
    }
    // What happens long after the meant shot is over spoils nothing.
    let latest = 1.2 * meant.met.last().map_or(0.0, |contact| contact.0);
    let mut found: Vec<([usize; 2], CueInputs, &Table, &Layout, f64)> = Vec::new();
    let draws = Draws::independent(ATTEMPTS, task.worlds, seed);
    for draw in draws.iter() {
        let (stroke, real, balls) = task.stroke(cue, draw);
        if stroke.is_miscue(real) {
            continue;
        }
        let seen = Contacts::of(real, balls, &stroke, latest);
        if let Some((time, pair)) = seen.unexpected(&meant).filter(|_| !task.point().is_made(&seen.tally)) {
            found.push((pair, stroke, real, balls, time));
        }
    }
    let count = |pair: [usize; 2]| found.iter().filter(|kiss| kiss.0 == pair).count();
    let most = found.iter().map(|kiss| kiss.0).max_by_key(|pair| count(*pair))?;
    let (balls, stroke, real, layout, time) = found.iter().find(|kiss| kiss.0 == most)?;
    let share = count(*balls) as f64 / ATTEMPTS as f64;
    if share < NAMED {
        return None;
    }
    let places = Recording::new(real, layout, stroke).ok()?.positions(*time);
    Some(Kiss { share, balls: *balls, place: 0.5 * (places[balls[0]] + places[balls[1]]) })
}

/// Notes which balls meet, until the cue ball has met both or it is too late.
struct Contacts {
    tally: Tally,
    met: Vec<(f64, [usize; 2])>,
    latest: f64,
    patience: StepBudget,
}

impl Contacts {
    fn of(table: &Table, layout: &Layout, cue: &CueInputs, latest: f64) -> Self {
        let patience = StepBudget(CONTACT_STEPS);
        let mut contacts = Self { tally: Tally::default(), met: Vec::new(), latest, patience };
        watch(table, layout, &strike(table, cue), &mut contacts);
        contacts
    }

    fn count(&self, pair: [usize; 2]) -> usize {
        self.met.iter().filter(|contact| contact.1 == pair).count()
    }

    /// The first contact that the meant shot has not: of balls that meet more often than there.
    fn unexpected(&self, meant: &Self) -> Option<(f64, [usize; 2])> {
        let mut seen = Vec::new();
        self.met.iter().copied().find(|(_, pair)| {
            seen.push(*pair);
            seen.iter().filter(|one| *one == pair).count() > meant.count(*pair)
        })
    }
}

impl Observer for Contacts {
    fn wants_ends(&self) -> bool {
        false
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if event.time > self.latest {
            return ControlFlow::Break(());
        }
        self.tally.note(&event);
        if let EventKind::BallBall(one, other) = event.kind {
            let pair = [one, other];
            let last = self.met.iter().rev().find(|contact| contact.1 == pair);
            if last.is_none_or(|last| event.time - last.0 > SAME) {
                self.met.push((event.time, pair));
            }
        }
        if self.tally.met_both() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.patience.step()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The break with natural english: red comes back from the far cushions through the way of the cue ball.
    #[test]
    fn a_kiss_that_the_errors_bring_is_named_with_its_balls_and_its_place() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("0.143,0.256,0.713,351.760,2.967").unwrap();
        let seen = |skill: Skill| kiss(skill.into(), Rule::ThreeCushion, &table, &layout, &cue, 1);
        let found = seen(Skill::NATIONAL).unwrap();
        assert_eq!(found.balls, [0, 2], "{found:?}");
        assert!((0.02..0.4).contains(&found.share), "{found:?}");
        assert!(found.place.abs().cmple(table.reach()).all(), "{found:?}");
        assert_eq!(seen(Skill::PERFECT), None);
    }

    #[test]
    fn the_room_of_the_aim_is_told_where_it_explains_how_often_the_shot_is_made() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("0.143,0.256,0.713,351.760,2.967").unwrap();
        let sensitivity = Sensitivity::new(Rule::ThreeCushion, &table, &layout, crate::coach::Doubt::NONE);
        let told = |made: usize| aim_width(&sensitivity, &cue, Skill::CLUB, Some(SuccessRate::new(made, 100)));
        let width = told(1).unwrap();
        // The hand stays within a window of this width so often, at most.
        let sigma = Skill::CLUB.at(&cue).phi.to_degrees();
        let within = (1..100).find(|made| 2.0 * sigma * quantile(0.5 + 0.005 * *made as f64) > width).unwrap();
        assert_eq!(told(within / 2), Some(width));
        assert_eq!((told((2 * within).min(99)), told(100)), (None, Some(width)), "{width} {within}");
    }
}
