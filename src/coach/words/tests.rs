//! Tests of the sentences for known shots.

use super::*;
use crate::{
    physics::raise_to_clear,
    table::{CueBall, Rail},
};

fn words(layout: &str, cue: &str) -> ShotWords {
    let table = Table::preset("textbook").unwrap();
    let layout = Layout::parse(layout, &table).unwrap();
    ShotWords::of(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
}

#[test]
fn shot_is_described_in_players_terms() {
    let words = words("-0.7,0 0.9,0.5 0,-0.03075", "-0.2,0.1,0,0,3");
    let sentence = words.sentence(CueBall::White, Units::default());
    assert!(sentence.starts_with("Red, half full on the left; two tips of "), "{sentence}");
    assert!(sentence.contains("right at 2 o'clock, one tip above centre; "), "{sentence}");
    assert!(sentence.ends_with("table lengths), level cue."), "{sentence}");
}

#[test]
fn all_cushions_before_first_ball_are_listed() {
    let cushion = words("-1,-0.5 1.3,-0.5 1.3,0.5", "-0.3,0,0,45,3").before[0];
    let before = [Rail::Top, Rail::Right].map(|rail| Cushion { rail, ..cushion }).to_vec();
    let words = ShotWords { before, ..words("-0.7,0 0.9,0.5 0,-0.03075", "-0.2,0.1,0,0,3") };
    let sentence = words.sentence(CueBall::White, Units::default());
    assert!(sentence.starts_with("Top long rail first at "), "{sentence}");
    assert!(sentence.contains(", then right short rail, then red, half full on the left; "), "{sentence}");
}

#[test]
fn course_ends_with_the_hit_on_the_second_ball() {
    let course = |layout: &str, cue: &str| words(layout, cue).course(CueBall::White, Units::default());
    let told = course("-1,0 0,0.02 0.6,0.1", "0,0.3,0,0,4");
    assert!(told.starts_with("Yellow \u{2013} ") && told.ends_with(" \u{2013} red, half on the right."), "{told}");
    let mirrored = course("-1,0 0,-0.02 0.6,-0.1", "0,0.3,0,0,4");
    assert!(mirrored.ends_with(" \u{2013} red, half on the left."), "{mirrored}");
    let short = words("-1,0 0,0.02 0.6,0.1", "0,0.3,0,0,4").short_course(CueBall::White, Units::default());
    assert_eq!(short, told.replace(", half on the right", ""));
    let nothing = words("-0.7,0 0.9,0.5 0,-0.03075", "0,0,0,10,0.3");
    let (white, units) = (CueBall::White, Units::default());
    for told in [nothing.course(white, units), nothing.short_course(white, units)] {
        assert_eq!(told, "Hits neither ball nor cushion.");
    }
}

#[test]
fn minimal_elevation_is_level_except_over_a_near_rail() {
    let table = Table::preset("match").unwrap();
    let told = |layout: &str, raised: f64| {
        let layout = Layout::parse(layout, &table).unwrap();
        let level = CueInputs::parse("0,0,0,0,2").unwrap();
        let low = raise_to_clear(&table, &layout, &level).unwrap();
        assert!(low.theta > 0.0, "{low:?}");
        let cue = CueInputs { theta: low.theta + raised.to_radians(), ..low };
        ShotWords::of(&table, &layout, &cue).unwrap().sentence(CueBall::White, Units::default())
    };
    let (middle, at_the_rail) = ("-0.7,0 0.9,0.5 0.5,-0.3", "-1.38,0 0.9,0.5 0.5,-0.3");
    assert!(told(middle, 0.0).ends_with(", level cue."), "{}", told(middle, 0.0));
    assert!(told(middle, 4.0).contains(", cue raised "), "{}", told(middle, 4.0));
    assert!(told(at_the_rail, 0.0).ends_with(", cue as level as it can be."), "{}", told(at_the_rail, 0.0));
}

#[test]
fn jump_names_the_cleared_ball_and_the_elevation() {
    let table = Table { flight: Some(crate::table::Flight::default()), ..Table::preset("textbook").unwrap() };
    let layout = Layout::parse("-0.5,0 -0.2,0 0.5,0.02", &table).unwrap();
    let words = ShotWords::of(&table, &layout, &CueInputs::parse("0,0,45,0,6").unwrap()).unwrap();
    let sentence = words.sentence(CueBall::White, Units::default());
    assert!(sentence.starts_with("Jumps over yellow, then red, "), "{sentence}");
    assert!(sentence.ends_with("cue raised 45°."), "{sentence}");
}
