//! Compares diamond systems, by which players compute their lines, with the simulation.
//!
//! Each system predicts where a cue ball on a given line arrives. One natural stroke per system (side, roll and speed), the
//! same for all its cases, is chosen to fit the arrivals best.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::{
    coach::systems::{self, Line, Mirror},
    table::Table,
};

const SYSTEMS: &str = include_str!("../../../tests/data/filmed/systems.json");

/// A diamond system.
#[derive(Clone, Debug, Deserialize)]
pub struct System {
    /// Its name.
    pub id: String,
    cases: Vec<Case>,
}

#[derive(Clone, Debug, Deserialize)]
struct Case {
    /// The numbers of start, first and third rail; `None` if the source does not have them.
    #[cfg(test)]
    start: Option<f64>,
    #[cfg(test)]
    first: Option<f64>,
    #[cfg(test)]
    third: Option<f64>,
    /// From the diamond behind the start of the line to the diamond of aim.
    cue_line: [[f64; 2]; 2],
    arrival_nose_x: Option<f64>,
    arrival_frame_x: Option<f64>,
    arrival_frame_right_y: Option<f64>,
}

/// A system's natural stroke, and how well it fits.
#[derive(Clone, Debug, Serialize)]
pub struct Natural {
    /// The system's name.
    pub id: String,
    /// Number of cases.
    pub cases: usize,
    /// The stroke.
    #[serde(flatten)]
    pub stroke: systems::NaturalStroke,
    /// Root mean square error of the arrivals, diamonds.
    pub rms: f64,
}

/// Returns the bundled systems.
pub fn bundled() -> Vec<System> {
    #[derive(Deserialize)]
    struct File {
        systems: Vec<System>,
    }
    serde_json::from_str::<File>(SYSTEMS).expect("the bundled systems are valid: a test reads them").systems
}

impl System {
    /// Returns the best natural stroke on `table`, by a grid search over side, roll and speed that is refined five times.
    pub fn natural(&self, table: &Table) -> Natural {
        let mut best = (systems::NaturalStroke { side: 0.0, roll: 1.0, speed: 2.6 }, f64::INFINITY);
        let mut width = [0.8, 0.6, 1.2];
        let mut middle = [0.5, 0.8, 3.0];
        for _ in 0..5 {
            for n in 0..11_i32.pow(3) {
                let step = |place: i32| f64::from(n / 11_i32.pow(place as u32) % 11 - 5) / 5.0;
                let [side, roll, speed] = [0, 1, 2].map(|i| middle[i as usize] + width[i as usize] * step(i));
                if !(0.0..=1.6).contains(&roll) || !(1.5..=4.5).contains(&speed) {
                    continue;
                }
                let stroke = systems::NaturalStroke { side, roll, speed };
                let rms = self.rms(table, &stroke);
                if rms < best.1 {
                    best = (stroke, rms);
                }
            }
            middle = [best.0.side, best.0.roll, best.0.speed];
            width = width.map(|width| 0.35 * width);
        }
        Natural { id: self.id.clone(), cases: self.cases.len(), stroke: best.0, rms: best.1 }
    }

    /// Returns the root mean square error of the arrivals with one stroke, diamonds. A case whose ball does not reach its rail
    /// counts as one diamond.
    pub fn rms(&self, table: &Table, stroke: &systems::NaturalStroke) -> f64 {
        let error = |case: &Case| case.error(self.coach_system()?, table, stroke);
        let squares = self.cases.iter().map(|case| error(case).unwrap_or(1.0).clamp(-1.0, 1.0).powi(2));
        (squares.sum::<f64>() / self.cases.len() as f64).sqrt()
    }

    /// Returns the coach's version of the system.
    fn coach_system(&self) -> Option<systems::System> {
        systems::System::ALL.into_iter().find(|system| system.id() == self.id)
    }
}

impl Case {
    /// Returns how far the ball arrives beyond the system's arrival, diamonds; `None` if it does not arrive.
    fn error(&self, system: systems::System, table: &Table, stroke: &systems::NaturalStroke) -> Option<f64> {
        let [from, to] = self.cue_line.map(DVec2::from_array);
        let line = (to - from).normalize();
        // The ball starts on the line, 0.4 diamonds inside the nose.
        let inside = |place: DVec2| place.x > 0.4 && place.x < 7.6 && place.y > 0.4 && place.y < 3.6;
        let start = (0..200).map(|step| from + 0.02 * f64::from(step) * line).find(|place| inside(*place))?;
        let arrival =
            system.simulated_arrival(table, Mirror::default(), &Line { from: start, direction: line }, stroke)?;
        Some(arrival - self.arrival()?)
    }

    /// Returns the arrival by the system, in diamonds along the third cushion.
    fn arrival(&self) -> Option<f64> {
        self.arrival_nose_x.or(self.arrival_frame_x).or(self.arrival_frame_right_y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn system_numbers_agree_with_the_file_to_a_tenth() {
        for system in bundled() {
            let coach_system = system.coach_system().unwrap();
            for case in &system.cases {
                let [from, to] = case.cue_line.map(DVec2::from_array);
                let line = Line::between(from, to);
                let numbers =
                    coach_system.numbers(&line).unwrap_or_else(|| panic!("{coach_system} {:?}", case.cue_line));
                for (ours, theirs) in
                    [(numbers.start, case.start), (numbers.first, case.first), (numbers.third, case.third)]
                {
                    assert!(
                        theirs.is_none_or(|theirs| (ours - theirs).abs() <= 0.1),
                        "{coach_system} {line:?}: {numbers:?}"
                    );
                }
                let (arrival, wanted) = (coach_system.third_along(numbers.third).unwrap(), case.arrival().unwrap());
                assert!((arrival - wanted).abs() <= 0.1, "{coach_system} {line:?}: {arrival} for {wanted}");
                assert!((coach_system.third_number(arrival).unwrap() - numbers.third).abs() < 1e-9);
            }
        }
        let sizes: Vec<_> = bundled().iter().map(|system| (system.id.clone(), system.cases.len())).collect();
        assert_eq!(sizes, [("corner5".to_owned(), 42), ("plus".to_owned(), 23), ("seven".to_owned(), 35)]);
    }

    #[test]
    fn coach_uses_the_best_fitting_stroke_of_each_system() {
        for (system, most) in bundled().iter().zip([0.11, 0.33, 0.15]) {
            let coach_system = system.coach_system().unwrap();
            let rms = system.rms(&Table::default(), &coach_system.natural_stroke());
            assert!(rms <= most, "{coach_system}: {rms}");
        }
    }
}
