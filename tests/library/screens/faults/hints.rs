//! Keys of an exercise that no hint mentioned.

use crate::screens::player::{Player, SIZES, TRUE_COLOUR};

fn hints(player: &Player, width: u16, height: u16) -> String {
    player.text(width, height).lines().last().unwrap().to_owned()
}

#[test]
fn hints_mention_notes_goals_and_shifts() {
    let aiming = Player::practising(TRUE_COLOUR);
    let line = hints(&aiming, 120, 40);
    let hinted = ["←→ aim", "hjkl tip", "↓↑ speed", "v hint", "m n made/miss", "o goal", "x shift"];
    assert!(hinted.iter().all(|part| line.contains(part)), "{line}");
    // There is no room in the last row, so the hint is in the row above it.
    aiming.shows_at((80, 24), &["m made, n missed"]);
    let ended = aiming.press("Space Space").wait(60.0);
    for (width, height) in SIZES {
        let line = hints(&ended, width, height);
        assert!(line.contains("Enter next") && line.contains("m n made/miss"), "{line}");
    }
    let line = hints(&ended, 120, 40);
    assert!(line.contains("o goal") && line.contains("x shift"), "{line}");
    let noted = Player::practising(TRUE_COLOUR).press("m");
    assert!(hints(&noted, 120, 40).contains("u undo"), "{}", hints(&noted, 120, 40));
}

#[test]
fn exam_hints_omit_notes_goals_and_shifts() {
    let exam = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter");
    let line = hints(&exam, 200, 60);
    assert!(["made/miss", "goal", "shift"].iter().all(|part| !line.contains(part)), "{line}");
    assert!(!exam.text(80, 24).contains("m made"));
}

#[test]
fn shifts_and_notes_are_unavailable_in_a_match() {
    for (keys, goal) in [("o o o", "Score: match"), ("o o o o", "Score: against the coach")] {
        let set = Player::practising(TRUE_COLOUR).press(keys);
        for player in [&set, &Player::practising(TRUE_COLOUR).press(keys).press("Left Space").wait(60.0)] {
            player.says(goal);
            let line = hints(player, 200, 60);
            assert!(!line.contains("made/miss") && !line.contains("shift"), "{line}");
        }
        set.press("x").says("a game plays on from where the balls stop").says(goal);
        Player::practising(TRUE_COLOUR).press(keys).press("m").says("; o chooses another goal").says(goal);
    }
}

#[test]
fn changing_the_player_keeps_the_match() {
    Player::new().press("F9 Enter p").says("Score: against the coach");
}

#[test]
fn a_match_after_real_table_notes_starts_in_the_simulator() {
    let player = Player::practising(TRUE_COLOUR).press("m o o");
    player.says("Real table: game");
    player.press("o").says("Score: match");
}

#[test]
fn goals_remember_their_length() {
    let game = Player::practising(TRUE_COLOUR).press("o > o <");
    game.says("game, 9 innings");
    let round = game.press("o o o o");
    round.says("run of 6");
    round.press("o").says("game, 9 innings");
}
