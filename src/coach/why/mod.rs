//! Why a shot is recommended: its tolerance, the likeliest kiss, the position that it leaves, and the difference from
//! the second-best shot.

mod words;

use std::{ops::ControlFlow, sync::atomic::AtomicBool};

use glam::DVec2;
use serde::Serialize;

use super::{
    Alternative, Input, Pattern, Recommendation, Sensitivity, Shooter, Skill, Technique,
    draws::Draws,
    pool::{DOUBLE_HIT_PENALTY, MAX_USUAL_SPEED},
    trial::{CONTACT_STEPS, Task, with_unlimited_task},
    words::table_lengths,
};
use crate::{
    game::{Rule, Tally},
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Recording, ShotError, StepBudget, watch},
    statistics::{SuccessRate, normal_quantile},
    table::{Layout, Table},
};

/// Attempts in which kisses are counted.
const ATTEMPTS: usize = 200;

/// Minimum share of the attempts for a kiss to be reported.
const MIN_KISS_SHARE: f64 = 0.02;

/// Probabilities that differ by no more than this are reported as about equal. It is one standard error of the difference if half of a
/// thousand and of four hundred attempts make the point.
const NOTABLE_DIFFERENCE: f64 = 0.03;

/// The aim width is reported only if it is at least this share of the window in which the player's direction must stay
/// to make the shot as often as it is made.
const MIN_EXPLAINED_SHARE: f64 = 0.8;

/// Contacts of the same two balls within this time count as one, s: a ball that follows another through runs into it again.
const SAME_CONTACT_WINDOW: f64 = 0.1;

/// An unintended contact of two balls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Kiss {
    /// Share of the player's attempts that the kiss spoils.
    pub share: f64,
    /// The balls.
    pub balls: [usize; 2],
    /// Where they meet in the first such attempt, m.
    pub place: DVec2,
}

/// Why a shot that is made more often than another may be ranked lower.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Drawback {
    /// It is struck harder than usual, and what happens then is less certain.
    HardStroke,
    /// It hits the first ball twice, and what happens then is less certain.
    HitsTwice,
}

impl Drawback {
    /// The drawback of `other` that explains why a shot made less often leads; `None` if it is not made more often, or nothing explains it.
    fn of(other: &Alternative, leader: &Recommendation) -> Option<Self> {
        let (its, own) = other.make_probability.zip(leader.make_probability)?;
        let penalty = other.effort_penalty - leader.effort_penalty;
        let is_explained = its.rate > own.rate && its.rate - penalty <= own.rate;
        let drawback = if other.cue.speed > MAX_USUAL_SPEED {
            Some(Self::HardStroke)
        } else {
            // Without a second hit, the strokes differ by a percent at most.
            (penalty > 0.5 * DOUBLE_HIT_PENALTY).then_some(Self::HitsTwice)
        };
        drawback.filter(|_| is_explained)
    }
}

/// How the second-best shot differs from the best.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The name of its pattern.
    pub pattern: Option<&'static str>,
    /// Whether the best shot has the same pattern.
    #[serde(skip)]
    pub has_same_pattern: bool,
    /// Its first object ball, if that differs.
    pub first_ball: Option<usize>,
    /// How much fuller it hits the same first ball; negative is thinner.
    pub fuller: f64,
    /// How many table lengths harder it is; negative is softer.
    pub harder: f64,
    /// Its make probability.
    pub make_probability: Option<f64>,
    /// What ranks it lower although it is made more often.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawback: Option<Drawback>,
    /// Total width by which its direction may be off, degrees. `None` if there is no limit, or the width does not
    /// explain the make probability.
    pub aim_deg: Option<f64>,
    /// Probability of the point after it, in a plan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next_probability: Option<f64>,
}

/// Why a shot is recommended.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Why {
    /// The make probability of the shot.
    pub make_probability: Option<f64>,
    /// Total width by which its direction may be off, degrees. `None` if there is no limit, the shot makes no point, or
    /// the width does not explain the make probability.
    pub aim_deg: Option<f64>,
    /// The kiss that spoils the most attempts.
    pub kiss: Option<Kiss>,
    /// Probability of the next point.
    pub next_probability: Option<f64>,
    /// The second-best shot.
    pub second: Option<Difference>,
    /// Numbers, from 2, of the shots with a higher estimated make probability than the first one that has no explanation but chance: the
    /// difference is not significant, and the attempts that chose the first shot say otherwise.
    #[serde(skip)]
    unsure: Vec<usize>,
    /// Whether the search stopped at the first shot that makes the point.
    #[serde(skip)]
    is_the_first: bool,
    /// Size of a diamond, m, and the centre of the table relative to its lower left corner.
    #[serde(skip)]
    scale: (f64, DVec2),
}

