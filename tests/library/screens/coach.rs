//! The player's view: keys go through the real app, and its pictures are compared at both sizes.

use std::{
    sync::{Arc, atomic::Ordering},
    time::Duration,
};

use super::{
    keys::key,
    player::{ASCII, NO_COLOUR, Player, SHOT, TRUE_COLOUR, advice, advice_of, check, check_at, cue, proposal},
};
use carom::{
    coach::{Difference, Kiss, Skill, Why},
    table::CueBall,
    terminal::{Advice, CoachEvent, Effect, Effort, PageId, Proposal, Shot},
};
use glam::DVec2;
use proptest::prelude::*;
use ratatui::{layout::Size, style::Color};

#[test]
fn skill_and_rule_are_explained_until_a_shot_is_shown() {
    let player = Player::new();
    let words =
        ["Shots for an expert at straight rail.", "S: how well you play; R: the rule.", "F3: drills; F9: a match."];
    player.shows_at((80, 24), &words);
    let player = player.press("R R S");
    // The explanation fits next to the longest names.
    player.shows_at((80, 24), &["S: how well you play; R: the rule.", "Shots for a world-class player"]);
    player.shows(&["three-cushion."]);
    player.press("Enter").answer().does_not_show("Shots for");
}

#[test]
fn the_start_screen() {
    check("start", &Player::new());
}

#[test]
fn balls_move_by_plain_coarse_and_fine_steps() {
    let player = Player::new().press("2 Right S-Right C-Up l L");
    player.shows(&["▸● yellow  -490.0    1.0", "● white   -710.0  182.5", "223.7 mm from white; step 10 mm"]);
    player.shows_at((80, 24), &["yellow at x -490.0 mm, y 1.0 mm"]);
}

#[test]
fn positions_gaps_and_steps_are_in_inches_with_feet() {
    let player = Player::with_settings(TRUE_COLOUR, "length_unit = \"feet\"\n");
    player.says("white at x -27.95 in, y 7.19 in, 4.76 in from yellow; step 0.39 in");
    player.shows(&["x in", "y in"]);
    let large = player.text(120, 40);
    assert!(large.contains("gap yellow 4.76, red 53.94 in") && !large.contains("mm"), "{large}");
    player.press("+").says("one step is 1.97 in");
}

#[test]
fn a_moved_ball_stops_in_contact_with_another() {
    let player = Player::new().press("S-Down S-Down");
    player.warns("white stops in contact with yellow");
    player.does_not_show("beyond");
    let text = player.text(80, 24);
    assert!(text.contains("y 61.5 mm"), "the white ball touches the yellow one\n{text}");
}

#[test]
fn a_moved_ball_stops_at_the_rail() {
    let player = Player::new().press("+ + S-Left");
    player.shows(&["x -1389.2 mm, y 182.5 mm"]);
    player.warns("white stops at the rail");
    player.does_not_show("beyond");
}

#[test]
fn without_a_shot_the_panel_shows_the_ball_positions() {
    let placing = Player::new().press("Enter").answer().press("v Esc Left");
    placing.shows_at((80, 24), &["Balls"]).hides_at((80, 24), &["Chances"]);
    placing.press("v").shows_at((80, 24), &["without a shot the panel shows"]);
}

#[test]
fn the_thinking_coach_can_be_stopped() {
    let player = Player::new().press("Enter").wait(0.35);
    player.shows(&["thinking ", "⠸ the coach is thinking; Esc stops it", "Esc cancel", "no shot yet"]);
    let player = player.press("Left");
    player.warns("the coach is thinking; Esc stops it");
    let late = player.advice_job.clone().unwrap();
    let mut player = player.press("Esc");
    assert!(late.cancel.load(Ordering::Relaxed));
    player.advice_job = Some(late);
    assert!(player.answer().app.coach.shot().is_none(), "a late answer is dropped");
}

