//! Why a shot leads: its margin, the kiss that lies in wait, what it leaves, and how the next best differs.

use std::{ops::ControlFlow, sync::atomic::AtomicBool};

use glam::DVec2;
use serde::Serialize;

use super::{
    Alternative, Input, Pattern, Recommendation, Sensitivity, Shooter, Skill, Technique, Units,
    draws::Draws,
    trial::{CONTACT_STEPS, Task, unhurried},
    words::{self, PlaceUnit, short, table_lengths},
};
use crate::{
    game::{Rule, Tally},
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Recording, ShotError, StepBudget, watch},
    statistics::{SuccessRate, quantile},
    table::{CueBall, Layout, Table},
};

/// Attempts among which kisses are counted.
const ATTEMPTS: usize = 200;

/// Share of the attempts from which on a kiss is named.
const NAMED: f64 = 0.02;

/// Difference of make probabilities from which on attempts tell which shot is the better one: the standard error of it where half of a
/// thousand and of four hundred attempts make the point.
const TOLD_APART: f64 = 0.03;

/// Share of the width that errors of direction would need at least for a shot's make probability, below which the width is not told.
const EXPLAINED: f64 = 0.8;

/// Two balls that meet again within this time have met once, s: a ball that follows another through runs on to it.
const SAME: f64 = 0.1;

/// Differences of fullness and of table lengths that are told.
const FULLER: f64 = 0.06;
const HARDER: f64 = 0.3;

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
    /// The numbers of the shots that seem to be made more often than the first, from 2, which luck may explain: their intervals meet.
    #[serde(skip)]
    unsure: Vec<usize>,
    /// Whether the shots are ranked by this point and the next.
    #[serde(skip)]
    is_planned: bool,
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
    let (balls, stroke, real, layout, time) = found.iter().max_by_key(|kiss| count(kiss.0))?;
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

impl Why {
    /// In one line, for who plays with `cue_ball`.
    pub fn words(&self, cue_ball: CueBall, units: Units) -> String {
        let names = cue_ball.names();
        let mut parts = Vec::new();
        let second = self.second.as_ref();
        let other = second.and_then(|second| second.make_probability);
        let plan = self.plan_words("the second shot");
        parts.extend(self.make_probability.zip(other).map(|(rate, other)| {
            let [own, its] = [rate, other].map(percent);
            if (rate - other).abs() > TOLD_APART {
                let luck = if self.is_unsure() { ", which is not surely more" } else { "" };
                format!("made {own} of the time, the second shot {its}{luck}")
            } else {
                format!("made {own} of the time, about as often as the second shot ({its})")
            }
        }));
        let alone = self.make_probability.filter(|_| other.is_none());
        parts.extend(alone.map(|rate| format!("made {} of the time", percent(rate))));
        parts.extend(plan.clone().filter(|_| self.is_by_plan()));
        parts.extend(self.aim_deg.map(|width| match second.and_then(|second| second.aim_deg) {
            Some(other) => {
                format!("its aim may be {} off in all, that of the second shot {}", degrees(width), degrees(other))
            }
            None => format!("its aim may be {} off in all", degrees(width)),
        }));
        parts.extend(self.kiss.map(|Kiss { share, balls: [one, other], place }| {
            let (diamond, middle) = self.scale;
            let at = (place + middle).to_array().map(|along| match units.place {
                PlaceUnit::Diamonds => short(along / diamond, 1),
                PlaceUnit::Mm => format!("{} mm", short(1e3 * along, 0)),
            });
            let [along, up] = at;
            format!(
                "{} and {} kiss in {} of the strokes, at {along} along and {up} up",
                names[one],
                names[other],
                percent(share)
            )
        }));
        parts.extend(plan.filter(|_| !self.is_by_plan()));
        parts.extend(second.map(|second| second.words(names)));
        if parts.is_empty() {
            return "Nothing else was found that makes the point.".to_owned();
        }
        words::capital(&format!("{}.", parts.join("; ")))
    }

