//! Messages and questions of the drills: protection against mistaken keys, sources of results, and sessions to resume later.

use super::{
    player::{Player, TRUE_COLOUR},
    practice::{exercise, history, session},
};
use carom::{
    drills::{Goal, Session, Venue},
    terminal::{DrillContext, KeyContext},
};
use crossterm::event::{KeyModifiers, MouseEvent, MouseEventKind};

#[test]
fn a_stroke_that_nobody_has_set_is_played_at_the_second_press() {
    let asked = Player::practising(TRUE_COLOUR).press("Space");
    asked.says("the stroke is unchanged; Space again plays it anyway");
    assert_eq!(asked.kept(), 0);
    let played = asked.press("Space").wait(60.0);
    assert_eq!(played.kept(), 1);
    assert_eq!(played.press("Enter Space").kept(), 2, "who wants it so is asked once");
    assert_eq!(Player::practising(TRUE_COLOUR).press("Left Space").kept(), 1);
}

#[test]
fn the_first_note_says_that_it_is_one_of_a_real_table_and_how_it_is_taken_back() {
    let noted = Player::practising(TRUE_COLOUR).press("n");
    noted.says("noted for a real table: missed, 0 of 1 now; u takes it back");
    noted.press("m").says("noted: made, 1 of 2 now");
}

#[test]
fn a_match_that_was_left_is_there_at_the_next_start_too() {
    let left = Player::practising(TRUE_COLOUR).press("o o o Left Enter Enter Esc");
    left.says("the match is kept; Enter on the exercise goes on with it, c on the coach's page at the next start");
    let left = left.press("Esc");
    assert_eq!(left.app.place(), KeyContext::Coach);
    let last = left.app.saved_session().unwrap();
    assert!(last.practice.as_ref().is_some_and(|practice| practice.is_match() && practice.attempts.len() == 1));
    let mut next = Player::new();
    next.app = next.app.with_saved_session(Some(last));
    next.says("c goes on with the match of the last session");
    let on = next.press("c");
    assert_eq!(on.app.place(), KeyContext::Drill(DrillContext::Exercise));
    assert_eq!(on.app.drills.turn.as_ref().unwrap().session.attempts.len(), 1);
    // An exercise that is open meanwhile does not replace it.
    let other = Player::practising(TRUE_COLOUR).press("o o o Left Enter Enter Esc 0 Home Enter F2");
    let kept = other.app.saved_session().unwrap();
    assert!(kept.practice.is_some_and(|practice| practice.is_match()));
}

#[test]
fn results_of_a_real_table_and_strokes_of_the_program_stand_apart() {
    let here = Session { venue: Venue::Program, ..session(6, "opening", Goal::Free, "x---") };
    let sessions: Vec<Session> = history().into_iter().chain([here]).collect();
    let positions = [exercise("opening", "From the opening")];
    let library = Player::at_library(TRUE_COLOUR, &positions, &sessions).press("Left");
    library.shows(&["table", "here", "27/37", "1/4", "table: 27 of 37", "here: 1 of 4"]);
    let record = library.press("Enter r");
    record.shows(&["27 of 37, 73 %", "1 of 4, 25 %", "here  free repetition", "table free repetition"]);
}

#[test]
fn a_search_that_finds_nothing_in_a_category_offers_the_others_and_esc_ends_it_first() {
    let none = Player::at_library(TRUE_COLOUR, &[], &[]).press("Left /").type_in("natural");
    none.says("None in My positions; ").says(" elsewhere: Enter lists them.");
    let elsewhere = none.app.drills.catalogue.elsewhere();
    let found = none.press("Enter");
    let catalogue = &found.app.drills.catalogue;
    assert_eq!((catalogue.found().len(), catalogue.filter.category, catalogue.elsewhere()), (elsewhere, None, 0));
    assert!(elsewhere > 1, "{elsewhere}");
    found.shows(&[": \"natural\"", "Esc end search"]);
    let all = found.press("Esc");
    assert_eq!(all.app.place(), KeyContext::Drill(DrillContext::Library));
    all.says("All ").is_silent_on("\"natural\"");
    assert_eq!(all.press("Esc").app.place(), KeyContext::Coach);
}

#[test]
fn while_the_model_shot_is_shown_tip_and_hit_are_its_own() {
    let aiming = Player::practising(TRUE_COLOUR);
    aiming.is_silent_on("Model tip");
    let shown = aiming.press("v");
    shown.shows(&["Model tip", "yours: yellow 100 % full"]).says("Model hit");
    shown.press("v").shows(&["Your stroke"]).is_silent_on("Model tip");
}

#[test]
fn an_exercise_says_where_the_balls_lie_and_that_it_is_on_another_table_than_the_settings_one() {
    let player = Player::at_library(TRUE_COLOUR, &[exercise("opening", "From the opening")], &[]).press("Left");
    player.says("balls: white ");
    player.press("Enter").says("balls: white ").is_silent_on("on match, not on");
    let other = Player::with_settings(TRUE_COLOUR, "table = \"textbook\"\nplace_unit = \"mm\"\n").press("F3 Enter");
    other.says("on match, not on ").says("textbook").says("balls, mm from the lower left corner: ");
}

#[test]
fn the_wheel_scrolls_the_record() {
    let sessions: Vec<Session> = (1..=30).map(|day| session(day, "opening", Goal::Free, "x-")).collect();
    let positions = [exercise("opening", "From the opening")];
    let mut player = Player::at_library(TRUE_COLOUR, &positions, &sessions).press("r");
    player.app.resize(ratatui::layout::Size::new(120, 40));
    let before = player.text(120, 40);
    let kind = MouseEventKind::ScrollDown;
    player.app.mouse(MouseEvent { kind, column: 20, row: 30, modifiers: KeyModifiers::NONE });
    let after = player.text(120, 40);
    // The latest session, of the day after the 30th of November, is listed first.
    assert!(before.contains("2026-12-01") && !after.contains("2026-12-01"), "{before}\n{after}");
}
