//! The drill screens: keys go through the real app, files into a folder, and the pictures are compared.

use super::{
    player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, check_at, places},
    practice::{exercise, many_positions, session, three_sessions},
};
use carom::{
    coach::Skill,
    drills::{Goal, Venue, decode, store::Store},
    game::Rule,
    table::Layout,
    terminal::{Condition, DrillCondition, DrillContext, DrillReport, DrillTask, KeyContext},
};
use crossterm::event::{KeyCode, KeyEvent};
use proptest::prelude::*;

/// Compares the pictures of a static screen.
pub fn check(name: &str, player: &Player) {
    assert_eq!(player.app.frame_interval(), None, "nothing moves by itself");
    super::player::check(name, player);
}

/// Returns a player at the library who has 37 attempts at the opening.
pub fn played() -> Player {
    Player::at_library(TRUE_COLOUR, &[exercise("opening", "From the opening")], &three_sessions())
}

#[test]
fn the_library_lists_the_users_positions() {
    let none = Player::at_library(TRUE_COLOUR, &[], &[]).press("Left");
    none.shows(&["0: My positions", "You have saved no position yet.", "a adds a position"]);
    check("library_played", &played().press("Left"));
    let long = Player::at_library(TRUE_COLOUR, &many_positions(), &[]).press("Left End");
    long.shows(&["60: My positions", "▸ Position number 60 of a", "you: not tried yet", "#opening"]);
    assert!(!long.text(80, 24).contains("Position number 40 of"), "the list is scrolled");
    let plain = Player::at_library(ASCII, &many_positions(), &[]).press("Left End Up");
    plain.is_plain().shows(&["> Position number 59 of", "Position number 60 of"]);
}

#[test]
fn attempts_logged_as_totals_have_no_best_run() {
    let mut noted = session(1, "opening", Goal::Free, "xxx--");
    let positions = [exercise("opening", "From the opening")];
    Player::at_library(TRUE_COLOUR, &positions, &[noted.clone()]).press("Left").shows(&["3 of 5, 60 %, best run 3"]);
    noted.unordered = true;
    let player = Player::at_library(TRUE_COLOUR, &positions, &[noted]).press("Left");
    player.shows(&["3/5", "table: 3 of 5, 60 %"]).does_not_show("best run");
    player.press("r").shows(&["high run  -"]);
}

#[test]
fn every_bundled_exercise_is_listed_and_can_be_opened() {
    let player = Player::at_library(TRUE_COLOUR, &[], &[]);
    let library = player.app.drills.catalogue.library.clone();
    let mut player = player;
    for exercise in library.exercises() {
        player.says(&exercise.title.chars().take(20).collect::<String>());
        // The whole text is next to the list, also on the smallest screen.
        let beside: Vec<String> =
            player.text(80, 24).lines().skip(2).map(|row| row.chars().skip(47).collect()).collect();
        let beside = beside.join(" ").replace('"', " ").split_whitespace().collect::<Vec<_>>().join(" ");
        let ends = [&exercise.point, "world-class", "you: not tried yet"];
        assert!(ends.into_iter().all(|words| beside.contains(words)), "{}: {beside}", exercise.name);
        player = player.press("Enter");
        assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Exercise), "{}", exercise.name);
        player.says("set the stroke and play it");
        player = player.press("Esc Down");
    }
}

#[test]
fn the_search_filters_while_typing() {
    let player = Player::at_library(TRUE_COLOUR, &many_positions(), &[]).press("Left /").type_in("number 17");
    check("search", &player);
    let found = player.press("Enter");
    assert_eq!(found.app.key_context(), KeyContext::Drill(DrillContext::Library));
    found.says("Position number 17").does_not_show("Position number 18");
    let none = found.press("/").type_in("zzz");
    none.says("No exercise matches. 0 lists all.");
    let before = none.press("Esc");
    before.says("Position number 17").does_not_show("Position number 18");
    before.press("0").says("Position number 18");
}