#[test]
fn a_shot_is_recommended() {
    let player = Player::new().press("Enter").answer();
    check("recommended", &player);
    let large = ["expert makes it 94 % (92-95)", "Red, half full on the right; two tips of running", "aim left 2.82 "];
    player.shows_at((120, 40), &large);
    // At the smaller size: the sentence, the card next to the table, and the aim in the title or in a row.
    let small = ["Red, half full on the right; two tips of", "red 1/2", "on the right", "2 tips left", "3 tips above"];
    player.shows_at((80, 24), &small);
    let text = player.text(80, 24);
    assert!(["aim left 2.82 → right 1.59, at noses", "nose to nose"].iter().any(|aim| text.contains(aim)), "{text}");
    // The thesis' numbers are one key away.
    player.press("N").shows_at((120, 40), &["0.200 R, 6.2 mm left", "351.20° ", "V0", "ω0"]);
}

#[test]
fn long_cue_ball_courses_are_complete_at_80_columns() {
    let shots = ["-0.25,0.35,2,10.15,6", "-0.35,0.3,2,10.56,6", "0.35,-0.3,2,7.58,6"];
    for settings in ["", "place_unit = \"mm\"\ntip_unit = \"mm\"\n"] {
        for cue in shots {
            let player = Player::with_settings(TRUE_COLOUR, settings).press("p").type_in("4d,2d 4.4d,2d 7d,3d");
            let mut player = player.press("Enter Enter");
            let job = player.advice_job.take().unwrap();
            let shot = proposal(&job.table, &job.layout, cue, 490);
            let (words, units) = (shot.shot.words.clone(), player.app.coach.units);
            assert!(words.between.len() >= 5, "{cue}: {words:?}");
            let text = player.tell(job.id, CoachEvent::Advice(advice_of(vec![shot]))).text(80, 24);
            let rows: Vec<&str> = text.lines().map(|row| row.trim_matches(['"', ' '])).collect();
            let way = words.short_course(CueBall::White, units);
            let joined = rows.join(" ");
            assert!(joined.contains(way.trim_end_matches('.')), "{way}\n{text}");
            let how = if settings.is_empty() { "of running" } else { " mm of " };
            assert!(["Yellow, ", how, "very hard"].iter().all(|part| joined.contains(part)), "{text}");
        }
    }
}

#[test]
fn reasons_are_shown_and_the_likely_kiss_is_marked() {
    let second = Difference {
        drawback: None,
        next_probability: None,
        pattern: Some("one cushion, reverse"),
        has_same_pattern: false,
        first_ball: Some(2),
        fuller: -0.2,
        harder: 0.5,
        make_probability: Some(0.59),
        aim_deg: Some(0.65),
    };
    let mut why = Why::default();
    (why.make_probability, why.aim_deg, why.next_probability, why.second) =
        (Some(0.94), Some(0.72), Some(0.8), Some(second));
    why.kiss = Some(Kiss { share: 0.07, balls: [0, 2], place: DVec2::new(0.4, 0.3) });
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let mut player = Player::with(caps).press("Enter").answer();
        let job = player.analysis_job.take().unwrap();
        let player = player.tell(job.id, CoachEvent::Why(Box::new(why.clone())));
        let text = player.text(120, 40);
        // Its lines may break anywhere; the last words, which speak against the shot, are present. Degrees take more room without UTF-8.
        let second = if caps == ASCII { "Why: shot 2 (" } else { "Why: the next best is shot 2 (" };
        assert!(text.contains(second) && text.contains("7 %."), "{text}");
        player.shows(&["kiss with red 7 %"]);
        // If no panel has room for it, the status line displays what fits, instead of the chance that is displayed above.
        let text = player.text(80, 24);
        assert!(text.contains("Why: shot 2 (") && !text.contains("makes it"), "{text}");
        let mut player = player;
        for (keys, is_marked) in [("w", false), ("Esc", true), ("]", false), ("[", true), (".", false)] {
            player = player.press(keys);
            if is_marked {
                player.shows(&["kiss with red 7 %"]);
            } else {
                player.does_not_show("kiss with");
            }
        }
    }
}

#[test]
fn the_tip_length_is_shown_with_the_unit_tips() {
    let player = Player::new().press("Enter").answer();
    assert!(player.text(80, 24).contains(" 1 tip = 3 mm ") && player.text(120, 40).contains(" Tip = 3 mm "));
    player.press("N").does_not_show("ip = 3 mm");
    let mm = Player::with_settings(TRUE_COLOUR, "tip_unit = \"mm\"\n").press("Enter").answer();
    mm.does_not_show("ip = 3 mm");
}

