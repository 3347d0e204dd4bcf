//! Tables, settings, shell completions and manual pages through the real binary.

use crate::program::asked as carom;

fn text(args: &[&str]) -> String {
    String::from_utf8(carom(args).assert().success().get_output().stdout.clone()).unwrap()
}

fn said(args: &[&str], code: i32) -> String {
    String::from_utf8(carom(args).assert().code(code).get_output().stderr.clone()).unwrap()
}

#[test]
fn a_table_that_is_shown_can_be_changed_checked_and_played_on() {
    assert_eq!(text(&["table"]), text(&["table", "list"]));
    assert_eq!(text(&["table", "list", "--json"]).lines().count(), 3);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    let file = file.to_str().unwrap();
    let shown = text(&["table", "show", "match"]);
    std::fs::write(file, shown.replace("name = \"match\"", "name = \"mine\"")).unwrap();
    assert!(text(&["table", "check", file]).contains("mine: 2.84 x 1.42 m"));
    assert!(text(&["simulate", "--table", file, "--shot", "0,0,0,0,2"]).contains("all still after"));
}

#[test]
fn what_is_wrong_with_a_table_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bad.toml");
    let name = file.to_str().unwrap();
    assert!(said(&["table", "check", name], 1).contains("bad.toml"));
    std::fs::write(&file, text(&["table", "show", "textbook"]).replace("e_rail = 0.85", "e_rail = 1.5")).unwrap();
    let message = said(&["table", "check", name], 2);
    assert!(
        message.contains("e_rail = 1.5") && message.contains("0 to 1") && message.contains("bad.toml"),
        "{message}"
    );
    assert!(said(&["table", "show", "snooker"], 2).contains("snooker"));
}

#[test]
fn every_shell_has_its_completions() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = text(&["completions", shell]);
        assert!(script.contains("recommend") && script.contains("budget-ms"), "{shell}");
    }
    assert!(said(&["completions", "tcsh"], 2).contains("bash"));
}

#[test]
fn there_is_a_manual_page_for_the_program_and_every_subcommand() {
    assert!(text(&["man"]).contains("carom\\-recommend(1)"), "{}", text(&["man"]));
    assert!(text(&["man", "recommend"]).contains("budget\\-ms"));
    assert!(text(&["man", "table", "check"]).contains("TOML"));
    let message = said(&["man", "snooker"], 2);
    assert!(message.contains("snooker") && message.contains("recommend"), "{message}");
}

#[test]
fn the_settings_that_are_shown_are_a_file_that_can_be_used_and_mistakes_are_named() {
    let home = tempfile::tempdir().unwrap();
    let config = |args: &[&str]| {
        let mut command = carom(args);
        command.env("HOME", home.path()).env("XDG_CONFIG_HOME", home.path().join("config"));
        command.output().unwrap()
    };
    let path = String::from_utf8(config(&["config", "--path"]).stdout).unwrap();
    let path = std::path::Path::new(path.trim());
    assert!(path.starts_with(home.path()));
    let shown = config(&["config"]).stdout;
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, &shown).unwrap();
    assert!(config(&["config", "--check"]).status.success());
    assert_eq!(config(&["config"]).stdout, shown);
    std::fs::write(path, "theme = \"light\"\nspeed = 80\n").unwrap();
    let checked = config(&["config", "--check"]);
    let said = String::from_utf8(checked.stderr).unwrap();
    assert_eq!(checked.status.code(), Some(2));
    assert!(said.contains("line 2: speed = 80; accepted is 0.1, 0.25"), "{said}");
    assert!(String::from_utf8(config(&["config"]).stdout).unwrap().contains("theme = \"light\""));
}