#[test]
fn a_stroke_is_set_with_keys() {
    let player = Player::practising(TRUE_COLOUR);
    check("aiming", &player);
    player.says("red 100 % full");
    let set = player.press("S-Left Left Left Left C-Right h h k K Up S-Up +");
    set.shows(&["aim    right ", "left   0.3 tip", "up     1.1 tips", " lengths", "2.0° up"]);
    set.says("358.27°").says("3.10 m/s");
    let numbers = set.press("N");
    numbers.shows(&["aim    358.27°", "speed  3.10 m/s"]).does_not_show(" lengths");
    let set = numbers.press("N");
    assert!(set.text(80, 24).contains("1 tip = 3 mm") && set.text(120, 40).contains("Tip = 3 mm"));
    let in_mm = Player::with_settings(TRUE_COLOUR, "tip_unit = \"mm\"\n").press("F3 Enter h");
    in_mm.says("left   0.5 mm").does_not_show("= 3 mm");
    let full = set.press("Tab 0");
    full.says("352.68°").says("side   middle");
    let plain = Player::practising(NO_COLOUR).press("Left Left Left");
    plain.is_plain().shows(&["red 75 % full, left side, 137 cm", "no attempt yet"]);
    let plain = Player::practising(ASCII).press("S-Right S-Right");
    check_at(&[(80, 24)], "aiming_ascii", &plain);
    plain.is_plain();
    Player::practising(TRUE_COLOUR).shows_at(
        (200, 60),
        &["Your stroke", "Tip", "Hit", "Task", "red 100 % full", "The first shot of every match."],
    );
    let far = Player::practising(TRUE_COLOUR).press("H H H H H H H H H");
    far.says("further out the tip would slip off the ball");
}

#[test]
fn long_texts_are_paged() {
    let is_page = |player: &Player, title: &str, end: bool| {
        let text = player.text(80, 24);
        assert!(text.contains(title) && text.contains("cue at least") == end, "{text}");
    };
    let player = Player::practising(TRUE_COLOUR);
    // The text fills the space under the score while there is no score; the positions of the balls come last.
    let (task, large) = (player.text(80, 24), player.text(120, 40));
    assert!(task.contains("cushions do the rest.") && task.contains("PgDn 1/2") && task.contains('…'), "{task}");
    assert!(large.contains("balls: white ") && !large.contains("PgDn"), "{large}");
    player.press("PageDown").shows_at((80, 24), &["balls: white ", "PgDn 2/2"]);
    let player = Player::practising(TRUE_COLOUR).press("v");
    player.says("cue at least").says("Yours: ");
    is_page(&player, "Task: straight · PgDn 1/2", false);
    let player = player.press("PageDown");
    is_page(&player, "Task: straight · PgDn 2/2", true);
    is_page(&player.press("PageDown"), "Task: straight · PgDn 1/2", false);
}

#[test]
fn the_hint_shows_the_shot_and_marks_the_attempt_helped() {
    let player = Player::practising(TRUE_COLOUR).press("v");
    check("hint", &player);
    let hidden = Player::practising(TRUE_COLOUR).press("v Esc");
    hidden.shows(&["From the opening", "Esc back"]).does_not_show("hide shot");
    let player = player.press("Space Space").wait(60.0);
    assert!(player.store().sessions().items[0].attempts[0].helped);
    player.says("1 of your attempts with");
    let again = player.press("Enter Space").wait(60.0);
    let attempts = &again.store().sessions().items[0].attempts;
    assert_eq!((attempts.len(), attempts[1].helped), (2, false));
}

/// Aims as in the model shot.
fn aimed_as_the_model_shot(player: Player) -> Player {
    let turn = player.app.drills.turn.as_ref().unwrap();
    let degrees = turn.stroke().phi.to_degrees();
    let fine = ((degrees + 8.8) * 5.0).round() as usize;
    player
        .press(&"Right ".repeat(fine))
        .press("C-Left")
        .press(&"h ".repeat(12))
        .press(&"k ".repeat(18))
        .press("+ + + + + +")
}

