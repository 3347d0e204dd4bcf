//! Balls in the air: the side view of a jump, what is said where nothing jumps, and balls off the table.

use super::player::{ASCII, NO_COLOUR, Player, SIZES, TRUE_COLOUR};
use carom::{
    table::{Flight, Layout, Table},
    terminal::{Capabilities, Depth},
};

/// With the coach's shot taken over, on a table whose balls leave the cloth, or on one that keeps them.
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
            assert!(player.text(width, height).contains('0'), "{width}×{height}");
        }
        player.press("i").is_silent_on("Side view");
    }
}

#[test]
fn where_nothing_jumps_the_key_says_how_high_the_highest_hop_is() {
    let player = taken_over(TRUE_COLOUR, Some(Flight::default())).press("i");
    player.shows(&["nothing leaves the cloth by more than ", " mm in this shot"]).is_silent_on("Side view");
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
    // From the near spot at the cushion behind it, as hard as one likes.
    let hard = player.press(&"+ ".repeat(25)).press(&"S-Up ".repeat(14)).press(&"S-Left ".repeat(10));
    let shot = hard.app.shot().unwrap();
    let end: Layout = shot.recording.final_layout();
    assert!(end.validate(&Table::default()).is_ok(), "{end:?}");
    assert_eq!(shot.recording.off_table(), [true, false, false], "{:?}", shot.recording.events());
    hard.press("End").shows(&["Foul: white left the table over the "]);
}
