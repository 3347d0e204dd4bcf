//! The settings' screen through the real app: keys change values and keys, which hold at once and stand in the file.

use std::{fs, path::PathBuf};

use crate::{
    coach_player::{ASCII, NO_COLOUR, TRUE_COLOUR, is_toast},
    keys::key,
};
use carom::{
    game::Rule,
    table::{Layout, Table},
    terminal::{App, Capabilities, Depth, Effect, Glyphs, KeyContext, PageId, Settings, SettingsContext, SettingsFile},
};
use proptest::prelude::*;
use ratatui::{Terminal, backend::TestBackend, buffer::Buffer, style::Color};
use tempfile::TempDir;

/// Somebody with a settings file of their own.
struct Player {
    app: App,
    file: SettingsFile,
    folder: TempDir,
}

impl Player {
    /// At the settings, whose file has this text.
    fn with(caps: Capabilities, text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("config.toml");
        fs::write(&path, text).unwrap();
        let table = Table::default();
        let (settings, complaints) = Settings::load(&path);
        let app = App::new(table.clone(), Layout::opening(&table), caps, 7).unwrap();
        let app = app.with_settings(&settings).with_complaints(&path, &complaints);
        let app = app.with_settings_file(PathBuf::from("/home/player/.config/carom/config.toml"));
        Self { app, file: SettingsFile::default(), folder }.press("F5")
    }

    fn new() -> Self {
        Self::with(TRUE_COLOUR, "")
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("config.toml")
    }

    fn text_of_file(&self) -> String {
        fs::read_to_string(self.path()).unwrap()
    }

    fn take(&mut self, effect: Option<Effect>) {
        // What other screens want is another matter.
        if let Some(Effect::Settings(mut task)) = effect {
            // What is shown does not depend on where the tests run.
            task.path = self.path();
            let report = self.file.run(&task);
            self.app.receive_settings(report);
        }
    }

    fn press(mut self, keys: &str) -> Self {
        for word in keys.split_whitespace() {
            let effect = self.app.handle(&key(word));
            self.take(effect);
        }
        self
    }

    fn type_in(mut self, text: &str) -> Self {
        for letter in text.chars() {
            self = self.press(&letter.to_string());
        }
        self
    }

    fn picture(&self, width: u16, height: u16) -> Buffer {
        self.draw(width, height).backend().buffer().clone()
    }

    fn draw(&self, width: u16, height: u16) -> Terminal<TestBackend> {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| self.app.draw(frame)).unwrap();
        terminal
    }

    fn text(&self, width: u16, height: u16) -> String {
        self.draw(width, height).backend().to_string()
    }

    fn says(&self, part: &str) -> &Self {
        let text = self.text(120, 40);
        assert!(text.contains(part) || is_toast(&self.app, part), "{part}\n{text}");
        self
    }
}

fn check(name: &str, player: &Player) {
    for (width, height) in [(80, 24), (120, 40)] {
        insta::assert_snapshot!(format!("{name}_{width}x{height}"), player.text(width, height));
    }
}

#[test]
fn every_setting_is_listed_with_its_value_and_the_marked_one_in_words() {
    let player = Player::with(TRUE_COLOUR, "skill = \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\"\nspeed = 2.0\n");
    check("settings", &player);
    check("settings_skill", &player.press("Down Down Down Down Down"));
    check("settings_no_colour", &Player::with(NO_COLOUR, "speed = 2.0\n").press("End Up"));
    check("settings_ascii", &Player::with(ASCII, "speed = 2.0\n"));
    insta::assert_snapshot!("settings_200x60", Player::new().text(200, 60));
    for keys in ["", "Tab", "Enter", "Tab Enter", "Tab Enter q", "?"] {
        let text = Player::with(ASCII, "plan = false\n").press(keys).text(120, 40);
        assert!(text.is_ascii(), "{keys}\n{text}");
    }
    for cell in Player::with(NO_COLOUR, "plan = false\n").press("Tab").picture(120, 40).content() {
        assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset), "{cell:?}");
    }
}