#[test]
fn a_stroke_is_played_with_errors_and_compared() {
    let player = aimed_as_the_model_shot(Player::practising(TRUE_COLOUR)).press("Space");
    let attempt = player.store().sessions().items[0].attempts[0].clone();
    assert!(attempt.intended != attempt.played && attempt.chance.is_some() && attempt.advised.is_some());
    let half = player.wait(0.4);
    assert!(half.app.frame_interval().is_some());
    half.says("the shot is running").says("no attempt yet").does_not_show("Yours makes");
    let ended = half.wait(60.0);
    check("played", &ended);
    ended.says("Yours makes").says("your hand: ");
    ended.says(if attempt.made { "1 of 1 made" } else { "0 of 1 made" });
    let hinted = ended.press("v");
    hinted.shows(&["model shot makes ", "three tips above centre", "v hint"]);
    assert!(hinted.press("PageDown").text(80, 24).contains("your hand: "), "the comparison is on another page");
    let plain = Player::practising(NO_COLOUR).press("Right Space").wait(60.0);
    plain.is_plain().shows(&["your hand: ", "1 made", "Enter next"]);
}

#[test]
fn a_miss_is_explained_and_enter_skips_to_the_end() {
    let player = Player::practising(TRUE_COLOUR).press("S-Right S-Right S-Right S-Right Space");
    player.says("the shot is running");
    let ended = player.press("Enter");
    ended.says("No point: ");
    assert_eq!(ended.app.frame_interval(), None);
    let next = ended.press("Enter");
    next.says("set the stroke").says("0 of 1 made");
    assert_eq!(next.attempt_count(), 1);
}

#[test]
fn a_new_session_starts_only_after_the_result_is_seen() {
    for key in ["x", "o", "p", "m", "n"] {
        let watched = Player::practising(TRUE_COLOUR).press("S-Right S-Right S-Right S-Right Space").wait(0.1);
        let refused = watched.press(key);
        refused.says("the shot is running; Enter skips to its end").says("no attempt yet");
        let ended = refused.press("Enter");
        ended.says("No point: ").says("0 of 1 made");
        assert_eq!((ended.attempt_count(), ended.store().sessions().items.len()), (1, 1), "{key}");
        ended.press(key).does_not_show("No point: ");
    }
}

#[test]
fn results_from_a_real_table_are_noted_and_undone() {
    let player = Player::practising(TRUE_COLOUR).press("m m n m");
    player.says("Real table: free repetition").says("3 of 4 made").says("noted: made, 3 of 4 now");
    player.shows(&["3 of 4 made, 75 % (30-95)", "run 1, best 2, average 1.50", "noted: made, 3 of 4 now"]);
    let sessions = player.store().sessions().items;
    assert_eq!((sessions.len(), sessions[0].venue, sessions[0].attempts.len()), (1, Venue::Table, 4));
    assert!(sessions[0].attempts.iter().all(|attempt| attempt.advised.is_some() && attempt.played.is_none()));
    let back = player.press("u u");
    back.says("2 of 2 made").says("undone: missed, 2 of 2 now");
    assert_eq!(back.store().sessions().items[0].attempts.len(), 2);
    let none = back.press("u u u");
    none.says("no attempt yet").says("there is no note from a real table since");
    // Earlier, nothing could be undone after the exercise was left.
    let opened = none.press("m n Esc Enter");
    opened.says("free repetition: it goes on here after 2 played");
    let undone = opened.press("u");
    undone.says("undone: missed, 1 of 1 now");
    assert_eq!(undone.store().sessions().items[0].attempts.len(), 1);
    let none = undone.press("u");
    // A stroke that is played in the simulator counts separately.
    let played = none.press("m Space Space").wait(60.0);
    assert_eq!(played.store().sessions().items.len(), 2);
}

#[test]
fn a_reached_run_ends_and_the_next_note_starts_another() {
    let player = Player::practising(TRUE_COLOUR).press("o < < m n m m");
    player.says("run of 3").says("3 of 4 made");
    check("run", &player);
    let over = player.press("m");
    over.says("done: 4 of 5 made");
    let again = over.press("n");
    again.says("0 of 1 made");
    assert_eq!((again.attempt_count(), again.store().sessions().items.len()), (6, 2));
}

