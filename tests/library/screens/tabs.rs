//! Switching between screens: the same keys lead everywhere, from anywhere, and nothing is lost.

use super::player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, check_text, drawn};
use carom::{
    drills::Goal,
    terminal::{App, Capabilities, DrillContext, Effect, KeyContext, PageId, TrainingContext},
};
use ratatui::style::Modifier;

fn first_row(text: &str) -> String {
    text.lines().next().unwrap().trim_matches('"').to_owned()
}

#[test]
fn the_header_of_every_screen() {
    let mut rows = Vec::new();
    for (width, height) in [(80, 24), (100, 30), (120, 40), (200, 60)] {
        let coach = Player::new().press("S S").press("Enter");
        rows.push(first_row(&coach.text(width, height)));
        rows.push(first_row(&coach.answer().press("R R R Esc +").text(width, height)));
        rows.push(first_row(&Player::new().press("Enter").answer().press("+ Space").wait(1.0).text(width, height)));
        rows.push(first_row(&Player::new().press("R R S S S F5 F2").text(width, height)));
        rows.push(first_row(&Player::at_library(TRUE_COLOUR, &[], &[]).text(width, height)));
        rows.push(first_row(&Player::practising(TRUE_COLOUR).text(width, height)));
        rows.push(first_row(&Player::watching(TRUE_COLOUR).text(width, height)));
    }
    rows.push(first_row(&Player::with(NO_COLOUR).press("Enter").answer().text(80, 24)));
    rows.push(first_row(&Player::with(ASCII).press("Enter").answer().text(80, 24)));
    check_text("tabs", &rows.join("\n"));
}

#[test]
fn the_open_tab_is_visible_without_colours() {
    for caps in [TRUE_COLOUR, NO_COLOUR] {
        for (keys, screen) in
            [("F2", "Coach"), ("F3", "Drills"), ("F4", "Training"), ("F5", "Settings"), ("F7", "Calibration")]
        {
            for width in [80, 100] {
                let picture = Player::with(caps).press(keys).picture(width, 30);
                let reversed = |x: &u16| picture[(*x, 0)].modifier.contains(Modifier::REVERSED);
                let open: Vec<u16> = (0..width).filter(reversed).collect();
                let words: String = open.iter().map(|x| picture[(*x, 0)].symbol()).collect();
                assert_eq!(words.trim(), screen);
                let after = picture[(open[open.len() - 1] + 1, 0)].symbol();
                assert_eq!(after, " ", "the next tab does not touch {screen}");
            }
        }
    }
}

#[test]
fn the_coach_continues_thinking_on_other_screens() {
    let player = Player::new().press("Enter F4").wait(0.5);
    assert_eq!(player.app.frame_interval(), None, "nobody looks at the spinner");
    let player = player.answer().press("F2");
    assert!(player.app.coach.shot().is_some_and(|shot| shot.solved));
    assert!(player.text(80, 24).contains("expert makes it 94 %"));
    let playing = player.press("Space").wait(0.5).press("F3");
    let time = playing.app.coach.playback.time;
    let back = playing.wait(1.0).press("F2");
    assert!(back.app.coach.playback.time == time && !back.app.coach.playback.playing, "nothing plays unseen");
}

#[test]
fn a_shot_pauses_only_when_the_screen_changes() {
    let left = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter Esc y F2");
    let playing = left.press("Enter").answer().press("Space").wait(0.5);
    let resumed = playing.press("c");
    assert_eq!(resumed.app.key_context(), KeyContext::Drill(DrillContext::Exercise));
    assert!(!resumed.app.coach.playback.playing, "nothing plays unseen");
    let playing = Player::new().press("Enter").answer().press("Space").wait(0.5).press("F2");
    assert!(playing.app.coach.playback.playing);
    let closed = playing.press("? F2");
    assert!(closed.app.coach.playback.playing && closed.app.overlay.is_none());
}