    /// Whether the second-best shot is made more often, and this one leads because the next point counts too: as far as that is known, both
    /// together are more likely after it.
    fn is_by_plan(&self) -> bool {
        let second = self.second.as_ref();
        let made = self.make_probability.zip(second.and_then(|second| second.make_probability));
        let next = self.next_probability.zip(second.and_then(|second| second.next_probability));
        self.is_planned
            && made.is_some_and(|(own, other)| {
                own < other && next.is_none_or(|(after, after_other)| own * after > other * after_other)
            })
    }

    /// Whether the second-best shot seems to be made more often, which luck may explain, and no plan decides.
    fn is_unsure(&self) -> bool {
        self.unsure.contains(&2) && !self.is_by_plan()
    }

    /// How the next point is left, beside how the second-best shot, which is called `other`, leaves it.
    fn plan_words(&self, other: &str) -> Option<String> {
        let there = self.second.as_ref().and_then(|second| second.next_probability);
        let there = there.map_or_else(String::new, |there| format!(" (after {other}: {})", percent(there)));
        let left = self.next_probability.map(|next| format!("it leaves the next point at {}{there}", percent(next)));
        match left {
            Some(left) if self.is_by_plan() => Some(format!("the plan decides: {left}")),
            None if self.is_by_plan() => Some("the plan decides: the next point counts too".to_owned()),
            left => left,
        }
    }

    /// The same in few words beside the chance that it is made, for who plays with `cue_ball`: how the second-best shot differs first,
    /// and that the plan decides where it does. What comes first says all; every further sentence is a fact shorter.
    pub fn brief(&self, cue_ball: CueBall) -> impl Iterator<Item = String> {
        let names = cue_ball.names();
        let second = self.second.as_ref().map_or_else(
            || "no other was found".to_owned(),
            |second| {
                let made = second.make_probability.map_or_else(String::new, |rate| format!(": {}", percent(rate)));
                let luck = if self.is_unsure() { ", not surely more" } else { "" };
                format!("shot 2 ({}){made}{luck}", second.parts(names))
            },
        );
        let mut facts = self.facts(cue_ball);
        let first = if self.is_by_plan() { format!("{second}; {}", facts.remove(0)) } else { second };
        ever_shorter(std::iter::once(first).chain(facts).collect())
    }

    /// The part of it that a list of the shots with their chances does not say, ever shorter; nothing where there is nothing.
    pub fn beside_the_list(&self, cue_ball: CueBall) -> impl Iterator<Item = String> {
        let unsure: Vec<String> =
            self.unsure.iter().filter(|number| **number != 2 || self.is_unsure()).map(usize::to_string).collect();
        let luck = match &unsure[..] {
            [] => None,
            [number] => Some(format!("shot {number} is not surely made more often")),
            numbers => Some(format!("shots {} are not surely made more often", numbers.join(", "))),
        };
        ever_shorter(luck.into_iter().chain(self.facts(cue_ball)).collect()).map(|sentence| words::capital(&sentence))
    }

    /// What the list of the shots does not say. That the plan decides comes first, where it does.
    fn facts(&self, cue_ball: CueBall) -> Vec<String> {
        let names = cue_ball.names();
        let mut parts = Vec::new();
        parts.extend(self.aim_deg.map(|width| {
            let other = self.second.as_ref().and_then(|second| second.aim_deg);
            let there = other.map_or_else(String::new, |width| format!(", shot 2's {}", degrees(width)));
            format!("the aim may be {} off in all{there}", degrees(width))
        }));
        parts.extend(self.kiss.map(|Kiss { share, balls: [one, other], .. }| {
            format!("{} and {} kiss in {}", names[one], names[other], percent(share))
        }));
        if let Some(plan) = self.plan_words("shot 2") {
            let place = if self.is_by_plan() { 0 } else { parts.len() };
            parts.insert(place, plan);
        }
        parts
    }
}

