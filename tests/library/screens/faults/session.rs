//! What the next start may go on from, as keys change it.

use carom::{coach::Skill, game::Rule};

use crate::screens::player::{Player, TRUE_COLOUR};

#[test]
fn nothing_is_remembered_before_something_was_done_and_then_all_of_it() {
    let player = Player::new();
    assert!(player.app.last().is_none());
    let player = player.press("Right R S x");
    let last = player.app.last().unwrap();
    assert_eq!((last.layout, &*last.table), (*player.app.coach.layout(), player.app.coach.table()));
    assert_eq!((last.rule, last.cue_ball), (Rule::OneCushion, player.app.page().cue_ball()));
    assert_ne!(last.skill, Skill::EXPERT);
    assert!(last.practice.is_none());
    let saved = last.clone().into_owned();
    assert_eq!(saved, last, "what is written is what was compared");
    let moved = player.press("Right");
    assert_ne!(moved.app.last(), Some(saved.clone()));
    assert_eq!(moved.press("u").app.last(), Some(saved.clone()));
}

#[test]
fn what_is_practised_is_remembered_as_long_as_it_is_on_the_screen() {
    let player = Player::practising(TRUE_COLOUR).press("m");
    let saved = player.app.last().unwrap().into_owned();
    assert_eq!(saved.practice.as_ref().map(|session| session.attempts.len()), Some(1));
    let noted = player.press("n");
    assert_ne!(noted.app.last(), Some(saved.clone()));
    assert!(noted.press("F2").app.last().is_none(), "the coach's table is as at the start");
}
