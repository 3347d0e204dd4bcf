//! The mouse through the real app: mouse reports move balls, shots and lists.

use super::{
    player::{NO_COLOUR, Player, TRUE_COLOUR},
    runs::{OTHER_RUN, RUN},
};
use carom::{
    table::Table,
    terminal::{KeyContext, Mapping, Overlay, PageId},
};
use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use glam::DVec2;
use proptest::prelude::*;
use ratatui::layout::{Rect, Size};

pub const PRESS: MouseEventKind = MouseEventKind::Down(MouseButton::Left);
pub const DRAG: MouseEventKind = MouseEventKind::Drag(MouseButton::Left);
const RELEASE: MouseEventKind = MouseEventKind::Up(MouseButton::Left);

/// Returns the mapping of the table on the coach's screen at 120×40.
pub fn mapping() -> Mapping {
    Mapping::fit(&Table::default(), Rect::new(4, 1, 112, 29))
}

impl Player {
    pub fn send_mouse(mut self, kind: MouseEventKind, (column, row): (u16, u16)) -> Self {
        self.app.mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
        self
    }
}

/// Resizes to 120×40.
pub fn resized(mut player: Player) -> Player {
    player.app.resize(Size::new(120, 40));
    player
}

#[test]
fn a_drag_moves_a_ball_and_is_one_undo_step() {
    let player = resized(Player::new().press("2"));
    let start = *player.app.coach.layout();
    let cell = mapping().to_cell(start.balls[2]);
    let mut player = player.send_mouse(PRESS, cell);
    assert_eq!((player.app.coach.selected, *player.app.coach.layout()), (2, start), "a press alone moves nothing");
    for column in 0..100 {
        player = player.send_mouse(DRAG, (cell.0 - column / 4, cell.1 + column / 12));
    }
    let end = (cell.0 - 24, cell.1 + 8);
    let player = player.send_mouse(RELEASE, end);
    assert_eq!(mapping().to_cell(player.app.coach.layout().balls[2]), end);
    let player = player.send_mouse(DRAG, (10, 10));
    assert_eq!(mapping().to_cell(player.app.coach.layout().balls[2]), end, "the ball was released");
    let player = player.press("u");
    assert_eq!(*player.app.coach.layout(), start);
    assert!(player.press("u").text(120, 40).contains("there is nothing to undo"));
}

#[test]
fn in_what_if_mode_the_wheel_changes_speed_and_dragging_leaves() {
    let player = resized(Player::new().press("Enter").answer().press("w S-Up"));
    let (before, start) = (player.app.coach.playback.speed(), *player.app.coach.layout());
    let cell = mapping().to_cell(start.balls[0]);
    let player = player.send_mouse(MouseEventKind::ScrollUp, cell);
    assert!(player.app.coach.playback.speed() > before && player.app.key_context() == KeyContext::OwnStroke);
    let player = player.send_mouse(PRESS, cell);
    assert_eq!((player.app.key_context(), *player.app.coach.layout()), (KeyContext::Coach, start));
    let player = player.send_mouse(DRAG, (cell.0 + 8, cell.1)).send_mouse(RELEASE, (cell.0 + 8, cell.1));
    assert!(player.app.coach.layout().balls[0].x > start.balls[0].x + 0.1);
    assert_eq!(*player.press("u").app.coach.layout(), start);
}

#[test]
fn a_dragged_ball_stops_at_cushions_and_other_balls() {
    let player = resized(Player::new());
    let (table, start) = (Table::default(), *player.app.coach.layout());
    let cell = mapping().to_cell(start.balls[0]);
    let player = player.send_mouse(PRESS, cell).send_mouse(DRAG, (0, 0));
    assert_eq!(player.app.coach.layout().balls[0], DVec2::new(-1.0, 1.0) * table.reach());
    let onto = mapping().to_cell(start.balls[1]);
    let player = player.send_mouse(DRAG, onto).send_mouse(RELEASE, onto);
    let gap = player.app.coach.layout().balls[0].distance(start.balls[1]) - 2.0 * table.radius;
    assert!(gap.abs() < 1e-9, "{gap}");
}

