//! Games of two sides: whose turn it is, which ball is the cue ball, and the score of each side.

use serde_json::Value;

use crate::program::{carom, command, fed, folder};

/// A stroke that moves the cue ball a little and meets nothing.
const MISS: &str = "0,0,5,180,0.3\n";

fn of_kind<'a>(lines: &'a [Value], kind: &str) -> Vec<&'a Value> {
    lines.iter().filter(|line| line["kind"] == kind).collect()
}

#[test]
fn after_a_miss_the_other_ball_is_the_cue_ball_and_nobody_has_touched_the_balls() {
    let folder = folder();
    let args = ["play", "--both", "--ball", "yellow", "--innings", "1", "--seed", "1", "--json"];
    let lines = fed(command(folder.path(), &args), &MISS.repeat(5)).json();
    let (positions, attempts) = (of_kind(&lines, "position"), of_kind(&lines, "attempt"));
    assert_eq!(attempts.len(), 2, "one inning of each side: {lines:?}");
    for (index, colour) in ["yellow", "white"].into_iter().enumerate() {
        assert_eq!([&positions[index]["cue_ball"], &attempts[index]["cue_ball"]], [colour, colour]);
    }
    let (end, next) = (&attempts[0]["end"], &positions[1]["layout"]);
    assert_eq!([&end[0], &end[1], &end[2]], [&next[1], &next[0], &next[2]]);
    let result = of_kind(&lines, "result")[0];
    assert_eq!(result["over"], true);
    for side in ["white", "yellow"] {
        assert_eq!([&result["sides"][side]["tried"], &result["sides"][side]["innings"]], [1, 1]);
    }
}

#[test]
fn the_coach_plays_the_other_side_and_alone_one_keeps_ones_ball() {
    let folder = folder();
    let args = [
        "play",
        "--against-coach",
        "--innings",
        "2",
        "--seed",
        "1",
        "--strokes",
        "40",
        "--skill",
        "beginner",
        "--json",
    ];
    let lines = fed(command(folder.path(), &args), &MISS.repeat(5)).json();
    let attempts = of_kind(&lines, "attempt");
    assert!(attempts.iter().any(|attempt| attempt["cue_ball"] == "yellow"), "{lines:?}");
    for attempt in &attempts {
        assert_eq!(attempt["by_coach"], attempt["cue_ball"] == "yellow", "{attempt}");
        assert_eq!(attempt["helped"], false, "{attempt}");
    }
    let alone = ["play", "--ball", "yellow", "--innings", "2", "--seed", "1", "--json"];
    let lines = fed(command(folder.path(), &alone), &MISS.repeat(5)).json();
    assert!(of_kind(&lines, "attempt").iter().all(|attempt| attempt["cue_ball"] == "yellow"));
    assert!(of_kind(&lines, "result")[0].get("sides").is_none());
    let told = fed(command(folder.path(), &["play", "--both", "--innings", "1"]), &MISS.repeat(3)).out;
    assert!(told.contains("the cue ball is white") && told.contains("the cue ball is yellow"), "{told}");
    assert!(told.contains("\nwhite: 0 of 1 made") && told.contains("\nyellow: 0 of 1 made"), "{told}");
}

#[test]
fn words_that_are_no_ball_or_side_are_refused_with_what_would_be_accepted() {
    let folder = folder();
    for (args, says) in
        [(["play", "--ball", "red"], "use white or yellow"), (["play", "--side", "up"], "left or right")]
    {
        let refused = carom(folder.path(), &args);
        assert!(refused.code == Some(2) && refused.err.contains(says), "{}", refused.err);
    }
}
