//! Saving the balls of the coach's table: the dialog opens over the table, and the page stays the same.

use carom::terminal::{KeyContext, PageId};

use crate::screens::player::{Player, check};

#[test]
fn the_title_prompt_opens_over_the_coachs_page() {
    let player = Player::new().press("Right");
    let table = player.text(120, 40);
    let asked = player.press("s");
    check("save", &asked);
    asked.says("save the balls as (a title, and #tags if you like):").does_not_show("no position");
    let rows = |text: &str| text.lines().skip(1).take(30).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(rows(&asked.text(120, 40)), rows(&table), "the balls stay visible behind the prompt");
    let saved = asked.type_in("My corner #draw").press("Enter");
    saved.says("saved as my-corner").says("My positions");
    assert_eq!((saved.app.screen, saved.app.key_context()), (PageId::Coach, KeyContext::Coach));
    assert_eq!(saved.store().positions().items[0].title, "My corner");
    saved.press("d Left").says("My corner").says("#draw");
}

#[test]
fn an_invalid_title_can_be_corrected_and_escape_cancels() {
    let refused = Player::new().press("s").type_in("??").press("Enter");
    refused.says("gives no name").says("if you like): ??");
    let saved = refused.press("Backspace Backspace").type_in("mine").press("Enter");
    saved.says("saved as mine");
    let left = Player::new().press("s").type_in("q1").press("Esc");
    assert_eq!(left.app.key_context(), KeyContext::Coach);
    assert!(left.store().positions().items.is_empty());
    let mut pasted = Player::new().press("s");
    pasted.app.paste("from a\nchat");
    pasted.says("if you like): from a chat");
}

#[test]
fn a_late_save_result_does_not_replace_an_open_prompt() {
    let mut player = Player::new().press("s").type_in("mine").press("Enter p").type_in("2d,");
    let position = player.store().positions().items[0].clone();
    player.app.coach.saved(Box::new(position), Ok(false));
    player.says("mine is not saved: there is another of this name").says("share code)").says("2d,");
    assert_eq!(player.app.key_context(), KeyContext::Question { is_typed: true });
}

#[test]
fn replacing_needs_confirmation_and_bundled_names_are_refused() {
    let twice = Player::new().press("s").type_in("mine").press("Enter Right s").type_in("mine").press("Enter");
    twice.says("there is a position called mine already; replace it?");
    let first = twice.store().positions().items[0].layout;
    let kept = twice.press("n");
    assert_eq!((kept.store().positions().items[0].layout, kept.app.key_context()), (first, KeyContext::Coach));
    let replaced = kept.press("s").type_in("mine").press("Enter y");
    replaced.says("saved as mine");
    assert_eq!(replaced.store().positions().items[0].layout, *replaced.app.coach.layout());
    let bundled = replaced.app.drills.catalogue.library.exercises()[0].name.clone();
    let refused = replaced.press("s").type_in(&bundled).press("Enter");
    refused.says("is the name of a bundled exercise");
}

#[test]
fn typed_text_survives_switching_screens() {
    let player = Player::new().press("s").type_in("half").press("F4 F2");
    player.says("if you like): half");
    assert_eq!(player.type_in("t").press("F1 Esc Enter").store().positions().items[0].name, "halft");
}
