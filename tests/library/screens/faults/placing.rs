//! The way back from a shot to the balls, by one gesture.

use carom::{
    table::Table,
    terminal::{Mapping, Mode},
};
use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Rect;

use crate::screens::player::{Player, SIZES};

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
    let mut player = watching();
    player.app.resize(ratatui::layout::Size::new(120, 40));
    let mapping = Mapping::fit(&Table::default(), Rect::new(4, 1, 112, 29));
    let (time, layout) = (player.app.coach.playback.time, *player.app.coach.layout());
    let red = player.app.coach.watched().unwrap().recording.positions(time)[2];
    let (column, row) = mapping.to_cell(red);
    let mouse = |kind, column| MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE };
    player.app.mouse(mouse(MouseEventKind::Down(MouseButton::Left), column));
    assert_eq!((player.app.coach.mode, player.app.coach.selected), (Mode::Placing, 2));
    player.warns_nothing();
    // The ball was elsewhere when it was clicked, so it is not dragged from there.
    player.app.mouse(mouse(MouseEventKind::Drag(MouseButton::Left), column + 3));
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
