//! A recommended shot as the screen needs it: its recording, the dots of its paths, and how it meets the first ball.

use glam::DVec2;

use super::words::BALL_NAMES;
use crate::{
    coach::{Hit, first_hit},
    physics::{CueInputs, Impulse},
    simulation::{Recording, ShotError},
    table::{BALLS, Layout, Table},
};

/// Distance of two dots of a path, m. The screen shows every second or third of them, as its sub-pixels ask for.
pub const DOT_SPACING: f64 = 0.0275;
/// Seconds between two looks at a path; at 10 m/s a ball moves 10 mm meanwhile, well below a dot's distance.
const PATH_STEP: f64 = 0.001;

/// A dot of a ball's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// When the ball is here, s.
    pub time: f64,
    /// Where, m.
    pub place: DVec2,
}

/// A shot ready to be shown and played.
#[derive(Debug)]
pub struct Shot {
    /// What the player has to do.
    pub cue: CueInputs,
    /// What the stroke gives the cue ball.
    pub impulse: Impulse,
    /// Whether the shot makes the point.
    pub solved: bool,
    /// Where the shot comes from.
    pub source: String,
    /// What happens, exact at any time.
    pub recording: Recording,
    /// The dots of the three balls' paths.
    pub paths: [Vec<Dot>; BALLS],
    /// The first contact of the cue ball with an object ball.
    pub contact: Option<Hit>,
}

impl Shot {
    /// Records the shot `cue` from `layout`; `solved` says whether it makes the point, `source` where it comes from.
    ///
    /// # Errors
    /// What the simulator refuses.
    pub fn new(
        table: &Table,
        layout: &Layout,
        cue: CueInputs,
        solved: bool,
        source: impl Into<String>,
    ) -> Result<Self, ShotError> {
        let recording = Recording::new(table, layout, &cue)?;
        Ok(Self {
            cue,
            impulse: *recording.impulse(),
            solved,
            source: source.into(),
            paths: std::array::from_fn(|ball| dots(&recording, ball)),
            contact: first_hit(table, &recording),
            recording,
        })
    }

    /// How the cue ball meets the first object ball, in words.
    pub fn contact_words(&self) -> Option<String> {
        let contact = self.contact?;
        let side = if contact.left { "left" } else { "right" };
        let percent = (100.0 * contact.fullness).round();
        Some(format!("hits {} {percent}% full, {side} side", BALL_NAMES[contact.ball]))
    }
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
            // What is over counts for the next, so that the distance is right on average.
            since_dot -= DOT_SPACING;
            dots.push(Dot { time, place });
        }
    }
    dots
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shot(layout: &str, cue: &str) -> Shot {
        let table = Table::default();
        let layout = Layout::parse(layout, &table).unwrap();
        Shot::new(&table, &layout, CueInputs::parse(cue).unwrap(), false, "policy").unwrap()
    }

    #[test]
    fn fullness_and_side_are_those_the_player_sees() {
        // The object ball lies half a radius to the right of the cue ball's way along x: its left side is hit.
        let half = shot("-0.7,0 0,-0.03075 0.9,0.5", "0,0,0,0,3");
        let contact = half.contact.unwrap();
        assert_eq!(contact.ball, 1);
        assert!((contact.fullness - 0.5).abs() < 0.01, "{contact:?}");
        assert_eq!(half.contact_words().unwrap(), "hits yellow 50% full, left side");
    }

    #[test]
    fn a_ball_that_is_touched_from_the_start_is_met_along_the_stroke() {
        let contact = shot("0,0 0.0615,0 0.9,0.5", "0,0,0,0,3").contact.unwrap();
        assert!((contact.fullness - 1.0).abs() < 1e-9, "{contact:?}");
    }

    #[test]
    fn dots_are_evenly_spaced_along_the_way() {
        let dots = &shot("-1,0 0,0.6 1,0.6", "0,0,0,0,1.5").paths[0];
        assert!(dots.len() > 10);
        for pair in dots.windows(2) {
            assert!((pair[1].place.distance(pair[0].place) - DOT_SPACING).abs() < 0.01);
        }
    }
}
