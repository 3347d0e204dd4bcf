//! Exams: they are announced before the first stroke, and an exam that was left can be resumed.

use carom::{
    drills::{Category, Goal, Library},
    terminal::{DrillContext, KeyContext},
};

use crate::screens::player::{Player, TRUE_COLOUR, check};

const EXERCISE: KeyContext = KeyContext::Drill(DrillContext::Exercise);
const LIBRARY: KeyContext = KeyContext::Drill(DrillContext::Library);

#[test]
fn an_exam_starts_with_an_introduction() {
    let player = Player::at_library(TRUE_COLOUR, &[], &[]).press("E");
    check("exam_begins", &player);
    player.says("level 2").says("20 exercises of grade 2 to 4").says("one attempt each").says("expert");
    let begun = player.press("Enter");
    assert_eq!((begun.app.key_context(), begun.attempt_count()), (EXERCISE, 0), "the first Enter plays nothing");
    begun.says("exercise 1 of 20").says("set the stroke and play it");
    let once_more = begun.press("Enter");
    once_more.says("the stroke is unchanged; Space twice plays it anyway");
    assert_eq!((once_more.attempt_count(), once_more.press("Left Enter").attempt_count()), (0, 1));
    let back = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Esc");
    assert_eq!(back.app.key_context(), LIBRARY, "nothing has begun: nothing is asked");
}

#[test]
fn a_left_exam_is_resumed_from_the_coach() {
    let player = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter Esc");
    player.says("leave the exam after 1 of 20 exercises? c on the coach's page goes on with it.");
    let left = player.press("y");
    assert_eq!(left.app.key_context(), LIBRARY);
    left.says("the exam is kept; c on the coach's page (F2) goes on with it");
    let on = left.press("F2 c");
    assert_eq!(on.app.key_context(), EXERCISE);
    on.says("exercise 2 of 20");
    let over = (2..=20).fold(on, |player, _| player.press("Space Space Enter Enter"));
    over.says("Grade: ");
    assert_eq!((over.attempt_count(), over.store().sessions().items.len()), (20, 1), "one exam");
    over.press("Esc F2 c").says("no unfinished exam or earlier session");
}

#[test]
fn an_exam_may_have_a_single_category() {
    let player = Player::at_library(TRUE_COLOUR, &[], &[]).press("Right Right e");
    player.says("An exam of level 1").says("6 exercises of grade 1 to 3 of the listed category, \"Draw\"");
    let mut player = player.press("Enter");
    let session = player.app.drills.turn.as_ref().unwrap().session.clone();
    assert!(session.exercises.iter().all(|exercise| exercise.category == Category::Draw), "{:?}", session.exercises);
    for n in 1..=6 {
        player.says(&format!("exercise {n} of 6"));
        player = player.press("Space Space Enter Enter");
    }
    player.says("of 6 made").says("Grade: ");
    let none = Player::at_library(TRUE_COLOUR, &[], &[]).press("Left e");
    none.warns("nobody has measured how difficult your own positions are, so there is no exam of them");
}

#[test]
fn missed_exercises_are_practised_from_the_result() {
    let exam = Player::at_library(TRUE_COLOUR, &[], &[]).press("Right Right e Enter");
    let over = (0..6).fold(exam, |player, _| player.press("Space Space Enter Enter"));
    let result = over.app.drills.exam_result.as_ref().unwrap();
    let missed = result.session.attempts.iter().position(|attempt| !attempt.made).unwrap();
    assert_eq!(result.mark, missed, "the first miss is marked");
    let titles: Vec<String> = result.session.exercises.iter().map(|exercise| exercise.title.clone()).collect();
    let practice = over.press("Enter");
    let session = |player: &Player| player.app.drills.turn.as_ref().unwrap().session.clone();
    assert_eq!((session(&practice).goal, &session(&practice).exercises[0].title), (Goal::Free, &titles[missed]));
    let par = session(&practice).exercises[0].par;
    assert_eq!(par, Library::bundled().get(&session(&practice).exercises[0].name).unwrap().par, "as in the library");
    practice.says("free repetition").says("no attempt yet");
    // Leaving it leads back to the result, where another exercise can be chosen.
    let back = practice.press("v Space Space Enter Esc");
    assert_eq!(back.app.key_context(), KeyContext::Drill(DrillContext::Result));
    back.says("Grade: ");
    let last = back.press("End Enter");
    assert_eq!(session(&last).exercises[0].title, titles[5]);
    let library = last.press("Esc Esc");
    assert_eq!(library.app.key_context(), LIBRARY);
    assert_eq!(library.store().sessions().items.len(), 2, "the exam and the repetition that was played");
}

