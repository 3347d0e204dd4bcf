//! Guests on a shared machine: what is saved for them, what they must not do, and two sessions of one guest.

use std::{
    fs,
    path::{Path, PathBuf},
};

use portable_pty::CommandBuilder;

use crate::{
    program::{asked, carom as program, command, fed},
    terminal::{OPENING, PATIENCE, REST, Session, guest},
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
fn a_guest_plays_and_leaves_files_in_the_players_folder_alone() {
    let home = tempfile::tempdir().unwrap();
    let mut session = Session::start_at(home.path(), guest("Anna"), 80, 24);
    session.wait_for(OPENING);
    session.send("\x1b[B\r");
    session.wait_for_advice();
    session.send("q");
    assert!(session.assert_left_without_trace().success());
    let own = folder(home.path(), "anna");
    let left = files(home.path());
    assert!(left.iter().any(|file| file.ends_with("last.json")), "{left:?}");
    assert!(left.iter().all(|file| file.starts_with(&own)), "{left:?}");
    // The next session continues from there, and that of another player does not.
    let mut again = Session::start_at(home.path(), guest("anna"), 80, 24);
    again.wait_for("Coach Drills");
    again.settle(REST);
    again.send("c");
    again.wait_for("this is where the last session ended");
    let mut other = Session::start_at(home.path(), guest("ben"), 80, 24);
    other.wait_for(OPENING);
    other.press("c");
    assert!(!other.screen().contents().contains("this is where"), "{}", other.screen().contents());
}

#[test]
fn a_guest_starts_no_training_and_has_no_shell() {
    let mut session = Session::start_command(guest("anna"), 80, 24);
    session.wait_for(OPENING);
    session.send("\x1a");
    session.wait_for("guests have no shell");
    session.send("t");
    session.wait_for("no run is training");
    session.send("n");
    session.wait_for("guests can watch runs");
    session.settle(REST);
    session.send("q");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn a_guests_settings_lead_to_no_file_that_is_not_theirs() {
    let home = tempfile::tempdir().unwrap();
    let (own, secret) = (folder(home.path(), "anna"), home.path().join("secret.toml"));
    fs::create_dir_all(&own).unwrap();
    fs::write(&secret, "password = \"xyzzy\"\n").unwrap();
    fs::write(own.join("config.toml"), format!("table = \"{}\"\n", secret.display())).unwrap();
    let mut session = Session::start_at(home.path(), guest("anna"), 120, 40);
    session.wait_for(OPENING);
    session.send("\x1b[17~");
    session.wait_for("It is taken as");
    let said = session.screen().contents();
    assert!(said.contains("secret.toml") && !said.contains("xyzzy") && !said.contains("password"), "{said}");
}

#[test]
fn two_sessions_of_one_player_lose_nothing() {
    let home = tempfile::tempdir().unwrap();
    let mut sessions = [(); 2].map(|()| Session::start_at(home.path(), guest("anna"), 80, 24));
    for session in &mut sessions {
        session.wait_for(OPENING);
        session.send("\r");
    }
    for session in &mut sessions {
        session.wait_for_advice();
        session.send("q");
        assert!(session.assert_left_without_trace().success());
    }
    let own = folder(home.path(), "anna");
    let last = fs::read_to_string(own.join("last.json")).unwrap();
    assert!(serde_json::from_str::<serde_json::Value>(&last).is_ok(), "{last}");
    assert!(files(&own).iter().all(|file| !file.to_string_lossy().ends_with(".partial")), "{:?}", files(&own));
}

#[test]
fn a_disk_that_takes_nothing_is_told_and_neither_spoils_the_screen_nor_keeps_the_program() {
    let mut limited = CommandBuilder::new("sh");
    let program = assert_cmd::cargo::cargo_bin!("carom").to_str().unwrap();
    limited.args(["-c", &format!("ulimit -f 0; exec {program} --guest")]);
    let mut session = Session::start_command(limited, 80, 24);
    session.wait_for(OPENING);
    session.send("\x1b[B\r");
    session.wait_for_advice();
    session.send("\x1b[17~");
    session.wait_for("cannot go on from here");
    session.settle(REST);
    let said = session.screen().contents();
    assert!(!said.contains("tracing") && !said.contains("Unable to write"), "{said}");
    session.cut();
    session.ends_within(PATIENCE);
}

#[test]
fn a_hostile_name_is_refused_before_anything_is_read_or_made() {
    let home = tempfile::tempdir().unwrap();
    for name in ["../anna", "/etc", "..", "a b", "\u{1b}]0;x\u{7}", ""] {
        let said = program(home.path(), &["--guest", &format!("--player={name}")]);
        assert_eq!(said.code, Some(2), "{name:?}: {}", said.err);
        assert!(said.err.contains("accepted are 1 to 32 letters") && !said.err.contains('\u{1b}'), "{}", said.err);
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
    // Guests cannot run other commands.
    asked(&["--guest", "train"]).assert().code(2);
}

#[test]
fn a_folder_that_cannot_be_made_is_a_sentence() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir_all(home.path().join("carom")).unwrap();
    fs::write(home.path().join("carom/players"), "in the way").unwrap();
    let said = fed(command(home.path(), &["--guest", "--plain"]), "quit\n");
    assert_eq!((said.code, said.err.lines().count()), (Some(1), 1), "{}", said.err);
    assert!(said.err.contains("players/guest cannot be made"), "{}", said.err);
}

#[test]
fn a_guest_may_talk_in_lines() {
    let home = tempfile::tempdir().unwrap();
    let said = fed(command(home.path(), &["--guest", "--player", "anna", "--plain"]), "where\nquit\n");
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("Say help"), "{}", said.out);
    assert!(files(home.path()).iter().all(|file| file.starts_with(home.path().join("carom/players/anna"))));
}
