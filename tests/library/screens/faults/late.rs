//! Results that arrive after the player has gone on, and shots that do not happen.

use carom::terminal::DrillReport;

use crate::screens::player::{Player, TRUE_COLOUR};

#[test]
fn a_stroke_that_ends_after_its_session_is_left_still_counts() {
    let mut player = Player::practising(TRUE_COLOUR).press("o Space Space Enter Enter");
    let stroke = player.requested_tasks("Space");
    let mut left = player.press("Esc");
    left.says("the run is kept");
    left.run(stroke);
    assert_eq!(left.attempt_count(), 2);
    let on = left.press("Enter");
    on.says("it goes on here after 2 played");
    assert_eq!(on.press("Space Space Enter Enter").attempt_count(), 3);
}

#[test]
fn nothing_moves_after_a_miscue() {
    let mut player = Player::practising(TRUE_COLOUR).press("Space");
    for task in player.requested_tasks("Space") {
        let mut reports = Vec::new();
        player.practice.run(task, &mut |report| reports.push(report));
        for mut report in reports {
            if let DrillReport::Played(_, Ok(outcome), _) = &mut report {
                outcome.shot = None;
            }
            player.app.receive_drill(report);
        }
    }
    player.finish_replay().says("next");
}

#[test]
fn a_run_that_is_opened_again_is_read_from_its_beginning() {
    let player = Player::watching(TRUE_COLOUR);
    let before = player.app.subscriptions().followed;
    let again = player.press("Esc Enter").app.subscriptions().followed;
    assert_eq!(before[0].as_ref().map(|(folder, _)| folder), again[0].as_ref().map(|(folder, _)| folder));
    assert_ne!(before, again);
}