#[test]
fn the_corners_show_the_origin_of_the_diamonds() {
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let player = Player::with(caps);
        let text = player.text(80, 24);
        let row = |number: usize| text.lines().nth(number).unwrap().chars().take(67).collect::<String>();
        assert!(row(1).contains('4') && row(17).contains('0') && row(17).contains('8'), "{text}");
        // A system displays its own numbers there.
        let text = player.press("y").text(80, 24);
        assert!(!text.lines().nth(1).unwrap().starts_with("\"4"), "{text}");
    }
}

#[test]
fn the_cushions_of_the_cue_ball_are_numbered_on_the_rails() {
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let player = Player::with(caps);
        let bottom = |player: &Player| player.text(80, 24).lines().nth(17).unwrap().to_owned();
        assert!(!bottom(&player).contains('1'));
        let player = player.press("Enter").answer();
        assert!(bottom(&player).contains('1'), "{}", player.text(80, 24));
    }
}

#[test]
fn contacts_or_all_events_are_listed_and_stepped_through() {
    let player = Player::new().press("Enter").answer().press(". . .");
    let shot = player.app.coach.shot().unwrap();
    let third = shot.recording.events().iter().filter(|event| event.kind.is_contact()).nth(2).unwrap().time;
    assert_eq!(player.app.coach.playback.time, third);
    player.shows(&["Contacts 3/"]);
    player.does_not_show("yellow rolls");
    player.press("E").shows(&["Events ", "/25"]);
}

#[test]
fn a_recommended_miss_is_labelled_as_best_attempt() {
    let mut player = Player::new().press("Enter");
    let job = player.advice_job.take().unwrap();
    let shot = Shot::new(&job.table, &job.layout, cue(SHOT), false, "policy").unwrap();
    let attempt = Proposal { shot: Arc::new(shot), made: None, risk: None, next: None, is_early: false };
    let effort = Some(Effort { simulations: 4321, elapsed: Duration::from_secs(2) });
    let player = player.tell(job.id, CoachEvent::Advice(Advice { effort, ..advice_of(vec![attempt]) }));
    assert!(player.text(120, 40).contains("Contacts 0/"));
    assert!(player.text(80, 24).contains("no point found in 4321 simulations; this is the best attempt"));
}

#[test]
fn a_refusal_of_the_coach_is_shown_verbatim() {
    let mut player = Player::new().press("Enter");
    let job = player.advice_job.take().unwrap();
    let player = player.tell(job.id, CoachEvent::Refused("the weights file is corrupt".to_owned()));
    player.warns("the weights file is corrupt");
}

#[test]
fn the_shot_plays() {
    check("playing", &Player::new().press("Enter").answer().press("+ Space").wait(0.5));
}

#[test]
fn stepping_stops_at_events() {
    let player = Player::new().press("Enter").answer().press("E . . Right Left .");
    player.shows(&["Events 4/25", "white - red", "next: white rolls in 0.3 s", "● white    653.2  -23.7  1.36 follow"]);
    let shot = player.app.coach.shot().unwrap();
    assert_eq!(player.app.coach.playback.time, shot.recording.events()[3].time);
}

#[test]
fn the_next_shot_starts_from_the_end_positions() {
    let player = Player::new().press("Enter").answer().press("E End");
    player.shows(&["Events 25/25", "red stops", "Point: red, ", "● white   -902.1 -266.6  0.00"]);
    let end = player.app.coach.shot().unwrap().recording.final_layout();
    let player = player.press("n");
    assert_eq!(*player.app.coach.layout(), end);
    assert!(player.app.coach.shot().is_none());
    assert_eq!(player.advice_job.as_ref().unwrap().layout, end, "the coach is asked for the next shot");
    let player = player.press("Esc u");
    assert!(player.app.coach.shot().is_some(), "undo brings the shot back as well");
}

#[test]
fn undo_and_redo_walk_through_all_changes() {
    let start = *Player::new().app.coach.layout();
    let moved = Player::new().press("Left 3 Up r");
    let end = *moved.app.coach.layout();
    let back = moved.press("u u u");
    assert_eq!(*back.app.coach.layout(), start);
    let refused = back.press("u");
    refused.warns("there is nothing to undo");
    assert_eq!(*refused.press("U U C-r").app.coach.layout(), end);
}

