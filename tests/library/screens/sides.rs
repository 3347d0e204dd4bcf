//! Both players' balls: whoever is at the table, every ball keeps its place and its colour, and is called by it.

use super::player::{NO_COLOUR, Player};
use carom::{drills::Record, physics::CueInputs};

/// The speed of a stroke that nobody has set yet, m/s.
const FIRST_SPEED: f64 = 2.5;

/// Where brackets stand around each ball's letter on the picture.
fn places(text: &str) -> Vec<Option<(usize, usize)>> {
    let find = |sign: &str| {
        text.lines().enumerate().find_map(|(row, line)| Some((row, line.chars().collect::<String>().find(sign)?)))
    };
    ["(W)", "(Y)", "(R)"].map(find).to_vec()
}

#[test]
fn taking_the_other_ball_moves_and_repaints_none() {
    let before = Player::with(NO_COLOUR).press("r");
    let white = before.text(120, 40);
    let layout = *before.app.coach.layout();
    let after = before.press("x");
    let yellow = after.text(120, 40);
    assert!(places(&white).iter().all(Option::is_some), "{white}");
    assert_eq!(places(&white), places(&yellow), "{white}\n{yellow}");
    assert_eq!(*after.app.coach.layout(), layout.for_the_opponent());
    assert!(yellow.contains("yellow is the cue ball now"), "{yellow}");
    // In true colours too: the same cells have the same inks.
    let inks = |player: &Player| {
        let buffer = player.picture(120, 40);
        let cells = buffer.content().iter().enumerate().filter(|(index, _)| index % 120 < 70 && index / 120 < 30);
        let mut inks: Vec<_> = cells.map(|(_, cell)| format!("{:?}{:?}", cell.fg, cell.bg)).collect();
        inks.sort();
        inks
    };
    let one = Player::new().press("r 3");
    let before = inks(&one);
    assert_eq!(inks(&one.press("x 3")), before);
    // The keys are the colours', and a step back brings the other player back.
    let selected = after.press("2");
    assert_eq!(selected.app.coach.selected, 0, "yellow is ball 0 now");
    let back = selected.press("u");
    assert_eq!(*back.app.coach.layout(), layout);
    assert_eq!(back.app.page().cue_ball().name(), "white");
}

impl Player {
    /// Strikes away from everything, softly, and goes to the end of the shot.
    fn misses(self) -> Self {
        (0..23).fold(self, |player, _| player.press("Down")).press("S-Left Space Enter")
    }
}

#[test]
fn in_a_match_of_two_the_turn_passes_with_a_miss_and_the_score_is_each_sides_own() {
    let player = Player::practising(NO_COLOUR).press("o o o");
    player.says("match, 10 innings");
    player.says("Stroke of white");
    let missed = player.misses();
    missed.says("white: 0 in 1 inning, best");
    let next = missed.press("Enter");
    next.says("Stroke of yellow");
    assert_eq!(next.app.page().cue_ball().name(), "yellow");
}

#[test]
fn in_a_match_against_the_coach_it_makes_the_strokes_of_the_other_ball_and_they_count_on_its_side_alone() {
    let shot = "0,0.2,2,140,3";
    for (taught, meant) in [(Some(shot), CueInputs::parse(shot).unwrap().speed), (None, FIRST_SPEED)] {
        let mut player = Player::practising(NO_COLOUR).press("o o o o");
        player.says("Score: against the coach");
        player.taught = taught;
        let turn = player.misses().press("Enter");
        for says in ["The coach's turn", "Stroke of yellow", "with errors as large as yours; Space plays it"] {
            turn.says(says);
        }
        let turn = turn.press("Left");
        turn.warns("the coach plays this stroke: Space");
        let played = turn.press("Space Enter");
        for says in ["coach (yellow): ", "you (white): 0 in 1 inning", "the coach: ", "the coach's hand: "] {
            played.says(says);
        }
        let session = &played.store().sessions().items[0];
        let by_coach: Vec<bool> = session.attempts.iter().map(|attempt| attempt.by_coach).collect();
        assert_eq!(by_coach, [false, true]);
        assert!((session.attempts[1].meant.unwrap().speed - meant).abs() < 1e-9, "what the coach has shown is played");
        assert_eq!(Record::of([session], |_, _| true).tried, 1, "the record is the player's");
    }
}
