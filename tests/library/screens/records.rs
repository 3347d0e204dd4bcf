//! The record of a player: the estimate of the skill, and how it is displayed.

use super::{
    drills::{check, played},
    player::{ASCII, OTHER_SHOTS, Player, TRUE_COLOUR, cue},
    practice::{exercise, session, three_sessions},
};
use carom::drills::Goal;

#[test]
fn the_record_of_a_player() {
    let none = Player::at_library(TRUE_COLOUR, &[], &[]).press("r");
    // The reason why there is no estimate yet is displayed completely.
    let text = played().press("r").text(80, 24);
    assert!(text.contains("no games"), "{text}");
    none.shows(&["all exercises", "attempts  0", "0 of 20", "nothing is played yet"]);
    // 37 attempts at one shot are enough for the rate of this shot, and too few for the skill of the player.
    let few = played().press("r");
    few.shows(&["enough, but at 1 of 3"]);
    few.press("w").says("no estimate of your skill yet");
    let others = OTHER_SHOTS.iter().zip([7, 8]).map(|(shot, number)| {
        let mut other = session(number, "other", Goal::Free, "x-x");
        other.exercises[0].shot = Some(cue(shot));
        other
    });
    let sessions: Vec<_> = three_sessions().into_iter().chain(others).collect();
    let one =
        Player::at_library(TRUE_COLOUR, &[exercise("opening", "From the opening")], &sessions).press("Left Enter r");
    check("record", &one);
    one.says("37").says("high run").says("7");
    let figures = ["table     27 of 37, 73 % (57-85)", "average   2.25 an inning", "high run  7"];
    played().press("r").shows(&figures).shows(&["all exercises", "by session, last:"]);
    Player::at_library(ASCII, &[exercise("opening", "x")], &three_sessions()).press("r").is_plain().shows(&figures);
    let large = played().press("r").text(200, 60);
    assert!(figures.iter().all(|part| large.contains(part)), "{large}");
    one.says("you play like an average of");
    let kept = one.press("w");
    kept.says("me by my notes");
    let skill = kept.store().own_skill().unwrap().unwrap().skill;
    let played = kept.app.drills.player.skill;
    assert_eq!(played.to_string(), skill.to_string());
    let left = kept.press("Esc Esc");
    left.does_not_show("newer than your skill");
    let mut newer = session(20, "opening", Goal::Free, &"x-".repeat(10));
    newer.attempts.iter_mut().for_each(|note| note.at = 4_000_000_000);
    left.store().save(&newer, &[], 0).unwrap();
    let left = left.press("Esc");
    assert_eq!(left.app.coach.query.skill, played, "the same player everywhere");
    left.press("d").shows(&["20 notes are newer than your skill: r, then w takes the new estimate"]);
}

#[test]
fn the_record_includes_attempts_noted_by_another_program() {
    let player = played();
    player.store().save(&session(7, "opening", Goal::Free, "xxx"), &[], 0).unwrap();
    player.press("r").shows(&[" of 40, "]);
}

#[test]
fn grade_and_score_stay_separated_with_many_attempts() {
    let row = |tried: usize| {
        let mut graded = exercise("opening", "From the opening");
        graded.grade = 3;
        let attempts = "x".repeat(tried - 20) + &"-".repeat(20);
        let sessions = [session(1, "opening", Goal::Free, &attempts)];
        let text = Player::at_library(TRUE_COLOUR, &[graded], &sessions).press("Left").text(80, 24);
        text.lines().find(|line| line.contains("▸ From the opening")).unwrap().to_owned()
    };
    for (tried, figures) in [(120, "3 100/120"), (1020, "3   1k/1k")] {
        let row = row(tried);
        assert!(row.contains(figures), "{row}");
    }
}

#[test]
fn a_record_of_all_exercises_cannot_be_narrowed() {
    let game = Player::practising(TRUE_COLOUR).press("o o r");
    game.does_not_show("all or one");
    game.press("a").warns("this record is of all exercises");
    let one = Player::practising(TRUE_COLOUR).press("r");
    one.shows(&["all or one"]);
    one.press("a").warns_nothing();
}

#[test]
fn a_shot_pauses_behind_the_record() {
    let watched = Player::practising(TRUE_COLOUR).press("S-Right S-Right S-Right S-Right Space").wait(0.1);
    let back = watched.press("r a a").wait(60.0).press("Esc");
    back.says("the shot is running").does_not_show("No point: ");
    back.wait(60.0).says("No point: ");
}
