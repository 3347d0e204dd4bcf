//! Balls in the air: the side view of a jump, the text if nothing jumps, and balls off the table.

use super::{
    player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, cue},
    practice::exercise,
};
use carom::{
    drills::Exercise,
    table::{Flight, Layout, Table},
    terminal::{Capabilities, Depth},
};

/// Returns a player who has taken over the coach's shot, on a table whose balls can leave the cloth or on one that keeps them.
fn in_what_if_mode(caps: Capabilities, flight: Option<Flight>) -> Player {
    let table = Table { flight, ..Table::default() };
    Player::at_table(caps, &table, tempfile::tempdir().unwrap()).press("Enter").answer().press("w")
}

#[test]
fn the_side_view_is_drawn_at_every_size_and_closes() {
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let flat = in_what_if_mode(caps, Some(Flight::default())).press(&"+ ".repeat(40));
        let player = flat.press("i");
        player.shows(&["Side view", "white jumps", " mm high, ", " far"]);
        if caps.depth == Depth::Mono {
            player.is_plain();
        }
        player.press("i").does_not_show("Side view");
    }
}

#[test]
fn the_side_view_key_explains_that_nothing_jumps() {
    let player = in_what_if_mode(TRUE_COLOUR, Some(Flight::default())).press("i");
    player.shows(&["no ball rises 2 mm in this shot"]).does_not_show("Side view");
    let flat = in_what_if_mode(TRUE_COLOUR, None).press("i");
    flat.shows(&["no ball leaves this table's cloth: its file has no section [flight]"]);
}

#[test]
fn jumps_are_listed_as_contacts_and_hops_as_events() {
    let player = in_what_if_mode(TRUE_COLOUR, Some(Flight::default()));
    player.does_not_show("jumps").does_not_show(" mm up");
    let player = player.press(&"+ ".repeat(40));
    assert!(player.text(120, 40).contains(" mm up"), "{}", player.text(120, 40));
    let hops = in_what_if_mode(TRUE_COLOUR, Some(Flight::default())).press("Esc E .");
    assert!(hops.text(80, 24).contains(" jumps "), "{}", hops.text(80, 24));
}

#[test]
fn balls_off_the_table_are_respotted_for_the_next_shot() {
    let player = in_what_if_mode(TRUE_COLOUR, Some(Flight::default()));
    // From the near spot at the cushion behind it, at full speed.
    let hard = player.press(&"+ ".repeat(25)).press(&"S-Up ".repeat(14)).press(&"S-Left ".repeat(10));
    let shot = hard.app.coach.shot().unwrap();
    let end: Layout = shot.recording.final_layout();
    assert!(end.validate(&Table::default()).is_ok(), "{end:?}");
    assert_eq!(shot.recording.off_table(), [true, false, false], "{:?}", shot.recording.events());
    hard.press("End").shows(&["Foul, if played exactly: white"]);
}

/// Returns a player at an exercise whose shot jumps over red, with that shot taken over, and after it was played.
fn practised_jump(caps: Capabilities) -> Player {
    let jump = Exercise {
        layout: Layout::parse("-0.5,0 0.5,0.02 -0.2,0", &Table::default()).unwrap(),
        shot: Some(cue("0,0.5,45,0,6")),
        ..exercise("jump", "A jump")
    };
    Player::at_library(caps, &[jump], &[]).press("Left Enter w")
}

#[test]
fn an_exercise_has_a_side_view_before_and_during_playback() {
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let player = practised_jump(caps);
        player.does_not_show("Side view");
        let player = player.press("i");
        player.shows(&["Side view", "white jumps", "the jump from the side"]);
        if caps.depth == Depth::Mono {
            player.is_plain();
        }
        let playing = player.press("Space").wait(0.2);
        playing.shows(&["Side view"]);
        playing.press("i").does_not_show("Side view");
    }
}

#[test]
fn exercises_report_missing_jumps_and_balls_off_the_table() {
    Player::practising(TRUE_COLOUR).press("v i").shows(&["no ball rises 2 mm in this shot"]).does_not_show("Side view");
    // Over the rail, from near it and at full speed.
    let off = Exercise {
        layout: Layout::parse("1.1,0 -0.5,0.02 -0.2,0", &Table::default()).unwrap(),
        shot: Some(cue("0,0.5,45,0,7")),
        ..exercise("off", "Off the table")
    };
    let player = Player::at_library(TRUE_COLOUR, &[off], &[]).press("Left Enter w Space").wait(60.0);
    player.says("Foul: white left the table over the right rail and goes to the ");
}

#[test]
fn forbidden_jumps_are_shown_in_header_and_answer() {
    let player = Player::with_settings(TRUE_COLOUR, "jumps = false\n");
    assert!(player.text(120, 40).contains(" no jumps"));
    let player = player.press("Enter");
    assert!(!player.advice_job.as_ref().unwrap().query.jumps);
    player.answer().shows(&["jumps are off"]);
    Player::new().press("Enter").answer().does_not_show("jumps");
}