#[test]
fn an_unavailable_key_explains_why() {
    for (keys, reason) in [("Space", "there is no shot yet; Enter asks the coach"), ("U", "there is nothing to redo")] {
        Player::new().press(keys).warns(reason);
    }
    let watching = Player::new().press("Enter").answer().press("h");
    watching.warns("a shot is being watched; Esc goes back to the balls");
    // Esc gives no warning if there is nothing to leave.
    Player::new().press("Esc").warns_nothing();
}

#[test]
fn the_help_lists_every_key() {
    check("help", &Player::new().press("?"));
    let closed = Player::new().press("? Left Esc");
    assert_eq!(closed.picture(80, 24), Player::new().picture(80, 24));
}

#[test]
fn the_coach_screens_are_complete_without_colours() {
    for caps in [NO_COLOUR, ASCII] {
        let player = Player::with(caps).press("Enter").answer().press("E . .");
        if caps == NO_COLOUR {
            check("no_colour", &player);
        } else {
            check_at(&[(80, 24)], "ascii", &player);
        }
        player.is_plain().shows(&["Events 3/25", "W white", "Y yellow", "R red"]);
        let player = player.press("2");
        player.is_plain().shows(&["Y yellow  -710.0    0.0", "121.0 mm from white; step 10 mm", "Enter ask"]);
        let player = player.press("v v").finish_analysis();
        let map = ["Margins", "# point", "- one ball", "X the stro"];
        player.is_plain().shows_at((120, 40), &map);
        player.shows_at((120, 40), &["1.62 right  0.71 left", "speed   0.45 softer 0.28 harder"]);
        player.shows_at((80, 24), &["side  R1.62  L0.71", "# point - one ball"]);
        player.does_not_show("too few");
        let plan = player.press("v");
        plan.is_plain().shows(&["now  94 % red, ", "next 100 % very hard"]);
        // At 80 columns there is no room to explain the distances below them.
        plan.shows_at((80, 24), &["stop half within W 34, Y 34, R 57 cm"]);
        plan.shows_at((120, 40), &["stop white 34, yellow 34, red 57 cm"]);
        if caps == ASCII {
            check_at(&[(120, 40)], "ascii_plan", &plan);
        }
        // The end positions of the balls are small letters among the paths.
        let text = plan.text(120, 40);
        let ends = |letter: char| text.lines().take(30).any(|row| row.contains(letter));
        assert!(['w', 'r'].into_iter().all(ends), "{text}");
    }
    for caps in [NO_COLOUR, ASCII] {
        let mut player = Player::with(caps).press("Enter").answer().finish_analysis();
        for _ in 0..4 {
            player.is_plain();
            player = player.press("v");
        }
    }
}

#[test]
fn half_blocks_draw_the_same_table() {
    let player = Player::new().press("Enter").answer().press("g .");
    check_at(&[(120, 40)], "half_blocks", &player);
    player.shows(&["▀", "Contacts 1/"]);
    let sextants = '\u{1FB00}'..='\u{1FB3B}';
    assert!(!player.text(80, 24).chars().any(|character| sextants.contains(&character)));
}

#[test]
fn a_too_small_terminal_names_both_sizes() {
    let player = Player::new();
    check_at(&[(79, 24)], "too_small", &player);
    for (width, height) in [(80, 23), (20, 5), (1, 1), (0, 0)] {
        player.picture(width, height);
    }
    player.shows_at((40, 10), &["40×10", "80×24"]);
}

#[test]
fn keys_are_ignored_while_the_terminal_is_too_small() {
    let mut player = Player::new();
    player.app.resize(Size::new(60, 20));
    let before = *player.app.coach.layout();
    let mut player = player.press("Right Enter d F5 :");
    assert_eq!((*player.app.coach.layout(), player.app.screen), (before, PageId::Coach));
    assert!(player.advice_job.is_none());
    player.event(&key("q"));
    assert!(matches!(player.effects.pop(), Some(Effect::Quit)), "quitting still works");
    player.app.paste("2d,0.5d");
    player.app.resize(Size::new(80, 24));
    assert_eq!(*player.app.coach.layout(), before, "a paste is ignored, too");
    assert_ne!(*player.press("Right").app.coach.layout(), before);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn random_keys_keep_the_layout_valid(keys in prop::collection::vec(0..KEYS.len(), 1..60), width in 60_u16..200) {
        let mut player = Player::new();
        for key in keys {
            player = player.press(KEYS[key]).wait(0.2);
            if player.advice_job.is_some() && key % 3 > 0 {
                player = player.answer();
            }
            if let Some(job) = player.analysis_job.take_if(|_| key % 5 == 0) {
                player = player.tell(job.id, CoachEvent::Next(Some(advice(&job))));
            }
        }
        prop_assert!(player.app.coach.layout().validate(player.app.coach.table()).is_ok());
        player.picture(width, 40);
    }
}

