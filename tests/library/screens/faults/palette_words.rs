//! Words that a player would search in the command palette.

use carom::terminal::{Action, CoachAction, DrillAction};

use crate::screens::player::{Player, TRUE_COLOUR};

/// Returns the selected actions after this word was typed.
fn found(player: Player, word: &str) -> Vec<Action> {
    let mut player = player.press(":");
    player.app.paste(word);
    player.app.command_palette.as_ref().unwrap().matching(player.app.commands()).iter().map(|one| one.action).collect()
}

fn at_coach(word: &str) -> Vec<Action> {
    found(Player::new(), word)
}

fn in_the_library(word: &str) -> Vec<Action> {
    found(Player::at_library(TRUE_COLOUR, &[], &[]), word)
}

#[test]
fn random_position_is_found_by_synonyms() {
    for word in ["random", "shuffle"] {
        assert_eq!(at_coach(word), [Action::Coach(CoachAction::RandomPosition)], "{word}");
    }
}

#[test]
fn opening_position_is_found_by_synonyms() {
    for word in ["clear", "reset"] {
        assert!(at_coach(word).contains(&Action::Coach(CoachAction::OpeningPosition)), "{word}");
    }
}

#[test]
fn share_and_save_are_found_by_synonyms() {
    for word in ["export", "share"] {
        assert_eq!(in_the_library(word), [Action::Drill(DrillAction::Share)], "{word}");
        assert!(at_coach(word).contains(&Action::Coach(CoachAction::SavePosition)), "{word}");
    }
}

#[test]
fn commands_about_diamonds_are_found() {
    assert!(at_coach("diamond").contains(&Action::Coach(CoachAction::NextInfoPanel)));
    assert!(in_the_library("diamond").contains(&Action::Drill(DrillAction::Search)));
}
