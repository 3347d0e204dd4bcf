//! Matches against the coach: the choice of the distance and of the coach's level, the equalising inning, and the result.

use carom::{
    coach::Skill,
    drills::{Goal, Session},
    game::Rule,
    terminal::{DrillContext, KeyContext},
};

use super::player::{ASCII, NO_COLOUR, OTHER_SHOTS, Player, SHOT, TRUE_COLOUR, check, cue};

fn session(player: &Player) -> Session {
    player.app.drills.turn.as_ref().unwrap().session.clone()
}

/// Returns a match to `points` at straight rail that a player without errors has begun. The coach's shot makes the first point.
fn to(points: usize, level: &str) -> Player {
    let mut player = Player::at_library(NO_COLOUR, &[], &[]).press("p p p p p M Up Left Left").press(level);
    player.model_shot = Some(SHOT);
    player.press("Enter").press(&"< ".repeat(15 - points))
}

#[test]
fn the_distance_and_the_coachs_level_are_chosen_before_a_match() {
    let player = Player::at_library(TRUE_COLOUR, &[], &[]).press("M");
    check("match_begins", &player);
    player.shows(&["three-cushion", "15 points", "no limit", "as you", "Enter begin"]);
    let chosen = player.press("Right Right Down Right Right Down Right Right");
    chosen.shows(&["25 points", "10 innings", "club", "Space plays each of the coach's strokes"]);
    let begun = chosen.press("Enter");
    let goal = Goal::Match { innings: 10, points: 25, against_coach: true };
    assert_eq!((session(&begun).goal, session(&begun).coach_skill), (goal, Some(Skill::CLUB)));
    begun.shows(&["inning 1 of 10, to 25 points", "coach: club"]);
    // The choices stay.
    begun.press("Esc M").shows(&["25 points", "10 innings", "club"]);
    Player::at_library(NO_COLOUR, &[], &[]).press("M").is_plain().says("15 points");
    Player::at_library(ASCII, &[], &[]).press("M Down Left").is_plain().says("50 innings");
    let left = Player::at_library(TRUE_COLOUR, &[], &[]).press("M Esc");
    assert_eq!(left.app.key_context(), KeyContext::Drill(DrillContext::Library));
}

#[test]
fn the_coach_equalises_from_the_opening() {
    let player = to(1, "");
    player.says("inning 1, to 1 point");
    assert_eq!(session(&player).exercises[0].rule, Rule::StraightRail);
    let made = player.press("v w Space Enter");
    made.says("you (white): 1, best 1").says("inning 1, the equalising one");
    let coach = made.press("Enter");
    coach.says("Stroke of yellow").says("the coach's stroke, with errors as large as yours");
    let turn = coach.app.drills.turn.as_ref().unwrap();
    assert_eq!(turn.layout, session(&coach).exercises[0].layout);
    let over = coach.press("Space Enter");
    over.says("the match is over: you 1 : 1 coach, a draw")
        .says("averages 1.00 : 1.00")
        .says("coach (yellow): 1, best 1")
        .says("Enter begin again")
        .does_not_show("Enter next");
    assert!(session(&over).is_over());
    let again = over.press("Enter");
    again.says("inning 1, to 1 point").says("no attempt yet");
}

#[test]
fn the_first_to_the_distance_wins() {
    let mut made = to(1, "Down Down Down Right").press("v w Space Enter");
    made.model_shot = Some(OTHER_SHOTS[0]);
    let over = made.press("Enter");
    over.says("the coach's stroke (it plays as beginner); Space plays it");
    assert_eq!(*over.app.drills.turn.as_ref().unwrap().stroke(), cue(OTHER_SHOTS[0]), "its own, not the player's");
    assert_eq!(session(&over).coach_skill, Some(Skill::BEGINNER));
    // A stroke at which the tip slips has no playback.
    let over = over.press("Space").wait(60.0);
    let last = session(&over).attempts[1].clone();
    assert!(last.by_coach && !last.made && last.intended != last.played, "a beginner has errors");
    over.says("the match is over: you 1 : 0 coach, you win").says("you win");
    assert_eq!(session(&over.press("Enter")).coach_skill, Some(Skill::BEGINNER), "another match of the same kind");
}

#[test]
fn an_unfinished_match_is_resumed_or_given_up() {
    let begun = to(5, "").press("Left Space Enter Enter");
    let (id, attempts) = (session(&begun).id, session(&begun).attempts.len());
    assert_eq!(attempts, 1);
    let resumed = session(&Player::new().after(&begun).press("F9"));
    assert_eq!((resumed.id.as_str(), resumed.attempts.len(), resumed.goal), (id.as_str(), 1, session(&begun).goal));
    let asked = begun.press("M Enter");
    asked.says("give up the match after 1 attempt? It stays in the record.");
    let kept = asked.press("n Esc");
    assert_eq!(session(&kept).id, id);
    let other = kept.press("M Enter y");
    assert_ne!(session(&other).id, id);
    assert_eq!(other.app.key_context(), KeyContext::Drill(DrillContext::Exercise));
    let left = other.press("Esc F9");
    assert_eq!(
        left.app.key_context(),
        KeyContext::Drill(DrillContext::Match),
        "the one that was given up is not offered"
    );
}
