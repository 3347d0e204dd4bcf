//! Diamond systems: what players count on, against the simulation.
//!
//! Each system says where a cue ball that runs along a given line arrives. One natural stroke a system, the same for all
//! its cases, is chosen so that the arrivals fit best: its side, its roll and its speed.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::lone::{Follower, Motion, alone};
use crate::{simulation::Rail, table::Table};

const SYSTEMS: &str = include_str!("../../../tests/data/filmed/systems.json");

/// How far behind the nose the diamonds stand, in diamonds.
const FRAME: f64 = 0.225;

/// A diamond system.
#[derive(Clone, Debug, Deserialize)]
pub struct System {
    /// Its name.
    pub id: String,
    cases: Vec<Case>,
}

#[derive(Clone, Debug, Deserialize)]
struct Case {
    /// From the diamond behind which the line begins to that through which it is aimed.
    cue_line: [[f64; 2]; 2],
    #[serde(default)]
    arrival_nose_x: Option<f64>,
    #[serde(default)]
    arrival_frame_x: Option<f64>,
    #[serde(default)]
    arrival_frame_right_y: Option<f64>,
}

/// A system's natural stroke, and how well it fits.
#[derive(Clone, Debug, Serialize)]
pub struct Natural {
    /// The system's name.
    pub id: String,
    /// Cases.
    pub cases: usize,
    /// Running side as a surface speed, over the ball's speed.
    pub side: f64,
    /// Roll over natural roll.
    pub roll: f64,
    /// Speed of the ball, m/s.
    pub speed: f64,
    /// Root mean square of the arrivals' errors, diamonds.
    pub rms: f64,
}

/// The bundled systems.
pub fn bundled() -> Vec<System> {
    #[derive(Deserialize)]
    struct File {
        systems: Vec<System>,
    }
    serde_json::from_str::<File>(SYSTEMS).expect("the bundled systems are valid: a test reads them").systems
}

impl System {
    /// The natural stroke on `table`: the best of a net of sides, rolls and speeds.
    pub fn natural(&self, table: &Table) -> Natural {
        let mut best = Natural {
            id: self.id.clone(),
            cases: self.cases.len(),
            side: 0.0,
            roll: 1.0,
            speed: 2.6,
            rms: f64::INFINITY,
        };
        let mut width = [0.8, 0.6, 1.2];
        let mut middle = [0.5, 0.8, 3.0];
        for _ in 0..5 {
            for n in 0..11_i32.pow(3) {
                let step = |place: i32| f64::from(n / 11_i32.pow(place as u32) % 11 - 5) / 5.0;
                let [side, roll, speed] = [0, 1, 2].map(|i| middle[i as usize] + width[i as usize] * step(i));
                if !(0.0..=1.6).contains(&roll) || !(1.5..=4.5).contains(&speed) {
                    continue;
                }
                let rms = self.rms(table, side, roll, speed);
                if rms < best.rms {
                    best = Natural { side, roll, speed, rms, ..best };
                }
            }
            middle = [best.side, best.roll, best.speed];
            width = width.map(|width| 0.35 * width);
        }
        best
    }

    /// Root mean square of the errors with one stroke, diamonds. A case that does not come to its rail counts as a diamond.
    pub fn rms(&self, table: &Table, side: f64, roll: f64, speed: f64) -> f64 {
        let squares =
            self.cases.iter().map(|case| case.error(table, side, roll, speed).unwrap_or(1.0).clamp(-1.0, 1.0).powi(2));
        (squares.sum::<f64>() / self.cases.len() as f64).sqrt()
    }
}

impl Case {
    /// How far beyond the system's arrival the ball comes, diamonds.
    fn error(&self, table: &Table, side: f64, roll: f64, speed: f64) -> Option<f64> {
        let [from, to] = self.cue_line.map(DVec2::from_array);
        let diamond = table.diamond();
        let metres = |place: DVec2| (place - DVec2::new(4.0, 2.0)) * diamond;
        let line = (to - from).normalize();
        // The ball lies on the line, half a diamond inside the nose.
        let inside = |place: DVec2| place.x > 0.4 && place.x < 7.6 && place.y > 0.4 && place.y < 3.6;
        let start = (0..200).map(|step| from + 0.02 * f64::from(step) * line).find(|place| inside(*place))?;
        // Running side on the first rail: towards where the ball goes on.
        let running = if line.perp_dot(self.next_direction(line)?) < 0.0 { 1.0 } else { -1.0 };
        let motion = Motion {
            place: metres(start),
            velocity: speed * line,
            slip: (1.0 - roll) * speed * line,
            side: running * side * speed,
        };
        let followed = Follower::new(&[], 5).of(table, &alone(motion.place), &motion.impulse(table.radius));
        let wanted = if self.arrival_frame_right_y.is_some() { Rail::Right } else { Rail::Bottom };
        // The leg that leads to the third rail, or to it past a corner that is met first.
        let hit = if followed.hits.get(1)?.1 == wanted { 1 } else { 2 };
        let diamonds = |place: DVec2| place / diamond + DVec2::new(4.0, 2.0);
        let (before, place) = (diamonds(followed.hits[hit - 1].2), diamonds(followed.hits.get(hit)?.2));
        // The nose is a ball's radius beyond its centre; the diamonds are behind the nose, on the same line.
        let radius = table.radius / diamond;
        let direction = place - before;
        let at_bottom = |beyond: f64| {
            let way = (before.y - radius + beyond) / -direction.y;
            (direction.y < 0.0).then_some(before.x + way * direction.x)
        };
        if let Some(x) = self.arrival_nose_x {
            // The ball touches the nose beside its centre.
            Some(at_bottom(0.0)? - x)
        } else if let Some(x) = self.arrival_frame_x {
            Some(at_bottom(FRAME + radius)? - x)
        } else {
            let way = (8.0 + FRAME - before.x) / direction.x;
            (direction.x > 0.0)
                .then_some(before.y + way * direction.y)
                .zip(self.arrival_frame_right_y)
                .map(|(y, wanted)| y - wanted)
        }
    }

    /// Where a ball goes on along the first rail: the way that it came.
    fn next_direction(&self, line: DVec2) -> Option<DVec2> {
        let to = DVec2::from_array(self.cue_line[1]);
        let n = if to.x < 0.0 {
            DVec2::X
        } else if to.y > 4.0 {
            DVec2::NEG_Y
        } else if to.y < 0.0 {
            DVec2::Y
        } else if to.x > 8.0 {
            DVec2::NEG_X
        } else {
            return None;
        };
        Some(line - 2.0 * line.dot(n) * n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bundled_systems_have_the_cases_that_their_readme_tells() {
        let sizes: Vec<_> = bundled().iter().map(|system| (system.id.clone(), system.cases.len())).collect();
        assert_eq!(sizes, [("corner5".to_owned(), 42), ("plus".to_owned(), 23), ("seven".to_owned(), 35)]);
    }
}