#[test]
fn a_key_press_ends_a_drag() {
    let player = resized(Player::new());
    let start = *player.app.coach.layout();
    let cell = mapping().to_cell(start.balls[0]);
    let player = player.send_mouse(PRESS, cell).send_mouse(DRAG, (40, 20)).press("u").send_mouse(DRAG, (50, 20));
    assert_eq!(*player.app.coach.layout(), start);
}

#[test]
fn balls_can_be_dragged_before_but_not_during_playback() {
    let player = resized(Player::new().press("Enter").answer());
    let cell = mapping().to_cell(player.app.coach.layout().balls[2]);
    let taken = player.send_mouse(PRESS, cell).send_mouse(DRAG, (cell.0, cell.1 + 3));
    assert!(taken.app.coach.shot().is_none(), "the shot was for where the balls lay");
    let player = taken.press("u .").wait(0.1);
    let start = *player.app.coach.layout();
    let player = resized(player).send_mouse(PRESS, cell).send_mouse(DRAG, (cell.0, cell.1 + 3));
    assert_eq!(*player.app.coach.layout(), start, "a click leaves the shot and moves nothing");
    let thinking = resized(Player::new().press("Enter")).send_mouse(PRESS, cell);
    thinking.warns("the coach is thinking; Esc stops it");
}

#[test]
fn the_wheel_over_the_table_changes_the_playback_speed() {
    let player = resized(Player::new().press("Enter").answer());
    let speed = player.app.coach.playback.speed();
    let player = player.send_mouse(MouseEventKind::ScrollUp, (40, 20));
    assert!(player.app.coach.playback.speed() > speed);
    let player =
        player.send_mouse(MouseEventKind::ScrollDown, (40, 20)).send_mouse(MouseEventKind::ScrollDown, (40, 20));
    assert!(player.app.coach.playback.speed() < speed);
    assert_eq!(player.send_mouse(MouseEventKind::ScrollUp, (40, 39)).app.coach.playback.speed(), 0.5 * speed);
}

#[test]
fn clicking_a_listed_shot_shows_it() {
    for (caps, views) in [(TRUE_COLOUR, "v"), (NO_COLOUR, "v v v v v")] {
        let player = resized(Player::with(caps).press("Enter").answer().press(views));
        let chosen = |player: &Player| player.app.coach.current_advice().map(|advised| advised.chosen);
        let text = player.text(120, 40);
        let row = text.lines().position(|line| line.contains("62 %")).unwrap() as u16;
        let player = player.send_mouse(PRESS, (5, row));
        assert_eq!(chosen(&player), Some(2), "{text}");
        assert_eq!(chosen(&player.send_mouse(PRESS, (5, row - 2))), Some(0));
    }
}

#[test]
fn the_wheel_without_a_shot_shows_no_warning() {
    resized(Player::new()).send_mouse(MouseEventKind::ScrollDown, (60, 15)).warns_nothing();
}

#[test]
fn the_wheel_scrolls_the_help_and_the_command_palette() {
    let player = resized(Player::new().press("?")).send_mouse(MouseEventKind::ScrollDown, (3, 3));
    assert_eq!(player.app.overlay, Some((Overlay::Help, 3)));
    let clicked = player.send_mouse(PRESS, (60, 15));
    assert_eq!(clicked.app.overlay, Some((Overlay::Help, 3)), "what lies below is not reached");
    let player = resized(Player::new().press(":")).send_mouse(MouseEventKind::ScrollDown, (3, 3));
    assert_eq!(player.app.command_palette.as_ref().unwrap().mark(9), 1);
}

#[test]
fn clicking_a_tab_opens_its_screen() {
    for width in [80, 120, 200] {
        let mut player = Player::new();
        for screen in [PageId::Settings, PageId::Drills, PageId::Training, PageId::Coach] {
            player.app.resize(Size::new(width, 40));
            let row = player.text(width, 40).lines().next().unwrap().to_owned();
            // The lines of the text are quoted.
            let column = row.find(screen.title()).unwrap() as u16 - 1;
            player = player.send_mouse(PRESS, (column, 0));
            assert_eq!(player.app.screen, screen, "{width}");
        }
        player.app.resize(Size::new(width, 40));
        assert_eq!(player.send_mouse(PRESS, (width - 2, 0)).app.screen, PageId::Coach);
    }
}