#[test]
fn an_exam_is_discarded_after_a_question() {
    let exam = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter x");
    exam.says("discard the exam after 1 of 20 exercises?").says("its results stay in the record");
    let stays = exam.press("n");
    assert_eq!(stays.app.key_context(), EXERCISE);
    stays.says("exercise 2 of 20");
    let discarded = stays.press("x y");
    discarded.says("the exam is discarded");
    assert_eq!((discarded.app.key_context(), discarded.attempt_count()), (LIBRARY, 1));
    assert!(discarded.app.saved_session().is_none_or(|last| last.practice.is_none()));
    discarded.press("F2 c").says("no unfinished exam or earlier session");
    // One of an earlier session of the program is not offered again either.
    let left = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter");
    let resumed = Player::new().after(&left).press("c");
    resumed.says("exercise 2 of 20");
    let gone = resumed.press("Delete y F2");
    assert!(gone.app.saved_session().is_none_or(|last| last.into_sessions().iter().all(|one| one.practice.is_none())));
    gone.press("c").says("no unfinished exam or earlier session");
    let unplayed = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter x");
    assert_eq!(unplayed.app.key_context(), LIBRARY, "nothing was played: nothing is asked");
    Player::practising(TRUE_COLOUR).press("Delete").warns("no exam is under way");
}

#[test]
fn an_open_exam_is_resumed_from_the_coach() {
    for keys in ["F2 c", "Esc F2 c", "r F2 c"] {
        let on = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter").press(keys);
        assert_eq!(on.app.key_context(), EXERCISE, "{keys}");
        on.says("exercise 2 of 20");
    }
}

#[test]
fn a_left_exam_is_saved_for_the_next_start() {
    let left = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter Esc y F2 Right");
    let practice = left.app.saved_session().and_then(|last| last.practice.map(|session| session.attempts.len()));
    assert_eq!(practice, Some(1));
}

#[test]
fn several_left_exams_can_all_be_resumed() {
    let played = |player: Player, exercises: usize| {
        (0..exercises).fold(player.press("e Enter"), |player, _| player.press("Space Space Enter Enter"))
    };
    let attempts = |player: &Player| {
        let sessions = player.app.saved_session().unwrap().into_sessions();
        sessions.iter().filter_map(|one| one.practice.as_ref().map(|exam| exam.attempts.len())).collect::<Vec<_>>()
    };
    // On other pages, too, an exam is in progress.
    let open = played(Player::at_library(TRUE_COLOUR, &[], &[]), 1).press("F2 Right");
    assert_eq!(attempts(&open), [1]);
    let two = played(open.press("F3 Esc y"), 2).press("Esc y");
    let three = played(two, 3).press("Esc y F2");
    assert_eq!(attempts(&three), [3, 2, 1]);
    // The open exam waits until all others were resumed.
    let mut player = three;
    for exercise in [4, 3, 2, 4, 3] {
        player = player.press("F2 c");
        player.says(&format!("exercise {exercise} of 20"));
    }
}

#[test]
fn leaving_an_exam_without_attempts_asks_nothing() {
    let left = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Esc");
    assert_eq!(left.app.key_context(), LIBRARY);
    left.does_not_show("the exam is kept");
}

#[test]
fn an_exam_without_attempts_is_not_saved() {
    for keys in ["e", "e Enter"] {
        let seen = Player::at_library(TRUE_COLOUR, &[], &[]).press(keys);
        assert!(seen.app.saved_session().is_none_or(|last| last.practice.is_none()), "{keys}");
    }
}

#[test]
fn attempts_noted_by_another_program_are_not_overwritten() {
    let mut player = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter");
    let elsewhere = |player: &Player, notes: usize| {
        let mut exam = player.store().sessions().items.remove(0);
        let before = exam.attempts.clone();
        (0..notes).for_each(|_| exam.log(true).unwrap());
        player.store().save(&exam, &before, 0).unwrap();
    };
    for notes in [2, 1] {
        elsewhere(&player, notes);
        let kept = player.attempt_count();
        player = player.press("Space Space");
        player.warns("another program has changed this session");
        assert_eq!(player.attempt_count(), kept);
        player.says(&format!("exercise {} of 20", kept + 1));
    }
    let on = player.press("Space Space Enter Enter");
    assert_eq!(on.attempt_count(), 5);
    // A player who opens the drills again sees it before the next stroke.
    elsewhere(&on, 3);
    let seen = on.press("F2 F3");
    seen.says("another program has continued this session").says("exercise 9 of 20");
    elsewhere(&seen, 12);
    seen.press("Space Space").says("Grade: ");
    // Results from a real table, and undone ones.
    let mut noted = Player::practising(TRUE_COLOUR).press("m m");
    elsewhere(&noted, 2);
    for key in ["m", "u"] {
        noted = noted.press(key);
        assert_eq!(noted.attempt_count(), if key == "m" { 4 } else { 3 });
    }
    noted.says("undone: made, 3 of 3 now");
}