#[test]
fn exercises_exams_and_typed_text_survive_switching_screens() {
    let player = Player::practising(TRUE_COLOUR).press("S-Left k Space").wait(0.3);
    let time = |player: &Player| player.app.drills.turn.as_ref().unwrap().watched().unwrap().playback.time;
    let before = time(&player);
    let player = player.press("F2 F5 F3");
    assert_eq!((player.app.key_context(), time(&player)), (KeyContext::Drill(DrillContext::Exercise), before));
    player.wait(60.0).says("your hand: ");
    let exam = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter F2 s");
    exam.says("save the balls as");
    let exam = exam.type_in("mine").press("Enter");
    exam.says("saved as mine");
    exam.press("F3").says("exercise 2 of 20");
    let typing = Player::at_library(TRUE_COLOUR, &[], &[]).press("a").type_in("carom:half");
    let typing = typing.press("F5 F3");
    typing.says("carom:half");
    let form = Player::at_runs(TRUE_COLOUR).press("n Down Down Down 7 F2 t");
    assert_eq!(form.app.key_context(), KeyContext::Training(TrainingContext::Form));
    form.says("--steps 7 --seed 1");
}

#[test]
fn a_match_against_the_coach_starts_or_resumes_from_anywhere() {
    let chosen = Player::new().press("F9");
    assert_eq!(chosen.app.key_context(), KeyContext::Drill(DrillContext::Match));
    let player = chosen.press("Enter");
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Exercise));
    let session = |player: &Player| player.app.drills.turn.as_ref().unwrap().session.clone();
    let begun = session(&player);
    assert!(matches!(begun.goal, Goal::Match { against_coach: true, .. }), "{begun:?}");
    let again = player.press("F5 F9");
    assert_eq!(session(&again).id, begun.id);
    Player::new().press(": a g a i n s t Enter").does_not_show(" Commands ");
    let left = again.press("Left Enter Enter");
    let gone_on = session(&Player::new().after(&left).press("F9"));
    assert_eq!((gone_on.id, gone_on.attempts.len()), (begun.id, 1), "at the next start too");
    let exam = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter Space Space Enter Enter F2 F9");
    exam.warns("an exam is under way; leave it before a match");
}

#[test]
fn the_glossary_opens_everywhere() {
    for keys in ["F8", ": g l o s s Enter", "p F8", "F5 F8"] {
        Player::new().press(keys).shows(&["Tip: how far the tip of the cue is"]);
    }
    let closed = Player::new().press("F8 End F8");
    assert_eq!(closed.app.overlay, None);
    Player::with(ASCII).press("F8").is_plain();
}

#[test]
fn switching_screens_closes_palette_and_help() {
    for keys in [": x F3", "? F3", "F6 F3", "F8 F3"] {
        let player = Player::new().press(keys);
        assert_eq!((player.app.screen, player.app.overlay), (PageId::Drills, None), "{keys}");
        assert!(player.app.command_palette.is_none());
    }
}

#[test]
fn help_and_messages_open_over_text_fields() {
    let typing = Player::at_library(TRUE_COLOUR, &[], &[]).press("a x F1");
    typing.says("The library");
    let back = typing.press("Esc y F6");
    back.says("Messages, the newest first");
    back.press("Esc").says("the code of a position: xy");
}

#[test]
fn carom_watch_has_no_tabs() {
    let caps: Capabilities = TRUE_COLOUR;
    let mut app = App::watching(caps, None, None).unwrap();
    let effect: Option<Effect> = app.handle(&super::keys::key("F2"));
    assert!(effect.is_none() && app.screen == PageId::Training);
    assert!(app.toasts.shown[0].text.contains("no other screens here"));
    let row = first_row(&drawn(&app, 80, 24).backend().to_string());
    assert!(row.starts_with(" carom  training runs") && !row.contains("Drills"), "{row}");
}

#[test]
fn changing_the_player_keeps_the_result_being_watched() {
    let watched = Player::practising(TRUE_COLOUR).press("S-Right S-Right S-Right S-Right Space").wait(0.1);
    let first = watched.app.drills.turn.as_ref().unwrap().session.skill;
    let back = watched.press("F2 S").press("F3");
    let chosen = back.app.coach.query.skill;
    assert_ne!(chosen, first);
    back.says("the shot is running").says("no attempt yet");
    let ended = back.press("Enter");
    ended.says("No point: ").says("0 of 1 made");
    let next = ended.press("Enter");
    next.says("set the stroke").says("no attempt yet");
    assert_eq!(next.app.drills.turn.as_ref().unwrap().session.skill, chosen);
    // If the result was already seen, the other player starts at once.
    let seen = next.press("Space Enter F2 S F3");
    seen.says("set the stroke").says("no attempt yet");
    assert_eq!(seen.app.drills.turn.as_ref().unwrap().session.skill, seen.app.coach.query.skill);
}
