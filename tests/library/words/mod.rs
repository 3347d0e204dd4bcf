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
struct Tried {
    solved: usize,
    named: usize,
    /// Points of the strokes that are read back, by the way of reading.
    made: [usize; READINGS.len()],
}

/// Recommends shots for this many layouts under every rule, and reads their words back.
fn tried(layouts: usize, simulations: u64) -> Tried {
    let table = Table::default();
    let coach = Coach::new(table.clone());
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(20);
    let mut tried = Tried::default();
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
        tried.solved += 1;
        tried.named += usize::from(Pattern::of(&technique).is_some());
        let words = ShotWords::of_technique(&table, &layout, &advice.cue, &technique);
        let (units, white) = (Units::default(), CueBall::White);
        let text = [words.sentence(white, units), words.course(white, units), words.aim(units)].join("\n");
        for (reading, made) in READINGS.into_iter().zip(&mut tried.made) {
            let read =
                stroke(&text, reading, &table, &layout).unwrap_or_else(|error| panic!("{text}: {error}: {layout:?}"));
            *made += usize::from(scores(rule, &table, &layout, &read));
        }
    }
    tried
}

#[test]
fn recommendations_have_names_and_who_goes_by_the_words_makes_the_point() {
    let tried = tried(42, 4000);
    assert_eq!(tried.named, tried.solved, "{tried:?}");
    let [.., both] = tried.made;
    assert!(tried.solved >= 38 && 10 * both >= 9 * tried.solved, "{tried:?}");
}

/// Run by `cargo test --profile quick --test library words:: -- --ignored --nocapture`: takes minutes.
#[test]
#[ignore = "minutes"]
fn a_thousand_recommendations_have_names_and_make_the_point_when_their_words_are_read_back() {
    let tried = tried(1000, 20_000);
    println!("{tried:?} for {READINGS:?}");
    assert_eq!(tried.named, tried.solved, "{tried:?}");
    let least = 9 * tried.solved;
    assert!(tried.solved >= 980 && tried.made.iter().all(|made| 10 * made >= least), "{tried:?}");
}
