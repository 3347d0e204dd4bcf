//! Diamond systems on the coach's table.

use carom::{drills::Library, terminal::CoachEvent};

use super::player::{ASCII, Player, advice_of, proposal};
use ratatui::style::Color;

/// Returns a player whose coach has answered with this shot.
fn advised(player: Player, balls: &str, words: &str) -> Player {
    let mut player = player.press("p");
    player.app.paste(balls);
    let mut player = player.press("Enter R R Enter");
    let job = player.advice_job.take().expect("the coach was asked");
    let best = proposal(&job.table, &job.layout, words, 900);
    player.tell(job.id, CoachEvent::Advice(advice_of(vec![best]))).finish_analysis()
}

/// The same with the shot and the balls of a bundled exercise.
fn with_model_shot(player: Player, name: &str) -> Player {
    let library = Library::bundled();
    let exercise = library.get(name).unwrap();
    let [white, yellow, red] = exercise.layout.balls;
    let balls = format!("{},{} {},{} {},{}", white.x, white.y, yellow.x, yellow.y, red.x, red.y);
    let cue = exercise.shot.unwrap();
    let words = format!("{},{},{},{},{}", cue.a, cue.b, cue.theta.to_degrees(), cue.phi.to_degrees(), cue.speed);
    advised(player, &balls, &words)
}

#[test]
fn systems_are_cycled_with_their_numbers_at_the_rails() {
    let player = Player::new().press("y");
    player.shows(&["Corner-5", "50 - 30 = 20: aim at 20", "on this table"]);
    player.shows(&["20", "30", "40", "50", "60", "10"]);
    let player = player.press("y");
    player.shows(&["Plus", "7 - 4 = 3: aim at 3"]);
    let player = player.press("y");
    player.shows(&["Seven", "4 x 6 = 24: aim at 24"]);
    // The shot is not drawn with an example; the example ends when the shot is played.
    player.press("Enter").answer().press("Space").does_not_show("aim at 24");
    Player::new().press("y y y y").does_not_show("aim at");
}

#[test]
fn the_system_of_the_shot_is_shown_first() {
    for (name, system) in
        [("corner-5-from-the-corner", "Corner-5"), ("plus-from-three", "Plus"), ("seven-from-four", "Seven")]
    {
        let player = with_model_shot(Player::with(ASCII), name).press("Esc");
        let player = player.press("y");
        player.shows(&[&format!("{system} - for this shot")]);
        // Without the shot, its numbers are gone, too, and the moved balls are visible.
        let moved = player.press("1 S-Up");
        moved.does_not_show(&format!("{system} - "));
        let mut player = moved.press("u y");
        player.shows(&[&format!("{system} - for this shot")]);
        player.app.paste("2d,0.5d 6d,2d 4d,3.5d");
        player.does_not_show(&format!("{system} - "));
    }
}

#[test]
fn examples_hide_the_balls_and_unmatched_shots_are_reported() {
    let yellow = Color::Rgb(0xf6, 0xc3, 0x24);
    let is_there = |player: &Player| {
        let picture = player.picture(120, 40);
        let table = (1..29).flat_map(|y| (0..120).map(move |x| (x, y)));
        table.map(|at| &picture[at]).any(|cell| [cell.fg, cell.bg].contains(&yellow))
    };
    // The shot is too slow for three cushions.
    let player = advised(Player::new(), "6d,1d 7d,3.5d 0.5d,0.5d", "0,0,3,133,0.6").press("Esc");
    assert!(is_there(&player));
    let player = player.press("y");
    player.shows(&["Corner-5 \u{b7} an example", "No system describes this shot."]);
    assert!(!is_there(&player), "{}", player.text(120, 40));
    // Before any shot there is no message about it.
    Player::new().press("y").does_not_show("No system describes");
}

#[test]
fn the_text_includes_the_number_of_the_shot() {
    let balls = "0.840,-0.320 -0.270,-0.550 -0.180,-0.630";
    advised(Player::with(ASCII), balls, "0.25,0.3,3,146.4,2.4")
        .press("y")
        .shows_at((200, 60), &["the same on this table, this shot at 17"]);
}

#[test]
fn an_example_of_another_system_hides_the_shots_system() {
    let player = with_model_shot(Player::with(ASCII), "corner-5-from-the-corner").press("y");
    player.shows(&["Corner-5 - for this shot", " Corner-5: ", " on the wood"]);
    let player = player.press("y");
    player.shows(&["Plus - an example", "Cue from "]);
    player.does_not_show("Corner-5: ");
}

#[test]
fn a_parallel_shift_is_shown_first_for_its_shot_only() {
    let player = advised(Player::with(ASCII), "-0.6035,-0.355 0.165,0.42 0,0.3", "0,0.2,2,75,4").press("Esc y");
    player.shows(&["- Parallel shift - for this shot -", "Aimed at diamond 3 of the top rail", "as here, to 4.3"]);
    assert!(player.text(120, 40).contains("The dots are the line to the"));
    assert!(player.text(200, 60).contains("further along the third"));
    let next = player.press("y");
    next.shows(&["Corner-5 - an example"]);
    let mut shift = next.press("y y y y");
    shift.shows(&["Parallel shift - for this shot"]);
    shift.app.paste("2d,0.5d 6d,2d 4d,3.5d");
    shift.does_not_show("- Parallel shift");
}

#[test]
fn a_parallel_shift_fits_and_cut_sentences_end_with_dots() {
    let (balls, cue) = ("1.117,0.53 -0.405,-0.174 0.064,0.331", "-0.079,0.425,0.3,-156.5,2.82");
    let player = advised(Player::with(ASCII), balls, cue).press("Esc y");
    player.shows_at((80, 24), &["Diamond 2 of the left rail leads to", "2.4, as here,", "on this table to 3.7"]);
    let large = ["Aimed at diamond 2 of the left rail,", "On this table to", "Aimed further along the first..."];
    player.shows_at((120, 40), &large);
}
