//! Filmed shots: keys go through the real app, strokes are fitted, and the pictures are compared.

use super::player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, check};
use carom::terminal::{Capabilities, Depth, DrillContext, DrillReport, DrillTask, Glyphs, KeyContext};

const HALF_BLOCKS: Capabilities = Capabilities { depth: Depth::Ansi, glyphs: Glyphs::Half, unicode: true };

fn list(caps: Capabilities) -> Player {
    Player::at_library(caps, &[], &[]).press("f")
}

/// Returns a player who watches the second shot of the film, which makes the point.
fn watching(caps: Capabilities) -> Player {
    list(caps).press("Down Enter")
}

/// Returns the status line from that word on.
fn status(player: &Player, word: &str) -> String {
    let text = player.text(120, 40);
    let line = text.lines().rev().find(|line| line.contains(word)).unwrap_or_else(|| panic!("{word}: {text}"));
    line[line.find(word).unwrap()..].to_owned()
}

/// Returns the distance of white from the film, cm.
fn white_distance_cm(player: &Player) -> f64 {
    let line = status(player, "white ");
    line.split_whitespace().find_map(|word| word.parse().ok()).unwrap_or_else(|| panic!("{line}"))
}

#[test]
fn the_list_of_filmed_shots() {
    let player = list(TRUE_COLOUR);
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Films));
    check("film_list", &player);
    let end = list(ASCII).press("End");
    end.is_plain().shows(&["> shot 180  point    3.2    13.8", "Shot 180, point", "91 shots of a match, 21 points"]);
    player.says("91 shots of a match, 21 points");
    player.press("?").says("fitted to the cue ball");
}

#[test]
fn a_filmed_shot_and_its_simulation_move_together() {
    let player = watching(TRUE_COLOUR);
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Film));
    assert!(player.app.frame_interval().is_some(), "it plays at once");
    let early = player.wait(1.5);
    early.says("within the fitted 2 s");
    assert!(white_distance_cm(&early) < 2.0, "{} cm on the part that was fitted", white_distance_cm(&early));
    let late = early.wait(4.0);
    late.says("predicted from the first 2 s");
    let paused = late.press("Space");
    assert_eq!(paused.app.frame_interval(), None);
    check("film_watching", &paused);
    let end = paused.press("Space").wait(60.0);
    end.says("at rest, white ").says("simulated no point, filmed a point");
    assert_eq!(end.app.frame_interval(), None, "it rests at its end");
}

#[test]
fn the_film_is_drawn_without_colours_and_with_half_blocks() {
    for (name, caps) in [("no_colour", NO_COLOUR), ("ascii", ASCII), ("half_blocks", HALF_BLOCKS)] {
        let player = watching(caps).wait(5.5).press("Space");
        player.shows(&["white 6.0 cm, yellow 0.0 cm, red", "Events 11/19", "predicted from the first 2 s"]);
        match name {
            "half_blocks" => assert!(player.text(80, 24).contains('▀')),
            _ => drop(player.is_plain()),
        }
    }
    // The other player's ball hides its outline until something has met it.
    watching(NO_COLOUR).wait(5.5).shows_at((80, 24), &["letters the film's"]);
}

#[test]
fn shots_are_stepped_through_and_a_late_fit_is_dropped() {
    let player = watching(TRUE_COLOUR).wait(1.0).press("]");
    player.says("filmed shot 4").does_not_show("filmed shot 2 ");
    let player = player.press("[ [ [");
    player.says("filmed shot 0").says("this is the first filmed shot");
    list(TRUE_COLOUR).press("End Enter ]").says("filmed shot 180").says("this is the last filmed shot");
    let mut player = player.press("Esc");
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Films));
    // Two requests are made before the first one is answered.
    let first = player.requested_tasks("Enter");
    player.says("the stroke is being fitted").says("filmed shot 0");
    player = player.press("Space");
    player.says("there is no filmed shot on the table yet");
    let second = player.requested_tasks("]");
    assert!(matches!((&first[..], &second[..]), ([DrillTask::Film(_)], [DrillTask::Film(_)])));
    player.run(first);
    player.says("the stroke is being fitted").says("filmed shot 2");
    player.run(second);
    player.says("white is ");
}

#[test]
fn a_failed_fit_is_shown_until_the_next_request() {
    let mut player = list(TRUE_COLOUR);
    let tasks = player.requested_tasks("Enter");
    let [DrillTask::Film(filmed)] = &tasks[..] else { panic!("{tasks:?}") };
    player.app.receive_drill(DrillReport::Filmed(filmed.number, Err("the balls overlap".to_owned())));
    player.warns("the balls overlap");
    let failed = player.wait(60.0);
    failed.warns_nothing();
    failed.says("the balls overlap").does_not_show("is being fitted");
    failed.press("] [").says("white is ").does_not_show("the balls overlap");
}

#[test]
fn film_playback_has_event_steps_and_esc_leads_back() {
    let player = watching(TRUE_COLOUR).press(". .");
    assert_eq!(player.app.frame_interval(), None, "stepping pauses");
    player.says("Events 2/");
    let player = player.press("+ Space").wait(0.1).press("Esc");
    assert_eq!(player.app.frame_interval(), None, "nobody watches");
    let player = player.press("Esc");
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Library));
    let player = player.press("F2 f");
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Films), "from the coach's table as well");
    let player = player.press("Enter F2 f");
    // The page is not opened on top of itself.
    assert_eq!(player.app.key_context(), KeyContext::Drill(DrillContext::Films));
    player.press("Esc").says("choose an exercise");
}

#[test]
fn the_balls_of_a_filmed_shot_are_put_on_the_coachs_table() {
    let filmed = &carom::study::filmed::bundled()[1];
    let is_sent = |player: Player| {
        let sent = player.press("c");
        sent.shows(&["three-cushion", "placing balls"]);
        assert_eq!(*sent.app.coach.layout(), filmed.layout(&carom::table::Table::default()));
    };
    is_sent(list(TRUE_COLOUR).press("Down"));
    is_sent(watching(TRUE_COLOUR));
}
