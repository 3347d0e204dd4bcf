//! A table is calibrated in the program: every stroke survives any end of the program, and the command line continues with it.

use std::fs;

use crate::{
    program::asked,
    terminal::{OPENING, PATIENCE, REST, Session, carom},
};

#[test]
fn a_stroke_that_was_entered_is_there_after_the_program_was_killed() {
    let home = tempfile::tempdir().unwrap();
    let start = || {
        let mut session = Session::start_at(home.path(), carom(), 80, 24);
        session.wait_for(OPENING);
        session.send("\x1b[18~");
        session.wait_for("Strokes of slow-roll");
        session
    };
    let mut first = start();
    first.wait_for("1 halves a doubt)");
    first.send("\r9.6\r5.4\r725 mm\r\r");
    first.wait_for("1/2");
    first.wait_for("mu_r");
    // Typed, but not saved yet.
    first.send("\r8.8\r");
    first.wait_for("8.8");
    first.signal("KILL");
    first.child.wait().unwrap();
    let kept = fs::read_to_string(home.path().join("data/carom/calibration.toml")).unwrap();
    assert_eq!(kept.matches("[[trial]]").count(), 1, "{kept}");
    let mut second = start();
    second.wait_for("9.6, 5.4, 725 mm");
    second.wait_for("mu_r");
    second.send("q");
    assert!(second.assert_left_without_trace().success());
    let mut command = asked(&["calibrate"]);
    command.env("HOME", home.path()).env("XDG_DATA_HOME", home.path().join("data"));
    let said = command.write_stdin("9.4 5.3\ndone\n").output().unwrap();
    assert!(String::from_utf8_lossy(&said.stdout).contains("slow-back (1)"), "{said:?}");
    let kept = fs::read_to_string(home.path().join("data/carom/calibration.toml")).unwrap();
    assert_eq!(kept.matches("[[trial]]").count(), 2, "{kept}");
}

#[test]
fn what_is_typed_in_part_is_there_at_the_next_start_whatever_ended_the_program() {
    let home = tempfile::tempdir().unwrap();
    let start = || {
        let mut session = Session::start_at(home.path(), carom(), 80, 24);
        session.wait_for(OPENING);
        session
    };
    let mut session = start();
    session.send("\x1b[18~");
    session.wait_for("Strokes of slow-roll");
    session.press("\r");
    for (ending, text) in [("HUP", "9"), ("TERM", ".6"), ("cut", "1"), ("quit", "2"), ("", "3")] {
        session.send(text);
        session.settle(REST);
        match ending {
            "cut" => session.cut(),
            "quit" => session.send("\x03"),
            "" => break,
            signal => session.signal(signal),
        }
        session.ends_within(PATIENCE);
        session = start();
        session.wait_for("a stroke of slow-roll that was typed in part");
        session.send("\x1b[18~");
        session.wait_for("Strokes of slow-roll");
    }
    session.wait_for("9.6123");
    // A field that was emptied stays empty.
    session.send("\x15");
    session.settle(REST);
    session.send("\x1b");
    session.settle(REST);
    session.send("\x03");
    session.ends_within(PATIENCE);
    let mut last = start();
    last.settle(REST);
    assert!(!last.screen().contents().contains("typed in part"), "{}", last.screen().contents());
    last.send("q");
    assert!(last.assert_left_without_trace().success());
}
