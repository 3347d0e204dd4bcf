//! The shots of the study: random ones that a player could play, and those of the reference files.

use std::f64::consts::TAU;

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Deserialize;

use crate::{
    physics::{CueDegrees, CueInputs, Impulse, strike},
    printing::shell_word,
    simulation::EventKind,
    table::{Flight, Layout, Table},
};

/// The greatest cue elevation of random shots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxElevation(f64);

impl MaxElevation {
    /// Usual strokes: 20 degrees.
    pub const USUAL: Self = Self(0.35);
    /// Jumps and massés: 60 degrees.
    pub const FLIGHTS: Self = Self(std::f64::consts::FRAC_PI_3);

    /// Returns the elevation in degrees.
    pub fn degrees(self) -> f64 {
        self.0.to_degrees().round()
    }
}

/// Range of the random cue speeds, m/s.
const SPEEDS: std::ops::Range<f64> = 0.5..6.0;

/// A shot to study.
#[derive(Clone, Copy, Debug)]
pub struct StudyShot {
    /// Initial positions of the balls.
    pub layout: Layout,
    /// The stroke.
    pub cue: CueInputs,
    /// The impulse of the stroke on the cue ball. Every method starts from exactly these bits.
    pub impulse: Impulse,
}

impl StudyShot {
    /// Creates a shot on `table`.
    pub fn new(table: &Table, layout: Layout, cue: CueInputs) -> Self {
        Self { layout, cue, impulse: strike(table, &cue) }
    }

    /// Returns the command line that plays the shot on the table that `--table` finds by this name or path.
    pub fn command_line(&self, table: &str) -> String {
        let [p, q, r] = self.layout.balls;
        let CueInputs { a, b, theta, phi, speed } = self.cue;
        format!(
            "carom simulate --table {} --layout=\"{},{} {},{} {},{}\" --shot=\"{a},{b},{},{},{speed}\"",
            shell_word(table),
            p.x,
            p.y,
            q.x,
            q.y,
            r.x,
            r.y,
            theta.to_degrees(),
            phi.to_degrees(),
        )
    }
}

/// Draws `count` shots from `seed`: balls anywhere, the tip within the miscue limit, the cue raised up to `max_elevation`, aimed at
/// a random part of an object ball.
pub fn random_shots(table: &Table, count: usize, seed: u64, max_elevation: MaxElevation) -> Vec<StudyShot> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..count).map(|_| random_shot(table, max_elevation, &mut rng)).collect()
}

fn random_shot(table: &Table, max_elevation: MaxElevation, rng: &mut impl Rng) -> StudyShot {
    let layout = Layout::random(table, rng);
    let target = if rng.random() { 1 } else { 2 };
    let line = layout.balls[target] - layout.balls[0];
    let thin = rng.random_range(-1.0..1.0) * (2.0 * table.radius / line.length()).min(1.0);
    let offset = (table.miscue_limit * rng.random_range(0.0..1.0)).sqrt();
    let (a, b) = (offset * rng.random_range(0.0..TAU).sin(), 0.0);
    let b = b + rng.random_range(-1.0..1.0) * (offset * offset - a * a).max(0.0).sqrt();
    // Rounded to digits that a person could type, so that the command line reproduces the same bits.
    let digits = |x: f64| (1e6 * x).round() / 1e6;
    let degrees = |x: f64| digits(x.to_degrees()).to_radians();
    let theta = degrees(rng.random_range(0.0..max_elevation.0));
    let phi = degrees(line.to_angle() + thin.asin());
    let cue = CueInputs { a: digits(a), b: digits(b), theta, phi, speed: digits(rng.random_range(SPEEDS)) };
    StudyShot::new(table, layout, cue)
}

/// A shot computed by an independent program with 50 digits; its numbers are rounded to `f64` in the file.
#[derive(Clone, Debug, Deserialize)]
pub struct ReferenceShot {
    /// Name of the table preset.
    pub preset: String,
    /// Initial positions of the balls.
    pub layout: Layout,
    /// The stroke as written in the file, angles in degrees.
    pub cue: CueDegrees,
    /// Time at which all balls are at rest, s.
    pub duration: f64,
    /// Displacement of the final positions per relative change in speed or angle, m; `None` for resting contacts.
    pub condition: Option<f64>,
    /// The events; empty for resting contacts.
    #[serde(default)]
    pub events: Vec<ReferenceEvent>,
    /// Final positions of the balls.
    #[serde(rename = "final")]
    pub end: Layout,
}

/// An event as the reference files write it.
#[derive(Clone, Debug, Deserialize)]
pub struct ReferenceEvent {
    /// Its time, s.
    pub t: f64,
    /// Its kind, named as in [`EventKind::name`].
    pub kind: String,
    /// The balls involved.
    pub balls: Vec<usize>,
    /// The cushion involved; `None` for other events.
    pub rail: Option<String>,
}

impl ReferenceShot {
    /// Returns the table of the shot, `None` if there is no preset of that name. If a ball leaves the cloth, the table gets the
    /// default flight parameters.
    pub fn table(&self) -> Option<Table> {
        let flies = self.events.iter().any(|event| event.kind == EventKind::Jumps(0).name());
        let table = Table::preset(&self.preset).ok()?;
        Some(if flies { Table { flight: table.flight.or(Some(Flight::default())), ..table } } else { table })
    }

    /// Returns the final positions; a ball that left the table is on its spot.
    pub fn final_layout(&self, table: &Table) -> Layout {
        let leaves = |ball| {
            let is_it =
                |event: &ReferenceEvent| event.balls == [ball] && event.kind == EventKind::LeavesTable(ball).name();
            self.events.iter().any(is_it)
        };
        self.end.with_spotted(table.length, table.radius, std::array::from_fn(leaves))
    }
}

/// Returns the reference files by name: ordinary shots, hard ones, resting contacts, and flights.
pub fn references() -> [(&'static str, Vec<ReferenceShot>); 4] {
    let read = |text: &str| {
        let line = |line| serde_json::from_str(line).expect("the bundled reference shots are valid: a test reads them");
        text.lines().map(line).collect()
    };
    [
        ("shots", read(include_str!("../../tests/data/shots.jsonl"))),
        ("hard", read(include_str!("../../tests/data/hard.jsonl"))),
        ("contact", read(include_str!("../../tests/data/contact.jsonl"))),
        ("flights", read(include_str!("../../tests/data/flights.jsonl"))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_drawn_shot_can_be_played_again_from_its_command_line() {
        let table = Table::preset("textbook").unwrap();
        for shot in random_shots(&table, 200, 5, MaxElevation::USUAL) {
            shot.cue.validate().unwrap();
            shot.cue.validate_tip(table.miscue_limit + 1e-6).unwrap();
            let line = shot.command_line(&table.name);
            let part = |option: &str| line.split_once(option).unwrap().1.split('"').next().unwrap();
            assert_eq!(Layout::parse(part("--layout=\""), &table).unwrap(), shot.layout);
            let cue = CueInputs::parse(part("--shot=\"")).unwrap();
            assert!((cue.phi - shot.cue.phi).abs() < 1e-15 && cue.speed == shot.cue.speed, "{line}");
        }
    }

    #[test]
    fn the_bundled_reference_shots_are_valid() {
        let counts = references().map(|(_, shots)| shots.len());
        assert_eq!(counts, [80, 84, 40, 60]);
    }
}