#[test]
fn a_value_that_is_changed_holds_at_once_and_stands_in_the_file() {
    let player = Player::with(TRUE_COLOUR, "# mine\ntheme = \"dark\" # at night\n").press("Right");
    assert_eq!(player.picture(80, 24)[(79, 23)].bg, Color::Rgb(0xf6, 0xf5, 0xf0), "the light theme's paper");
    assert_eq!(player.text_of_file(), "# mine\ntheme = \"light\" # at night\n");
    // theme, colours, glyphs, table, rule, skill, plan, think_ms, step_mm, speed, mouse
    let player = player
        .press("Down Down Down Right Down Right Right Down Left Down Right Down Left Down Right Down Right Down l");
    assert_eq!(player.app.table().name, "textbook");
    let query = &player.app.coach().query;
    assert_eq!((query.rule, query.plan), (Rule::ThreeCushion, false));
    assert_eq!((player.app.step_mm(), player.app.playback().speed(), player.app.wants_mouse()), (50.0, 2.0, false));
    let (settings, complaints) = Settings::load(&player.path());
    assert_eq!((settings.think_ms, settings.rule, complaints.len()), (500, Rule::ThreeCushion, 0));
    // Back to the defaults, each in its place.
    let player =
        player.press("Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Delete Up Up Up Delete");
    assert_eq!(Settings::load(&player.path()).0, Settings::default());
    assert!(player.text_of_file().starts_with("# mine\ntheme = \"dark\" # at night\n"));
    player.press("Delete").says("this is as it is by default");
}

#[test]
fn the_table_comes_back_with_a_step_back() {
    let player = Player::new().press("Down Down Down Right F2");
    assert_eq!(player.app.table().name, "textbook");
    let player = player.press("Left u u");
    assert_eq!((player.app.table().name.as_str(), player.app.layout()), ("match", &Layout::opening(&Table::default())));
    assert_eq!(player.press("U").app.table().name, "textbook");
}

#[test]
fn a_value_is_typed_and_what_is_refused_is_named_and_can_be_mended() {
    let player = Player::new().press("Down Down Down Down Down Down Down Enter").type_in("5");
    check("settings_typing", &player);
    assert_eq!(player.app.place(), KeyContext::Settings(SettingsContext::Typing));
    let player = player.press("Enter");
    player.says("think_ms = 5; accepted is 10 to 60000");
    check("settings_refused", &player);
    let player = player.type_in("50").press("Enter");
    assert!(player.text_of_file().contains("think_ms = 550\n"));
    // From a number that was typed on, the next larger and smaller of the usual ones.
    assert_eq!(Settings::load(&player.press("Right").path()).0.think_ms, 1000);
    let player = Player::new().press("Down Down Down Enter").type_in("/nowhere/mine.toml").press("Enter");
    player.says("table = /nowhere/mine.toml; accepted is");
    let file = player.folder.path().join("mine.toml");
    fs::write(&file, include_str!("../../src/table/match.toml").replace("\"match\"", "\"mine\"")).unwrap();
    let path = file.to_str().unwrap().to_owned();
    let mut player = player.press("Esc Enter");
    player.app.paste(&path);
    let player = player.press("Enter");
    assert_eq!(player.app.table().name, "mine");
    fs::write(&file, "R = \"large\"\n").unwrap();
    let refused = player.press("Delete Enter").type_in(&path).press("Enter");
    refused.says("line 1");
    assert_eq!(refused.app.table().name, "match");
    assert!(refused.press("Esc Enter Esc").text_of_file().contains("table = \"match\""));
}

#[test]
fn what_somebody_else_writes_meanwhile_is_read_and_not_lost() {
    let player = Player::with(TRUE_COLOUR, "theme = \"dark\"\n");
    fs::write(player.path(), "theme = \"dark\"\nspeed = 4.0\n").unwrap();
    let player = player.press("Right");
    player.says("has been changed by somebody else; it is read anew");
    assert_eq!(player.text_of_file(), "theme = \"dark\"\nspeed = 4.0\n");
    assert_eq!(player.app.playback().speed(), 4.0);
    check("settings_changed_meanwhile", &without_folder(player));
    let player = Player::with(TRUE_COLOUR, "theme = \"dark\"\n");
    fs::write(player.path(), "theme = \n").unwrap();
    // Opened once more, the file is damaged.
    let player = player.press("F2 F5");
    player.says("line 1").says("what is set holds until the program ends, while the file cannot be read or written");
    let player = player.press("Right");
    player.says("this holds until the program ends").says("is left as it is");
    assert_eq!(player.text_of_file(), "theme = \n");
    assert_eq!(player.app.settings().settings.palette.name(), "light");
}

