//! The settings screen through the real app: keys change values and key bindings, which take effect immediately and are saved.

use std::fs;

use super::{
    keys::key,
    player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, check},
};
use carom::{
    game::Rule,
    table::{Layout, Table},
    terminal::{Capabilities, Depth, Effect, Glyphs, KeyContext, PageId, Settings, SettingsContext},
};
use proptest::prelude::*;
use ratatui::style::Color;

/// Returns a player at the settings, with this text in the file.
fn with(caps: Capabilities, text: &str) -> Player {
    Player::with_settings(caps, text).press("F5")
}

fn new() -> Player {
    with(TRUE_COLOUR, "")
}

#[test]
fn every_setting_is_listed_and_the_selected_one_explained() {
    let player = with(TRUE_COLOUR, "skill = \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\"\nspeed = 2.0\n");
    check("values", &player);
    let skill = player.press("Down Down Down Down Down");
    skill.shows(&["2 changed", "Who plays: the errors that the", "errors in mm"]);
    let speed = with(NO_COLOUR, "speed = 2.0\n").press("End Up Up Up Up");
    speed.is_plain().shows(&["1 changed", "Playback speed of shots", "Accepted: 0.1, 0.25, 0.5, 1, 2, 4"]);
    with(ASCII, "speed = 2.0\n").is_plain().shows(&["> theme", "Colours of the screen."]);
    new().shows_at((200, 60), &["Colours of the screen.", "think_ms", "mouse"]);
    for keys in ["", "Tab", "Enter", "Tab Enter", "Tab Enter q", "?"] {
        with(ASCII, "plan = false\n").press(keys).is_plain();
    }
    with(NO_COLOUR, "plan = false\n").press("Tab").is_plain();
}

#[test]
fn a_changed_value_takes_effect_and_is_saved() {
    let player = with(TRUE_COLOUR, "# mine\ntheme = \"dark\" # at night\n").press("Right");
    assert_eq!(player.picture(80, 24)[(79, 23)].bg, Color::Rgb(0xf6, 0xf5, 0xf0), "the light theme's paper");
    assert_eq!(player.settings_text(), "# mine\ntheme = \"light\" # at night\n");
    // theme, colours, glyphs, table, rule, skill, doubt, plan, jumps, think_ms, step_mm, speed, mouse
    let player = player.press(
        "Down Down Down Right Down Right Right Down Left Down Left Down Right Down Right Down Left Down Right Down Right Down l",
    );
    assert_eq!(player.app.coach.table().name, "textbook");
    let query = &player.app.coach.query;
    assert_eq!((query.rule, query.plan, query.jumps), (Rule::ThreeCushion, false, false));
    assert!(player.text(80, 24).contains("jumps") && player.settings_text().contains("jumps = false\n"));
    assert_eq!((player.app.coach.step_mm(), player.app.coach.playback.speed(), player.app.mouse), (50.0, 2.0, false));
    let (settings, mistakes) = Settings::load(&player.path("config.toml"));
    assert_eq!((settings.think_ms, settings.rule, mistakes.len()), (500, Rule::ThreeCushion, 0));
    // Back to the defaults, each in its place.
    let player = player.press(
        "Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Up Up Delete",
    );
    assert_eq!(Settings::load(&player.path("config.toml")).0, Settings::default());
    assert!(player.settings_text().starts_with("# mine\ntheme = \"dark\" # at night\n"));
    player.press("Delete").says("this is the default already");
}

#[test]
fn undo_restores_the_previous_table() {
    let player = new().press("Down Down Down Right F2");
    assert_eq!(player.app.coach.table().name, "textbook");
    let player = player.press("Left u u");
    assert_eq!(player.app.coach.table().name, "match");
    assert_eq!(*player.app.coach.layout(), Layout::opening(&Table::default()));
    assert_eq!(player.press("U").app.coach.table().name, "textbook");
}

#[test]
fn user_tables_are_selected_by_key_or_name() {
    let folder = tempfile::tempdir().unwrap();
    let tables = folder.path().join("tables");
    fs::create_dir(&tables).unwrap();
    for name in ["cellar", "club"] {
        let text = include_str!("../../../src/table/match.toml").replace("\"match\"", &format!("\"{name}\""));
        fs::write(tables.join(format!("{name}.toml")), text).unwrap();
    }
    let player = Player::in_folder(TRUE_COLOUR, folder).press("F5 Down Down Down Left");
    player.shows(&["◂ club ▸", "cellar, club."]);
    assert_eq!(player.app.coach.table().name, "club");
    let mut player = player.press("Left");
    assert_eq!(player.app.coach.table().name, "cellar");
    for (typed, name) in [("club", "club"), ("cellar.toml", "cellar")] {
        player = player.press("Enter").type_in(typed).press("Enter");
        assert_eq!(player.app.coach.table().name, name);
    }
}

