//! Spectators: what they see, when it ends, and what nobody sees.

use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    process::Command,
    thread,
    time::Duration,
};

use portable_pty::CommandBuilder;

use crate::{
    program::{KillOnDrop, Outcome, command, outcome},
    terminal::{QUIET_TIME, Session, TIMEOUT, guest},
};

/// Returns a guest session with this command after `ssh`.
fn over_ssh(name: &str, words: &str) -> CommandBuilder {
    let mut command = guest(name);
    command.env("SSH_ORIGINAL_COMMAND", words);
    command
}

/// Returns the program without a terminal, in the home folder of a session.
fn piped_carom(home: &Path, args: &[&str]) -> Command {
    let mut command = command(home, args);
    command.env("XDG_DATA_HOME", home.join("data")).env_remove("SSH_ORIGINAL_COMMAND");
    command
}

/// Runs it to its end.
fn run_piped(home: &Path, args: &[&str]) -> Outcome {
    outcome(piped_carom(home, args).spawn().unwrap())
}

/// Returns the folder in which a player shows their table.
fn shown_folder(home: &Path, name: &str) -> PathBuf {
    home.join("data/carom/players").join(name).join("shown")
}

/// Starts a player who shows their table.
fn start_showing_player(home: &Path, name: &str) -> Session {
    let mut session = Session::start_at(home, guest(name), 80, 24).ready();
    session.send("F");
    session.wait_for(&format!("carom follow {name} shows this table"));
    let file = shown_folder(home, name).join("table.json");
    session.wait_until("the file", |_| file.exists());
    session
}

#[test]
fn a_table_is_followed_live_while_its_player_allows_it() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    assert_eq!(run_piped(home, &["follow", "anna"]).code, Some(1), "the player anna does not exist yet");
    let mut anna = Session::start_at(home, guest("Anna"), 80, 24).ready();
    assert!(!shown_folder(home, "anna").exists(), "nothing is shown by itself");
    run_piped(home, &["follow", "anna"]).fails(1, &["anna shows no table now"]);
    anna.send("F");
    anna.wait_for("carom follow Anna shows this table");
    // From then on the status line says so, in addition to its other text.
    anna.press("\x1b[C");
    anna.wait_for("shown to others: white at x -700.0 mm");
    let mut ben = Session::start_at(home, over_ssh("ben", "follow anna"), 80, 24);
    ben.wait_for("following anna");
    ben.wait_for("anna places the balls");
    ben.wait_for("-700.0");
    anna.press("\x1b[C");
    ben.wait_for("-690.0");
    anna.send("\r");
    ben.wait_for("the coach thinks for anna");
    anna.wait_for_advice();
    anna.wait_until_quiet(Duration::from_secs(2));
    let shot_line = |screen: &vt100::Screen| screen.contents().lines().nth(18).map(str::to_owned);
    let words = shot_line(anna.screen());
    ben.wait_until("the shot in words", |screen| shot_line(screen) == words);
    anna.send(" ");
    ben.wait_until("the shot plays", |screen| screen.contents().contains("next: "));
    let over =
        |screen: &vt100::Screen| ["Point", "No point", "point"].iter().any(|word| screen.contents().contains(word));
    anna.wait_until("the end", over);
    ben.wait_until("the end", over);
    anna.send("w");
    ben.wait_for("anna's own stroke, not the coach's shot");
    anna.send("\x1b");
    // Keys of the spectator change nothing.
    ben.send("\x1b[C\x1b[Cro\rF");
    ben.wait_until_quiet(QUIET_TIME);
    assert!(ben.screen().contents().contains("following anna") && !shown_folder(home, "ben").exists());
    anna.send("F");
    ben.wait_for("anna shows no table at the moment");
    assert_eq!(fs::read_dir(shown_folder(home, "anna")).unwrap().count(), 1, "only the lock remains");
    anna.send("F");
    ben.wait_for("following anna: match");
    anna.quit_with("q");
    ben.wait_for("anna shows no table at the moment");
    ben.quit_with("q");
    assert!(!home.join("data/carom/players/ben/last.json").exists(), "it was not ben's session");
}

#[test]
fn a_killed_player_disappears_and_an_idle_one_writes_nothing() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let mut anna = start_showing_player(home, "anna");
    let mut ben = Session::start_at(home, over_ssh("ben", "follow anna"), 120, 40);
    ben.wait_for("anna places the balls");
    anna.wait_until_quiet(Duration::from_secs(3));
    let changed = || fs::metadata(shown_folder(home, "anna").join("table.json")).unwrap().modified().unwrap();
    let (before, written) = (changed(), anna.bytes_written());
    thread::sleep(Duration::from_secs(2));
    assert_eq!((changed(), anna.bytes_written()), (before, written));
    // Another session of the same player cannot show a second table under her name.
    let mut second = Session::start_at(home, guest("anna"), 80, 24).ready();
    second.send("F");
    second.wait_for("another session of yours");
    assert!(!second.screen().contents().contains("from now on"));
    anna.signal("KILL");
    ben.wait_for("anna shows no table at the moment");
    assert_eq!(run_piped(home, &["follow", "anna"]).code, Some(1));
    second.send("F");
    ben.wait_for("anna places the balls");
}

#[test]
fn nameless_players_show_nothing_and_players_may_follow_themselves() {
    let mut nobody = Session::start(80, 24);
    nobody.send("F");
    nobody.wait_for("carom --player NAME");
    let home = tempfile::tempdir().unwrap();
    let mut anna = start_showing_player(home.path(), "anna");
    let mut mirror = Session::start_at(home.path(), over_ssh("anna", "follow Anna"), 80, 24);
    mirror.wait_for("Anna places the balls");
    anna.press("\x1b[C");
    mirror.wait_for("-700.0");
}

