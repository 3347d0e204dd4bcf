//! Every page at every size of terminal: nothing may panic, however little room there is.

use super::{
    player::{Player, TRUE_COLOUR},
    practice::exercise,
    toasts::with_refusals,
};

fn draw(players: impl IntoIterator<Item = Player>) {
    for player in players {
        for width in (1..=240).step_by(7) {
            for height in (1..=90).step_by(5) {
                player.picture(width, height);
            }
        }
    }
}

#[test]
fn the_coach_can_be_drawn_at_every_size() {
    let shot = |views: &str| Player::new().press("Enter").answer().finish_analysis().press(".").press(views);
    draw(["", "v", "v v", "v v v"].map(shot));
}

#[test]
fn the_drills_can_be_drawn_at_every_size() {
    let library = |keys: &str| Player::at_library(TRUE_COLOUR, &[exercise("opening", "x")], &[]).press(keys);
    draw(["Left", "Left Enter", "Left Enter Space Space", "r", "a", "f", "f Enter"].map(library));
}

#[test]
fn training_and_overlays_can_be_drawn_at_every_size() {
    draw(vec![
        Player::listing(TRUE_COLOUR),
        Player::watching(TRUE_COLOUR).press("5 6 7 8 9"),
        with_refusals(Player::new(), &[3, 60, 9]),
        Player::new().press("Left :").press(&"w ".repeat(120)),
        Player::new().press("?"),
    ]);
}

#[test]
fn the_settings_can_be_drawn_at_every_size() {
    let settings = |keys: &str| {
        Player::with_settings(TRUE_COLOUR, "skill = \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\"\n").press("F5").press(keys)
    };
    draw(["", "Enter x", "Tab Right Down", "Tab Enter q", "Tab ?", "Delete F6"].map(settings));
}
