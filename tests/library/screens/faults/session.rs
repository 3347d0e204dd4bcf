//! What the next start can continue from, as keys change it.

use carom::{coach::Skill, game::Rule, terminal::Terms};

use crate::screens::player::{Player, TRUE_COLOUR};

#[test]
fn the_session_is_saved_only_after_a_change() {
    let player = Player::new();
    assert!(player.app.saved_session().is_none());
    let player = player.press("Right R S x");
    let last = player.app.saved_session().unwrap();
    assert_eq!((last.layout, &last.table), (*player.app.coach.layout(), player.app.coach.table()));
    assert_eq!((last.rule, last.cue_ball), (Rule::OneCushion, player.app.page().cue_ball()));
    assert_ne!(last.skill, Skill::EXPERT);
    assert!(last.practice.is_none());
    let moved = player.press("Right");
    assert_ne!(moved.app.saved_session(), Some(last.clone()));
    assert_eq!(moved.press("u").app.saved_session(), Some(last));
}

#[test]
fn practice_is_saved_while_its_page_is_open() {
    let player = Player::practising(TRUE_COLOUR).press("m");
    let saved = player.app.saved_session().unwrap();
    assert_eq!(saved.practice.as_ref().map(|session| session.attempts.len()), Some(1));
    let noted = player.press("n");
    assert_ne!(noted.app.saved_session(), Some(saved.clone()));
    assert!(noted.press("F2").app.saved_session().is_none(), "the coach's table is unchanged");
}

#[test]
fn rule_player_and_plan_are_restored_unless_settings_changed() {
    let terms = |player: &Player| player.app.coach.query.terms();
    let chosen = Player::new().press("R S P");
    let left = terms(&chosen);
    assert!(left.rule == Rule::OneCushion && left.skill != Skill::EXPERT && !left.plan);
    let second = Player::new().after(&chosen);
    assert_eq!(terms(&second), left);
    second.does_not_show("c goes on");
    assert_eq!(second.app.coach.layout(), Player::new().app.coach.layout());
    assert!(second.app.saved_session().is_none(), "the file stays as it is");
    // A setting takes precedence over the previous session if it has changed since; each setting is independent.
    let set = Player::with_settings(TRUE_COLOUR, "skill = \"club\"").after(&chosen);
    assert_eq!(terms(&set), Terms { skill: Skill::CLUB, ..left });
    // What was left at one start holds at the one after it.
    let third = Player::new().after(&second.press("r"));
    assert_eq!(terms(&third), left);
    // Changes on the settings screen take effect immediately.
    let fourth = third.press("F5 Home Down Down Down Down Right F2 r");
    assert_eq!(terms(&fourth).rule, Rule::ThreeCushion);
    let fifth = |settings: &str| terms(&Player::with_settings(TRUE_COLOUR, settings).after(&fourth));
    assert_eq!(fifth("rule = \"three-cushion\""), Terms { rule: Rule::ThreeCushion, ..left });
    assert_eq!(fifth("rule = \"straight\"").rule, Rule::StraightRail);
}
