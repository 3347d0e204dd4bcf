//! The rules: when a shot scores a point.

use std::{fmt, ops::ControlFlow, str::FromStr};

use serde::{Deserialize, Serialize};

use super::{Point, Touching};
use crate::{
    physics::{CueInputs, Impulse, strike},
    simulation::{AllSavings, CushionContacts, Event, EventKind, Observer, StepBudget, watch_with},
    table::{Layout, Table},
};

/// The condition of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Rule {
    /// Straight rail: the cue ball hits both object balls (r3 of the thesis).
    #[default]
    #[serde(rename = "straight")]
    StraightRail,
    /// At least one cushion before the first contact with the second object ball.
    #[serde(rename = "one-cushion")]
    OneCushion,
    /// At least three cushions before the first contact with the second object ball.
    #[serde(rename = "three-cushion")]
    ThreeCushion,
}

/// Error: an unknown name of a rule.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no rule \"{0}\"; use straight, one-cushion or three-cushion")]
pub struct UnknownRule(String);

impl Rule {
    /// All rules.
    pub const ALL: [Self; 3] = [Self::StraightRail, Self::OneCushion, Self::ThreeCushion];

    /// Returns the name on the command line and in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::StraightRail => "straight",
            Self::OneCushion => "one-cushion",
            Self::ThreeCushion => "three-cushion",
        }
    }

    /// Returns the number of cushion contacts needed before the second object ball.
    pub const fn cushions(self) -> u32 {
        match self {
            Self::StraightRail => 0,
            Self::OneCushion => 1,
            Self::ThreeCushion => 3,
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for Rule {
    type Err = UnknownRule;

    fn from_str(text: &str) -> Result<Self, UnknownRule> {
        let name = match text {
            "straight rail" | "straight-rail" => Self::StraightRail.name(),
            "1" | "1c" | "one" => Self::OneCushion.name(),
            "3" | "3c" | "three" => Self::ThreeCushion.name(),
            name => name,
        };
        Self::ALL.into_iter().find(|rule| rule.name() == name).ok_or_else(|| UnknownRule(text.to_owned()))
    }
}

/// The contacts of the cue ball in a shot so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Whether it has hit each object ball (balls 1 and 2).
    pub hit: [bool; 2],
    /// Whether ball 2, the red one, was hit first.
    pub red_first: bool,
    /// Number of cushion contacts.
    pub cushions: u32,
    /// Number of cushion contacts before the first object ball.
    pub cushions_before_first: u32,
    /// Number of cushion contacts before the second object ball.
    pub cushions_before_second: u32,
    /// Whether it has hit its first object ball again before the second.
    pub hit_again: bool,
    /// Whether a ball has left the table: a foul by every rule, so no point.
    pub left_table: bool,
    /// The ball that touched the cue ball and was pushed by the stroke, which is a foul too. No event reports it, so it
    /// must be set when the tally is created.
    pub pushed: Option<usize>,
    /// Number of balls in the air.
    pub airborne: u8,
    /// The cue ball's cushion contacts, without bounces that are too small to see.
    pub contacts: CushionContacts,
}

impl Tally {
    /// Creates the initial tally of a stroke.
    #[inline]
    pub fn from_stroke(table: &Table, layout: &Layout, impulse: &Impulse) -> Self {
        Self { pushed: Touching::of(table, layout).pushed(layout, impulse), ..Self::default() }
    }

    /// Counts one event.
    pub fn count(&mut self, event: &Event) {
        self.cushions += u32::from(self.contacts.follow(0, event).is_some());
        match event.kind {
            EventKind::BallBall(0, ball) if !self.hit[ball - 1] => {
                if !self.has_hit_any() {
                    self.red_first = ball == 2;
                }
                self.hit[ball - 1] = true;
                if self.has_hit_both() {
                    self.cushions_before_second = self.cushions;
                } else {
                    self.cushions_before_first = self.cushions;
                }
            }
            EventKind::BallBall(0, _) => self.hit_again |= !self.has_hit_both(),
            EventKind::Jumps(_) => self.airborne += 1,
            EventKind::Lands(_) => self.airborne -= 1,
            EventKind::LeavesTable(_) => {
                self.airborne -= 1;
                self.left_table = true;
            }
            _ => {}
        }
    }

    /// Whether nothing can change the result: the cue ball has hit `enough` object balls and no ball is in the air, or
    /// there was a foul.
    pub fn is_decided(&self, enough: u8) -> bool {
        let hits = u8::from(self.hit[0]) + u8::from(self.hit[1]);
        self.is_foul() || (hits >= enough && self.airborne == 0)
    }

    /// Whether the cue ball has hit an object ball.
    pub fn has_hit_any(&self) -> bool {
        self.hit[0] || self.hit[1]
    }

    /// Whether it has hit both object balls.
    pub fn has_hit_both(&self) -> bool {
        self.hit[0] & self.hit[1]
    }

    /// Returns the object ball that was hit first, if any: 1 or 2.
    pub fn first_ball(&self) -> Option<usize> {
        self.has_hit_any().then_some(if self.red_first { 2 } else { 1 })
    }

    /// Returns the object balls that have not been hit yet.
    pub fn not_hit(&self) -> [bool; 2] {
        self.hit.map(|hit| !hit)
    }

    /// Whether there was a foul, which rules out a point.
    pub const fn is_foul(&self) -> bool {
        self.left_table || self.pushed.is_some()
    }

    /// Whether this is a point by the rule, whichever ball was first; it can still become one until both object balls
    /// are hit. [`super::Point`] has the additional condition of an opening shot.
    pub fn is_point(&self, rule: Rule) -> bool {
        self.has_hit_both() && self.cushions_before_second >= rule.cushions() && !self.is_foul()
    }
}

/// Observes a shot until its result is decided.
#[derive(Clone, Copy, Debug)]
pub struct Referee {
    /// The contacts of the cue ball so far.
    pub tally: Tally,
    enough: Option<u8>,
    step_budget: StepBudget,
}

impl Referee {
    /// Observes a shot to its end.
    pub fn until_end() -> Self {
        Self::new(None, u32::MAX)
    }

    /// Observes until the cue ball has hit `enough` object balls, or to the end of the shot if `None`. A shot whose
    /// resting contacts take more than `steps` integration steps counts as decided by then.
    pub fn new(enough: Option<u8>, steps: u32) -> Self {
        Self { tally: Tally::default(), enough, step_budget: StepBudget(steps) }
    }

    /// Starts with this tally.
    #[must_use]
    pub const fn with_tally(self, tally: Tally) -> Self {
        Self { tally, ..self }
    }
}

impl Observer for Referee {
    fn wants_ends(&self) -> bool {
        self.enough.is_none()
    }

    fn awaited(&self) -> Option<[bool; 2]> {
        self.enough.map(|_| self.tally.not_hit())
    }

    #[inline]
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.tally.count(&event);
        match self.enough {
            Some(enough) if self.tally.is_decided(enough) => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.step_budget.step()
    }
}

/// Whether a shot makes a point. The layout and the stroke are not validated.
pub fn scores(rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    let impulse = strike(table, cue);
    let mut referee = Referee::new(Some(2), u32::MAX).with_tally(Tally::from_stroke(table, layout, &impulse));
    watch_with::<AllSavings, _>(table, layout, &impulse, &mut referee);
    Point::of(rule, table, layout).is_made(&referee.tally)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::{Rail, Recording};

    fn tally(kinds: &[EventKind]) -> Tally {
        let mut tally = Tally::default();
        for (index, kind) in kinds.iter().enumerate() {
            tally.count(&Event { time: index as f64, kind: *kind });
        }
        tally
    }

    const RAIL: EventKind = EventKind::BallRail(0, Rail::Top);

    #[test]
    fn three_cushions_count_only_before_the_second_ball() {
        let before = tally(&[RAIL, EventKind::BallBall(0, 2), RAIL, RAIL, EventKind::BallBall(0, 1)]);
        assert!(before.is_point(Rule::ThreeCushion) && before.is_point(Rule::OneCushion));
        assert_eq!((before.first_ball(), tally(&[RAIL]).first_ball()), (Some(2), None));
        let after = tally(&[RAIL, EventKind::BallBall(0, 2), RAIL, EventKind::BallBall(0, 1), RAIL]);
        assert!(!after.is_point(Rule::ThreeCushion) && after.is_point(Rule::OneCushion));
    }

    /// Found as a recommendation on `thesis`, said to make five cushions: its spin presses the ball on a cushion.
    #[test]
    fn bounces_too_small_to_see_are_no_cushions() {
        let table = Table::preset("thesis").unwrap();
        let at = "0.6283951506,0.1520682201 -0.2642806437,0.5864331828 -1.0299205072,0.5257231269";
        let (layout, cue) = (
            Layout::parse(at, &table).unwrap(),
            CueInputs::parse("-0.42116,0.07782,2.52145,155.41484,2.55193").unwrap(),
        );
        let recording = Recording::new(&table, &layout, &cue).unwrap();
        let (mut counted, mut bounces) = (Tally::default(), 0);
        for event in recording.events() {
            counted.count(event);
            if counted.has_hit_both() {
                break;
            }
            bounces += u32::from(matches!(event.kind, EventKind::BallRail(0, _)));
        }
        assert_eq!((bounces, counted.cushions), (5, 2));
        assert!(!scores(Rule::ThreeCushion, &table, &layout, &cue));
    }

    #[test]
    fn hit_again_is_set_only_before_second_ball() {
        let hit_again = |balls: &[usize]| {
            let hits: Vec<EventKind> = balls.iter().map(|ball| EventKind::BallBall(0, *ball)).collect();
            tally(&hits).hit_again
        };
        assert!(hit_again(&[1, 1, 2]) && hit_again(&[2, 2]));
        assert!(!hit_again(&[1, 2]) && !hit_again(&[1, 2, 1]));
    }

    #[test]
    fn foul_decides_the_shot_without_a_point() {
        let both = Tally { hit: [true; 2], ..Tally::default() };
        assert!(both.is_point(Rule::StraightRail));
        for foul in [Tally { left_table: true, ..both }, Tally { pushed: Some(1), ..both }] {
            assert!(!foul.is_point(Rule::StraightRail) && foul.is_decided(2));
        }
        let table = Table::default();
        let gap = |gap: f64| Layout::parse(&format!("0,0 {},0 -0.3,0.02", 2.0 * table.radius + gap), &table).unwrap();
        let cue = CueInputs::parse("0,-0.4,5,0,3").unwrap();
        assert_eq!([0.0, 1e-3].map(|apart| scores(Rule::StraightRail, &table, &gap(apart), &cue)), [false, true]);
    }

    #[test]
    fn hitting_one_ball_twice_is_no_point() {
        let tally = tally(&[EventKind::BallBall(0, 1), RAIL, EventKind::BallBall(0, 1)]);
        assert!(tally.first_ball() == Some(1) && !tally.is_point(Rule::StraightRail));
    }

    #[test]
    fn contacts_between_object_balls_are_ignored() {
        let tally = tally(&[
            EventKind::BallBall(0, 1),
            EventKind::BallBall(1, 2),
            EventKind::BallRail(1, Rail::Left),
            EventKind::SlidingRolling(0),
        ]);
        assert_eq!((tally.hit, tally.cushions), ([true, false], 0));
    }

    #[test]
    fn rule_names_round_trip_and_unknown_names_are_refused() {
        for rule in Rule::ALL {
            assert_eq!(rule.name().parse(), Ok(rule));
        }
        for (short, rule) in [
            ("3", Rule::ThreeCushion),
            ("3c", Rule::ThreeCushion),
            ("three", Rule::ThreeCushion),
            ("one", Rule::OneCushion),
        ] {
            assert_eq!(short.parse(), Ok(rule));
        }
        assert!("snooker".parse::<Rule>().unwrap_err().to_string().contains("snooker"));
    }
}
