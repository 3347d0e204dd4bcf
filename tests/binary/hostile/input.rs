//! Sequences of a terminal that are cut, come late or in one read with something else: no key after them is lost.

use std::{thread, time::Duration};

use crate::terminal::{OPENING, Session};

/// What begins and never ends.
const CUT: [&str; 27] = [
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

#[test]
fn ctrl_c_is_heard_after_every_cut_sequence() {
    for sequence in CUT {
        for pause in [0, 300] {
            let mut session = Session::start(80, 24);
            session.wait_for(OPENING);
            session.send(sequence);
            thread::sleep(Duration::from_millis(pause));
            session.send("\x03");
            assert!(session.assert_left_without_trace().success(), "{sequence:?} {pause}");
        }
    }
}

#[test]
fn other_keys_are_heard_too() {
    // How long each may stand still on its way: a tenth of a second, and a paste ten times as long.
    for (sequence, pause) in [("\x1b[<", 300), ("\x1b[<0;", 300), ("\x1b[?", 300), ("\x1b[200~half a paste", 1500)] {
        let mut session = Session::start(80, 24);
        session.wait_for(OPENING);
        session.send(sequence);
        thread::sleep(Duration::from_millis(pause));
        session.send("?");
        session.wait_for("Placing the balls");
        session.send("\x03");
        assert!(session.assert_left_without_trace().success());
    }
}

#[test]
fn a_paste_right_behind_an_escape_runs_no_keys() {
    let mut session = Session::start(80, 24);
    session.wait_for(OPENING);
    session.send("\x1b\x1b[200~qqq\x1b[201~");
    session.send("?");
    session.wait_for("Placing the balls");
}

#[test]
fn ctrl_c_quits_from_help_messages_and_palette() {
    for keys in ["?", ":", "d", "t"] {
        let mut session = Session::start(80, 24);
        session.wait_for(OPENING);
        session.press(keys);
        session.send("\x03");
        assert!(session.assert_left_without_trace().success(), "{keys}");
    }
}
