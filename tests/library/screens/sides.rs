//! Both players' balls: whoever is at the table, every ball keeps its place and its colour, and is called by it.

use super::player::{NO_COLOUR, Player};

/// Where brackets stand around each ball's letter on the picture.
fn places(text: &str) -> Vec<Option<(usize, usize)>> {
    let find = |sign: &str| {
        text.lines().enumerate().find_map(|(row, line)| Some((row, line.chars().collect::<String>().find(sign)?)))
    };
    ["(W)", "(Y)", "(R)"].map(find).to_vec()
}

#[test]
fn taking_the_other_ball_moves_and_repaints_none() {
    let before = Player::with(NO_COLOUR).press("r");
    let white = before.text(120, 40);
    let layout = *before.app.coach.layout();
    let after = before.press("x");
    let yellow = after.text(120, 40);
    assert!(places(&white).iter().all(Option::is_some), "{white}");
    assert_eq!(places(&white), places(&yellow), "{white}\n{yellow}");
    assert_eq!(*after.app.coach.layout(), layout.for_the_opponent());
    assert!(yellow.contains("yellow is the cue ball now"), "{yellow}");
    // In true colours too: the same cells have the same inks.
    let inks = |player: &Player| {
        let buffer = player.picture(120, 40);
        let cells = buffer.content().iter().enumerate().filter(|(index, _)| index % 120 < 70 && index / 120 < 30);
        let mut inks: Vec<_> = cells.map(|(_, cell)| format!("{:?}{:?}", cell.fg, cell.bg)).collect();
        inks.sort();
        inks
    };
    let one = Player::new().press("r 3");
    let before = inks(&one);
    assert_eq!(inks(&one.press("x 3")), before);
    // The keys are the colours', and a step back brings the other player back.
    let selected = after.press("2");
    assert_eq!(selected.app.coach.selected, 0, "yellow is ball 0 now");
    let back = selected.press("u");
    assert_eq!(*back.app.coach.layout(), layout);
    assert_eq!(back.app.page().cue_ball().name(), "white");
}

#[test]
fn in_a_match_of_two_the_turn_passes_with_a_miss_and_the_score_is_each_sides_own() {
    let player = Player::practising(NO_COLOUR).press("o o o");
    player.says("match, 10 innings");
    player.says("Stroke of white");
    // Away from everything, softly: a miss.
    let mut player = player;
    for _ in 0..23 {
        player = player.press("Down");
    }
    let missed = player.press("S-Left Space Enter");
    missed.says("white: 0 in 1 inning, best");
    let next = missed.press("Enter");
    next.says("Stroke of yellow");
    assert_eq!(next.app.page().cue_ball().name(), "yellow");
}
