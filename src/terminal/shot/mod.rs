//! A shot prepared for display: its recording, the dots of its paths, its description in words, and its hit on the first object ball.

pub mod aiming;
pub mod film;
pub mod history;
pub mod placing;
pub mod playback;
pub mod profile;
pub mod spin;
pub mod stroke;
pub mod what_if;

use std::sync::OnceLock;

use glam::DVec2;

pub use self::{
    history::History,
    playback::{Playback, PlaybackKey},
    profile::Profile,
    spin::Spin,
    stroke::{OwnStroke, StrokeChange},
    what_if::WhatIf,
};

use crate::{
    coach::{Hit, Pattern, ShotWords, Technique, Verdict},
    game::Rule,
    physics::CueInputs,
    simulation::{EventKind, REPORTED_HEIGHT, Rail, Recording, ShotError},
    table::{BALLS, CueBall, Layout, Table},
};

/// Distance of two dots of a path, m. The screen draws every second or third of them, depending on its sub-pixels.
pub const DOT_SPACING: f64 = 0.0275;
/// Sampling interval of a path, s; at 10 m/s a ball moves 10 mm in it, well below the distance of two dots.
const PATH_STEP: f64 = 0.001;

/// A dot of a ball's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Time at which the ball is here, s.
    pub time: f64,
    /// Position, m.
    pub position: DVec2,
    /// Height above the cloth, m.
    pub height: f64,
}

impl Dot {
    /// Whether the ball is visibly in the air.
    pub fn is_aloft(&self) -> bool {
        self.height >= REPORTED_HEIGHT
    }
}

/// The cue ball's first contact with one of the object balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The object ball, 1 or 2.
    pub ball: usize,
    /// Time, s.
    pub time: f64,
    /// Position of the cue ball, m.
    pub position: DVec2,
    /// Position of the object ball, m.
    pub other: DVec2,
}

/// The first thing that the cue ball hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstImpact {
    /// An object ball, with the hit.
    Ball(Hit),
    /// A cushion, and the hit on the first object ball after it, if any.
    Rail(Rail, Option<Hit>),
    /// Nothing.
    Nothing,
}

impl FirstImpact {
    /// The first thing that the cue ball hits in a recorded shot, whose hit on its first object ball is `first`.
    pub fn of(recording: &Recording, first: Option<Hit>) -> Self {
        let met = recording.events().iter().find_map(|event| match event.kind {
            EventKind::BallRail(0, rail) => Some(Some(rail)),
            EventKind::BallBall(0, _) => Some(None),
            _ => None,
        });
        match (met.flatten(), first) {
            (Some(rail), hit) => Self::Rail(rail, hit),
            (None, Some(hit)) => Self::Ball(hit),
            (None, None) => Self::Nothing,
        }
    }
}

/// A shot ready for display and playback.
#[derive(Debug)]
pub struct Shot {
    /// The stroke.
    pub cue: CueInputs,
    /// Whether the shot makes the point.
    pub solved: bool,
    /// Where the shot comes from, in a word.
    pub source: String,
    /// The simulated motion, exact at any time.
    pub recording: Recording,
    /// The dots of the three balls' paths.
    pub paths: [Vec<Dot>; BALLS],
    /// The cue ball's first contact with each object ball that it hits.
    pub contacts: Vec<Contact>,
    /// Description in a player's words.
    pub words: ShotWords,
    /// The pattern of the shot; `None` if it does not hit both object balls.
    pub pattern: Option<&'static Pattern>,
    /// Side view of its jump, computed at first use.
    profile: OnceLock<Option<Profile>>,
    /// The verdict by each rule, computed at first use.
    verdicts: [OnceLock<Verdict>; Rule::ALL.len()],
}

impl Shot {
    /// Simulates the stroke `cue` from `layout`. `solved`: whether it makes the point; `source`: where it comes from.
    ///
    /// # Errors
    /// Any error of the simulator.
    pub fn new(
        table: &Table,
        layout: &Layout,
        cue: CueInputs,
        solved: bool,
        source: impl Into<String>,
    ) -> Result<Self, ShotError> {
        Ok(Self::of(table, Recording::new(table, layout, &cue)?, cue, solved, source))
    }

    /// Prepares a recorded shot; `cue` is the stroke to display.
    pub fn of(table: &Table, recording: Recording, cue: CueInputs, solved: bool, source: impl Into<String>) -> Self {
        let technique = Technique::of_recorded(table, &recording);
        let layout = Layout::new(recording.positions(0.0));
        Self {
            cue,
            solved,
            source: source.into(),
            paths: std::array::from_fn(|ball| dots(&recording, ball)),
            contacts: (1..BALLS).filter_map(|ball| first_contact(&recording, ball)).collect(),
            words: ShotWords::of_technique(table, &layout, &cue, &technique),
            pattern: Pattern::of(&technique),
            profile: OnceLock::new(),
            verdicts: Default::default(),
            recording,
        }
    }

    /// Side view of its jump on `table`, which must be the table of the recording; `None` if no ball jumps.
    pub fn profile(&self, table: &Table) -> Option<&Profile> {
        self.profile.get_or_init(|| Profile::of(table, &self.recording)).as_ref()
    }