/// The sentence names a folder that is another one each time.
fn without_folder(mut player: Player) -> Player {
    player.app.tick(60.0);
    player
}

#[test]
fn what_holds_for_the_session_is_shown_and_gone_on_from() {
    let text = "# mine\nrule = \"straight\" # at home\n";
    let player = Player::with(TRUE_COLOUR, text).press("F2 R R S P + F5");
    player.says("three-cushion now; the file has straight");
    let query = &player.app.coach().query;
    let skill = Settings::default().skill;
    assert_eq!((query.rule, query.plan, query.skill == skill), (Rule::ThreeCushion, false, false));
    assert_eq!(player.app.step_mm(), 50.0, "it was opened, and nothing has changed");
    assert_eq!(player.text_of_file(), text);
    // On from three cushions, around the end and once more; all else stays as it is.
    let player = player.press("Home Down Down Down Down");
    check("settings_session", &player);
    let player = player.press("Right Right");
    assert_eq!(player.app.coach().query.rule, Rule::OneCushion);
    assert_eq!(player.text_of_file(), "# mine\nrule = \"one-cushion\" # at home\n");
    assert_eq!((player.app.coach().query.plan, player.app.step_mm()), (false, 50.0));
    // What is in force is kept as it is.
    let player = player.press("Down Down Enter");
    player.says("plan (Enter alone keeps false) = ");
    let player = player.press("Enter");
    assert!(player.text_of_file().contains("plan = false\n"), "{}", player.text_of_file());
    assert!(!player.text_of_file().contains("skill"));
    // Back at what is the default, the file still has something else, which can be taken out.
    let player = player.press("F2 R R F5 Up Up");
    player.says("straight ▸ now; the file has one-cushion");
    assert!(player.press("Delete").text_of_file().contains("rule = \"straight\" # at home\n"));
}

#[test]
fn themes_and_characters_of_the_session_are_shown_too() {
    let player = Player::new().press("F2 T");
    player.says("theme: light, for this session; F5 keeps it");
    let player = player.press("g F5");
    player.says("light ▸ now; the file has dark").says("half now; the file has auto");
    assert_eq!(player.text_of_file(), "");
    let player = player.press("T");
    player.says("high-contrast ▸ now; the file has dark");
    let player = player.press("Enter Enter");
    assert_eq!(Settings::load(&player.path()).0.palette.name(), "high-contrast");
    assert_eq!(player.app.caps().glyphs, Glyphs::Half);
    let player = Player::with(NO_COLOUR, "").press("T");
    player.says("no colours here: NO_COLOR is set or the terminal has none");
    assert_eq!(player.app.settings().settings, Settings::default());
}

#[test]
fn every_mistake_of_the_file_is_kept_to_be_read() {
    let player = Player::with(TRUE_COLOUR, "speed = 9.5\nskill = 3\ntempo = 1\n");
    assert!(is_toast(&player.app, "speed = 9.5") && is_toast(&player.app, "; and 2 more: F6"));
    let past: Vec<&str> = player.app.toasts().past().collect();
    assert_eq!(past.len(), 3, "{past:?}");
    assert!(past[1].contains("skill = 3") && past[2].contains("tempo"), "{past:?}");
}

#[test]
fn colours_and_characters_are_found_out_anew() {
    fn detect(settings: &Settings) -> Capabilities {
        let variable = |name: &str| (name == "LANG").then(|| "C.UTF-8".to_owned());
        Capabilities::detect(variable, (settings.depth, settings.glyphs))
    }
    let mut player = Player::new();
    player.app = player.app.with_detection(detect);
    let player = player.press("Down Right Down Right Right Right");
    assert_eq!(player.app.caps(), Capabilities { depth: Depth::True, glyphs: Glyphs::Half, unicode: true });
    let player = player.press("Up Right");
    assert_eq!(player.app.caps().depth, Depth::Indexed);
    assert_eq!(player.press("Delete").app.caps().depth, Depth::Ansi, "nothing is known of the terminal");
}

