//! Numbers that are typed into the form of a new run, and a pasted name.

use carom::terminal::{Effect, KeyContext, TrainingContext};

use crate::screens::player::{Player, TRUE_COLOUR};

/// Returns a player at the number of shots in the form.
fn at_number_of_shots() -> Player {
    Player::listing(TRUE_COLOUR).press("n Down Down Down")
}

/// Returns the value of an option of the started run.
fn started_option(player: &Player, option: &str) -> Option<String> {
    let launch = player.effects.iter().find_map(|effect| match effect {
        Effect::Train(launch) => Some(launch),
        _ => None,
    })?;
    let mut arguments = launch.arguments.iter().skip_while(|argument| *argument != option).skip(1);
    arguments.next().map(|value| value.to_string_lossy().into_owned())
}

#[test]
fn the_first_digit_replaces_the_number() {
    let typed = at_number_of_shots().press("4 0 0 0 0");
    typed.says("40,000");
    let started_run = typed.press("Enter");
    assert_eq!(started_option(&started_run, "--steps").as_deref(), Some("40000"));
    // A player who comes back types a new number, also in the seed.
    let again = at_number_of_shots().press("4 0 Down 7 Up 9 0 Enter");
    assert_eq!(started_option(&again, "--steps").as_deref(), Some("90"));
    assert_eq!(started_option(&again, "--seed").as_deref(), Some("7"));
    let chosen = at_number_of_shots().press("4 0 Right 6 Enter");
    assert_eq!(started_option(&chosen, "--steps").as_deref(), Some("6"), "a number that was chosen is replaced too");
}

#[test]
fn backspace_edits_the_existing_number() {
    let player = at_number_of_shots().press("Backspace 3 Enter");
    assert_eq!(started_option(&player, "--steps").as_deref(), Some("5000003"));
    let player = at_number_of_shots().press("4 0 Backspace 5 Enter");
    assert_eq!(started_option(&player, "--steps").as_deref(), Some("45"));
}

#[test]
fn every_valid_seed_can_be_typed_and_larger_ones_are_refused() {
    let greatest = u64::MAX.to_string();
    let typed = at_number_of_shots().press("4 Down").type_in(&greatest);
    assert_eq!(started_option(&typed.press("Enter"), "--seed"), Some(greatest));
    let mut player = at_number_of_shots().press("4 Down").type_in(&"9".repeat(20));
    player.warns("seed: accepted is a whole number up to 18446744073709551615");
    player = player.press("Down Up 5");
    player.app.paste(&"9".repeat(23));
    player.warns("seed: accepted is a whole number up to 18446744073709551615");
    assert_eq!(started_option(&player.press("Enter"), "--seed").as_deref(), Some("5"), "the number stays as it was");
}

#[test]
fn a_run_longer_than_a_day_asks_for_confirmation() {
    let player = at_number_of_shots().press("9 0 0 0 0 0 0 0 0 0 Enter");
    assert!(player.effects.is_empty(), "{:?}", player.effects);
    assert_eq!(player.app.key_context(), KeyContext::Question { is_typed: false });
    player.says("9,000,000,000 shots take about");
    player.shows(&["start the run?", "y yes", "n no"]);
    let no = player.press("n");
    assert_eq!(no.app.key_context(), KeyContext::Training(TrainingContext::Form), "the form is as it was");
    no.says("9,000,000,000");
    let yes = no.press("Enter y");
    assert_eq!(started_option(&yes, "--steps").as_deref(), Some("9000000000"));
    assert_eq!(yes.app.key_context(), KeyContext::Training(TrainingContext::Watch));
    let usual = at_number_of_shots().press("Enter");
    assert_eq!(started_option(&usual, "--steps").as_deref(), Some("5000000"), "a usual number starts immediately");
}

#[test]
fn a_policy_name_can_be_pasted() {
    let mut player = Player::watching(TRUE_COLOUR).press("k");
    assert_eq!(player.app.key_context(), KeyContext::Question { is_typed: true });
    player = player.press(&"Backspace ".repeat(100));
    player.app.paste("three-cushions\n");
    player.says("keep the networks under the name: three-cushions");
    let player = player.press("Enter");
    let kept = player.effects.iter().find_map(|effect| match effect {
        Effect::SavePolicy(task) => Some(task.name.clone()),
        _ => None,
    });
    assert_eq!(kept.as_deref(), Some("three-cushions"));
}