/// A shot's make probability, and the probability of the next point.
type Probabilities = (Option<f64>, Option<f64>);

/// Whether a shot leads although it is made less often than another one, because it leaves a clearly easier next point, so that it has the
/// higher probability of both.
fn leads_by_plan((own, after): Probabilities, (other, after_other): Probabilities) -> bool {
    let known = own.zip(after).zip(other.zip(after_other));
    known.is_some_and(|((own, after), (other, after_other))| {
        own < other && own * after > other * after_other && after - after_other >= NOTABLE_DIFFERENCE
    })
}

/// Explains the recommended shot. It takes some hundred simulations; the same seed draws the same attempts.
///
/// # Errors
/// Fails if the layout or the stroke is invalid.
pub fn why(
    shooter: Shooter,
    rule: Rule,
    table: &Table,
    layout: &Layout,
    advice: &Recommendation,
    seed: u64,
) -> Result<Why, ShotError> {
    let technique = Technique::of(table, layout, &advice.cue)?;
    let sensitivity = Sensitivity::new(rule, table, layout, shooter.effective_doubt());
    let second = advice.alternatives.first().map(|other| -> Result<Difference, ShotError> {
        let its = Technique::of(table, layout, &other.cue)?;
        let [ball, its_ball] = [&technique, &its].map(|technique| technique.first.map(|hit| hit.ball));
        let lengths = |cue: &CueInputs| table_lengths(table, cue.speed).unwrap_or_default();
        let [own_pattern, pattern] = [&technique, &its].map(|shot| Pattern::of(shot).map(|pattern| pattern.name));
        Ok(Difference {
            has_same_pattern: pattern.is_some() && pattern == own_pattern,
            pattern,
            first_ball: its_ball.filter(|_| its_ball != ball),
            fuller: if its_ball == ball { its.fullness() - technique.fullness() } else { 0.0 },
            harder: lengths(&other.cue) - lengths(&advice.cue),
            make_probability: other.make_probability.map(|rate| rate.rate),
            drawback: Drawback::of(other, advice),
            aim_deg: aim_width(&sensitivity, &other.cue, shooter.skill, other.make_probability),
            next_probability: other.next_probability,
        })
    });
    let rate = |made: Option<SuccessRate>| made.map(|made| made.rate);
    let is_unsure = |other: &Alternative| {
        let own = (rate(advice.make_probability), advice.next_probability);
        let its = (rate(other.make_probability), other.next_probability);
        let rates = advice.make_probability.zip(other.make_probability);
        rates.is_some_and(|(own, its)| own.rate < its.rate && !its.is_significantly_above(&own))
            && !leads_by_plan(own, its)
            && Drawback::of(other, advice).is_none()
    };
    let numbered = (2..).zip(&advice.alternatives);
    Ok(Why {
        make_probability: advice.make_probability.map(|rate| rate.rate),
        aim_deg: aim_width(&sensitivity, &advice.cue, shooter.skill, advice.make_probability),
        kiss: kiss(shooter, rule, table, layout, &advice.cue, seed),
        next_probability: advice.next_probability,
        second: second.transpose()?,
        unsure: numbered.filter(|(_, other)| is_unsure(other)).map(|(number, _)| number).collect(),
        is_the_first: shooter.skill.is_perfect(),
        scale: (table.diamond(), 0.5 * DVec2::new(table.length, table.width)),
    })
}

/// Returns the total width by which the direction may be off, degrees. `None` if a player of this skill makes the shot
/// much more often than the direction stays within that width: other directions make it too.
fn aim_width(sensitivity: &Sensitivity, cue: &CueInputs, skill: Skill, made: Option<SuccessRate>) -> Option<f64> {
    let margin = sensitivity.margin(Input::Direction, cue)?;
    let width = margin.less? + margin.more?;
    // Of all windows of this width, errors stay most often within the one centred at zero.
    let least = |rate: f64| 2.0 * skill.at(cue).phi.to_degrees() * normal_quantile(0.5 * (1.0 + rate));
    let explains = made.is_none_or(|made| made.rate >= 1.0 || width > MIN_EXPLAINED_SHARE * least(made.rate));
    explains.then_some(width)
}