#[test]
fn games_continue_from_end_positions_and_repetitions_can_shift() {
    let at = |player: &Player| player.app.drills.turn.as_ref().unwrap().layout;
    let game = Player::practising(TRUE_COLOUR).press("o o Space Space Enter");
    let opening: Layout = exercise("opening", "").layout;
    let end = game.app.drills.turn.as_ref().unwrap().watched().unwrap().outcome.played.end;
    let next = game.press("Enter");
    assert!(at(&next) == end && end != opening);
    next.says("game, 10 innings");
    let shifted = Player::practising(TRUE_COLOUR).press("x Space Space Enter Enter");
    let moved = at(&shifted);
    for (from, to) in opening.balls.iter().zip(moved.balls) {
        assert!((from.distance(to) - 0.03075).abs() < 1e-9, "{from} {to}");
    }
    shifted.says("shifted");
    // A result that is logged in a shifted layout shifts the balls, too.
    let noted = shifted.press("m m");
    assert_ne!(at(&noted), moved);
    assert_ne!(at(&noted), opening);
}

#[test]
fn an_exam_has_twenty_exercises_and_a_grade() {
    let mut player = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter");
    for n in 1..=20 {
        player.says(&format!("exercise {n} of 20"));
        let hint = player.app.disabled_reason(Condition::Drill(DrillCondition::HasModelShot));
        assert_eq!(hint, Some("an exam gives no hints"));
        player = player.press("Space Space Enter Enter");
    }
    player.says("Grade: ").says("of 20 made").says("beginner");
    let text = player.text(80, 24);
    let ends = ["beginner  ", "club  ", "world-class  "].map(|name| {
        let row = text
            .lines()
            .find(|line| line.contains(name) && line.contains(" of 20"))
            .unwrap_or_else(|| panic!("{text}"));
        row.find(" of 20").map(|at| row[..at].chars().count())
    });
    assert!(ends.iter().all(|end| *end == ends[0]), "{ends:?}\n{text}");
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Result));
    assert_eq!(player.store().sessions().items[0].attempts.len(), 20);
    let left = player.press("Esc e Enter Space Space Enter Enter Esc");
    left.says("leave the exam after 1 of 20 exercises?");
    let stays = left.press("n c");
    assert_eq!(stays.app.key_context(), KeyContext::Drill(DrillContext::Exercise), "the coach would give the answer");
    stays.says("an exam is under way");
    assert_eq!(stays.press("Esc y").app.key_context(), KeyContext::Drill(DrillContext::Library));
}

#[test]
fn drills_keep_the_coachs_player_unless_another_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    Store::new(&places(folder.path())).save_skill(Skill::level(4.35)).unwrap();
    let player = Player::in_folder(TRUE_COLOUR, folder).press("d");
    let own = player.store().own_skill().unwrap().unwrap().skill;
    player.says("player: me by my notes");
    let back = player.press("Esc");
    assert_eq!(back.app.coach.query.skill, Skill::EXPERT);
    let again = back.press("d");
    again.says("player: me by my notes");
    let cycled = again.press("Esc S S S S S");
    assert_eq!(cycled.app.coach.query.skill, own);
    let perfect = cycled.press("S d");
    perfect.says("player: perfect");
    let chosen = perfect.press("p Esc");
    assert_eq!(chosen.app.coach.query.skill, Skill::EXPERT);
}

