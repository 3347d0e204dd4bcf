//! Whole conversations.

use super::*;
use crate::coach::words::LengthUnit;
use std::time::Instant;

fn talk(lines: &str) -> String {
    talk_of(None, &Settings { think_ms: 1_000, ..Settings::default() }, lines)
}

/// A conversation with a player of this own skill, under these settings.
fn talk_of(own: Option<Skill>, settings: &Settings, lines: &str) -> String {
    let table = Table::default();
    let layout = Layout::parse("-0.5,0 0,0 0.5,0.03", &table).unwrap();
    let mut output = Vec::new();
    let initial = InitialState { layout, own, seed: 1 };
    converse(Coach::new(table), initial, settings, lines.as_bytes(), &mut output, "").unwrap();
    String::from_utf8(output).unwrap()
}

fn assert_contains(reply: &str, all: &[&str]) {
    for words in all {
        assert!(reply.contains(words), "{words}: {reply}");
    }
}

#[test]
fn a_too_long_line_is_refused_and_the_conversation_continues() {
    let reply = talk(&format!("{}\nwhere\nquit", "x".repeat(2 << 20)));
    assert!(reply.contains("too long; accepted are up to 1048576 bytes") && reply.len() < 2000, "{}", reply.len());
    assert_eq!(reply.matches("White lies at").count(), 2, "{reply}");
}

#[test]
fn a_shot_is_described_with_margins_course_and_end() {
    let reply = talk("shot\nnumbers\nmargins\ntell\ngo on\nundo\nquit\nwhere");
    assert_contains(
        &reply,
        &[
            "percent of the time, between",
            "hits yellow",
            "table lengths), ",
            "Pattern: ",
            "\nPoint: ",
            "Direction: up to",
            "white meets yellow.",
            "all balls lie still",
        ],
    );
    assert!(!reply.contains(['%', '\u{b0}']), "signs are words: {reply}");
    let first = "White lies at 2.59 diamonds along and 2.00 up, -500 and 0 millimetres from the middle.";
    assert_eq!(reply.matches(first).count(), 2, "at the start and after undo, but not after quit: {reply}");
}

#[test]
fn tenths_of_a_millimetre_are_given_unless_zero() {
    let reply = talk("balls 2d,0.5d 6d,2d 4d,3.5d");
    for words in [", -710 and -532.5 millimetres", ", 710 and 0 millimetres", ", 0 and 532.5 millimetres"] {
        assert!(reply.contains(words), "{words}: {reply}");
    }
}

#[test]
fn distances_and_speeds_are_in_the_unit_of_the_settings() {
    let units = Units { length: LengthUnit::Feet, ..Units::default() };
    let settings = Settings { think_ms: 1_000, units, ..Settings::default() };
    let reply = talk_of(None, &settings, "words\nshot\nnumbers\nmargins\ntell\n");
    assert_contains(
        &reply,
        &["-19.69 and 0.00 inches from the middle", "0.121 inches each", "feet a second, ", "feet a second softer"],
    );
    assert!(!reply.contains("m/s") && !reply.contains("metres a second"), "{reply}");
    assert!(!reply.contains("millimetres"), "{reply}");
}

#[test]
fn the_system_of_a_shot_and_the_terms_are_explained() {
    let reply = talk("system\nwords\nrule three-cushion\nballs 2d,2.6d 2d,2d 6d,2d\nshot\nsystem");
    assert!(reply.contains("There is no shot yet") && reply.contains("3.1 millimetres each"), "{reply}");
    let told = reply.lines().last().unwrap();
    let is_told = told.contains("Aim through the diamond") || told.starts_with("Parallel shift");
    assert!(is_told || told == "No diamond system describes this shot.", "{reply}");
}