#[test]
fn follow_prints_text_or_json_until_the_player_leaves() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let mut anna = start_showing_player(home, "anna");
    assert_eq!(run_piped(home, &["follow"]).ok().out, "anna\n");
    assert_eq!(run_piped(home, &["follow", "--json"]).out, "{\"player\":\"anna\"}\n");
    let heard = home.join("heard.txt");
    let plain = piped_carom(home, &["follow", "anna"]).stdout(File::create(&heard).unwrap()).spawn().unwrap();
    let seen = home.join("seen.txt");
    let json = piped_carom(home, &["follow", "anna", "--json"]).stdout(File::create(&seen).unwrap()).spawn().unwrap();
    let objects = || fs::read_to_string(&seen).unwrap();
    let text = || fs::read_to_string(&heard).unwrap();
    anna.wait_until("the balls", |_| text().contains("White lies at"));
    anna.send("\r");
    anna.wait_until("the advice", |_| text().contains("The coach recommends: "));
    anna.send(" ");
    anna.wait_until("the shot", |_| text().contains("anna plays the shot.") && objects().contains("\"playing\":true"));
    // A hard shot takes half a minute; the rest is watched at four times its speed.
    anna.send("++");
    anna.wait_until("the verdict", |_| text().contains("oint"));
    anna.send("q");
    let [plain, _] = [plain, json].map(|child| outcome(child).ok());
    assert!(text().starts_with("anna plays straight"), "{}", text());
    assert!(plain.err.contains("anna no longer shows the table"));
    let text = objects();
    let records: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(records.len() > 3 && records.iter().all(|record| record["table"]["name"] == "match"), "{text}");
    assert_eq!(records.last().unwrap()["shot"]["over"], true);
}

#[test]
fn forged_table_files_do_no_harm() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let anna = start_showing_player(home, "anna");
    let good = fs::read_to_string(shown_folder(home, "anna").join("table.json")).unwrap();
    drop(anna);
    let folder = shown_folder(home, "mallory");
    fs::create_dir_all(&folder).unwrap();
    let put = |text: &str| {
        // Written atomically, as by a player's own program.
        fs::write(folder.join("new"), text).unwrap();
        fs::rename(folder.join("new"), folder.join("table.json")).unwrap();
    };
    let named = good.replace("\"name\":\"match\"", "\"name\":\"\\u001b[2J\\u009bred\"");
    assert_ne!(named, good);
    put(&named);
    let mut ben = Session::start_at(home, over_ssh("ben", "follow mallory"), 120, 40);
    ben.wait_for("mallory places the balls");
    let heard = home.join("heard.txt");
    let mut plain =
        KillOnDrop(piped_carom(home, &["follow", "mallory"]).stdout(File::create(&heard).unwrap()).spawn().unwrap());
    let text = || fs::read_to_string(&heard).unwrap();
    ben.wait_until("the lines", |_| text().contains("mallory plays"));
    put("{\"version\":1,");
    ben.wait_for("cannot be read");
    put(&good.replace("\"selected\":0", "\"selected\":7"));
    put(&" ".repeat(1 << 20));
    thread::sleep(Duration::from_secs(1));
    ben.wait_for("cannot be read");
    put(&good);
    ben.wait_for("mallory places the balls");
    // A link does not lead a guest to other files.
    #[cfg(unix)]
    {
        fs::write(home.join("secret"), &good).unwrap();
        fs::remove_file(folder.join("table.json")).unwrap();
        std::os::unix::fs::symlink(home.join("secret"), folder.join("table.json")).unwrap();
        ben.wait_for("cannot be read");
    }
    fs::remove_file(folder.join("table.json")).unwrap();
    ben.wait_for("mallory shows no table at the moment");
    plain.wait().unwrap();
    assert!(!text().contains(['\u{1b}', '\u{9b}']), "{:?}", text());
    assert!(ben.child.try_wait().unwrap().is_none(), "the spectator's program still runs");
}

#[test]
fn hostile_names_and_other_ssh_commands_are_rejected() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    for name in ["../anna", "/etc", "a b", "\u{1b}]0;x\u{7}", ""] {
        let refused = run_piped(home, &["follow", "--", name]).fails(2, &["accepted are 1 to 32 letters"]);
        assert!(
            refused.out.is_empty() && !refused.err.contains('\u{1b}'),
            "{name:?}: {} {:?}",
            refused.out,
            refused.err
        );
    }
    let asked = |words: &str| {
        let mut command = piped_carom(home, &["--guest", "--player", "ben"]);
        outcome(command.env("SSH_ORIGINAL_COMMAND", words).spawn().unwrap())
    };
    let refused = asked("follow ../../secret\u{1b}[2J").fails(2, &["accepted are"]);
    assert!(!refused.err.contains('\u{1b}'), "{:?}", refused.err);
    assert!(asked("follow").ok().err.contains("nobody shows"));
    for words in ["train --list", "doctor", "simulate", "cat /etc/passwd", "followx anna"] {
        let mut ben = Session::start_at(home, over_ssh("ben", words), 80, 24).ready();
        ben.send("q");
        assert_eq!(ben.wait_for_exit(TIMEOUT).exit_code(), 0, "{words}");
    }
    assert_eq!(run_piped(home, &["follow", "anna"]).err.lines().count(), 1);
}
