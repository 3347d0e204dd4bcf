//! The simulator against shots that an independent program computed with 50 significant digits.

use carom::{
    physics::CueInputs,
    simulation::Recording,
    table::{Layout, Table},
};
use serde::Deserialize;

#[derive(Deserialize)]
struct Shot {
    preset: String,
    layout: Layout,
    cue: CueInputs,
    duration: f64,
    #[serde(default)]
    condition: f64,
    #[serde(default)]
    events: Vec<serde_json::Value>,
    #[serde(rename = "final")]
    end: Layout,
}

fn shots(text: &str) -> Vec<Shot> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn play(shot: &Shot) -> Recording {
    let table = Table::preset(&shot.preset).unwrap();
    Recording::new(&table, &shot.layout, &shot.cue).unwrap()
}

fn distance(one: &Layout, other: &Layout) -> f64 {
    one.balls.iter().zip(other.balls).map(|(a, b)| a.distance(b)).fold(0.0, f64::max)
}

fn check_exact(text: &str) {
    let mut units = Vec::new();
    for (line, shot) in shots(text).iter().enumerate() {
        let recording = play(shot);
        let line = line + 1;
        let names = |events: &[serde_json::Value]| -> Vec<String> {
            events.iter().map(|e| format!("{} {} {}", e["kind"], e["balls"], e["rail"])).collect()
        };
        let ours: Vec<serde_json::Value> =
            recording.events().iter().map(|event| serde_json::to_value(event).unwrap()).collect();
        assert_eq!(names(&ours), names(&shot.events), "line {line}: another sequence of events");
        if shot.condition < 1e6 {
            for (mine, theirs) in ours.iter().zip(&shot.events) {
                let error = (mine["t"].as_f64().unwrap() - theirs["t"].as_f64().unwrap()).abs();
                assert!(error < 1e-9, "line {line}: {mine} is {error:e} s off {theirs}");
            }
            assert!((recording.duration() - shot.duration).abs() < 1e-9, "line {line}: duration");
        }
        let unit = (1.0 + shot.condition) * 2f64.powi(-53);
        let error = distance(&recording.final_layout(), &shot.end) / unit;
        assert!(error <= 1000.0, "line {line}: the balls stop {error} units off");
        units.push(error);
    }
    units.sort_by(f64::total_cmp);
    println!(
        "error / ((1 + condition) 2^-53): median {:.2}, p90 {:.2}, worst {:.1}",
        units[units.len() / 2],
        units[units.len() * 9 / 10],
        units[units.len() - 1]
    );
}

#[test]
fn ordinary_shots_are_exact() {
    check_exact(include_str!("../data/shots.jsonl"));
}

#[test]
fn hard_shots_are_exact() {
    check_exact(include_str!("../data/hard.jsonl"));
}

#[test]
fn resting_contacts_end_within_a_billionth_of_a_metre() {
    let mut worst = 0.0_f64;
    for (line, shot) in shots(include_str!("../data/contact.jsonl")).iter().enumerate() {
        let recording = play(shot);
        let error = distance(&recording.final_layout(), &shot.end);
        let late = (recording.duration() - shot.duration).abs();
        assert!(error < 1e-9 && late < 1e-8, "line {}: {error:e} m, {late:e} s off", line + 1);
        worst = worst.max(error);
    }
    println!("worst error {worst:e} m");
}
