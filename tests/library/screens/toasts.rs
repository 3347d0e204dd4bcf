//! Toasts through the real app: their position, their duration, and that they hide nothing that needs an answer.

use super::{
    player::{ASCII, NO_COLOUR, Player, SIZES, TRUE_COLOUR, check, check_at},
    runs::trainer_failed,
};
use carom::terminal::CoachEvent;
use ratatui::style::Color;

/// Returns a player whose coach has refused with sentences of these numbers of words.
pub fn with_refusals(mut player: Player, words: &[usize]) -> Player {
    for count in words {
        player = player.press("Enter");
        let id = player.advice_job.take().unwrap().id;
        let sentence = format!("the weights are damaged{}", ", and so is all else".repeat(*count));
        player = player.tell(id, CoachEvent::Refused(sentence));
    }
    player
}

#[test]
fn toasts_overlay_the_picture_and_wrap() {
    let player = with_refusals(Player::new(), &[0, 5]).press("u");
    check("toasts", &player);
    let picture = player.picture(80, 24);
    let warning = Color::Rgb(0xff, 0x8a, 0x70);
    assert!((0..24).any(|y| picture[(79, y)].fg == warning && picture[(79, y)].symbol() == "│"));
    for caps in [NO_COLOUR, ASCII] {
        let player = with_refusals(Player::with(caps), &[0, 5]).press("u");
        player.is_plain().shows(&["the weights are damaged", "there is nothing to undo"]);
    }
    let long = with_refusals(Player::new(), &[60]);
    assert!(long.text(80, 24).contains("F6 shows all of it"));
}

#[test]
fn toasts_expire_and_answers_vanish_with_the_next_key() {
    let player = Player::new().press("u");
    player.warns("there is nothing to undo");
    assert_eq!(player.app.frame_interval(), None, "nothing moves while it is read");
    let time = player.app.toasts.time_left().unwrap();
    assert!((4.0..8.0).contains(&time), "{time}");
    let gone = player.wait(time);
    assert_eq!((gone.app.toasts.time_left(), gone.app.toasts.shown.len()), (None, 0));
    assert_eq!(gone.picture(80, 24), Player::new().picture(80, 24), "nothing is left of it");
    let player = with_refusals(gone.press("u"), &[0]).press("Left");
    assert!(!player.has_toast("there is nothing to undo"));
    player.warns("the weights are damaged");
    assert!(player.press("Esc").app.toasts.shown.iter().all(|toast| !toast.text.contains("weights")));
}

#[test]
fn background_failures_are_shown_and_stay_in_the_messages() {
    let mut player = Player::new().press("F5");
    player.app.receive_training(trainer_failed(None, "the disk is full"));
    player.warns("the disk is full");
    assert_eq!(player.app.toasts.take_unlogged().len(), 1, "the failure is logged once");
    assert!(player.app.toasts.take_unlogged().is_empty());
    let player = player.wait(60.0).press("F6");
    let text = player.text(120, 40);
    assert!(text.contains("the disk is full") && text.contains("carom.log"), "{text}");
    let closed = player.press("Esc");
    assert!(closed.app.overlay.is_none() && !closed.text(120, 40).contains("the disk is full"));
}

#[test]
fn no_toast_covers_the_messages_page() {
    let mistakes: Vec<String> = (1..=7).map(|n| format!("mistake{n} = 1")).collect();
    let player = Player::with_settings(TRUE_COLOUR, &mistakes.join("\n"));
    player.warns("and 6 more: F6");
    let player = with_refusals(player, &[0]).press("F6");
    player.warns_nothing();
    let text = player.text(120, 40);
    assert!((1..=7).all(|n| text.contains(&format!("\"mistake{n}\""))), "{text}");
    player.press("Esc").warns_nothing();
}

#[test]
fn refusals_over_the_messages_page_are_not_recorded() {
    let refused = Player::new().press("F6 x");
    refused.shows(&["close this first: Esc", "No messages so far"]);
    let closed = refused.press("F6");
    assert_eq!((closed.app.overlay, closed.app.toasts.messages().len()), (None, 0));
    closed.warns_nothing();
}

#[test]
fn a_failure_appears_once_on_the_open_messages_page() {
    let count = |player: &Player, (width, height)| player.text(width, height).matches("the disk is full").count();
    let failure = || trainer_failed(None, "the disk is full");
    let open = Player::new().press("F6").report(failure());
    assert_eq!(SIZES.map(|size| count(&open, size)), [1, 1], "{}", open.text(80, 24));
    assert!(!open.text(80, 24).contains('┌'), "{}", open.text(80, 24));
    open.press("q").warns_nothing();
    // If the first lines are out of sight, the failure is shown in a toast over the others.
    let many: Vec<usize> = (1..=40).collect();
    let scrolled = with_refusals(Player::new(), &many).press("F6 Down").report(failure());
    assert!(scrolled.text(80, 24).contains('┌'), "{}", scrolled.text(80, 24));
    scrolled.press("q").warns("the disk is full");
}

#[test]
fn toasts_never_hide_questions() {
    let mut player = Player::at_library(TRUE_COLOUR, &[], &[]).press("Left a");
    player.app.paste(&"half a code ".repeat(40));
    let player = player.press("Enter");
    check_at(&[(80, 24)], "toasts_question", &player);
    player.shows(&["paste or type the code of a position", "Enter take it"]);
    let name = Player::watching(TRUE_COLOUR).press("k Backspace / Enter");
    let text = name.text(80, 24);
    assert!(text.contains("keep the networks under the name") && name.has_toast("is no name"), "{text}");
}