#[test]
fn a_typed_value_is_checked_and_remains_editable() {
    let player = new().press("Down Down Down Down Down Down Down Down Down Enter").type_in("5");
    player.shows(&["think_ms = 5", "Accepted: 10 to 60000.", "Enter take it"]);
    assert_eq!(player.app.key_context(), KeyContext::Question { is_typed: true });
    let player = player.press("Enter");
    player.says("think_ms = 5; accepted is 10 to 60000");
    check("refused", &player);
    // Decimal commas are accepted.
    for (downs, typed, line) in [(5, "0,6", "skill = \"average=0.6\"\n"), (11, "0,5", "speed = 0.5\n")] {
        let written = new().press(&"Down ".repeat(downs)).press("Enter").type_in(typed).press("Enter").settings_text();
        assert!(written.contains(line), "{written}");
    }
    let player = player.type_in("50").press("Enter");
    assert!(player.settings_text().contains("think_ms = 550\n"));
    // From a typed number, the keys lead to the next larger and smaller usual values.
    assert_eq!(Settings::load(&player.press("Right").path("config.toml")).0.think_ms, 1000);
    let player = new().press("Down Down Down Enter").type_in("/nowhere/mine.toml").press("Enter");
    player.says("table = /nowhere/mine.toml; accepted is");
    let file = player.path("mine.toml");
    fs::write(&file, include_str!("../../../src/table/match.toml").replace("\"match\"", "\"mine\"")).unwrap();
    let path = file.to_str().unwrap().to_owned();
    let mut player = player.press("Esc Enter");
    player.app.paste(&path);
    let player = player.press("Enter");
    assert_eq!(player.app.coach.table().name, "mine");
    fs::write(&file, "R = \"large\"\n").unwrap();
    let refused = player.press("Delete Enter").type_in(&path).press("Enter");
    refused.says("line 1");
    assert_eq!(refused.app.coach.table().name, "match");
    assert!(refused.press("Esc Enter Esc").settings_text().contains("table = \"match\""));
}

#[test]
fn external_changes_of_the_file_are_kept() {
    let player = with(TRUE_COLOUR, "theme = \"dark\"\n");
    fs::write(player.path("config.toml"), "theme = \"dark\"\nspeed = 4.0\n").unwrap();
    let player = player.press("Right");
    assert_eq!(player.settings_text(), "theme = \"light\"\nspeed = 4.0\n");
    assert_eq!(player.app.coach.playback.speed(), 1.0, "external changes do not alter values in use");
    player.shows(&["2 changed", "theme       •◂ light ▸", "speed       •  1.0"]);
    let player = with(TRUE_COLOUR, "theme = \"dark\"\n");
    fs::write(player.path("config.toml"), "theme = \n").unwrap();
    // Opened once more, the file is damaged.
    let player = player.press("F2 F5");
    player.says("line 1").says("changes last until the program ends: the file has a fault (F6), or cannot be written");
    let player = player.press("Right");
    player.says("this change lasts until the program ends; ").says("was not written: ");
    assert_eq!(player.settings_text(), "theme = \n");
    assert_eq!(player.app.settings.settings.theme.name(), "light");
    fs::remove_file(player.path("config.toml")).unwrap();
    let player = player.press("Right");
    assert_eq!(Settings::load(&player.path("config.toml")).0.theme.name(), "high-contrast", "created again");
}

#[test]
fn placed_balls_stay_when_the_table_changes() {
    let to_textbook = |player: Player| player.press("F5 Home Down Down Down Right F2");
    let begun = with(TRUE_COLOUR, "").press("F2");
    let spots = to_textbook(begun);
    assert_eq!(*spots.app.coach.layout(), Layout::opening(spots.app.coach.table()));
    let placed = with(TRUE_COLOUR, "").press("F2 Right Right");
    let layout = *placed.app.coach.layout();
    let placed = to_textbook(placed);
    assert_eq!((placed.app.coach.table().name.as_str(), *placed.app.coach.layout()), ("textbook", layout));
}

