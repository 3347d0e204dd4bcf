//! Balls in the air: the side view of a jump, the text if nothing jumps, and balls off the table.

use super::{
    player::{ASCII, NO_COLOUR, Player, SIZES, TRUE_COLOUR},
    practice::exercise,
};
use carom::{
    drills::Exercise,
    physics::CueInputs,
    table::{Flight, Layout, Table},
    terminal::{Capabilities, Depth},
};

/// Returns a player who has taken over the coach's shot, on a table whose balls can leave the cloth or on one that keeps them.
fn taken_over(caps: Capabilities, flight: Option<Flight>) -> Player {
    let table = Table { flight, ..Table::default() };
    Player::at_table(caps, &table, tempfile::tempdir().unwrap()).press("Enter").answer().press("w")
}

#[test]
fn the_side_view_is_drawn_at_every_size_and_with_letters_alone_and_goes_again() {
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let flat = taken_over(caps, Some(Flight::default())).press(&"+ ".repeat(40));
        let player = flat.press("i");
        player.shows(&["Side view", "white jumps", " mm high, ", " far"]);
        if caps.depth == Depth::Mono {
            player.is_plain();
        }
        for (width, height) in SIZES {
            assert!(player.text(width, height).contains("Side view"), "{width}×{height}");
        }
        player.press("i").is_silent_on("Side view");
    }
}

#[test]
fn where_nothing_jumps_the_key_says_so() {
    let player = taken_over(TRUE_COLOUR, Some(Flight::default())).press("i");
    player.shows(&["no ball jumps in this shot"]).is_silent_on("Side view");
    let flat = taken_over(TRUE_COLOUR, None).press("i");
    flat.shows(&["no ball leaves this table's cloth: its file has no section [flight]"]);
}

#[test]
fn a_jump_is_among_the_contacts_and_a_hop_with_all_events_alone() {
    let player = taken_over(TRUE_COLOUR, Some(Flight::default()));
    player.is_silent_on("jumps").is_silent_on(" mm up");
    let player = player.press(&"+ ".repeat(40));
    assert!(player.text(120, 40).contains(" mm up"), "{}", player.text(120, 40));
    let hops = taken_over(TRUE_COLOUR, Some(Flight::default())).press("Esc E .");
    assert!(hops.text(80, 24).contains(" jumps "), "{}", hops.text(80, 24));
}

#[test]
fn the_balls_that_a_player_goes_on_with_lie_on_the_table_whatever_left_it() {
    let player = taken_over(TRUE_COLOUR, Some(Flight::default()));
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
        shot: Some(CueInputs::parse("0,0.5,45,0,6").unwrap()),
        ..exercise("jump", "A jump")
    };
    Player::at_library(caps, &[jump], &[]).press("Left Enter w")
}

#[test]
fn an_exercise_shows_its_jump_from_the_side_before_and_while_it_plays_at_every_size() {
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let player = practised_jump(caps);
        player.is_silent_on("Side view");
        let player = player.press("i");
        player.shows(&["Side view", "white jumps", "the jump from the side"]);
        if caps.depth == Depth::Mono {
            player.is_plain();
        }
        for (width, height) in SIZES {
            assert!(player.text(width, height).contains("Side view"), "{width}×{height}");
        }
        let playing = player.press("Space").wait(0.2);
        playing.shows(&["Side view"]);
        playing.press("i").is_silent_on("Side view");
    }
}

#[test]
fn an_exercise_without_a_jump_says_so_and_a_ball_off_the_table_is_told() {
    Player::practising(TRUE_COLOUR).press("v i").shows(&["no ball jumps in this shot"]).is_silent_on("Side view");
    // Over the rail, from near it and at full speed.
    let off = Exercise {
        layout: Layout::parse("1.1,0 -0.5,0.02 -0.2,0", &Table::default()).unwrap(),
        shot: Some(CueInputs::parse("0,0.5,45,0,7").unwrap()),
        ..exercise("off", "Off the table")
    };
    let player = Player::at_library(TRUE_COLOUR, &[off], &[]).press("Left Enter w Space").wait(60.0);
    player.says("Foul: white left the table over the right rail and goes to the ");
}

#[test]
fn where_jumps_are_forbidden_the_coachs_first_row_and_its_answer_say_so() {
    let player = Player::with_settings(TRUE_COLOUR, "jumps = false\n");
    assert!(player.text(120, 40).contains(" no jumps"));
    let player = player.press("Enter");
    assert!(!player.asked.as_ref().unwrap().query.jumps);
    player.answer().shows(&["jumps are off"]);
    Player::new().press("Enter").answer().is_silent_on("jumps");
}
