//! Messages and questions of the drills: protection against mistaken keys, sources of results, and sessions to resume later.

use super::{
    mouse::resized,
    player::{Player, TRUE_COLOUR},
    practice::{exercise, session, three_sessions},
};
use carom::{
    drills::{Goal, Session, Venue},
    storage::save_json,
    terminal::{DrillContext, KeyContext, SavedSession},
};
use crossterm::event::MouseEventKind;

#[test]
fn an_unchanged_stroke_needs_a_second_press() {
    let asked = Player::practising(TRUE_COLOUR).press("Space");
    asked.says("the stroke is unchanged; Space again plays it anyway");
    assert_eq!(asked.attempt_count(), 0);
    let played = asked.press("Space").wait(60.0);
    assert_eq!(played.attempt_count(), 1);
    assert_eq!(played.press("Enter Space").attempt_count(), 2, "the question is asked only once");
    assert_eq!(Player::practising(TRUE_COLOUR).press("Left Space").attempt_count(), 1);
}

#[test]
fn the_first_note_explains_venue_and_undo() {
    let noted = Player::practising(TRUE_COLOUR).press("n");
    noted.says("noted for a real table: missed, 0 of 1 now; u undoes it");
    noted.press("m").says("noted: made, 1 of 2 now");
}

#[test]
fn a_left_match_can_be_resumed_at_the_next_start() {
    let left = Player::practising(TRUE_COLOUR).press("o o o Left Enter Enter Esc");
    left.says("the match is kept; Enter on the exercise goes on with it, c on the coach's page at the next start");
    let left = left.press("Esc");
    assert_eq!(left.app.key_context(), KeyContext::Coach);
    let last = left.app.saved_session().unwrap();
    assert!(last.practice.as_ref().is_some_and(|practice| practice.is_match() && practice.attempts.len() == 1));
    let next = Player::new().after(&left);
    next.says("c goes on with the match of the last session");
    let on = next.press("c");
    assert_eq!(on.app.key_context(), KeyContext::Drill(DrillContext::Exercise));
    assert_eq!(on.app.drills.turn.as_ref().unwrap().session.attempts.len(), 1);
    // An exercise that is open meanwhile does not replace it.
    let other = Player::practising(TRUE_COLOUR).press("o o o Left Enter Enter Esc 0 Home Enter F2");
    let kept = other.app.saved_session().unwrap();
    assert!(kept.practice.is_some_and(|practice| practice.is_match()));
}

/// Regression test: notes at another exercise replaced the run.
#[test]
fn a_left_run_is_saved_despite_later_notes() {
    let positions = [exercise("first", "The first"), exercise("second", "The second")];
    let run = Player::at_library(TRUE_COLOUR, &positions, &[]).press("Left Home Enter o m Esc");
    let left = run.press("Down Enter m Esc").app.saved_session().unwrap();
    assert!(matches!(left.practice.map(|practice| practice.goal), Some(Goal::Run(_))));
}

#[test]
fn a_game_of_an_earlier_start_goes_on_when_its_exercise_is_opened() {
    let left = Player::at_library(TRUE_COLOUR, &[], &[]).press("Home Enter o o Left Enter Enter F2");
    let mut next = Player::new();
    let path = next.path("last.json");
    save_json(&path, &left.app.saved_session().unwrap()).unwrap();
    next.app = next.app.with_saved_session(SavedSession::load(&path).unwrap());
    let again = next.press("c Esc Enter");
    again.says("game, 10 innings: it goes on here");
    assert_eq!(again.app.drills.turn.as_ref().unwrap().session.attempts.len(), 1);
}