#[test]
fn session_values_are_shown_and_used_as_starting_points() {
    let text = "# mine\nrule = \"straight\" # at home\n";
    let player = with(TRUE_COLOUR, text).press("F2 R R S P + F5");
    player.says("three-cushion now and at the next start");
    let query = &player.app.coach.query;
    let skill = Settings::default().skill;
    assert_eq!((query.rule, query.plan, query.skill == skill), (Rule::ThreeCushion, false, false));
    assert_eq!(player.app.coach.step_mm(), 50.0, "it was opened, and nothing has changed");
    assert_eq!(player.settings_text(), text);
    // Continues from three cushions, past the end of the list and once more; everything else stays the same.
    let player = player.press("Home Down Down Down Down");
    player.shows(&[
        "4 changed",
        "rule        •◂ three-cushion ▸ now",
        "Now \"three-cushion\", also",
        "Enter twice saves",
    ]);
    let player = player.press("Right Right");
    assert_eq!(player.app.coach.query.rule, Rule::OneCushion);
    assert_eq!(player.settings_text(), "# mine\nrule = \"one-cushion\" # at home\n");
    assert_eq!((player.app.coach.query.plan, player.app.coach.step_mm()), (false, 50.0));
    // The value in force is saved unchanged.
    let player = player.press("Down Down Down Enter");
    player.says("plan (Enter alone keeps false) = ");
    let player = player.press("Enter");
    assert!(player.settings_text().contains("plan = false\n"), "{}", player.settings_text());
    assert!(!player.settings_text().contains("skill"));
    // Back at the default value, the file still has another one, which can be removed.
    let player = player.press("F2 R R F5 Up Up Up");
    player.says("straight ▸ now and at the next start");
    assert!(player.press("Delete").settings_text().contains("rule = \"straight\" # at home\n"));
}

#[test]
fn session_themes_and_glyphs_are_shown() {
    let player = new().press("F2 T");
    player.says("theme: light, for this session; F5 keeps it");
    let player = player.press("g F5");
    player.says("light ▸ now; the next start uses dark").says("half now; the next start uses auto");
    assert_eq!(player.settings_text(), "");
    let player = player.press("T");
    player.says("high-contrast ▸ now; the next start uses dark");
    let player = player.press("Enter Enter");
    assert_eq!(Settings::load(&player.path("config.toml")).0.theme.name(), "high-contrast");
    assert_eq!(player.app.caps.glyphs, Glyphs::Half);
    let player = with(NO_COLOUR, "").press("T");
    player.says("no colours here: NO_COLOR is set or the terminal has none");
    assert_eq!(player.app.settings.settings, Settings::default());
}

#[test]
fn every_error_in_the_file_is_listed_in_the_messages() {
    let player = with(TRUE_COLOUR, "speed = 9.5\nskill = 3\ntempo = 1\n");
    assert!(player.has_toast("speed = 9.5") && player.has_toast("; and 2 more: F6"));
    let past: Vec<&str> = player.app.toasts.messages().collect();
    assert_eq!(past.len(), 3, "{past:?}");
    assert!(past[1].contains("skill = 3") && past[2].contains("tempo"), "{past:?}");
}

#[test]
fn changed_settings_detect_terminal_capabilities_again() {
    fn detect(settings: &Settings) -> Capabilities {
        let variable = |name: &str| (name == "LANG").then(|| "C.UTF-8".to_owned());
        Capabilities::detect(variable, (settings.depth, settings.glyphs))
    }
    let mut player = new();
    player.app = player.app.with_detection(detect);
    let player = player.press("Down Right Down Right Right Right");
    assert_eq!(player.app.caps, Capabilities { depth: Depth::True, glyphs: Glyphs::Half, unicode: true });
    let player = player.press("Up Right");
    assert_eq!(player.app.caps.depth, Depth::Indexed);
    assert_eq!(player.press("Delete").app.caps.depth, Depth::Ansi, "nothing is known of the terminal");
}

