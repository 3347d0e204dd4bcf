//! Every page on every size of terminal: nothing may panic, however little room there is.

use super::{
    player::{Player, TRUE_COLOUR},
    practice::exercise,
    toasts::refused,
};

#[test]
fn every_size_can_be_drawn() {
    let shot = |views: &str| Player::new().press("Enter").answer().studied().press(".").press(views);
    let settings = |keys: &str| {
        Player::with_settings(TRUE_COLOUR, "skill = \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\"\n").press("F5").press(keys)
    };
    let library = |keys: &str| Player::at_library(TRUE_COLOUR, &[exercise("opening", "x")], &[]).press(keys);
    let coach = ["", "v", "v v", "v v v"].map(shot);
    let drills = ["Left", "Left Enter", "Left Enter Space", "r", "a", "f", "f Enter"].map(library);
    let runs = vec![Player::listing(TRUE_COLOUR), Player::watching(TRUE_COLOUR).press("5 6 7 8 9")];
    let over = vec![
        refused(Player::new(), &[3, 60, 9]),
        Player::new().press("Left :").press(&"w ".repeat(120)),
        Player::new().press("?"),
    ];
    let settings = ["", "Enter x", "Tab Right Down", "Tab Enter q", "Tab ?", "Delete F6"].map(settings);
    for player in coach.into_iter().chain(drills).chain(runs).chain(over).chain(settings) {
        for width in (1..=240).step_by(7) {
            for height in (1..=90).step_by(5) {
                player.picture(width, height);
            }
        }
    }
}