#[test]
fn the_selection_in_the_library_follows_wheel_and_click() {
    let player = resized(Player::at_library(TRUE_COLOUR, &[], &[]));
    let text = player.text(120, 40);
    assert_eq!(player.app.drills.catalogue.mark, 0);
    let player =
        player.send_mouse(MouseEventKind::ScrollDown, (5, 10)).send_mouse(MouseEventKind::ScrollDown, (100, 10));
    assert_eq!(player.app.drills.catalogue.mark, 1, "only over the list");
    // The heading of the first category is in the second row of the page's area, and its exercises follow.
    let player = player.send_mouse(PRESS, (5, 7));
    let title = player.app.drills.catalogue.marked().unwrap().title.clone();
    let row = text.lines().nth(7).unwrap();
    assert!(row.contains(title.split_whitespace().next().unwrap()), "{title}: {row}");
}

#[test]
fn the_selection_in_the_settings_follows_wheel_and_click() {
    let player = resized(Player::new().press("F5"));
    let row = |player: &Player, part: &str| player.text(120, 40).lines().position(|line| line.contains(part)).unwrap();
    let speed = row(&player, "speed") as u16;
    let player = resized(player.send_mouse(PRESS, (5, speed)));
    assert_eq!(player.app.settings.marked().key, "speed");
    let player = resized(player.send_mouse(MouseEventKind::ScrollDown, (5, speed)).press("Tab"));
    assert_eq!(player.app.settings.marked().key, "mouse");
    let random = row(&player, "random position") as u16;
    let player = player.send_mouse(PRESS, (5, random)).press("Enter");
    assert!(player.text(120, 40).contains("press the key that should do this: random position"));
}

#[test]
fn the_selection_in_the_runs_follows_wheel_and_click() {
    let player = resized(Player::listing(TRUE_COLOUR));
    let text = player.text(120, 40);
    let row = |name: &str| text.lines().position(|line| line.contains(name)).unwrap() as u16;
    let (first, second) = (row(RUN), row(OTHER_RUN));
    assert_eq!(player.app.training.list.mark(), 0);
    let player = player.send_mouse(PRESS, (5, second));
    assert_eq!(player.app.training.list.mark(), usize::from(second - first));
    let player = player.send_mouse(MouseEventKind::ScrollUp, (5, second));
    assert_eq!(player.app.training.list.mark(), usize::from(second - first) - 1);
    let player = player.send_mouse(PRESS, (5, 0));
    assert_eq!(player.app.training.list.mark(), usize::from(second - first) - 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn random_mouse_reports_keep_the_layout_valid(
        reports in prop::collection::vec((0..4_usize, 0..130_u16, 0..50_u16), 1..80), ball in 0..3_usize,
    ) {
        let mut player = resized(Player::new());
        let cell = mapping().to_cell(player.app.coach.layout().balls[ball]);
        player = player.send_mouse(PRESS, cell);
        for (kind, column, row) in reports {
            let kind = [DRAG, DRAG, PRESS, MouseEventKind::Down(MouseButton::Right)][kind];
            player = player.send_mouse(kind, (column, row));
            prop_assert_eq!(player.app.coach.layout().validate(player.app.coach.table()), Ok(()));
        }
    }
}

#[test]
fn the_mouse_moves_no_selection_while_a_question_is_open() {
    let list = (20, 12);
    for asked in ["F5 Enter 7", "F5 Tab Enter", "F5 Tab Down Down Enter T"] {
        let player = resized(Player::new().press(asked));
        let marks = |player: &Player| (player.app.settings.mark, player.app.settings.keys.mark);
        let before = marks(&player);
        let player = player.send_mouse(MouseEventKind::ScrollDown, list).send_mouse(PRESS, list);
        assert_eq!(marks(&player), before, "{asked}");
        let player = player.press("Esc").send_mouse(MouseEventKind::ScrollDown, list);
        assert_ne!(marks(&player), before, "{asked}: it was answered");
    }
}