#[test]
fn a_coach_position_is_saved_shared_added_and_removed() {
    let player = Player::new().press("Right s");
    let saved = player.type_in("My corner #draw #hard").press("Enter d Left");
    saved.says("My corner").says("#draw #hard");
    let kept = saved.store().positions().items.remove(0);
    assert_eq!((kept.title.as_str(), kept.rule, kept.tags.len()), ("My corner", Rule::StraightRail, 2));
    let shared = saved.press("y");
    let code = shared.copied[0].clone();
    assert_eq!(decode(&code).unwrap().layout, kept.layout);
    check("share", &shared);
    let asked = shared.press("x");
    asked.says("remove your position my-corner? Its results stay.");
    let gone = asked.press("y");
    assert!(gone.store().positions().items.is_empty());
    let mut adding = gone.press("a");
    adding.app.paste(&format!("  {}\n{}", &code[..20], &code[20..]));
    adding.shows(&["paste or type the code of a position:", "Enter take it"]);
    assert!(adding.text(120, 40).replace(char::is_whitespace, "").contains(&code[20..40]), "the two parts are one");
    let added = adding.press("Enter");
    added.says("saved as my-corner");
    assert_eq!(added.store().positions().items[0].layout, kept.layout);
    // Once more: a position of that name already exists.
    let mut again = added.press("a");
    again.app.paste(&code);
    let again = again.press("Enter");
    again.says("there is a position called my-corner already; replace it?");
    again.press("n").says("My corner");
}

#[test]
fn a_truncated_code_is_refused_and_remains_editable() {
    let mut player = Player::at_library(TRUE_COLOUR, &[], &[]).press("Left a");
    let code = carom::drills::encode(&exercise("opening", "From the opening")).unwrap();
    player.app.paste(&code[..code.len() - 3]);
    let refused = player.press("Enter");
    refused.shows(&["paste or type the code of a position:", "to its end", "Enter take it"]);
    assert_eq!(refused.app.key_context(), KeyContext::Question { is_typed: true });
    let mended = refused.type_in(&code[code.len() - 3..]).press("Enter");
    mended.says("saved as opening");
}

#[test]
fn write_errors_are_reported_and_nothing_is_lost() {
    let player = Player::practising(TRUE_COLOUR).press("m");
    // The folder of sessions is a file: nothing can be written there.
    std::fs::remove_dir_all(player.path("sessions")).unwrap();
    std::fs::write(player.path("sessions"), "in the way").unwrap();
    let refused = player.press("m");
    check_unsaved(&refused, "the note counts here, but it is not saved");
    refused.says("2 of 2 made");
    // Once the folder is writable, everything is written.
    std::fs::remove_file(refused.path("sessions")).unwrap();
    let saved = refused.press("n");
    assert_eq!(saved.store().sessions().items[0].attempts.len(), 3);
    std::fs::remove_dir_all(saved.path("sessions")).unwrap();
    std::fs::write(saved.path("sessions"), "in the way").unwrap();
    check_unsaved(&saved.press("Space Space"), "the attempt counts here, but it is not saved");
}

fn check_unsaved(player: &Player, sentence: &str) {
    player.says(sentence);
    assert_eq!(std::fs::read(player.path("sessions")).unwrap(), b"in the way");
}

