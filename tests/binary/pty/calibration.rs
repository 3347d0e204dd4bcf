//! A table is calibrated in the program: every stroke survives any end of the program, and the command line continues with it.

use std::fs;

use crate::{
    program::{carom_command, finished},
    terminal::{QUIET_TIME, Session, TIMEOUT, carom},
};

#[test]
fn entered_strokes_survive_a_kill() {
    let home = tempfile::tempdir().unwrap();
    let start = || {
        let mut session = Session::start_at(home.path(), carom(), 80, 24).ready();
        session.send("\x1b[18~");
        session.wait_for("Strokes of slow-roll");
        session
    };
    let mut first = start();
    first.wait_for("five-plain helps most (3.8 bits)");
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
    second.quit_with("q");
    let mut command = carom_command(&["calibrate"]);
    command.env("HOME", home.path()).env("XDG_DATA_HOME", home.path().join("data"));
    let printed = finished(command.write_stdin("9.4 5.3\ndone\n"));
    assert!(printed.out.contains("slow-back (1)"), "{}", printed.out);
    let kept = fs::read_to_string(home.path().join("data/carom/calibration.toml")).unwrap();
    assert_eq!(kept.matches("[[trial]]").count(), 2, "{kept}");
}

#[test]
fn partly_typed_strokes_survive_every_end_of_the_program() {
    let home = tempfile::tempdir().unwrap();
    let start = || Session::start_at(home.path(), carom(), 80, 24).ready();
    let mut session = start();
    session.send("\x1b[18~");
    session.wait_for("Strokes of slow-roll");
    session.press("\r");
    for (ending, text) in [("HUP", "9"), ("TERM", ".6"), ("cut", "1"), ("quit", "2"), ("", "3")] {
        session.send(text);
        session.wait_until_quiet(QUIET_TIME);
        match ending {
            "cut" => session.disconnect(),
            "quit" => session.send("\x03"),
            "" => break,
            signal => session.signal(signal),
        }
        session.wait_for_exit(TIMEOUT);
        session = start();
        session.wait_for("a stroke of slow-roll that was typed in part");
        session.send("\x1b[18~");
        session.wait_for("Strokes of slow-roll");
    }
    session.wait_for("9.6123");
    // A field that was emptied stays empty.
    session.send("\x15");
    session.wait_until_quiet(QUIET_TIME);
    session.send("\x1b");
    session.wait_until_quiet(QUIET_TIME);
    session.send("\x03");
    session.wait_for_exit(TIMEOUT);
    let mut last = start();
    last.wait_until_quiet(QUIET_TIME);
    assert!(!last.screen().contents().contains("typed in part"), "{}", last.screen().contents());
    last.quit_with("q");
}