#[test]
fn a_key_is_given_other_work_and_gets_its_own_back() {
    let player = Player::new().press("Tab");
    check("keys", &player);
    check("keys_no_colour", &Player::with(NO_COLOUR, "[keys]\nx = \"Enter\"\n").press("Tab Down Down"));
    check("keys_ascii", &Player::with(ASCII, "[keys]\nx = \"Enter\"\n").press("Tab Right Right"));
    // Behind the first command is the one that moves a ball to the left.
    let asked = player.press("Down Enter");
    assert_eq!(asked.app.place(), KeyContext::Settings(SettingsContext::Pressing));
    asked.says("press the key that is to do this: move the ball left by one step");
    let refused = asked.press("Enter");
    refused.says("Enter keeps its work");
    let given = refused.press("a");
    // In the drills it adds a position from a code.
    given.says("a does something else: add a position from a code that is typed or pasted (Drills: library)");
    check("keys_taken", &given);
    let kept = given.press("n");
    assert!(!kept.text_of_file().contains("[keys]"));
    let player = kept.press("Enter a y");
    assert!(player.text_of_file().contains("[keys]\na = \"Left\"\n"), "{}", player.text_of_file());
    check("keys_given", &player);
    let moved = player.press("F2 a");
    assert!((moved.app.layout().balls[0].x + 0.72).abs() < 1e-9);
    let again = moved.press("F5 Enter a");
    again.says("a does this already");
    let back = again.press("Esc Delete");
    assert!(!back.text_of_file().contains("Left"), "{}", back.text_of_file());
    back.press("F3 a").says("paste or type the code");
}

#[test]
fn keys_of_the_header_and_the_hints_are_the_users_own() {
    let player = Player::with(TRUE_COLOUR, "[keys]\nx = \"R\"\nF7 = \"F2\"\n").press("F7");
    let first = |width| player.text(width, 40).lines().next().unwrap().to_owned();
    assert!(first(80).contains(" x straight S expert P plan"), "{}", first(80));
    assert!(first(120).contains(" F7 Coach  F3 Drills  F4 Training  F5 Settings "), "{}", first(120));
    let player = player.press("x");
    assert_eq!(player.app.coach().query.rule, Rule::OneCushion);
}

#[test]
fn escape_goes_back_to_the_screen_before() {
    for (keys, screen) in [("F2 F5 Tab Esc", PageId::Coach), ("F4 F5 Esc", PageId::Training)] {
        assert_eq!(Player::new().press(keys).app.screen(), screen, "{keys}");
    }
}

#[test]
fn every_size_can_be_drawn() {
    for keys in ["", "Enter x", "Tab Right Down", "Tab Enter q", "Tab ?", "Delete F6"] {
        let player = Player::with(TRUE_COLOUR, "skill = \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\"\n").press(keys);
        for width in (1..=240).step_by(13) {
            for height in (1..=90).step_by(7) {
                player.picture(width, height);
            }
        }
    }
}

/// What one may press at any time.
const KEYS: &[&str] = &[
    "Left",
    "Right",
    "Up",
    "Down",
    "Right",
    "Down",
    "Tab",
    "Enter",
    "Enter",
    "Esc",
    "Delete",
    "Backspace",
    "x",
    "1",
    "0",
    "y",
    "n",
    "q",
    "F2",
    "F3",
    "F4",
    "F5",
    "F5",
    "F6",
    "?",
    ":",
    "Home",
    "End",
    "a",
    "C-r",
    "C-p",
    "u",
    "Space",
    "T",
    "g",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn whatever_is_pressed_the_file_says_what_holds(
        keys in prop::collection::vec(0..KEYS.len(), 1..60), width in 40_u16..200, height in 10_u16..60,
    ) {
        let mut player = Player::with(TRUE_COLOUR, "# mine\nodd = 1\nplan = false # behind\n[keys]\n\"Hyper-x\" = \"q\"\n");
        for key in keys {
            // What ends the program is another matter.
            if KEYS[key] != "q" || player.app.place() == KeyContext::Settings(SettingsContext::Pressing) {
                player = player.press(KEYS[key]);
            }
        }
        player.picture(width, height);
        let (settings, complaints) = Settings::load(&player.path());
        let screen = player.app.settings();
        prop_assert_eq!(Some(&settings), screen.file.as_ref());
        prop_assert_eq!(&settings.keys, &screen.settings.keys);
        prop_assert_eq!(complaints.len(), 2);
        let text = player.text_of_file();
        prop_assert!(text.starts_with("# mine\nodd = 1\nplan = ") && text.contains(" # behind\n"), "{}", text);
    }
}