#[test]
fn a_key_is_remapped_and_reset() {
    let player = new().press("Tab");
    check("keys", &player);
    let own = "[keys]\nx = \"Enter\"\n";
    let plain = with(NO_COLOUR, own).press("Tab Down");
    plain.is_plain().shows(&["Keys ◂ Coach ▸", "▸ ↓ j           move the ball down by one step"]);
    let plain = with(ASCII, own).press("Tab Right Right");
    plain.is_plain().shows(&["Keys < "]);
    let asked = player.press("Enter");
    assert_eq!(asked.app.key_context(), KeyContext::Settings(SettingsContext::Pressing));
    asked.says("press the key that should do this: move the ball left by one step");
    let refused = asked.press("Enter");
    refused.says("Enter cannot be changed");
    let given = refused.press("a");
    // In the drills it adds a position from a code.
    given.says("a already does: add a position from a code that is typed or pasted (Drills: library)");
    check("keys_taken", &given);
    let kept = given.press("n");
    assert!(!kept.settings_text().contains("[keys]"));
    let player = kept.press("Enter a y");
    assert!(player.settings_text().contains("[keys]\na = \"Left\"\n"), "{}", player.settings_text());
    player.shows(&["▸ a ← h       • move the ball left by one step"]);
    let moved = player.press("F2 a");
    assert!((moved.app.coach.layout().balls[0].x + 0.72).abs() < 1e-9);
    let again = moved.press("F5 Enter a");
    again.says("a does this already");
    let back = again.press("Esc Delete");
    assert!(!back.settings_text().contains("Left"), "{}", back.settings_text());
    back.press("F3 a").says("paste or type the code");
}

#[test]
fn y_and_n_answer_questions_even_when_remapped() {
    let given = new().press("Tab Enter y y");
    assert!(given.settings_text().contains("y = \"Left\""), "{}", given.settings_text());
    let asked = given.press("Down Enter a");
    asked.shows(&["y yes   n no"]);
    assert!(asked.press("y").settings_text().contains("a = "));
    // A key that is bound to the action of y also says yes.
    let other = with(TRUE_COLOUR, "[keys]\nj = \"y\"\n").press("Tab Enter a j");
    assert!(other.settings_text().contains("a = \"Left\""), "{}", other.settings_text());
}

#[test]
fn the_header_shows_remapped_keys() {
    let player = with(TRUE_COLOUR, "[keys]\nx = \"R\"\nF7 = \"F2\"\n").press("F7");
    let first = |width| player.text(width, 40).lines().next().unwrap().to_owned();
    assert!(first(80).contains(" x straight S expert P plan"), "{}", first(80));
    assert!(first(120).contains(" F7 Coach  F3 Drills  F4 Training  F5 Settings "), "{}", first(120));
    let player = player.press("x");
    assert_eq!(player.app.coach.query.rule, Rule::OneCushion);
}

#[test]
fn escape_returns_to_the_previous_screen() {
    for (keys, screen) in [("F2 F5 Tab Esc", PageId::Coach), ("F4 F5 Esc", PageId::Training)] {
        assert_eq!(new().press(keys).app.screen, screen, "{keys}");
    }
}

/// Keys that can be pressed at any time.
const KEYS: &str = "Left Right Up Down Right Down Tab Enter Enter Esc Delete Backspace x 1 0 y n q F2 F3 F4 F5 F5 \
    F6 ? : Home End a C-r C-p u Space T g";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_keys_keep_file_and_settings_equal(
        keys in prop::collection::vec(0..KEYS.split(' ').count(), 1..60), width in 40_u16..200, height in 10_u16..60,
    ) {
        let mut player = with(TRUE_COLOUR, "# mine\nodd = 1\nplan = false # behind\n[keys]\n\"Hyper-x\" = \"q\"\n");
        for index in keys {
            let name = KEYS.split(' ').nth(index).unwrap();
            // The key that ends the program is excluded.
            if name != "q" || player.app.key_context() == KeyContext::Settings(SettingsContext::Pressing) {
                player.event(&key(name));
            }
            // Another key may have been bound to that action.
            if matches!(player.effects.last(), Some(Effect::Quit)) {
                break;
            }
        }
        player.picture(width, height);
        let (settings, mistakes) = Settings::load(&player.path("config.toml"));
        let screen = &player.app.settings;
        prop_assert_eq!(Some(&settings), screen.file.as_ref());
        prop_assert_eq!(&settings.keys, &screen.settings.keys);
        prop_assert_eq!(mistakes.len(), 2);
        let text = player.settings_text();
        prop_assert!(text.starts_with("# mine\nodd = 1\nplan = ") && text.contains(" # behind\n"), "{}", text);
    }
}
