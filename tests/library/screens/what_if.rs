//! What-if mode: the coach's shot is taken over as the player's own stroke, changed, played and left, at the coach and in an exercise.

use super::player::{ASCII, NO_COLOUR, OTHER_SHOTS, Player, SHOT, SIZES, TRUE_COLOUR, cue, worker_answers};
use carom::{
    statistics::SuccessRate,
    terminal::{Capabilities, CoachEvent, CoachWorker, KeyContext},
};

/// Returns a player at the coach who has taken over the coach's shot.
fn in_what_if_mode(caps: Capabilities) -> Player {
    Player::with(caps).press("Enter").answer().press("w")
}

/// Reports how often the last stroke that was asked about succeeds.
fn report_success_rate(mut player: Player, made: usize) -> Player {
    let job = player.success_rate_job.take().expect("it is asked how often the stroke is made");
    player.tell(job.id, CoachEvent::StrokeRated(SuccessRate::new(made, 1000)))
}

#[test]
fn the_coachs_shot_is_copied_changed_and_played() {
    let player = in_what_if_mode(TRUE_COLOUR);
    assert_eq!(player.app.key_context(), KeyContext::OwnStroke);
    player.shows(&["You … % · coach 94 %", "You: as the coach", "Esc leave"]);
    assert_eq!(player.success_rate_job.as_ref().unwrap().stroke.as_ref().unwrap().0, cue(SHOT));
    let player = report_success_rate(player, 880);
    player.shows(&["You 88 % · coach 94 %", "Point, if played exactly: "]);
    let player = player.press("S-Up l l S-Right");
    player.shows(&["You … % · coach 94 %", "No point, if played exactly: ", "You: "]);
    player.shows_at((120, 40), &["left", "harder by ", "lengths", "you", "coach"]);
    player.shows_at((80, 24), &["harder by ", " lengths "]);
    let player = report_success_rate(player, 20).press("Space");
    let played = player.app.coach.watched().unwrap().cue.speed;
    assert!(player.app.coach.playback.playing && played == 3.0, "the own stroke is played");
    let player = player.press("u u u");
    assert!(!player.app.coach.playback.playing, "a change goes back to the stroke");
    player.shows(&["You: as the coach"]);
    let player = player.press("U Esc");
    assert_eq!(player.app.key_context(), KeyContext::Coach);
    assert_eq!(player.shown_cue(), Some(cue(SHOT)));
    player.does_not_show("You 2").does_not_show("You: ");
    assert!(player.analysis_job.is_some(), "the closer look at the coach's shot goes on");
    let other = player.press("] w");
    assert_eq!(other.shown_cue(), Some(cue(OTHER_SHOTS[0])), "whichever is shown is taken over");
}

#[test]
fn without_advice_a_stroke_starts_full_at_a_ball() {
    let player = Player::with(TRUE_COLOUR).press("w");
    assert_eq!(player.app.key_context(), KeyContext::OwnStroke);
    player.shows(&["You … %", "if played exactly: ", "Red, full;"]).does_not_show("coach 9");
    let player = report_success_rate(player.press("Right"), 40);
    player.shows(&["You 4 %"]);
    let end = player.app.coach.shot().unwrap().recording.final_layout();
    let on = player.press("Space n");
    assert_eq!((on.app.key_context(), *on.app.coach.layout()), (KeyContext::OwnStroke, end));
    assert!(on.success_rate_job.is_some(), "the next stroke is there to be set");
    let back = on.press("Esc");
    assert!(back.app.key_context() == KeyContext::Coach && back.app.coach.shot().is_none());
    let before = back.app.coach.layout().balls[0].x;
    let back = back.press("h");
    assert!(back.app.coach.layout().balls[0].x < before, "balls are placed again");
    let placed = *back.app.coach.layout();
    let undone = back.press("w Up Up n n u");
    assert_ne!(*undone.app.coach.layout(), placed);
    let undone = undone.press("u");
    let speed = |player: &Player| player.app.coach.what_if().unwrap().shot.cue.speed;
    assert!((speed(&undone) - 2.7).abs() < 1e-9, "the stroke that was played is back");
    let undone = undone.press("u u");
    assert_eq!((undone.app.key_context(), *undone.app.coach.layout()), (KeyContext::OwnStroke, placed));
    undone.warns("the stroke is unchanged");
    let asked = undone.press("Esc Enter").answer();
    assert!(asked.app.coach.what_if().is_none() && asked.app.coach.shot().is_some());
    // A changed request is about another stroke.
    let player = Player::with(TRUE_COLOUR).press("w F5 Down F2");
    assert!(player.app.coach.what_if().is_some());
    let player = player.press("F5 Home Down Down Down Down Right F2");
    assert!(player.app.coach.what_if().is_none() && player.app.coach.shot().is_none(), "another rule");
}

#[test]
fn speeds_are_in_feet_with_lengths_in_feet() {
    let player = Player::with_settings(TRUE_COLOUR, "length_unit = \"feet\"\n").press("Enter").answer().press("w");
    for size in [(80, 24), (120, 40), (200, 60)] {
        player.shows_at(size, &["8.20 ft/s"]).hides_at(size, &["m/s"]);
    }
    player.press("Esc N").shows_at((120, 40), &["8.20 ft/s, the cue"]).does_not_show("m/s");
    // Speeds of two digits have their unit, too.
    let harder = Player::with_settings(TRUE_COLOUR, "length_unit = \"feet\"\n").press("Enter").answer();
    let harder = harder.press("w Up Up Up Up Up Up Up Up");
    harder.shows_at((80, 24), &["speed 1", " ft/s"]);
}