#[test]
fn a_goal_belongs_to_the_exercise_for_which_it_was_chosen() {
    let positions = [exercise("first", "The first"), exercise("second", "The second")];
    let goal = |player: &Player| player.app.drills.turn.as_ref().unwrap().session.goal;
    let chosen = Player::at_library(TRUE_COLOUR, &positions, &[]).press("Left Home Enter o o >");
    assert_eq!(goal(&chosen), Goal::Game { innings: 11 });
    let other = chosen.press("Esc Down Enter");
    assert_eq!(goal(&other), Goal::Free);
    let back = other.press("o Esc Up Enter");
    assert_eq!(goal(&back), Goal::Game { innings: 11 });
    assert_eq!(goal(&back.press("Esc Down Enter")), Goal::Run(5));
}

#[test]
fn real_table_and_simulator_results_are_listed_separately() {
    let here = Session { venue: Venue::Program, ..session(6, "opening", Goal::Free, "x---") };
    let sessions: Vec<Session> = three_sessions().into_iter().chain([here]).collect();
    let positions = [exercise("opening", "From the opening")];
    let library = Player::at_library(TRUE_COLOUR, &positions, &sessions).press("Left");
    library.shows(&["table", "here", "27/37", "1/4", "table: 27 of 37", "here: 1 of 4"]);
    let record = library.press("Enter r");
    record.shows(&["27 of 37, 73 %", "1 of 4, 25 %", "here  free repetition", "table free repetition"]);
}

#[test]
fn keys_for_a_marked_exercise_say_that_none_is_listed() {
    for key in ["x", "Enter", "y", "c"] {
        Player::at_library(TRUE_COLOUR, &[], &[]).press("Left").press(key).warns("no exercise is listed; 0 lists all");
    }
}

#[test]
fn an_empty_search_offers_other_categories() {
    let none = Player::at_library(TRUE_COLOUR, &[], &[]).press("Left /").type_in("natural");
    none.says("None in My positions; ").says(" elsewhere: Enter lists them.");
    let elsewhere = none.app.drills.catalogue.matches_elsewhere();
    let found = none.press("Enter");
    let catalogue = &found.app.drills.catalogue;
    let listed = (catalogue.filtered().len(), catalogue.filter.category, catalogue.matches_elsewhere());
    assert_eq!(listed, (elsewhere, None, 0));
    assert!(elsewhere > 1, "{elsewhere}");
    found.shows(&[": \"natural\"", "Esc end search"]);
    let all = found.press("Esc");
    assert_eq!(all.app.key_context(), KeyContext::Drill(DrillContext::Library));
    all.says("All ").does_not_show("\"natural\"");
    assert_eq!(all.press("Esc").app.key_context(), KeyContext::Coach);
}

#[test]
fn the_hint_shows_the_model_shots_tip_and_hit() {
    let aiming = Player::practising(TRUE_COLOUR);
    aiming.does_not_show("Model tip");
    let shown = aiming.press("v");
    shown.shows(&["Model tip", "yours: red 100 % full"]).says("Model hit");
    shown.press("v").shows(&["Your stroke"]).does_not_show("Model tip");
}

#[test]
fn an_exercise_shows_ball_positions_and_a_different_table() {
    let player = Player::at_library(TRUE_COLOUR, &[exercise("opening", "From the opening")], &[]).press("Left");
    player.says("balls: white ");
    player.press("Enter").says("balls: white ").does_not_show("on match, not on");
    let other = Player::with_settings(TRUE_COLOUR, "table = \"textbook\"\nplace_unit = \"mm\"\n").press("F3 Enter");
    other.says("on match, not on ").says("textbook").says("balls, mm from the lower left corner: ");
}

#[test]
fn the_wheel_scrolls_the_record() {
    let sessions: Vec<Session> = (1..=30).map(|day| session(day, "opening", Goal::Free, "x-")).collect();
    let positions = [exercise("opening", "From the opening")];
    let player = resized(Player::at_library(TRUE_COLOUR, &positions, &sessions).press("r"));
    let before = player.text(120, 40);
    let after = player.send_mouse(MouseEventKind::ScrollDown, (20, 30)).text(120, 40);
    // The latest session, of the day after the 30th of November, is listed first.
    assert!(before.contains("2026-12-01") && !after.contains("2026-12-01"), "{before}\n{after}");
}