/// Finds the kiss that spoils the most of the player's attempts; `None` if none spoils at least 2 %.
fn kiss(shooter: Shooter, rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs, seed: u64) -> Option<Kiss> {
    if shooter.skill.is_perfect() {
        return None;
    }
    with_unlimited_task(table, layout, rule, shooter, CONTACT_STEPS, &AtomicBool::new(false), |task| {
        worst_kiss(task, cue, seed)
    })
}

fn worst_kiss(task: &Task, cue: &CueInputs, seed: u64) -> Option<Kiss> {
    let meant = Contacts::of(task.table, task.layout, cue, f64::INFINITY);
    if !task.point().is_made(&meant.tally) {
        return None;
    }
    // Contacts long after the end of the intended shot do no harm.
    let latest = 1.2 * meant.events.last().map_or(0.0, |contact| contact.0);
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
    if share < MIN_KISS_SHARE {
        return None;
    }
    let places = Recording::new(real, layout, stroke).ok()?.positions(*time);
    Some(Kiss { share, balls: *balls, place: 0.5 * (places[balls[0]] + places[balls[1]]) })
}

/// Records the contacts of balls until the cue ball has hit both object balls, or until `latest`.
struct Contacts {
    tally: Tally,
    events: Vec<(f64, [usize; 2])>,
    latest: f64,
    step_budget: StepBudget,
}

impl Contacts {
    fn of(table: &Table, layout: &Layout, cue: &CueInputs, latest: f64) -> Self {
        let step_budget = StepBudget(CONTACT_STEPS);
        let impulse = strike(table, cue);
        let tally = Tally::from_stroke(table, layout, &impulse);
        let mut contacts = Self { tally, events: Vec::new(), latest, step_budget };
        watch(table, layout, &impulse, &mut contacts);
        contacts
    }

    fn count(&self, pair: [usize; 2]) -> usize {
        self.events.iter().filter(|contact| contact.1 == pair).count()
    }

    /// Finds the first contact that does not occur in the intended shot: two balls meet more often than there.
    fn unexpected(&self, meant: &Self) -> Option<(f64, [usize; 2])> {
        let mut seen = Vec::new();
        self.events.iter().copied().find(|(_, pair)| {
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
        self.tally.count(&event);
        if let EventKind::BallBall(one, other) = event.kind {
            let pair = [one, other];
            let last = self.events.iter().rev().find(|contact| contact.1 == pair);
            if last.is_none_or(|last| event.time - last.0 > SAME_CONTACT_WINDOW) {
                self.events.push((event.time, pair));
            }
        }
        if self.tally.has_hit_both() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.step_budget.step()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The break with natural english: red returns from the far cushions across the path of the cue ball.
    fn natural_break() -> (Table, Layout, CueInputs) {
        let table = Table::default();
        let layout = Layout::opening(&table);
        (table, layout, CueInputs::parse("0.143,0.256,0.713,351.760,2.967").unwrap())
    }

    #[test]
    fn frequent_kiss_is_reported_with_balls_and_position() {
        let (table, layout, cue) = natural_break();
        let seen = |skill: Skill| kiss(skill.into(), Rule::ThreeCushion, &table, &layout, &cue, 1);
        let found = seen(Skill::NATIONAL).unwrap();
        assert_eq!(found.balls, [0, 2], "{found:?}");
        assert!((0.02..0.4).contains(&found.share), "{found:?}");
        assert!(found.place.abs().cmple(table.reach()).all(), "{found:?}");
        assert_eq!(seen(Skill::PERFECT), None);
    }

    #[test]
    fn aim_width_is_reported_if_it_explains_the_probability() {
        let (table, layout, cue) = natural_break();
        let sensitivity = Sensitivity::new(Rule::ThreeCushion, &table, &layout, crate::coach::Doubt::NONE);
        let told = |made: usize| aim_width(&sensitivity, &cue, Skill::CLUB, Some(SuccessRate::new(made, 100)));
        let width = told(1).unwrap();
        // Errors stay within a window of this width at most this often.
        let sigma = Skill::CLUB.at(&cue).phi.to_degrees();
        let within = (1..100).find(|made| 2.0 * sigma * normal_quantile(0.5 + 0.005 * *made as f64) > width).unwrap();
        assert_eq!(told(within / 2), Some(width));
        assert_eq!((told((2 * within).min(99)), told(100)), (None, Some(width)), "{width} {within}");
    }
}
