//! Attempts that the disk has refused are saved later, and the player is told which ones are not.

use std::fs;

use crate::screens::player::{Player, TRUE_COLOUR};

/// Makes the folder of sessions unwritable, as on a full disk.
fn block(player: &Player) {
    fs::create_dir_all(player.path("sessions")).unwrap();
    fs::rename(player.path("sessions"), player.path("kept")).unwrap();
    fs::write(player.path("sessions"), "in the way").unwrap();
}

fn unblock(player: &Player) {
    fs::remove_file(player.path("sessions")).unwrap();
    fs::rename(player.path("kept"), player.path("sessions")).unwrap();
}

/// The results of the only session on the disk.
fn results(player: &Player) -> Vec<bool> {
    let sessions = player.store().sessions().items;
    assert!(sessions.len() < 2, "{sessions:?}");
    sessions.into_iter().flat_map(|session| session.attempts).map(|attempt| attempt.made).collect()
}

#[test]
fn refused_attempts_are_saved_when_the_exercise_is_left() {
    for keys in ["m", "Space Space Enter Enter"] {
        let player = Player::practising(TRUE_COLOUR);
        block(&player);
        let refused = player.press(keys);
        refused.warns("counts here, but it is not saved");
        unblock(&refused);
        let left = refused.press("Esc");
        assert_eq!(left.attempt_count(), 1, "{keys}");
        left.says("what was not saved is on the disk now");
    }
    let exam = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter");
    block(&exam);
    let exam = exam.press("Space Space Enter Enter");
    unblock(&exam);
    assert_eq!(exam.press("Esc y").attempt_count(), 1);
}

#[test]
fn unsaved_attempts_are_named_and_stay_in_the_record() {
    let player = Player::practising(TRUE_COLOUR).press("m");
    block(&player);
    let left = player.press("n n Esc");
    left.warns("not saved: 2 attempts at From the opening; ");
    left.warns("cannot be written: ");
    left.warns("; carom tries again");
    let record = left.press("Enter r");
    record.says("1 of 3, 33 %");
    unblock(&record);
    assert_eq!(results(&record.press("F2 F3")), [true, false, false], "opening the drills saves them too");
}

#[test]
fn a_refused_undo_is_not_taken_for_another_program() {
    let player = Player::practising(TRUE_COLOUR).press("m n");
    block(&player);
    let undone = player.press("u");
    undone.warns("not saved");
    let again = undone.press("m");
    again.warns("not saved");
    unblock(&again);
    let saved = again.press("n");
    assert_eq!(results(&saved), [true, true, false]);
    assert!(!saved.has_toast("another program"), "{}", saved.text(120, 40));
}

#[test]
fn a_refused_attempt_never_overwrites_what_another_program_has_noted() {
    let player = Player::practising(TRUE_COLOUR).press("m");
    block(&player);
    let refused = player.press("n");
    unblock(&refused);
    let mut session = refused.store().sessions().items.remove(0);
    let before = session.attempts.clone();
    session.log(true).unwrap();
    refused.store().save(&session, &before, 0).unwrap();
    let left = refused.press("Esc");
    left.warns("another program has changed this session");
    left.does_not_show("on the disk now");
    assert_eq!(results(&left), [true, true]);
}
