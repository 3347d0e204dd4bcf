//! Tests of parsing strokes in words.

use super::*;
use proptest::prelude::*;

use crate::{simulation::Rail, table::Table};

/// The cue ball's path lies between the others: yellow ahead of it to the left, red to the right.
fn layout(table: &Table) -> Layout {
    Layout::parse("2d,2d 6d,3d 6d,1d", table).unwrap()
}

fn stroke(text: &str, before: Option<&CueInputs>) -> Result<CueInputs, StrokeTextError> {
    let table = Table::default();
    StrokeText::parse(text)?.stroke(&table, &layout(&table), CueBall::White, before)
}

#[test]
fn stated_fullness_is_hit_with_any_tip_and_cue() {
    let table = Table::default();
    for (text, ball, fullness, left) in [
        ("red 1/2 right, 3 lengths", 2, 0.5, false),
        ("yellow three eighths left, 3 left, 2 up, 5 lengths", 1, 0.375, true),
        (
            "Red, half full on the left; two tips of right at 2 o'clock, one tip above centre; soft (2 table lengths), level cue.",
            2,
            0.5,
            true,
        ),
        ("thin right, the red ball, 1,5 left, cue raised 15°, 2.5 m/s", 2, 0.25, false),
        ("hard, red a graze on the left", 2, 0.02, true),
        ("red 40 % right, medium 2.9", 2, 0.4, false),
    ] {
        let cue = stroke(text, None).unwrap();
        let hit = aim(&table, &layout(&table), &cue).unwrap().hit.unwrap();
        assert_eq!((hit.ball, hit.left), (ball, left), "{text}");
        assert!((hit.fullness - fullness).abs() < 2e-4, "{text}: {hit:?}");
    }
    let full = stroke("red full, 3 lengths", None).unwrap();
    assert!(aim(&table, &layout(&table), &full).unwrap().hit.unwrap().fullness > 0.999);
}

#[test]
fn the_coachs_words_are_parsed_from_one_line_and_from_several() {
    let told = [
        "Red, half full on the right; two tips of right at 2 o'clock, one tip above centre; soft (2 table lengths), level cue.",
        "Red \u{2013} bottom 6.1 \u{2013} right 0.5 \u{2013} yellow, three quarters on the left.",
        "Cue from 1.6 on the left short rail to 2.5 on the right short rail.",
        "Pattern: two cushions (a ball, two cushions, the other ball).",
        "Why: It is made 93 % of the time, the second shot 88 %. The second shot is two cushions, softer.",
    ];
    let cue = stroke(&format!("{} {}", told[0], told[2]), None);
    assert!(cue.is_ok(), "{cue:?}");
    assert_eq!(stroke(&told.join(" "), None), cue);
    assert_eq!(stroke(&told.join("\n"), None), cue);
    assert_eq!(stroke(&told.join("\n").replace('\u{2013}', "-"), None), cue, "as it is printed in ASCII");
}

#[test]
fn tips_lengths_degrees_and_lines_are_parsed() {
    let table = Table::default();
    let read = |text: &str| stroke(&format!("to 2 right, {text}"), None).unwrap();
    let near = |value: f64, wanted: f64| assert!((value - wanted).abs() < 1e-9, "{value}, not {wanted}");
    for (text, a, b) in [
        ("1.5 left, 2 up, soft", 0.15, 0.2),
        ("1\u{bd} tips of running right, a little below centre, soft", -0.15, -0.05),
        ("left one and a half, draw 1, soft", 0.15, -0.1),
        ("2 tips at 3 o'clock, soft", -0.2, 0.0),
        ("no side, half a tip high, soft", 0.0, 0.05),
        ("centre ball, soft", 0.0, 0.0),
    ] {
        let cue = read(text);
        near(cue.a, a);
        near(cue.b, b);
    }
    let edge = read("3 right, 4 up, soft");
    assert!(!edge.is_miscue(&table) && (edge.a + 0.3).abs() < 1e-9, "{edge:?}");
    let clock = read("2 tips at 1:30, soft");
    near(clock.a, -0.2 * 0.5_f64.sqrt());
    near(clock.b, 0.2 * 0.5_f64.sqrt());
    assert!((table_lengths(&table, read("3.5 lengths").speed).unwrap() - 3.5).abs() < 1e-3);
    assert_eq!(read("soft (2.2 table lengths)").speed, read("2.2 lengths").speed, "the number says more than the word");
    near(read("raised 20, 10 ft/s").speed, 3.048);
    near(read("20 degrees, soft").theta, 20_f64.to_radians());
    near(stroke("to 2 right, 3 lengths", None).unwrap().phi, 0.0);
    near(stroke("left 2 \u{2192} right 2, 3 lengths", None).unwrap().phi, 0.0);
    let [nose, wood] = ["to 4 top, soft", "through 4 top, soft"].map(|text| stroke(text, None).unwrap().phi);
    near(nose.tan(), 1.0);
    near(wood.tan(), 2.225 / 2.0);
    let first = stroke("bottom long rail first at 3.5, then red, half full on the left, soft", None).unwrap();
    let technique = crate::coach::Technique::of(&table, &layout(&table), &first).unwrap();
    let met = technique.before.first().unwrap_or_else(|| technique.between.first().unwrap());
    assert!(met.rail == Rail::Bottom && (met.diamond - 3.5).abs() < 0.02, "{met:?}");
}

