//! Both players' balls: whichever side is at the table, every ball keeps its position, its colour and its name.

use super::{
    player::{NO_COLOUR, Player, cue},
    practice::exercise,
};
use carom::drills::Record;

/// The initial speed of a stroke, m/s.
const FIRST_SPEED: f64 = 2.5;

/// Returns the positions of the brackets around each ball's letter in the picture.
fn letter_positions(text: &str) -> Vec<Option<(usize, usize)>> {
    let find = |sign: &str| {
        text.lines().enumerate().find_map(|(row, line)| Some((row, line.chars().collect::<String>().find(sign)?)))
    };
    ["(W)", "(Y)", "(R)"].map(find).to_vec()
}

#[test]
fn switching_the_cue_ball_moves_and_repaints_no_ball() {
    let before = Player::with(NO_COLOUR).press("r");
    let white = before.text(120, 40);
    let layout = *before.app.coach.layout();
    let after = before.press("x");
    let yellow = after.text(120, 40);
    assert!(letter_positions(&white).iter().all(Option::is_some), "{white}");
    assert_eq!(letter_positions(&white), letter_positions(&yellow), "{white}\n{yellow}");
    assert_eq!(*after.app.coach.layout(), layout.for_the_opponent());
    assert!(yellow.contains("yellow is the cue ball now"), "{yellow}");
    // In true colours, too: the same cells have the same colours.
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
    // Each key selects the ball of its colour, and undo restores the other player.
    let selected = after.press("2");
    assert_eq!(selected.app.coach.selected, 0, "yellow is ball 0 now");
    let back = selected.press("u");
    assert_eq!(*back.app.coach.layout(), layout);
    assert_eq!(back.app.page().cue_ball().name(), "white");
}

impl Player {
    /// Plays softly away from everything, and goes to the end of the shot.
    fn miss(self) -> Self {
        (0..23).fold(self, |player, _| player.press("Down")).press("S-Left Space Enter")
    }
}

#[test]
fn in_a_match_a_miss_passes_the_turn() {
    let player = Player::practising(NO_COLOUR).press("o o o");
    player.says("Score: match").says("inning 1 of 10").says("Stroke of white");
    let missed = player.miss();
    missed.says("white: 0, best 0").says("inning 1 of 10");
    let next = missed.press("Enter");
    next.says("Stroke of yellow");
    assert_eq!(next.app.page().cue_ball().name(), "yellow");
}

#[test]
fn filmed_shots_keep_their_colours_during_a_match() {
    let yellow = Player::practising(NO_COLOUR).press("o o o").miss().press("Enter");
    assert_eq!(yellow.app.page().cue_ball().name(), "yellow");
    let list = yellow.press("F2 f");
    assert_eq!(list.app.page().cue_ball().name(), "white");
    let film = list.press("Enter");
    assert_eq!(film.app.page().cue_ball().name(), "white");
    assert_eq!(film.press("Esc Esc").app.page().cue_ball().name(), "yellow", "the match is still open");
}

#[test]
fn exercise_balls_keep_their_colours_at_the_coach() {
    let listed = Player::at_library(NO_COLOUR, &[exercise("opening", "x")], &[]).press("F2 x F3 Left c");
    assert_eq!(listed.app.coach.cue_ball().name(), "white", "as in the list");
    listed.says("the balls are taken over; Enter asks the coach");
    assert_eq!(listed.press("u").app.coach.cue_ball().name(), "yellow");
    let turn = Player::practising(NO_COLOUR).press("o o o").miss().press("Enter");
    let layout = turn.app.drills.turn.as_ref().unwrap().layout;
    let coach = turn.press("c");
    assert_eq!((*coach.app.coach.layout(), coach.app.coach.cue_ball().name()), (layout, "yellow"));
}

/// Returns a match against the coach, whose model shot is given, after a miss.
fn against_the_coach(model_shot: Option<&'static str>, shorter: &str) -> Player {
    let mut player = Player::practising(NO_COLOUR).press("o o o o");
    if !shorter.is_empty() {
        player = player.press(shorter);
    }
    player.says("Score: against the coach");
    player.model_shot = model_shot;
    player.miss().press("Enter")
}

const SHOT: &str = "0,0.2,2,140,3";

#[test]
fn the_coachs_strokes_in_a_match_count_only_for_it() {
    for (model_shot, meant) in [(Some(SHOT), cue(SHOT).speed), (None, FIRST_SPEED)] {
        let turn = against_the_coach(model_shot, "");
        let words = if model_shot.is_some() {
            "with errors as large as yours; Space plays it"
        } else {
            "Space plays full at a ball"
        };
        turn.says("The coach's turn: straight").says("Stroke of yellow").says(words);
        let turn = turn.press("Left");
        turn.warns("the coach plays this stroke: Space");
        let played = turn.press("Space Enter");
        played.says("coach (yellow): ").says("you (white): 0, best 0").says(" (the coach)").says("the coach's hand: ");
        let session = &played.store().sessions().items[0];
        let by_coach: Vec<bool> = session.attempts.iter().map(|attempt| attempt.by_coach).collect();
        assert_eq!((by_coach, session.attempts[1].helped), (vec![false, true], false));
        let speed = session.attempts[1].intended.unwrap().speed;
        assert!((speed - meant).abs() < 1e-9, "the displayed model shot is played");
        assert_eq!(Record::of([session], |_, _| true).tried, 1, "the record is the player's");
    }
}

#[test]
fn a_match_against_the_coach_is_resumed_and_finished() {
    let turn = against_the_coach(Some(SHOT), "< < < < < < < < <");
    turn.says("inning 1 of 1");
    turn.says("coach makes 40 %");
    let left = turn.press("Esc Enter");
    left.says("you 0 : 0 coach: it goes on here, inning 1 of 1").says("coach makes 40 %");
    let noted = left.press("m");
    noted.warns("the coach cannot play at a real table");
    let mut over = noted.press("Space Enter");
    // After a point, the coach has another stroke.
    while over.store().sessions().items[0].attempts.last().unwrap().made {
        over.says("coach (yellow): ");
        over = over.press("Enter Space Enter");
    }
    over.says("the match is over: you 0 : ");
    assert!(over.store().sessions().items[0].is_over());
    over.press("Enter").says("inning 1 of 1").says("no attempt yet");
}
