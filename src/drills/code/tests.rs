//! Tests of share codes: round trips, damaged and wrapped codes, and other versions.

use proptest::prelude::*;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::*;
use crate::table::Table;

/// Layouts on a millimetre grid, at any position, and with touching balls.
fn layout(seed: u64, sort: u8) -> Layout {
    let table = Table::default();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut layout = Layout::random(&table, &mut rng);
    match sort {
        0 => layout.balls = layout.balls.map(|ball| (ball * 1e3).trunc() / 1e3),
        1 => {}
        _ => {
            let towards = (layout.balls[1] - layout.balls[0]).normalize();
            layout.balls[0] = layout.balls[1] - 2.0 * table.radius * towards;
        }
    }
    layout
}

prop_compose! {
    fn exercises()(
        seed: u64,
        sort in 0..3_u8,
        rule in prop::sample::select(Rule::ALL.to_vec()),
        name in "[a-z0-9._-]{0,60}",
        title in "\\PC{0,80}",
        tags in prop::collection::vec("\\PC{1,20}", 0..5),
        shot in prop::option::of((-0.35..0.35, -0.35..0.35, 0.0..1.5_f64, -10.0..10.0, 0.01..9.0)),
    ) -> Exercise {
        // A name must not begin with a dot.
        let own = Exercise::new_own(&format!("x{name}"), rule, &match_table(), layout(seed, sort));
        let shot = shot.map(|(a, b, theta, phi, speed)| CueInputs { a, b, theta, phi, speed });
        Exercise { title, tags, shot, ..own }
    }
}

proptest! {
    #[test]
    fn exercise_round_trips_to_the_stated_precision(exercise in exercises()) {
        prop_assume!(exercise.validate().is_ok());
        let code = encode(&exercise).unwrap();
        let read = decode(&code).unwrap();
        prop_assert_eq!(read.layout, exercise.layout);
        prop_assert_eq!((&read.name, read.rule, &read.table), (&exercise.name, exercise.rule, &exercise.table));
        prop_assert_eq!(read.shot.is_some(), exercise.shot.is_some());
        if let (Some(read), Some(shot)) = (read.shot, exercise.shot) {
            prop_assert!((read.a - shot.a).abs() <= 1e-5 && (read.b - shot.b).abs() <= 1e-5);
            prop_assert!(read.tip_offset_squared() <= shot.tip_offset_squared() + 1e-12);
            prop_assert!((read.theta - shot.theta).to_degrees().abs() <= 1e-3);
            let turn = (read.phi - shot.phi).to_degrees();
            prop_assert!((turn - (turn / 360.0).round() * 360.0).abs() <= 0.51e-3);
            prop_assert!((read.speed - shot.speed).abs() <= 0.51e-4);
        }
        prop_assert!(code.len() <= MAX_CODE_LENGTH);
        if exercise.title.len() < 40 && exercise.tags.is_empty() && !exercise.title.is_empty() {
            prop_assert_eq!(&read.title, &exercise.title);
        }
        // Decoding and encoding again gives the same exercise.
        prop_assert_eq!(decode(&encode(&read).unwrap()).unwrap(), read);
    }

    #[test]
    fn any_changed_missing_or_extra_letter_is_detected(exercise in exercises(), letter in "[0-9a-z:=+/é]") {
        prop_assume!(exercise.validate().is_ok());
        let code = encode(&exercise).unwrap();
        for place in 0..=code.len() {
            let (before, after) = code.split_at(place);
            prop_assert!(decode(&format!("{before}{letter}{after}")).is_err(), "added at {}", place);
            let Some(there) = after.chars().next() else { continue };
            prop_assert!(decode(&format!("{before}{}", &after[1..])).is_err(), "missing at {}", place);
            prop_assert!(decode(before).is_err(), "cut at {}", place);
            let same = |letter: char| match letter { 'o' => '0', 'i' | 'l' => '1', other => other };
            if letter.chars().next().map(same) != Some(same(there)) {
                prop_assert!(decode(&format!("{before}{letter}{}", &after[1..])).is_err(), "changed at {}", place);
            }
        }
    }

    #[test]
    fn decoding_ignores_line_breaks_and_case(exercise in exercises(), width in 1..30_usize) {
        prop_assume!(exercise.validate().is_ok());
        let code = encode(&exercise).unwrap();
        let letters: Vec<char> = code.chars().collect();
        let wrapped: Vec<String> = letters.chunks(width).map(|line| line.iter().collect()).collect();
        let wrapped = format!("\n \t{}\r\n", wrapped.join("\r\n  "));
        prop_assert_eq!(decode(&wrapped).unwrap(), decode(&code).unwrap());
        prop_assert_eq!(decode(&code.to_uppercase()).unwrap(), decode(&code).unwrap());
    }
}

fn plain(layout: Layout) -> Exercise {
    Exercise::new_own("mine", Rule::ThreeCushion, &match_table(), layout)
}

#[test]
fn code_without_shot_is_short() {
    assert!(encode(&plain(layout(1, 0))).unwrap().len() <= 50);
    assert!(encode(&plain(layout(1, 1))).unwrap().len() <= 110);
}

#[test]
fn invalid_and_newer_codes_are_refused_with_a_message() {
    let said = |text: &str| decode(text).unwrap_err().to_string();
    assert!(said("https://example.org").contains("\"https://example.org\"") && said("").contains("carom:"));
    assert!(said("carom:").contains("damaged") && said("carom:u").contains("'u'"));
    let mut newer = vec![9, 1, 2, 3];
    newer.extend(CHECKSUM.checksum(&newer).to_be_bytes());
    assert!(said(&format!("carom:{}", base32::encode(&newer))).contains("version 9"));
}

#[test]
fn tags_are_split_into_words_and_unknown_flags_refused() {
    let tags = ["two words", "#bare", "#", ""].map(str::to_owned);
    let text = code(&plain(layout(1, 0)), "", &tags);
    assert_eq!(decode(&text).unwrap().tags, ["two", "words", "bare"]);
    let mut bytes = base32::decode(text.strip_prefix(PREFIX).unwrap()).unwrap();
    bytes.truncate(bytes.len() - size_of_val(&CHECKSUM.checksum(&[])));
    // The byte after the version, the table's empty name and the rule.
    bytes[3] |= 4;
    bytes.extend(CHECKSUM.checksum(&bytes).to_be_bytes());
    assert!(matches!(decode(&format!("{PREFIX}{}", base32::encode(&bytes))), Err(CodeError::Damaged)));
}

#[test]
fn unplayable_exercise_is_neither_encoded_nor_decoded() {
    let table = Table::default();
    let mut overlapping = plain(layout(1, 0));
    overlapping.layout.balls[1] = overlapping.layout.balls[0];
    assert!(matches!(encode(&overlapping), Err(ExerciseError::Layout(_))));
    assert!(matches!(decode(&code(&overlapping, "", &[])), Err(CodeError::Exercise(ExerciseError::Layout(_)))));
    let unnamed = Exercise { name: "a/b".to_owned(), ..plain(Layout::opening(&table)) };
    assert!(matches!(encode(&unnamed), Err(ExerciseError::Name(name)) if name == "a/b"));
}