#[test]
fn earlier_sessions_stay_available_until_resumed() {
    let place = |player: &Player| *player.app.coach.layout();
    let first = Player::new().press("r");
    let left = place(&first);
    // A mistaken key at the next start, and at the one after it.
    let second = Player::new().after(&first).press("r");
    let third = Player::new().after(&second).press("o r");
    let (at_second, at_third) = (place(&second), place(&third));
    let fourth = Player::new().after(&third).press("c");
    assert_eq!(place(&fourth), at_third);
    fourth.says("c goes back to the one before");
    let back = fourth.press("c");
    assert_eq!(place(&back), at_second);
    let back = back.press("c");
    assert_eq!(place(&back), left);
    back.press("c").says("no unfinished exam or earlier session");
}

#[test]
fn an_exam_that_is_left_without_a_stroke_comes_after_everything_else() {
    let left = Player::new().press("r");
    let place = *left.app.coach.layout();
    let exam = Player::new().after(&left).press("F3 e Enter Space Space Enter Enter Esc y F2 c");
    exam.says("exercise 2 of 20");
    // With a stroke in it, it is what the player wants.
    let played =
        Player::new().after(&left).press("F3 e Enter Space Space Enter Enter Esc y F2 c Space Space Enter Enter Esc y");
    played.says("c on the coach's page (F2) goes on with it");
    played.press("F2 c").says("exercise 3 of 20");
    for leave in ["Esc y F2", "F2"] {
        let declined = Player::new().after(&left).press("F3 e Enter Space Space Enter Enter Esc y F2 c").press(leave);
        assert_ne!(*declined.app.coach.layout(), place);
        let back = declined.press("c");
        assert_eq!((back.app.key_context(), *back.app.coach.layout()), (KeyContext::Coach, place), "{leave}");
        back.press("c").says("exercise 2 of 20");
    }
    exam.press("Esc y").says("the exam is kept; c on the coach's page (F2) goes on with it after what else was left");
}

#[test]
fn exams_that_are_left_without_a_stroke_take_turns() {
    let exams = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter Esc y");
    let exams = exams.press("e Enter Space Space Enter Enter Space Space Enter Enter Esc y");
    let mut player = exams;
    for exercise in [3, 2, 3, 2] {
        player = player.press("F2 c");
        player.says(&format!("exercise {exercise} of 20"));
        player = player.press("Esc y");
    }
}

#[test]
fn a_declined_exam_does_not_hide_the_last_session_at_the_next_start() {
    let exam = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter Esc y F2 c");
    Player::new().after(&exam).press("c").says("exercise 2 of 20");
    let declined = exam.press("Esc y F2 r");
    let place = *declined.app.coach.layout();
    let next = Player::new().after(&declined);
    next.says("c goes on from where the last session ended");
    let back = next.press("c");
    assert_eq!((back.app.key_context(), *back.app.coach.layout()), (KeyContext::Coach, place));
    back.press("c").says("exercise 2 of 20");
}

#[test]
fn leaving_a_run_needs_confirmation_and_it_can_be_resumed() {
    let sessions = |player: &Player| player.store().sessions().items.len();
    let run = Player::practising(TRUE_COLOUR).press("o Space Space Enter Enter");
    for key in ["x", "o", "<", "p", "m"] {
        let asked = Player::practising(TRUE_COLOUR).press("o Space Space Enter Enter").press(key);
        asked.says("give up the run after 1 attempt? It stays in the record.");
        let stays = asked.press("n Space");
        assert_eq!((stays.attempt_count(), sessions(&stays)), (2, 1), "{key}");
    }
    // The score shows the same count as the question.
    let watched = Player::practising(TRUE_COLOUR).press("o Space Space").wait(0.1);
    watched.says("no attempt yet");
    watched.press("x").says("give up the run after 1 attempt?").says(" of 1 made").does_not_show("no attempt yet");
    let left = run.press("Esc");
    assert_eq!(left.app.key_context(), LIBRARY);
    left.says("the run is kept; Enter on the exercise goes on with it");
    assert_eq!(left.app.saved_session().and_then(|last| last.practice.map(|run| run.attempts.len())), Some(1));
    let on = left.press("Enter");
    on.says("run of 5: it goes on here after 1 played");
    let played = on.press("Space Space Enter Enter");
    assert_eq!((played.attempt_count(), sessions(&played)), (2, 1), "one run");
    let other = played.press("x y Space");
    assert_eq!((other.attempt_count(), sessions(&other)), (3, 2), "another one");
}