#[test]
fn unreadable_files_are_named_and_unchanged() {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("sessions/20260101-000000-00000001.json", r#"{"format":"carom-session","version":9}"#);
    write("positions/broken.json", "{\"half");
    let player = Player::in_folder(TRUE_COLOUR, folder).press("d");
    player.warns("version 9");
    player.shows(&["some saved data cannot be read: F6 lists it"]);
    let all = player.press("F6");
    all.shows_at((200, 40), &["version 9", "broken.json"]);
    let player = all;
    assert_eq!(std::fs::read(player.path("positions/broken.json")).unwrap(), b"{\"half");
}

#[test]
fn an_exercise_can_be_opened_at_the_coach() {
    let player = Player::practising(TRUE_COLOUR).press("x Space Space Enter Enter");
    let layout = player.app.drills.turn.as_ref().unwrap().layout;
    let coach = player.press("c");
    assert_eq!((coach.app.key_context(), *coach.app.coach.layout()), (KeyContext::Coach, layout));
    // The exercise is still open.
    assert_eq!(coach.press("d").app.key_context(), KeyContext::Drill(DrillContext::Exercise));
    let from_list = Player::at_library(TRUE_COLOUR, &[exercise("opening", "x")], &[]).press("Left c");
    assert_eq!(*from_list.app.coach.layout(), exercise("opening", "x").layout);
    assert_eq!(Player::practising(TRUE_COLOUR).press("p").app.drills.player.skill, Skill::WORLD_CLASS);
}

#[test]
fn the_help_lists_every_key() {
    for (name, keys) in [("help_library", ""), ("help_exercise", "Left Enter"), ("help_record", "r")] {
        let player = Player::at_library(TRUE_COLOUR, &[exercise("opening", "From the opening")], &[]).press(keys);
        check_at(&[(100, 60)], name, &player.press("?"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn random_keys_keep_the_sessions_readable(keys in prop::collection::vec(0..54_usize, 1..60)) {
        let mut player = Player::at_library(TRUE_COLOUR, &[exercise("opening", "From the opening")], &three_sessions()).press("Left");
        for key in keys {
            let code = match key {
                0..=25 => KeyCode::Char(char::from(b'a' + key as u8)),
                26 => KeyCode::Enter,
                27 => KeyCode::Esc,
                28 => KeyCode::Left,
                29 => KeyCode::Up,
                30 => KeyCode::Down,
                31 => KeyCode::Tab,
                32 => KeyCode::Backspace,
                33 => KeyCode::End,
                48..=53 => KeyCode::F(key as u8 - 46),
                34..=38 => KeyCode::Char(' '),
                _ => KeyCode::Char("<>,.+-/0123vmnux"[key - 34..].chars().next().unwrap()),
            };
            // Keys that end the program or leave for training are excluded.
            if !matches!(code, KeyCode::Char('q' | 't')) {
                player.event(&KeyEvent::from(code));
                player = player.wait(0.7);
                player.text(80, 24);
            }
        }
        let sessions = player.store().sessions();
        prop_assert!(sessions.notes.is_empty(), "{:?}", sessions.notes);
    }
}

#[test]
fn an_undo_before_the_save_completes_is_kept() {
    let mut player = Player::practising(TRUE_COLOUR);
    let noted = |player: &mut Player, name: &str| {
        let saved = player.requested_tasks(name).into_iter().find_map(|task| match task {
            DrillTask::Save(session, _) => Some(session),
            _ => None,
        });
        saved.expect("a session is saved")
    };
    for session in ["m", "u", "n"].map(|name| noted(&mut player, name)) {
        player.app.receive_drill(DrillReport::Saved(session, Ok(())));
    }
    let notes: Vec<bool> = noted(&mut player, "m").attempts.iter().map(|attempt| attempt.made).collect();
    assert_eq!(notes, [false, true]);
}

#[test]
fn a_late_failure_does_not_affect_another_exercise() {
    let mut player = Player::practising(TRUE_COLOUR).press("Right");
    let session = |player: &Player| player.app.drills.turn.as_ref().unwrap().session.id.clone();
    let first = session(&player);
    drop(player.requested_tasks("Space"));
    let mut player = player.press("Esc Enter Right");
    let second = session(&player);
    let tasks = player.requested_tasks("Space");
    player.app.receive_drill(DrillReport::Played(first, Err("the first has failed".to_owned()), Ok(())));
    player.run(tasks);
    player.says("the shot is running");
    let mut player = player.press("Enter Enter");
    drop(player.requested_tasks("Space"));
    player.app.receive_drill(DrillReport::Played(second, Err("the second has failed".to_owned()), Ok(())));
    player.warns("the second has failed");
    player.says("set the stroke");
}

#[test]
fn advice_requests_have_unique_ids_and_the_current_skill() {
    let mut player = Player::practising(TRUE_COLOUR);
    let position = |tasks: Vec<DrillTask>| {
        let asked = tasks.into_iter().find_map(|task| match task {
            DrillTask::Advise(position) => Some((position.id, position.shooter.skill)),
            _ => None,
        });
        asked.expect("the coach is asked")
    };
    let other = position(player.app.receive_drill(DrillReport::SkillSaved(Skill::BEGINNER, Ok(()))));
    assert_eq!(other.1, Skill::BEGINNER);
    let mut player = player.press("Esc");
    let again = position(player.requested_tasks("Enter"));
    assert_eq!(again.1, Skill::BEGINNER);
    assert_ne!(again.0, other.0);
}
