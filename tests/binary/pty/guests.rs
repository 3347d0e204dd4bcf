//! Guests on a shared machine: what is saved for them, what they must not do, and two sessions of one guest.

use std::{
    fs,
    path::{Path, PathBuf},
};

use portable_pty::CommandBuilder;

use crate::{
    program::{carom as program, command, run, run_with_input},
    terminal::{QUIET_TIME, START_TEXT, Session, TIMEOUT, guest},
};

/// Returns the player's folder in a session's home folder.
fn folder(home: &Path, name: &str) -> PathBuf {
    home.join("data/carom/players").join(name)
}

/// Returns all files below `folder`.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

#[test]
fn a_guest_writes_only_to_the_players_folder() {
    let home = tempfile::tempdir().unwrap();
    let mut session = Session::start_at(home.path(), guest("Anna"), 80, 24).ready();
    session.send("\x1b[B\r");
    session.wait_for_advice();
    session.quit_with("q");
    let own = folder(home.path(), "anna");
    let left = files(home.path());
    assert!(left.iter().any(|file| file.ends_with("last.json")), "{left:?}");
    assert!(left.iter().all(|file| file.starts_with(&own)), "{left:?}");
    // The next session continues from there, and that of another player does not.
    let mut again = Session::start_at(home.path(), guest("anna"), 80, 24);
    again.wait_for("Coach Drills");
    again.wait_until_quiet(QUIET_TIME);
    again.send("c");
    again.wait_for("this is where the last session ended");
    let mut other = Session::start_at(home.path(), guest("ben"), 80, 24).ready();
    other.press("c");
    assert!(!other.screen().contents().contains("this is where"), "{}", other.screen().contents());
}

#[test]
fn a_guest_starts_no_training_and_has_no_shell() {
    let mut session = Session::start_command(guest("anna"), 80, 24).ready();
    session.send("\x1a");
    session.wait_for("guests have no shell");
    session.send("t");
    session.wait_for("no run is training");
    session.send("n");
    session.wait_for("guests can watch runs");
    session.wait_until_quiet(QUIET_TIME);
    session.quit_with("q");
}

#[test]
fn a_guests_settings_cannot_read_other_files() {
    let home = tempfile::tempdir().unwrap();
    let (own, secret) = (folder(home.path(), "anna"), home.path().join("secret.toml"));
    fs::create_dir_all(&own).unwrap();
    fs::write(&secret, "password = \"xyzzy\"\n").unwrap();
    fs::write(own.join("config.toml"), format!("table = \"{}\"\n", secret.display())).unwrap();
    let mut session = Session::start_at(home.path(), guest("anna"), 120, 40).ready();
    session.send("\x1b[17~");
    session.wait_for("It is taken as");
    let text = session.screen().contents();
    assert!(text.contains("secret.toml") && !text.contains("xyzzy") && !text.contains("password"), "{text}");
}

#[test]
fn two_sessions_of_one_player_lose_nothing() {
    let home = tempfile::tempdir().unwrap();
    let mut sessions = [(); 2].map(|()| Session::start_at(home.path(), guest("anna"), 80, 24));
    for session in &mut sessions {
        session.wait_for(START_TEXT);
        session.send("\r");
    }
    for session in &mut sessions {
        session.wait_for_advice();
        session.quit_with("q");
    }
    let own = folder(home.path(), "anna");
    let last = fs::read_to_string(own.join("last.json")).unwrap();
    assert!(serde_json::from_str::<serde_json::Value>(&last).is_ok(), "{last}");
    assert!(files(&own).iter().all(|file| !file.to_string_lossy().ends_with(".partial")), "{:?}", files(&own));
}

#[test]
fn an_unwritable_disk_is_reported_without_breaking_the_screen() {
    let mut limited = CommandBuilder::new("sh");
    let program = assert_cmd::cargo::cargo_bin!("carom").to_str().unwrap();
    limited.args(["-c", &format!("ulimit -f 0; exec {program} --guest")]);
    let mut session = Session::start_command(limited, 80, 24).ready();
    session.send("\x1b[B\r");
    session.wait_for_advice();
    session.send("\x1b[17~");
    session.wait_for("cannot go on from here");
    session.wait_until_quiet(QUIET_TIME);
    let text = session.screen().contents();
    assert!(!text.contains("tracing") && !text.contains("Unable to write"), "{text}");
    session.disconnect();
    session.wait_for_exit(TIMEOUT);
}

#[test]
fn hostile_player_names_are_refused_before_any_file_access() {
    let home = tempfile::tempdir().unwrap();
    for name in ["../anna", "/etc", "..", "a b", "\u{1b}]0;x\u{7}", ""] {
        let output =
            program(home.path(), &["--guest", &format!("--player={name}")]).fails(2, &["accepted are 1 to 32 letters"]);
        assert!(!output.err.contains('\u{1b}'), "{}", output.err);
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
    // Guests cannot run other commands.
    assert_eq!(run(&["--guest", "train"]).code, Some(2));
}

#[test]
fn a_player_folder_that_cannot_be_created_is_reported() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir_all(home.path().join("carom")).unwrap();
    fs::write(home.path().join("carom/players"), "in the way").unwrap();
    let output = run_with_input(command(home.path(), &["--guest", "--plain"]), "quit\n");
    assert_eq!((output.code, output.err.lines().count()), (Some(1), 1), "{}", output.err);
    assert!(output.err.contains("players/guest cannot be made"), "{}", output.err);
}

#[test]
fn a_guest_may_use_plain_mode() {
    let home = tempfile::tempdir().unwrap();
    let output =
        run_with_input(command(home.path(), &["--guest", "--player", "anna", "--plain"]), "where\nquit\n").ok();
    assert!(output.out.contains("Say help"), "{}", output.out);
    assert!(files(home.path()).iter().all(|file| file.starts_with(home.path().join("carom/players/anna"))));
}
