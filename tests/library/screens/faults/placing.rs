//! The way back from a shot to the balls, by one gesture.

use carom::terminal::Mode;

use crate::screens::{
    mouse::{DRAG, PRESS, mapping, resized},
    player::{Player, SIZES},
};

/// Returns a player who watches a shot in progress.
fn watching() -> Player {
    let player = Player::new().press("Enter").answer().press("Space").wait(1.0);
    assert_eq!(player.app.coach.mode, Mode::Watching);
    player
}

#[test]
fn tab_and_ball_numbers_return_to_placing() {
    for (keys, ball) in [("Tab", 1), ("BackTab", 2), ("1", 0), ("2", 1), ("3", 2), ("Esc", 0)] {
        let player = watching().press(keys);
        assert_eq!((player.app.coach.mode, player.app.coach.selected), (Mode::Placing, ball), "{keys}");
        let before = player.app.coach.layout().balls[ball];
        let moved = player.press("Left");
        assert_ne!(moved.app.coach.layout().balls[ball], before, "{keys}: arrows move it again");
    }
}

#[test]
fn clicking_a_ball_returns_to_placing_it() {
    let player = resized(watching());
    let (time, layout) = (player.app.coach.playback.time, *player.app.coach.layout());
    let red = player.app.coach.watched().unwrap().recording.positions(time)[2];
    let (column, row) = mapping().to_cell(red);
    let player = player.send_mouse(PRESS, (column, row));
    assert_eq!((player.app.coach.mode, player.app.coach.selected), (Mode::Placing, 2));
    player.warns_nothing();
    // The ball was elsewhere when it was clicked, so it is not dragged from there.
    let player = player.send_mouse(DRAG, (column + 3, row));
    assert_eq!(*player.app.coach.layout(), layout);
}

#[test]
fn the_hint_line_mentions_tab_while_watching_a_shot() {
    for (width, height) in SIZES {
        let text = watching().text(width, height);
        assert!(text.lines().last().unwrap().contains("Tab place"), "{text}");
        let placing = watching().press("Tab").text(width, height);
        assert!(!placing.lines().last().unwrap().contains("Tab place"), "{placing}");
    }
}
