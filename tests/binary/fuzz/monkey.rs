//! Monkey test at the terminal: random keys, pastes, mouse reports, cut sequences, resizes and suspensions, and finally Ctrl-C, which
//! must end the program and restore the terminal.
//!
//! `CAROM_MONKEY=3600 cargo test --profile quick --test binary fuzz::monkey -- --nocapture` plays for an hour.

use std::{
    env, fs,
    path::Path,
    thread,
    time::{Duration, Instant},
};

use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::terminal::Session;

/// Number of events in a session.
const EVENTS: u32 = 300;

const KEYS: [&str; 60] = [
    "\x1b[A",
    "\x1b[B",
    "\x1b[C",
    "\x1b[D",
    "\x1b[1;2A",
    "\x1b[1;2D",
    "\x1b[5~",
    "\x1b[6~",
    "\x1b[H",
    "\x1b[F",
    "\x1bOP",
    "\x1bOQ",
    "\x1bOR",
    "\x1b[15~",
    "\x1b",
    "\r",
    "\t",
    "\x1b[Z",
    " ",
    "\x7f",
    ".",
    ",",
    "?",
    "m",
    "d",
    "t",
    "u",
    "r",
    "s",
    "p",
    "n",
    "x",
    "1",
    "2",
    "3",
    "+",
    "-",
    "/",
    ":",
    "!",
    "\x12",
    "\x1a",
    "y",
    "a",
    "b",
    "c",
    "e",
    "f",
    "g",
    "h",
    "i",
    "j",
    "k",
    "l",
    "o",
    "v",
    "w",
    "z",
    "[",
    "]",
];

const HOSTILE_SEQUENCES: [&str; 12] = [
    "\x1b[<",
    "\x1b[<0;5;",
    "\x1b[?",
    "\x1b[200~",
    "\x1b[200~qqq\x1b[201~",
    "\x1b\x1b[200~qqq\x1b[201~",
    "\x1b]11;rgb:0/0/0\x07",
    "\x1bP1$r0m\x1b\\",
    "\x1b[M",
    "\x1bO",
    "\u{1b}[1;9999999999999R",
    "\u{9b}\u{202e}",
];

#[test]
fn random_input_leaves_the_terminal_restored() {
    let seconds = env::var("CAROM_MONKEY").ok().and_then(|text| text.parse().ok());
    let (start, end) = (Instant::now(), Duration::from_secs(seconds.unwrap_or(0)));
    let (mut sessions, mut events, mut most) = (0, 0_u64, 0);
    for seed in 0.. {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut session = Session::start(120, 40);
        for _ in 0..EVENTS {
            events += 1;
            match rng.random_range(0..20) {
                0 => session.send(HOSTILE_SEQUENCES.choose(&mut rng).unwrap()),
                1 => session.resize(rng.random_range(20..200), rng.random_range(5..60)),
                2 => {
                    let (button, column, row) =
                        (rng.random_range(0..70), rng.random_range(0..130), rng.random_range(0..45));
                    session.send(&format!("\x1b[<{button};{column};{row}M"));
                }
                3 => {
                    session.count_bytes(Duration::from_millis(20));
                }
                _ => session.send(KEYS.choose(&mut rng).unwrap()),
            }
            if session.child.try_wait().unwrap().is_some() {
                break;
            }
            session.count_bytes(Duration::from_millis(1));
            continue_if_suspended(&session);
        }
        most = most.max(memory(&session));
        // A paste without an end may block for a second.
        session.count_bytes(Duration::from_millis(1200));
        while continue_if_suspended(&session) {
            session.count_bytes(Duration::from_millis(100));
        }
        if session.child.try_wait().unwrap().is_none() {
            session.send("\x03");
        }
        let status = session.assert_clean_exit();
        assert!(status.success(), "seed {seed}: {status:?}");
        if let Some(home) = session.home() {
            abandon(&home.join("data/carom/runs"));
        }
        sessions += 1;
        if start.elapsed() >= end {
            break;
        }
    }
    println!("{sessions} sessions, {events} events, at most {most} kB");
}

/// Continues the program if Ctrl-Z, or the command for it, has suspended it. Returns whether it was suspended.
fn continue_if_suspended(session: &Session) -> bool {
    let is_suspended = status_of(session, "State").starts_with('T');
    if is_suspended {
        session.signal("CONT");
    }
    is_suspended
}

/// Abandons the runs that the keys have started: they outlive the screen.
fn abandon(runs: &Path) {
    let Ok(entries) = fs::read_dir(runs) else { return };
    for run in entries.map(|entry| entry.unwrap().path()) {
        let asked = Instant::now();
        // A run that has ended by itself does not read requests any more.
        while run.exists() && asked.elapsed() < Duration::from_secs(10) {
            let _ = fs::write(run.join("request"), "abandon");
            thread::sleep(Duration::from_millis(100));
        }
    }
}

/// Returns the resident memory, kB.
fn memory(session: &Session) -> u64 {
    status_of(session, "VmRSS").split_whitespace().next().and_then(|size| size.parse().ok()).unwrap_or(0)
}

/// Returns a field of the system's report on the process; empty where there is none.
fn status_of(session: &Session, field: &str) -> String {
    let id = session.child.process_id().unwrap_or_default();
    let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(field)?.strip_prefix(':'));
    line.unwrap_or_default().trim().to_owned()
}
