//! A shared machine of a club, set up as in `docs/club.md`, with a real sshd on the loopback address. It needs root, `sshd` and `ssh`:
//!
//! `cargo test --profile quick --test binary club:: -- --ignored --nocapture`

use std::{
    fs,
    net::{TcpListener, TcpStream},
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use assert_cmd::cargo::cargo_bin;
use portable_pty::CommandBuilder;

use crate::{
    program::KillOnDrop,
    terminal::{QUIET_TIME, START_TEXT, Session, TIMEOUT},
};

/// Number of players at the same time.
const PLAYERS: usize = 20;

/// Memory limit per player after a recommendation, bytes; shared memory counts in proportion.
const MEMORY_LIMIT: u64 = 25 << 20;

/// An sshd with the script and the configuration of the page, in its own folder.
struct Club {
    folder: tempfile::TempDir,
    port: u16,
    _sshd: KillOnDrop,
}

impl Club {
    fn open(players: &[String]) -> Self {
        // sshd runs no command that others could have written, so the folder must not be below a world-writable one.
        let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir_all("/run/sshd").unwrap();
        fs::create_dir(path("keys")).unwrap();
        for name in players.iter().map(String::as_str).chain(["host", "stranger"]) {
            let made =
                Command::new("ssh-keygen").args(["-q", "-t", "ed25519", "-N", "", "-f"]).arg(path(name)).status();
            assert!(made.unwrap().success());
        }
        for name in players {
            fs::copy(path(&format!("{name}.pub")), path("keys").join(name)).unwrap();
        }
        // A key file whose name is not a player's name must be ignored.
        fs::copy(path("stranger.pub"), path("keys").join("a b")).unwrap();
        let page = include_str!("../../docs/club.md");
        let script = script(&path("keys")).replace("/usr/local/bin/carom", cargo_bin!("carom").to_str().unwrap());
        fs::write(path("carom-keys"), script).unwrap();
        fs::set_permissions(path("carom-keys"), PermissionsExt::from_mode(0o755)).unwrap();
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let block = page.split("```\nMatch User carom\n").nth(1).unwrap().split("```").next().unwrap();
        let rules = block.replace("/usr/local/sbin/carom-keys", path("carom-keys").to_str().unwrap());
        let rules = rules.replace("CommandUser nobody", "CommandUser root");
        let places: String = ["DATA", "CONFIG", "STATE"]
            .map(|name| format!(" XDG_{name}_HOME={}", path("home").join(name).display()))
            .concat();
        let config = format!(
            "Port {port}\nListenAddress 127.0.0.1\nHostKey {}\nPidFile none\nUsePAM no\nPermitRootLogin yes\nStrictModes no\n\
             MaxStartups 100\nSetEnv{places} LANG=C.UTF-8\nMatch User root\n{rules}",
            path("host").display()
        );
        fs::write(path("sshd_config"), config).unwrap();
        let log = fs::File::create(path("log")).unwrap();
        let sshd = Command::new("/usr/sbin/sshd").args(["-D", "-e", "-f"]).arg(path("sshd_config")).stderr(log).spawn();
        let sshd = KillOnDrop(sshd.unwrap());
        let start = Instant::now();
        while TcpStream::connect(("127.0.0.1", port)).is_err() {
            assert!(start.elapsed() < TIMEOUT, "{}", fs::read_to_string(path("log")).unwrap());
            thread::sleep(Duration::from_millis(50));
        }
        Self { folder, port, _sshd: sshd }
    }

    /// Returns the arguments of `ssh` for the owner of this key.
    fn arguments(&self, key: &str) -> Vec<String> {
        let mut arguments: Vec<String> = ["-F", "none", "-p", &self.port.to_string(), "-i"].map(str::to_owned).into();
        arguments.push(self.folder.path().join(key).display().to_string());
        for option in ["StrictHostKeyChecking=no", "UserKnownHostsFile=/dev/null", "BatchMode=yes", "LogLevel=ERROR"] {
            arguments.extend(["-o".to_owned(), option.to_owned()]);
        }
        arguments
    }

    /// Starts a player at a terminal who requests the command `order` instead of the coach.
    fn player(&self, key: &str, order: &str) -> Session {
        let mut command = CommandBuilder::new("ssh");
        command.args(self.arguments(key));
        command.args(["-tt", "root@127.0.0.1"]);
        if !order.is_empty() {
            command.arg(order);
        }
        Session::start_command(command, 80, 24)
    }

    fn players_folder(&self) -> PathBuf {
        self.folder.path().join("home/DATA/carom/players")
    }
}

/// Returns the script of the page, changed to look for keys in the folder `keys`.
fn script(keys: &Path) -> String {
    let page = include_str!("../../docs/club.md");
    let script = page.split("```sh\n").find(|block| block.starts_with("#!/bin/sh")).unwrap();
    script.split("```").next().unwrap().replace("/etc/carom/keys", keys.to_str().unwrap())
}

#[test]
fn the_key_script_prints_one_line_per_valid_key() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("anna", "ssh-ed25519 AAAA anna\n\n# old\nssh-ed25519 BBBB anna");
    write("ben", "ssh-ed25519 CCCC ben\n");
    write("-c", "ssh-ed25519 DDDD c");
    let answer = Command::new("sh").args(["-c", &script(folder.path())]).output().unwrap();
    let answer = String::from_utf8(answer.stdout).unwrap();
    let line = |name, key| {
        let command = format!("restrict,pty,command=\"exec /usr/local/bin/carom --guest --player {name}\"");
        format!("{command} ssh-ed25519 {key} {name}\n")
    };
    assert_eq!(answer, [line("anna", "AAAA"), line("anna", "BBBB"), line("ben", "CCCC")].concat());
}

