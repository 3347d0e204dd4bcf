//! Terminal sequences that are cut, come late or arrive together with other input: no key after them is lost.

use std::{thread, time::Duration};

use crate::terminal::Session;

/// Sequences that start and never end.
const INCOMPLETE: [&str; 27] = [
    "\x1b",
    "\x1b[",
    "\x1b[<",
    "\x1b[<0",
    "\x1b[<0;",
    "\x1b[<0;1;",
    "\x1b[<0;1;1",
    "\x1b[?",
    "\x1b[?1",
    "\x1b[?1;2",
    "\x1b[>",
    "\x1b[M",
    "\x1b[M ",
    "\x1b[M  ",
    "\x1b[1",
    "\x1b[1;",
    "\x1b[1;5",
    "\x1b[[",
    "\x1bO",
    "\x1b]",
    "\x1b]11;rgb:",
    "\x1b]52;c;",
    "\x1bP",
    "\x1bP>|tm",
    "\x1b_G",
    "\x1b[200~",
    "\x1b[200~a paste without an end",
];

/// Number of programs that run at the same time.
const CONCURRENT: usize = 4;

/// Starts a session, sends a sequence, and waits for a pause in ms.
fn start_with(sequence: &str, pause: u64) -> Session {
    let mut session = Session::start(80, 24);
    session.send(sequence);
    thread::sleep(Duration::from_millis(pause));
    session
}

#[test]
fn ctrl_c_quits_after_every_incomplete_sequence() {
    let check = |sequence: &str, pause: u64| {
        let mut session = start_with(sequence, pause);
        session.send("\x03");
        assert!(session.assert_clean_exit().success(), "{sequence:?} {pause}");
    };
    // Each program mostly waits, so several run at once.
    thread::scope(|scope| {
        for sequences in INCOMPLETE.chunks(INCOMPLETE.len().div_ceil(CONCURRENT)) {
            scope.spawn(move || {
                for sequence in sequences {
                    check(sequence, 0);
                    check(sequence, 300);
                }
            });
        }
    });
}

#[test]
fn other_keys_work_after_incomplete_sequences() {
    // Maximum delay of each: a tenth of a second, and ten times that for a paste.
    let check = |sequence: &str, pause: u64| {
        let mut session = start_with(sequence, pause);
        session.send("?");
        session.wait_for("Placing the balls");
        session.quit_with("\x03");
    };
    thread::scope(|scope| {
        for (sequence, pause) in [("\x1b[<", 300), ("\x1b[<0;", 300), ("\x1b[?", 300), ("\x1b[200~half a paste", 1500)]
        {
            scope.spawn(move || check(sequence, pause));
        }
    });
}

#[test]
fn a_paste_right_after_escape_triggers_no_keys() {
    let mut session = Session::start(80, 24);
    session.send("\x1b\x1b[200~qqq\x1b[201~");
    session.send("?");
    session.wait_for("Placing the balls");
}

#[test]
fn ctrl_c_quits_from_help_messages_and_palette() {
    for keys in ["?", ":", "d", "t"] {
        let mut session = Session::start(80, 24);
        session.press(keys);
        session.send("\x03");
        assert!(session.assert_clean_exit().success(), "{keys}");
    }
}