/// Sentences of these parts, the first with all, every further one without the last of the one before.
fn ever_shorter(parts: Vec<String>) -> impl Iterator<Item = String> {
    (1..=parts.len()).rev().map(move |many| format!("{}.", parts[..many].join("; ")))
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn degrees(width: f64) -> String {
    format!("{}\u{b0}", short(width, 2))
}

impl Difference {
    fn words(&self, names: [&'static str; 3]) -> String {
        format!("the second shot: {}", self.parts(names))
    }

    fn parts(&self, names: [&'static str; 3]) -> String {
        let mut parts = vec![self.pattern.unwrap_or("another shot").to_owned()];
        parts.extend(self.first_ball.map(|ball| format!("off {}", names[ball])));
        parts
            .extend((self.fuller.abs() > FULLER).then(|| if self.fuller > 0.0 { "thicker" } else { "thinner" }.into()));
        parts.extend((self.harder.abs() > HARDER).then(|| if self.harder > 0.0 { "harder" } else { "softer" }.into()));
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coach::{Coach, Request};

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

    #[test]
    fn the_reasons_are_facts_of_the_two_best_shots() {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 0,0 0.5,0.03", &table).unwrap();
        let coach = Coach::without_policy(table.clone());
        let request = Request {
            skill: Skill::CLUB,
            simulations: 3000,
            budget: std::time::Duration::from_secs(60),
            ..Request::default()
        };
        let advice = coach.recommend(&layout, &request).unwrap();
        let why = why(request.shooter(), request.rule, &table, &layout, &advice, 1).unwrap();
        assert_eq!(why.make_probability, advice.make_probability.map(|rate| rate.rate));
        assert!(why.second.is_some() && !advice.alternatives.is_empty());
        let sentences: Vec<String> = why.brief(CueBall::White).collect();
        let [brief, .., least] = &sentences[..] else { panic!("{sentences:?}") };
        assert!(brief.starts_with("shot 2 (") && brief.contains("\u{b0} off in all") && brief.len() < 170, "{brief}");
        assert!(least.starts_with("shot 2 (") && least.ends_with(" %.") && !least.contains("off in all"), "{least}");
        let said = why.words(CueBall::White, Units::default());
        assert!(said.ends_with('.') && said.contains("the second shot"), "{said}");
        // Where the next point counts too, a shot may lead that is made less often.
        let second = why.second.clone().map(|second| Difference {
            make_probability: Some(0.9),
            next_probability: Some(0.31),
            ..second
        });
        let planned =
            Why { make_probability: Some(0.8), next_probability: Some(0.62), second, is_planned: true, ..why.clone() };
        let reason = "the plan decides: it leaves the next point at 62 %";
        assert!(
            planned
                .words(CueBall::White, Units::default())
                .contains(&format!("{reason} (after the second shot: 31 %)"))
        );
        for sentence in planned.brief(CueBall::White) {
            assert!(sentence.contains(&format!("{reason} (after shot 2: 31 %)")), "{sentence}");
        }
        assert!(planned.beside_the_list(CueBall::White).all(|sentence| sentence.starts_with("The plan decides")));
        let unknown = Why { next_probability: None, ..planned }.words(CueBall::White, Units::default());
        assert!(unknown.contains("the plan decides: the next point counts too"), "{unknown}");
        // By luck alone the second may seem to be made more often; then that is no reason against the first.
        let second = |unsure: &[usize]| {
            let second = why.second.clone().map(|second| Difference { make_probability: Some(0.54), ..second });
            Why { make_probability: Some(0.48), second, is_planned: false, unsure: unsure.to_vec(), ..why.clone() }
        };
        let said = second(&[2]).words(CueBall::White, Units::default());
        assert!(said.starts_with("Made 48 % of the time, the second shot 54 %, which is not surely more;"), "{said}");
        for sentence in second(&[2]).brief(CueBall::White) {
            assert!(sentence.contains("%, not surely more"), "{sentence}");
        }
        let first = second(&[2]).beside_the_list(CueBall::White).next().unwrap();
        assert!(first.starts_with("Shot 2 is not surely made more often"), "{first}");
        for (unsure, words) in [(&[3][..], "Shot 3 is not surely"), (&[2, 3], "Shots 2, 3 are not surely")] {
            let first = second(unsure).beside_the_list(CueBall::White).next().unwrap();
            assert!(first.starts_with(words), "{first}");
        }
        let said = second(&[]).words(CueBall::White, Units::default());
        assert!(said.starts_with("Made 48 % of the time, the second shot 54 %; "), "{said}");
        let alone = Why { second: None, ..why }.words(CueBall::White, Units::default());
        assert!(alone.ends_with('.') && !alone.contains("next shot"), "{alone}");
    }
}