    /// The verdict by a rule on `table`, which must be the table of the recording.
    pub fn verdict(&self, rule: Rule, table: &Table) -> Verdict {
        let place = Rule::ALL.iter().position(|one| *one == rule).unwrap_or_default();
        *self.verdicts[place].get_or_init(|| {
            let layout = Layout::new(self.recording.positions(0.0));
            Verdict::of(rule, table, &layout, &self.recording)
        })
    }

    /// Spin of the cue ball, of `radius` in m, at `time`, s, while the shot runs; `None` before and after.
    pub fn spin(&self, time: f64, radius: f64) -> Option<Spin> {
        let is_under_way = time > 0.0 && time < self.recording.duration();
        is_under_way.then(|| Spin::of(&self.recording.state(0, time), self.recording.motion(0, time), radius))
    }

    /// The first thing that the cue ball hits.
    pub fn first_impact(&self) -> FirstImpact {
        FirstImpact::of(&self.recording, self.words.first)
    }

    /// Describes the hit on the first object ball, with balls named for the player of `cue_ball`.
    pub fn contact_words(&self, cue_ball: CueBall) -> Option<String> {
        let contact = self.words.first?;
        let side = contact.side().map_or_else(String::new, |side| format!(", {side} side"));
        let percent = (100.0 * contact.fullness).round();
        Some(format!("hits {} {percent} % full{side}", cue_ball.names()[contact.ball]))
    }
}

fn first_contact(recording: &Recording, ball: usize) -> Option<Contact> {
    let event = recording.events().iter().find(|event| event.kind == EventKind::BallBall(0, ball))?;
    let place = |ball: usize| recording.state(ball, event.time).position;
    Some(Contact { ball, time: event.time, position: place(0), other: place(ball) })
}

fn dots(recording: &Recording, ball: usize) -> Vec<Dot> {
    let mut dots = Vec::new();
    let mut last = recording.state(ball, 0.0).position;
    let mut since_dot = 0.0;
    let steps = (recording.duration() / PATH_STEP) as u32;
    for step in 1..=steps {
        let time = PATH_STEP * f64::from(step);
        let place = recording.state(ball, time).position;
        since_dot += place.distance(last);
        last = place;
        if since_dot >= DOT_SPACING {
            // Carry over the excess, so that the distance is right on average.
            since_dot -= DOT_SPACING;
            dots.push(Dot { time, position: place, height: recording.height(ball, time) });
        }
    }
    dots
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shot(layout: &str, cue: &str) -> Shot {
        let table = Table::preset("textbook").unwrap();
        let layout = Layout::parse(layout, &table).unwrap();
        Shot::new(&table, &layout, CueInputs::parse(cue).unwrap(), false, "policy").unwrap()
    }

    #[test]
    fn fullness_and_side_are_as_seen_by_the_player() {
        // The object ball lies half a radius to the right of the cue ball's path along x: its left side is hit.
        let half = shot("-0.7,0 0,-0.03075 0.9,0.5", "0,0,0,0,3");
        let contact = half.words.first.unwrap();
        assert_eq!(contact.ball, 1);
        assert!((contact.fullness - 0.5).abs() < 0.01, "{contact:?}");
        assert_eq!(half.contact_words(CueBall::White).unwrap(), "hits yellow 50 % full, left side");
        assert_eq!(half.contact_words(CueBall::Yellow).unwrap(), "hits white 50 % full, left side");
    }

    #[test]
    fn contacts_are_the_first_touches_of_each_object_ball() {
        let shot = shot("-1,0 0,0.02 0.6,0.1", "0,0.3,0,0,4");
        let [yellow, red] = shot.contacts[..] else { panic!("{:?}", shot.contacts) };
        assert!(yellow.time < red.time && yellow.position.distance(shot.words.first.unwrap().place) < 1e-12);
        for contact in [yellow, red] {
            assert!((contact.position.distance(contact.other) - 0.0615).abs() < 1e-9, "{contact:?}");
        }
        assert!(matches!(shot.first_impact(), FirstImpact::Ball(hit) if hit.ball == 1));
    }

    #[test]
    fn a_cushion_before_the_first_ball_is_the_first_impact() {
        let bank = shot("0,0 -0.5,0 1,0.5", "0,0,0,0,4");
        assert!(
            matches!(bank.first_impact(), FirstImpact::Rail(Rail::Right, Some(hit)) if hit.ball == 1),
            "{:?}",
            bank.first_impact()
        );
        assert_eq!(shot("0,0 -1,0.5 1,0.5", "0,0,0,0,0.2").first_impact(), FirstImpact::Nothing);
    }

    #[test]
    fn a_ball_touched_from_the_start_is_hit_along_the_stroke() {
        let shot = shot("0,0 0.0615,0 0.9,0.5", "0,0,0,0,3");
        let contact = shot.words.first.unwrap();
        assert!((contact.fullness - 1.0).abs() < 1e-9, "{contact:?}");
        let words = shot.contact_words(CueBall::White).unwrap();
        assert_eq!(words, "hits yellow 100 % full", "head-on has no side");
    }

    #[test]
    fn dots_are_evenly_spaced_along_the_path() {
        let dots = &shot("-1,0 0,0.6 1,0.6", "0,0,0,0,1.5").paths[0];
        assert!(dots.len() > 10);
        for pair in dots.windows(2) {
            assert!((pair[1].position.distance(pair[0].position) - DOT_SPACING).abs() < 0.01);
        }
    }
}
