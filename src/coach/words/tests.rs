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

#[test]
fn a_jump_says_over_which_ball_and_how_far_the_cue_is_raised() {
    let table = Table { flight: Some(crate::table::Flight::default()), ..Table::preset("textbook").unwrap() };
    let layout = Layout::parse("-0.5,0 -0.2,0 0.5,0.02", &table).unwrap();
    let words = ShotWords::of(&table, &layout, &CueInputs::parse("0,0,45,0,6").unwrap()).unwrap();
    let sentence = words.sentence(CueBall::White, Units::default());
    assert!(sentence.starts_with("Jumps over yellow, then red, "), "{sentence}");
    assert!(sentence.ends_with("cue raised 45°."), "{sentence}");
}