#[test]
fn the_stroke_is_shown_in_the_units_of_the_keys() {
    let player = in_what_if_mode(TRUE_COLOUR);
    for size in SIZES {
        player.shows_at(size, &["aim ", "351.20°", "2 tips", "2.50 m/s", "6.0° up"]).hides_at(size, &["ω0"]);
    }
    // The smallest steps of every key are visible.
    player.press("C-Right l Up +").shows_at((80, 24), &["351.19°", "1.8 tips", "2.60 m/s", "7.0° up"]);
    Player::new().press("Enter").answer().press("N w").shows_at((80, 24), &["ω0"]);
}

#[test]
fn both_paths_are_distinguishable_without_colours() {
    for caps in [NO_COLOUR, ASCII] {
        let player = in_what_if_mode(caps).press("S-Right");
        let text = player.text(80, 24);
        let table: Vec<&str> = text.lines().skip(2).take(15).collect();
        let (dashes, words) = (table.join("").matches('=').count(), ["you", "coach"]);
        assert!(dashes > 10, "the coach's way is of another sign\n{text}");
        assert!(words.iter().all(|word| table.iter().any(|row| row.contains(word))), "{text}");
        player.is_plain();
        let left = player.press("Esc").text(80, 24);
        let is_dashed = |row: &str| row.chars().take(64).any(|sign| sign == '=');
        assert!(!left.lines().skip(2).take(15).any(is_dashed), "{left}");
    }
}

#[test]
fn the_success_rate_of_a_stroke_comes_from_the_coach() {
    let mut player = in_what_if_mode(TRUE_COLOUR);
    let job = player.success_rate_job.take().unwrap();
    let answers = worker_answers(&mut CoachWorker::with_simulation_limit(1), &job);
    let [answer] = &answers[..] else { panic!("{answers:?}") };
    let CoachEvent::StrokeRated(made) = answer.event else { panic!("{answer:?}") };
    assert!(answer.id == job.id && (0.2..0.8).contains(&made.rate), "{made:?}");
    // The answer to a stroke that has changed since is dropped.
    let player = player.press("Up").tell(job.id, CoachEvent::StrokeRated(made));
    player.shows(&["You … % · coach 94 %"]);
    let perfect = Player::new().press("S S S S S Enter").answer().press("w");
    assert!(perfect.success_rate_job.is_none(), "no rate is needed without errors");
}

#[test]
fn copying_the_model_shot_marks_the_attempt_helped() {
    let player = Player::practising(TRUE_COLOUR).press("w");
    player.shows(&["You: as the model shot", "model shot", "Esc hide shot"]);
    assert!(player.text(120, 40).contains("You "), "the success rate is displayed");
    let player = player.press("S-Left Up");
    player.shows(&["You: ", "harder by "]);
    let back = player.press("z z");
    back.shows(&["You: as the model shot"]);
    let left = back.press("Esc");
    left.shows(&["From the opening"]).does_not_show("You: ");
    let ended = left.press("Space").wait(60.0);
    let attempt = &ended.store().sessions().items[0].attempts[0];
    assert!(attempt.helped, "{attempt:?}");
    let meant = attempt.intended.unwrap();
    assert!((meant.speed - cue(SHOT).speed).abs() < 1e-9, "the stroke stays set: {meant:?}");
}

#[test]
fn exams_have_no_shot_to_copy() {
    let player = Player::at_library(TRUE_COLOUR, &[], &[]).press("e Enter w");
    player.says("an exam gives no hints");
}

#[test]
fn a_perfect_player_makes_or_misses_without_a_rate() {
    let player = Player::with_settings(TRUE_COLOUR, "skill = \"perfect\"\n").press("Enter").answer().press("w");
    player.shows(&["You make it"]);
    player.press("S-Up l l S-Right").shows(&["You miss"]);
}

#[test]
fn a_stroke_in_words_changes_only_the_stated_values() {
    let player = in_what_if_mode(TRUE_COLOUR);
    let before = player.app.coach.watched().unwrap().cue;
    let player = player.press("t").type_in("2 lengths").press("Enter");
    let softer = player.app.coach.watched().unwrap().cue;
    assert!(softer.speed < before.speed && (softer.a, softer.b, softer.phi) == (before.a, before.b, before.phi));
    let player = player.press("t").type_in("yellow 1/2 left, 1.5 right, raised 10").press("Enter");
    let stated = player.app.coach.watched().unwrap().cue;
    assert!((stated.a + 0.15).abs() < 1e-9 && (stated.theta - 10_f64.to_radians()).abs() < 1e-9);
    player.shows(&["You: "]);
    let player = player.press("t").type_in("softly").press("Enter");
    player.warns("\"softly\" is not understood; accepted are");
    player.shows(&["softly", "Enter take it"]);
    let player = player.press("Esc u");
    assert_eq!(player.app.coach.watched().unwrap().cue, softer, "one undo restores all values of one text");
    let drill = Player::practising(TRUE_COLOUR).press("t").type_in("yellow 1/2 left, 2 up, soft").press("Enter");
    assert!((drill.app.drills.turn.as_ref().unwrap().stroke().b - 0.2).abs() < 1e-9);
    drill.shows(&["50 % full"]);
}