/// Returns the process that serves a player.
fn process(name: &str) -> Option<u32> {
    let is_it = |id: &u32| {
        let words = fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
        let words: Vec<&[u8]> = words.split(|byte| *byte == 0).collect();
        words.first().is_some_and(|program| program.ends_with(b"carom")) && words.contains(&name.as_bytes())
    };
    fs::read_dir("/proc").unwrap().filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok()).find(is_it)
}

/// Returns a value of `/proc/PID/smaps_rollup`, bytes.
fn memory(process: u32, what: &str) -> u64 {
    let text = fs::read_to_string(format!("/proc/{process}/smaps_rollup")).unwrap();
    let line = text.lines().find_map(|line| line.strip_prefix(what)).unwrap();
    line.trim().trim_end_matches(" kB").parse::<u64>().unwrap() * 1024
}

/// Returns the processor time that a process has used, in ticks.
fn ticks(process: u32) -> u64 {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).unwrap();
    let fields: Vec<&str> = text.rsplit(')').next().unwrap().split_whitespace().collect();
    fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap()
}

#[test]
#[ignore = "needs root and sshd; see the command at the top of this file"]
fn twenty_players_share_a_machine_over_ssh() {
    let names: Vec<String> = (1..=PLAYERS).map(|number| format!("player-{number}")).collect();
    let club = Club::open(&names);
    // Whatever other command they request, they get the coach.
    let mut sessions: Vec<Session> = names.iter().map(|name| club.player(name, "cat /etc/passwd")).collect();
    for session in &mut sessions {
        session.wait_for(START_TEXT);
        assert!(!session.screen().contents().contains("root:"));
    }
    // All coaches think at the same time.
    let start = Instant::now();
    for session in &mut sessions {
        session.send("\r");
    }
    let mut waited = Vec::new();
    for session in &mut sessions {
        session.wait_for_advice();
        waited.push(start.elapsed().as_secs_f64());
    }
    eprintln!(
        "advice for all of {PLAYERS}: the first after {:.1} s, the last after {:.1} s",
        waited[0],
        waited[PLAYERS - 1]
    );
    for session in &mut sessions {
        session.wait_until_quiet(Duration::from_secs(2));
    }
    let processes: Vec<u32> = names.iter().map(|name| process(name).unwrap()).collect();
    let shares: Vec<u64> = processes.iter().map(|id| memory(*id, "Pss:")).collect();
    let resident: Vec<u64> = processes.iter().map(|id| memory(*id, "Rss:")).collect();
    let largest = |bytes: &[u64]| *bytes.iter().max().unwrap() as f64 / 1e6;
    eprintln!("memory of a player: {:.1} MB shared-aware, {:.1} MB resident", largest(&shares), largest(&resident));
    let before: Vec<u64> = processes.iter().map(|id| ticks(*id)).collect();
    thread::sleep(Duration::from_secs(3));
    let used: u64 = processes.iter().map(|id| ticks(*id)).sum::<u64>() - before.iter().sum::<u64>();
    eprintln!("at rest: {used} ticks of the processor in 3 s for all together");
    assert_eq!(used, 0);
    assert!(shares.iter().all(|bytes| *bytes <= MEMORY_LIMIT), "{shares:?}");

    // One session crashes and one is flooded with input: the others continue.
    assert!(Command::new("kill").args(["-KILL", &processes[0].to_string()]).status().unwrap().success());
    sessions[1].send(&"jk".repeat(50_000));
    let start = Instant::now();
    sessions[2].press("r");
    eprintln!("a key of another player is answered after {} ms meanwhile", start.elapsed().as_millis());
    assert!(start.elapsed() < Duration::from_secs(2));
    sessions[2].send("q");
    assert_eq!(sessions[2].wait_for_exit(TIMEOUT).exit_code(), 0);

    // Each player has a folder, and nobody else does.
    let folders = fs::read_dir(club.players_folder()).unwrap().map(|entry| entry.unwrap().file_name());
    let mut folders: Vec<String> = folders.map(|name| name.into_string().unwrap()).collect();
    folders.sort();
    let mut wanted = names.clone();
    wanted.sort();
    assert_eq!(folders, wanted);
    assert!(club.players_folder().join("player-3/last.json").exists());
}