/// Keys that a player may press at any time, except those that leave.
const KEYS: &[&str] = &[
    "Left", "S-Left", "C-Left", "Up", "S-Up", "Right", "S-Right", "Down", "S-Down", "h", "J", "+", "-", "Tab", "1",
    "2", "3", "Enter", "Enter", "Enter", "Esc", "Space", ",", ".", "0", "End", "n", "u", "U", "o", "r", "g", "?", "x",
    "R", "S", "P", "N", "E", "v", "[", "]", "F2", "F3", "F4", "F5", "F5", "F6", "Delete", "BackTab",
];

#[test]
fn the_balls_are_drawn_in_their_colours() {
    let picture = Player::new().picture(120, 40);
    // Bed of 108 by 27 cells from (6, 2): yellow at a quarter, white above it, red at three quarters, half way down.
    assert_eq!(picture[(33, 15)].fg, Color::Rgb(0xf6, 0xc3, 0x24));
    assert_eq!(picture[(33, 12)].fg, Color::Rgb(0xf7, 0xf3, 0xe8));
    assert_eq!(picture[(87, 15)].fg, Color::Rgb(0xd9, 0x36, 0x36));
    assert_eq!(picture[(60, 15)].bg, Color::Rgb(0x1b, 0x6d, 0x83));
}

#[test]
fn the_tip_is_drawn_as_the_shooter_sees_it() {
    // Positive a is left of the centre, as in the recommended shot.
    let picture = Player::new().press("Enter").answer().picture(120, 40);
    let blue = Color::Rgb(0x1f, 0x63, 0xc8);
    let columns: Vec<u16> =
        (72..84).filter(|&x| (30..40).any(|y| picture[(x, y)].fg == blue || picture[(x, y)].bg == blue)).collect();
    assert!(!columns.is_empty() && columns.iter().all(|&x| x <= 77), "{columns:?}");
}

#[test]
fn no_frames_are_scheduled_while_nothing_moves() {
    let player = Player::new();
    assert_eq!(player.app.frame_interval(), None);
    let player = player.press("Enter");
    assert!(player.app.frame_interval().is_some());
    let player = player.answer();
    assert_eq!(player.app.frame_interval(), None);
    let player = player.press("Space");
    assert!(player.app.frame_interval().is_some());
    assert_eq!(player.wait(1e3).app.frame_interval(), None, "playback ends at the end");
}

#[test]
fn overlays_pause_the_page_until_they_are_closed() {
    for over in ["?", "F6", ":"] {
        let player = Player::new().press("Enter").answer().press("Space").wait(0.1).press(over);
        let time = player.app.coach.playback.time;
        assert_eq!(player.app.frame_interval(), None, "{over}");
        let player = player.wait(1.0).press("Esc");
        assert!(player.app.coach.playback.time == time && player.app.coach.playback.playing, "{over}");
    }
}

#[test]
fn a_pending_analysis_restarts_when_the_page_is_reopened() {
    let mut player = Player::new().press("Enter").answer();
    let skill = player.app.coach.query.skill;
    player.app.coach.set_skill(Skill::CLUB);
    // Meanwhile, news from the coach arrives and ends the analysis of a shot that is not shown.
    let mut player = player.tell(0, CoachEvent::Refused(String::new()));
    player.app.coach.set_skill(skill);
    player.analysis_job = None;
    assert!(player.press("F5 F2").analysis_job.is_some());
}

#[test]
fn leaving_a_shot_stops_its_playback() {
    for leave in ["Esc", "Tab", "2"] {
        let player = Player::new().press("Enter").answer().press("Space").wait(0.5).press(leave);
        assert_eq!(player.app.frame_interval(), None, "{leave}");
        assert!(!player.app.coach.playback.playing);
    }
}
