//! The sentence of known shots.

use super::*;
use crate::table::CueBall;

fn words(layout: &str, cue: &str) -> ShotWords {
    let table = Table::preset("textbook").unwrap();
    let layout = Layout::parse(layout, &table).unwrap();
    ShotWords::of(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
}

#[test]
fn a_shot_is_told_as_a_player_says_it() {
    let words = words("-0.7,0 0.9,0.5 0,-0.03075", "-0.2,0.1,0,0,3");
    let sentence = words.sentence(CueBall::White, Units::default());
    assert!(sentence.starts_with("Red, half full on the left; two tips of "), "{sentence}");
    assert!(sentence.contains("right at 2 o'clock, one tip above centre; "), "{sentence}");
    assert!(sentence.ends_with("table lengths), level cue."), "{sentence}");
}