#[test]
#[ignore = "needs root and sshd; see the command at the top of this file"]
fn unknown_keys_are_refused_and_players_get_only_the_coach() {
    let club = Club::open(&["anna".to_owned()]);
    let ssh = |key: &str, more: &[&str]| {
        let mut command = Command::new("ssh");
        command.args(club.arguments(key)).arg("root@127.0.0.1").args(more).stdin(Stdio::null());
        command.output().unwrap()
    };
    let refused = ssh("stranger", &[]);
    assert!(!refused.status.success() && String::from_utf8_lossy(&refused.stderr).contains("Permission denied"));
    let blind = ssh("anna", &["sh"]);
    assert_eq!(blind.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&blind.stderr).contains("this is not a terminal"), "{blind:?}");
    assert!(!String::from_utf8_lossy(&ssh("anna", &["-s", "sftp"]).stdout).contains("sftp"));
    let mut session = club.player("anna", "");
    session.wait_for(START_TEXT);
    session.send("\x1a");
    session.wait_for("guests have no shell");
    session.wait_until_quiet(QUIET_TIME);
    session.send("q");
    assert_eq!(session.wait_for_exit(TIMEOUT).exit_code(), 0);
    assert!(is_below(&club.players_folder().join("anna"), &club.folder.path().join("home")));
}

#[test]
#[ignore = "needs root and sshd; see the command at the top of this file"]
fn a_player_watches_another_over_ssh() {
    let club = Club::open(&["anna".to_owned(), "ben".to_owned()]);
    let mut anna = club.player("anna", "");
    anna.wait_for(START_TEXT);
    let mut ben = club.player("ben", "follow anna");
    assert_ne!(ben.wait_for_exit(TIMEOUT).exit_code(), 0, "she has not allowed it yet");
    anna.send("F");
    anna.wait_for("carom follow anna shows this table");
    anna.wait_until_quiet(Duration::from_secs(1));
    let mut ben = club.player("ben", "follow anna");
    ben.wait_for("anna places the balls");
    anna.send("\r");
    anna.wait_for_advice();
    anna.send(" ");
    ben.wait_for("next: ");
    // A broken connection ends the display.
    anna.disconnect();
    ben.wait_for("anna shows no table at the moment");
    ben.send("q");
    assert_eq!(ben.wait_for_exit(TIMEOUT).exit_code(), 0);
}

/// Whether all files below `home` are below `folder`.
fn is_below(folder: &Path, home: &Path) -> bool {
    fs::read_dir(home).unwrap().all(|entry| {
        let path = entry.unwrap().path();
        if path.is_dir() { is_below(folder, &path) } else { path.starts_with(folder) }
    })
}
