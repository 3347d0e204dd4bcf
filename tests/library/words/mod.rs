//! The coach's words for a shot: every recommendation has a name, and a player who follows the words makes the point.

mod read_back;

use std::time::Duration;

use carom::{
    coach::{Coach, Doubt, Pattern, Request, ShotWords, Skill, Technique, Units},
    game::{Rule, scores},
    table::{CueBall, Layout, Table},
};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use read_back::{Reading, stroke};

const READINGS: [Reading; 4] = [Reading::Sentence, Reading::Course, Reading::Aim, Reading::Both];

/// Results of recommendations that are put into words and read back.
#[derive(Debug, Default)]
struct ReadBackCounts {
    solved: usize,
    named: usize,
    /// Points of the strokes that are read back, by the way of reading.
    made: [usize; READINGS.len()],
}

/// Recommends shots for this many layouts under every rule, and reads their words back.
fn read_back_recommendations(layouts: usize, simulations: u64) -> ReadBackCounts {
    let table = Table::default();
    let coach = Coach::new(table.clone());
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(20);
    let mut counts = ReadBackCounts::default();
    for number in 0..layouts {
        let layout = Layout::random(&table, &mut rng);
        let rule = Rule::ALL[number % Rule::ALL.len()];
        let budget = Duration::from_secs(60);
        let request =
            Request { rule, skill: Skill::EXPERT, doubt: Doubt::FULL, budget, simulations, ..Request::default() };
        let advice = coach.recommend(&layout, &request).unwrap();
        let technique = Technique::of(&table, &layout, &advice.cue).unwrap();
        if !scores(rule, &table, &layout, &advice.cue) {
            continue;
        }
        counts.solved += 1;
        counts.named += usize::from(Pattern::of(&technique).is_some());
        let words = ShotWords::of_technique(&table, &layout, &advice.cue, &technique);
        let (units, white) = (Units::default(), CueBall::White);
        let text = [words.sentence(white, units), words.course(white, units), words.aim(units)].join("\n");
        for (reading, made) in READINGS.into_iter().zip(&mut counts.made) {
            let read =
                stroke(&text, reading, &table, &layout).unwrap_or_else(|error| panic!("{text}: {error}: {layout:?}"));
            *made += usize::from(scores(rule, &table, &layout, &read));
        }
    }
    counts
}

#[test]
fn recommendations_read_back_from_their_words_score() {
    let counts = read_back_recommendations(42, 4000);
    assert_eq!(counts.named, counts.solved, "{counts:?}");
    let [.., both] = counts.made;
    assert!(counts.solved >= 38 && 10 * both >= 9 * counts.solved, "{counts:?}");
}

/// Run by `cargo test --profile quick --test library words:: -- --ignored --nocapture`: takes minutes.
#[test]
#[ignore = "takes minutes"]
fn a_thousand_recommendations_read_back_from_their_words_score() {
    let counts = read_back_recommendations(1000, 20_000);
    println!("{counts:?} for {READINGS:?}");
    assert_eq!(counts.named, counts.solved, "{counts:?}");
    let least = 9 * counts.solved;
    assert!(counts.solved >= 980 && counts.made.iter().all(|made| 10 * made >= least), "{counts:?}");
}
