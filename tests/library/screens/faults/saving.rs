//! Saving the balls of the coach's table: the dialog opens over the table, and the page stays the same.

use carom::terminal::{KeyContext, PageId};

use crate::screens::player::{Player, check};

fn at_coach() -> Player {
    Player::new()
}

#[test]
fn the_title_is_asked_over_the_table_and_one_stays_there() {
    let player = at_coach().press("Right");
    let table = player.text(120, 40);
    let asked = player.press("s");
    check("save", &asked);
    asked.says("save the balls as (a title, and #tags if you like):").is_silent_on("no position");
    let rows = |text: &str| text.lines().skip(1).take(30).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(rows(&asked.text(120, 40)), rows(&table), "the balls are seen while one thinks of a title");
    let saved = asked.type_in("My corner #draw").press("Enter");
    saved.says("saved as my-corner").says("My positions");
    assert_eq!((saved.app.screen, saved.app.place()), (PageId::Coach, KeyContext::Coach));
    assert_eq!(saved.store().positions().items[0].title, "My corner");
    saved.press("d Left").says("My corner").says("#draw");
}

#[test]
fn a_title_that_makes_no_name_is_mended_and_escape_saves_nothing() {
    let refused = at_coach().press("s").type_in("??").press("Enter");
    refused.says("gives no name").says("if you like): ??");
    let saved = refused.press("Backspace Backspace").type_in("mine").press("Enter");
    saved.says("saved as mine");
    let left = at_coach().press("s").type_in("q1").press("Esc");
    assert_eq!(left.app.place(), KeyContext::Coach);
    assert!(left.store().positions().items.is_empty());
    let mut pasted = at_coach().press("s");
    pasted.app.paste("from a\nchat");
    pasted.says("if you like): from a chat");
}

#[test]
fn an_answer_that_comes_late_does_not_take_the_place_of_what_is_asked_meanwhile() {
    let mut player = at_coach().press("s").type_in("mine").press("Enter p").type_in("2d,");
    let position = player.store().positions().items[0].clone();
    player.app.coach.saved(Box::new(position), Ok(false));
    player.says("mine is not saved: there is another of this name").says("code: 2d,");
    assert_eq!(player.app.place(), KeyContext::Question { is_typed: true });
}

#[test]
fn a_name_that_is_taken_is_asked_about_and_a_bundled_one_refused() {
    let twice = at_coach().press("s").type_in("mine").press("Enter Right s").type_in("mine").press("Enter");
    twice.says("there is a position called mine already; replace it?");
    let first = twice.store().positions().items[0].layout;
    let kept = twice.press("n");
    assert_eq!((kept.store().positions().items[0].layout, kept.app.place()), (first, KeyContext::Coach));
    let replaced = kept.press("s").type_in("mine").press("Enter y");
    replaced.says("saved as mine");
    assert_eq!(replaced.store().positions().items[0].layout, *replaced.app.coach.layout());
    let bundled = replaced.app.drills.catalogue.library.exercises()[0].name.clone();
    let refused = replaced.press("s").type_in(&bundled).press("Enter");
    refused.says("is the name of a bundled exercise");
}

#[test]
fn what_is_typed_stays_on_the_way_to_another_screen() {
    let player = at_coach().press("s").type_in("half").press("F4 F2");
    player.says("if you like): half");
    assert_eq!(player.type_in("t").press("F1 Esc Enter").store().positions().items[0].name, "halft");
}