/// The reasons for a shot and its diamond system are computed after the search. They must take less time than 2000 shots on the same
/// machine, which is half of a short search.
#[test]
#[ignore = "compares times: cargo test --profile quick --lib the_reasons -- --ignored"]
fn the_reasons_take_no_longer_than_a_short_search() {
    let table = Table::default();
    let layout = Layout::opening(&table);
    let coach = Coach::new(table.clone());
    let request = Request { simulations: 4000, budget: Duration::from_secs(60), ..Request::default() };
    let advice = coach.recommend(&layout, &request).unwrap();
    let timed = |work: &dyn Fn()| {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    // The minimum of three: other load on the machine only increases a time.
    let least = |work: &dyn Fn()| (0..3).map(|_| timed(work)).min().unwrap();
    let record = || Recording::new(&table, &layout, &advice.cue).unwrap();
    let shots = least(&|| (0..500).for_each(|_| drop(record())));
    let reasons = least(&|| {
        why(request.shooter(), request.rule, &table, &layout, &advice, 0).unwrap();
        guide(&table, &record()).inspect(|guide| assert!(!guide.to_string().is_empty()));
    });
    assert!(reasons < 4 * shots, "{reasons:?} for the reasons, {shots:?} for 500 shots");
}

#[test]
fn a_filmed_shot_is_described_next_to_its_simulation() {
    let reply = talk("film\nfilm 90\nfilm 91\nwhere");
    assert_contains(
        &reply,
        &[
            "There are 91 filmed shots",
            "Shot 90 of the film: a point, ",
            "fitted on the first 2 seconds",
            "\n1 second: from the film",
            "5 seconds: from the film, in centimetres: white ",
            "all balls lie still: white ",
            "There is no filmed shot 91",
            "White lies at 2.59 diamonds along and 2.00 up, -500 and 0",
        ],
    );
}

#[test]
fn with_the_yellow_cue_ball_every_colour_is_right() {
    let reply = talk(
        "cue ball yellow\nfirst white\nwhere\nmove yellow up 10\nshot\nnumbers\ntell\nundo\nundo\nwhere\ncue ball white\n",
    );
    let told = "Yellow lies at 4.00 diamonds along and 2.03 up, 0 and 10 millimetres from the middle.";
    assert!(reply.contains("The cue ball is yellow.") && reply.contains(told), "{reply}");
    assert!(reply.contains("Met first: white.") && reply.contains("hits white"), "{reply}");
    assert!(reply.contains("yellow meets") && !reply.contains("white meets yellow"), "{reply}");
    assert!(reply.trim_end().ends_with("The cue ball is white already."), "{reply}");
}

#[test]
fn the_saved_skill_is_used_and_its_absence_reported() {
    assert!(talk("skill own").contains("No skill of your own is saved yet"));
    let own = "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1";
    let settings = Settings { think_ms: 1_000, ..Settings::default() };
    let reply = talk_of(own.parse().ok(), &settings, "skill own\nskill 0.6\nshot\nskill 7\n");
    assert_contains(
        &reply,
        &[
            "You average 2.02, by your notes.",
            "The player averages 0.6 points an inning at three-cushion.",
            "\nA player who averages 0.6 makes it ",
            "accepted are 0.1 to 2.5 points an inning at three-cushion, or world-class",
        ],
    );
}

#[test]
fn the_sources_of_the_players_two_skills_are_named() {
    let settings = Settings { think_ms: 300, skill: "0.6".parse().unwrap(), ..Settings::default() };
    let of = |own| talk_of(own, &settings, "skill own\nshot\n");
    assert!(of(None).contains("You average 0.6, as set.\n"));
    let reply = of(Some(Skill::level(7.83)));
    assert!(reply.contains("You average 0.18, by your notes.\n"), "{reply}");
    assert!(reply.contains("\nA player who averages 0.18 makes it ") && !reply.contains("theta="), "{reply}");
}

#[test]
fn why_chances_and_plan_are_answered_in_sentences_without_the_course_again() {
    assert!(talk("why").contains("There is no shot yet") && talk("chances").contains("There is no shot yet"));
    let reply = talk("skill club\nshot\nwhy\nchances\nplan\nplan off\nplan");
    assert_contains(
        &reply,
        &[
            "The first shot. It is made ",
            "Shot 1. A club player makes it ",
            "\nThe next point ",
            "Say plan on to change",
        ],
    );
    let reasons = reply.lines().find(|line| line.starts_with("It is made ")).unwrap();
    // The course is told with the shot only.
    let (_, after_the_shot) = reply.split_once("The first shot. ").unwrap();
    assert!(!after_the_shot.contains("Pattern: ") && !after_the_shot.contains("cushions in all"), "{reply}");
    assert!(!reasons.contains(';') && !reply.contains(" and more."), "{reply}");
}

#[test]
fn impossible_commands_are_reported_and_the_conversation_continues() {
    let reply = talk(
        "tell\nother\ngo on\nmove white left 0\nundo\nfly\nballs 0,0 0,0 1,0\nmove white right 9000\nmove red right 9000\nfirst white\nrule one-cushion\n",
    );
    assert_contains(
        &reply,
        &[
            "no shot yet",
            "no other shot",
            "nothing to undo",
            "fly",
            "0.0000 m apart",
            "It stops there, in contact with yellow.",
            "It stops there, at the rail.",
            "\"white\" cannot be hit first; use any, yellow, red, cushion",
            "The rule is one-cushion",
        ],
    );
}

#[test]
fn an_own_stroke_is_tried_and_changed_in_words() {
    let reply = talk("skill club\ntry yellow 1/2 right, 1 left, 2 up, 3 lengths\ntry soft\ntry it\nquit");
    for words in [
        "Yellow, half full on the right; one tip of",
        "medium (3 table lengths)",
        "A club player makes it",
        "soft (2 table lengths)",
        "\"it\" is not understood; accepted are",
    ] {
        assert!(reply.contains(words), "{words}: {reply}");
    }
    assert!(talk("try soft").contains("where to aim is missing"));
}
