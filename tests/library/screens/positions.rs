//! Positions that are typed and pasted on the coach's table, and steps of quarter diamonds.

use carom::{
    drills::{Library, encode},
    game::Rule,
    table::{Layout, Table},
};

use super::player::Player;

fn layout(text: &str) -> Layout {
    Layout::parse(text, &Table::default()).unwrap()
}

#[test]
fn a_typed_layout_in_diamonds_is_one_undo_step() {
    let player = Player::new().press("p").type_in("2d,0.5d 6d,2d 4d,3.5d");
    assert_eq!(*player.app.coach.layout(), Layout::opening(&Table::default()), "nothing moves before Enter");
    let player = player.press("Enter");
    assert_eq!(*player.app.coach.layout(), layout("2d,0.5d 6d,2d 4d,3.5d"));
    // The panel displays both units.
    player.shows(&["white   -710.0 -532.5", "2.00", "0.50", "3.50"]);
    assert_eq!(*player.press("u").app.coach.layout(), Layout::opening(&Table::default()));
}

#[test]
fn one_position_is_typed_for_the_selected_or_named_ball() {
    let player = Player::new().press("3 p").type_in("4d,3.5d").press("Enter");
    assert_eq!(player.app.coach.layout().balls[2], layout("2d,0.5d 6d,2d 4d,3.5d").balls[2]);
    let player = player.press("p").type_in("yellow 1d,1d").press("Enter");
    assert_eq!(player.app.coach.layout().balls[1], layout("2d,0.5d 1d,1d 4d,3.5d").balls[1]);
}

#[test]
fn decimal_commas_and_plain_diamonds_are_accepted() {
    let player = Player::new().press("p").type_in("1d 1d 5d 0,5d 7d 3.5d").press("Enter");
    assert_eq!(*player.app.coach.layout(), layout("1d,1d 5d,0.5d 7d,3.5d"));
    let player = player.press("3 p").type_in("6,2").press("Enter");
    assert_eq!(player.app.coach.layout().balls[2], layout("1d,1d 5d,0.5d 6d,2d").balls[2]);
}

#[test]
fn an_invalid_position_is_refused_and_remains_editable() {
    let player = Player::new().press("p").type_in("2d,9d").press("Enter");
    player.warns("outside the table");
    player.shows(&["2d,9d"]);
    let player = player.press("Backspace Backspace").type_in("1d").press("Enter");
    assert_eq!(player.app.coach.layout().balls[0], layout("2d,1d 6d,2d 4d,3.5d").balls[0]);
    let player = player.press("p").type_in("nonsense").press("Esc Left");
    let white = player.app.coach.layout().balls[0];
    assert!(white.x < layout("2d,1d 6d,2d 4d,3.5d").balls[0].x, "the keys are the table's again");
}

#[test]
fn layouts_and_share_codes_can_be_pasted() {
    let mut player = Player::new();
    player.app.paste("2d,0.5d 6d,2d 4d,3.5d\n");
    assert_eq!(*player.app.coach.layout(), layout("2d,0.5d 6d,2d 4d,3.5d"));
    let library = Library::bundled();
    let exercise = library.get("natural").unwrap();
    player.app.paste(&encode(exercise).unwrap());
    assert_eq!((*player.app.coach.layout(), player.app.coach.query.rule), (exercise.layout, Rule::ThreeCushion));
    player.app.paste("a letter to a friend, by accident");
    player.warns("pasted text not used");
    assert_eq!(*player.app.coach.layout(), exercise.layout);
    player.app.paste("4d,3.5d");
    player.warns_nothing();
    // A text that is too long is cut at a character boundary.
    player.app.paste(&format!("x{}", "\u{e9}".repeat(2000)));
    let toast = player.app.toasts.shown.last().expect("it is refused");
    assert!(toast.text.len() < 1000, "{}", toast.text.len());
    // A share code is also accepted where positions are typed.
    let mut player = Player::new().press("p");
    player.app.paste(&encode(exercise).unwrap());
    assert_eq!(*player.press("Enter").app.coach.layout(), exercise.layout);
}

#[test]
fn diamond_steps_snap_to_quarter_diamonds() {
    let player = Player::new().press("D Down");
    assert_eq!(player.app.coach.layout().balls[0], layout("2d,2.5d 6d,2d 4d,3.5d").balls[0]);
    player.shows(&["white at 2.00d,2.50d", "step 1/4 diamond"]);
    let player = player.press("S-Right + Right");
    player.shows(&["step 50 mm", "x 227.5 mm"]);
}
