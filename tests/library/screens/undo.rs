//! Undo and redo: strokes that are set, and balls that come from elsewhere, also on another table.

use super::{
    player::{OTHER_SHOTS, Player, SHOT, TRUE_COLOUR, cue},
    practice::exercise,
};
use carom::{drills::Exercise, game::Rule, table::Layout, terminal::Mode};

#[test]
fn changes_of_the_stroke_are_undone_one_by_one() {
    let stroke = |player: &Player| *player.app.drills.turn.as_ref().unwrap().stroke();
    let player = Player::practising(TRUE_COLOUR);
    let start = stroke(&player);
    let set = player.press("Left Left Left k k Up Left");
    let end = stroke(&set);
    let back = set.press("z");
    assert!((back.app.drills.turn.as_ref().unwrap().stroke().speed - end.speed).abs() < 1e-12);
    let back = back.press("z z z");
    assert_eq!(stroke(&back), start, "aim, tip, speed, aim");
    back.press("z").says("the stroke is unchanged");
    let again = Player::practising(TRUE_COLOUR).press("Left Left Left k k Up Left z z z z Z Z Z C-r");
    assert_eq!(stroke(&again), end);
    again.press("Z").says("no change of the stroke to redo");
    let played = Player::practising(TRUE_COLOUR).press("Left Space z");
    played.says("a shot is being watched; Enter goes on");
}

#[test]
fn balls_from_another_table_are_one_undo_step() {
    let thesis = Exercise { table: "thesis".to_owned(), ..exercise("small", "On the other table") };
    let player = Player::at_library(TRUE_COLOUR, &[thesis], &[]).press("Left c");
    let place = |player: &Player| (player.app.coach.table().name.clone(), *player.app.coach.layout());
    let taken = place(&player);
    assert_eq!(taken.0, "thesis");
    let back = player.press("u");
    assert_eq!(place(&back), ("match".to_owned(), Layout::opening(back.app.coach.table())));
    back.says("the table is match");
    let again = back.press("U");
    assert_eq!(place(&again), taken);
    again.says("the table is thesis");
    again.press("u u").says("there is nothing to undo");
}

#[test]
fn undo_restores_balls_and_rule_together() {
    let exercise = Exercise { rule: Rule::OneCushion, ..exercise("other", "Under another rule") };
    let rule = |player: &Player| player.app.coach.query.rule;
    let taken = Player::at_library(TRUE_COLOUR, &[exercise], &[]).press("Left c");
    assert_eq!(rule(&taken), Rule::OneCushion);
    taken.says("the balls are taken over, with their rule, one-cushion");
    let back = taken.press("u");
    assert_eq!(rule(&back), Rule::StraightRail);
    back.says("what counts: straight");
    let again = back.press("U");
    assert_eq!(rule(&again), Rule::OneCushion);
    // A rule that was chosen since is a later step.
    let again = again.press("R u");
    assert_eq!(rule(&again), Rule::OneCushion);
    // A rule that was set since stays.
    let set = again.press("F5 Home Down Down Down Down Right F2");
    assert_eq!(rule(&set), Rule::ThreeCushion);
    assert_eq!(rule(&set.press("u")), Rule::ThreeCushion);
}

#[test]
fn undoing_the_switch_of_balls_keeps_the_selection() {
    let places = |player: &Player| player.app.coach.layout().balls;
    let player = Player::new();
    let before = places(&player);
    let after = places(&player.press("x u Right"));
    assert!(after[0] != before[0] && after[1] == before[1], "{before:?} {after:?}");
}

#[test]
fn undoing_a_change_of_terms_restores_the_shot() {
    for (key, message) in [
        ("S", "the player: expert (average above 2.5); its shot is shown"),
        ("R", "what counts: straight; its shot is shown"),
        ("P", "the next point counts too; its shot is shown"),
    ] {
        let changed = Player::new().press("Enter").answer().press(key);
        assert_eq!(changed.shown_cue(), None, "{key}");
        changed.says("Enter asks the coach, u undoes it");
        let back = changed.press("u");
        assert_eq!(back.shown_cue(), Some(cue(SHOT)), "{key}");
        assert_eq!(back.app.coach.mode, Mode::Watching, "{key}: told as it was");
        back.says(message);
        let again = back.press("U");
        assert_eq!(again.shown_cue(), None, "{key}");
        again.press("u u").says("there is nothing to undo");
    }
}

#[test]
fn shots_are_remembered_for_several_players() {
    let others = Player::new().press("Enter").answer().press("S Enter").report_better(OTHER_SHOTS[0], 893).press("Esc");
    let other = others.shown_cue();
    assert_eq!(other, Some(cue(OTHER_SHOTS[0])));
    let back = others.press("u");
    assert_eq!(back.shown_cue(), Some(cue(SHOT)), "the answer for another player replaces nothing");
    let again = back.press("U");
    assert_eq!(again.shown_cue(), other);
    let round = again.press("S S S S S");
    assert_eq!(round.shown_cue(), Some(cue(SHOT)), "the first player again");
    let moved = round.press("1 Right");
    assert_eq!(moved.shown_cue(), None);
    assert_eq!(moved.press("S").shown_cue(), None, "a shot is for the balls where they lay");
}
