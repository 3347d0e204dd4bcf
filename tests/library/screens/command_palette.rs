//! The command palette through the real app: its list, its filter, and its actions.

use super::player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, check_at};
use carom::terminal::Capabilities;
use ratatui::style::Modifier;

fn opened(caps: Capabilities) -> Player {
    Player::with(caps).press("Left :")
}

#[test]
fn the_palette_lists_available_and_unavailable_commands() {
    check_at(&[(80, 24)], "command_palette", &opened(TRUE_COLOUR));
    opened(NO_COLOUR).is_plain().shows(&["▸ Enter            ask the coach", "Enter do it"]);
    let text = opened(ASCII).press("s h o t").text(80, 24);
    assert!(text.is_ascii(), "{text}");
}

#[test]
fn typing_filters_commands_and_enter_runs_the_selected_one() {
    let player = opened(TRUE_COLOUR).press("c h a n g e Space U N D O");
    player.shows(&["Placing the balls: undo the last change"]).does_not_show("ask the coach");
    let moved = *player.app.coach.layout();
    let player = player.press("Enter");
    assert_ne!(*player.app.coach.layout(), moved, "the move was undone");
    assert_eq!(player.app.command_palette.as_ref().map(|_| ()), None);
    let player = player.press("C-p r e c o m m Esc u");
    player.warns("there is nothing to undo");
    assert!(player.press("C-p C-p").app.command_palette.is_none(), "the same key closes the palette");
}

#[test]
fn an_unavailable_command_explains_why_and_keeps_the_palette_open() {
    let player = opened(TRUE_COLOUR);
    assert!(player.text(80, 24).contains("▸ Enter            ask the coach"), "available commands come first");
    let player = player.press("p l a y Space p a u s e Enter");
    player.warns("there is no shot yet; Enter asks the coach");
    assert!(player.app.command_palette.is_some() && player.app.coach.shot().is_none());
    let player = player.press("x x x x");
    assert!(player.text(80, 24).contains("no matching command"));
    let player = player.press("Enter Esc");
    assert!(player.app.command_palette.is_none());
}

#[test]
fn a_key_with_two_contexts_is_listed_once() {
    let placing = Player::new().press(": y e l l o w");
    placing.shows_at((80, 24), &["1 of 69", "select the yellow ball"]).hides_at((80, 24), &["leave the shot"]);
    let watching = Player::new().press("Enter").answer().press(": y e l l o w");
    watching.shows_at((80, 24), &["1 of 69", "leave the shot and select the yellow ball"]);
}

#[test]
fn remapped_letters_are_typed_and_shown_as_keys() {
    let player = Player::with_settings(TRUE_COLOUR, "[keys]\n\"x\" = \"u\"\n");
    player.press("Left : x").shows_at((120, 40), &["x u ", "undo the last change"]);
}

#[test]
fn hints_omit_remapped_letters_in_text_fields() {
    let player = Player::with_settings(TRUE_COLOUR, "[keys]\nz = \"Enter\"\nF9 = \"Esc\"\n");
    let hints = |player: &Player| player.text(80, 24).lines().last().unwrap().trim_matches('"').to_owned();
    assert!(hints(&player).starts_with(" z ask"), "{}", hints(&player));
    let player = player.press(":");
    assert!(hints(&player).starts_with(" Enter do it"), "{}", hints(&player));
    assert!(hints(&player).contains(" F9 close"), "{}", hints(&player));
}

#[test]
fn the_help_scrolls_to_its_end_and_back() {
    let is_at_the_end = |player: &Player| !player.text(80, 24).contains("more lines below");
    let player = Player::new().press("?");
    assert!(!is_at_the_end(&player));
    let beginning = player.text(80, 24);
    let player = player.press("End");
    assert!(is_at_the_end(&player));
    let player = player.press("Home");
    assert_eq!(player.text(80, 24), beginning);
}

#[test]
fn the_selected_row_is_visible_without_colours() {
    for (width, height) in [(80, 24), (200, 60)] {
        let mut player = opened(NO_COLOUR);
        for _ in 0..60 {
            let picture = player.picture(width, height);
            let marked = (0..height).filter(|&y| {
                let reversed = |x: u16| picture[(x, y)].modifier.contains(Modifier::REVERSED);
                (width / 2 - 20..width / 2 + 20).all(reversed)
            });
            assert_eq!(marked.count(), 1);
            player = player.press("Down");
        }
        let last = player.app.commands().pop().unwrap();
        let start = format!("{:<17}{}", last.keys, &last.description[..20]);
        assert!(player.text(width, height).contains(&start), "the last of them is in view: {start}");
    }
}