#[test]
fn omitted_properties_keep_their_previous_values() {
    let table = Table::default();
    let before = stroke("red 1/2 right, 1 left, 2 up, 3 lengths", None).unwrap();
    let softer = stroke("soft", Some(&before)).unwrap();
    assert!(softer.speed < before.speed);
    assert_eq!((softer.a, softer.b, softer.phi), (before.a, before.b, before.phi));
    let fuller = stroke("3/4 right", Some(&before)).unwrap();
    let hit = aim(&table, &layout(&table), &fuller).unwrap().hit.unwrap();
    assert!(hit.ball == 2 && (hit.fullness - 0.75).abs() < 2e-4 && fuller.speed == before.speed);
    // Earlier the cue kept its direction, so that other side meant another hit.
    let other_side = stroke("3 right", Some(&before)).unwrap();
    let hit = aim(&table, &layout(&table), &other_side).unwrap().hit.unwrap();
    assert!(hit.ball == 2 && (hit.fullness - 0.5).abs() < 2e-4 && other_side.phi != before.phi, "{hit:?}");
    assert_eq!(stroke("raised 5", Some(&before)).unwrap().phi, before.phi);
}

#[test]
fn errors_name_the_unreadable_or_unplayable_part() {
    for (text, named) in [
        ("red somehow", "\"red somehow\" is not understood"),
        ("to 3.2", "\"to 3.2\" is not understood"),
        ("red 9/8 left, soft", "\"red 9/8 left\" is not understood"),
        ("1 left up, soft", "\"1 left up\" is not understood"),
        ("red 1/2 left, yellow 1/2 left, soft", "the ball is given twice, last as \"yellow 1/2 left\""),
        ("red 1/2 left, 1 left, 2 right, soft", "side is given twice, last as \"2 right\""),
        ("white 1/2 left, soft", "white is the cue ball"),
        ("1 left, soft", "where to aim is missing"),
        ("red, soft", "where to aim is missing"),
        ("red 1/2, soft", "the side of the ball is missing"),
        ("red 1/2 left", "the speed is missing"),
        ("red 1/2 left, 900 lengths", "900 lengths"),
        ("red 1/2 left, 9 left, soft", "9 tips from the centre"),
        ("red 1/2 left, 4 lengths, soft", "4 lengths are hard, not soft"),
        (" ; ,", "the text has no stroke"),
        ("to 2 right, 50 m/s", "50 m/s is outside the range; accepted are 0.05 to 12"),
        ("to 4.1 right, soft", "\"to 4.1 right\" is not understood"),
        ("to nan right, soft", "\"to nan right\" is not understood"),
        ("red full, raised 95, soft", "a cue raised by 95 degrees is outside the range; accepted is 0"),
    ] {
        let error = stroke(text, None).unwrap_err().to_string();
        assert!(error.contains(named), "{text}: {error}");
    }
    let table = Table::default();
    let behind = Layout::parse("1d,2d 4d,2d 7d,2d", &table).unwrap();
    let hidden = StrokeText::parse("red full, hard").unwrap();
    let error = hidden.stroke(&table, &behind, CueBall::White, None).unwrap_err();
    assert_eq!(error, StrokeTextError::Unreachable("red"));
}

/// Words of stroke texts, and some that are invalid.
const WORDS: &str = "red|yellow|white|the|ball|1/2|3/0|half|thin|full|on|left|right|up|below|1.5|1e9|-2|nan|inf|one|\
    and a half|a|tips|of|at|o'clock|13:70|to|from|through|top|first at|lengths|m/s|raised|level|,|;|\u{bd}";

proptest! {
    #[test]
    fn any_text_gives_a_playable_stroke_or_an_error(
        words in prop::collection::vec(prop::sample::select(WORDS.split('|').collect::<Vec<_>>()), 0..14),
        played_before: bool,
    ) {
        let table = Table::default();
        let before = CueInputs::parse("0.1,0.2,5,12.5,3").unwrap();
        let said = stroke(&words.join(" "), played_before.then_some(&before));
        match said {
            Ok(cue) => prop_assert!(cue.validate().is_ok() && cue.validate_tip(table.miscue_limit).is_ok(), "{cue:?}"),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}

/// Earlier the tip of a massé was judged as that of a level cue.
#[test]
fn a_raised_cue_may_hit_farther_up() {
    let masse = stroke("red full, 9 up, raised 60, 3 lengths", None).unwrap();
    assert!((masse.b - 0.9).abs() < 1e-9 && (masse.theta.to_degrees() - 60.0).abs() < 1e-9, "{masse:?}");
    let faster = stroke("4 lengths", Some(&masse)).unwrap();
    assert!(faster.speed > masse.speed && faster.b == masse.b);
    assert!(matches!(stroke("raised 0", Some(&masse)), Err(StrokeTextError::Tips(..))));
}
