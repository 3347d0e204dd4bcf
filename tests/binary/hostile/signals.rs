//! Every catchable signal restores the terminal; a file size limit is reported like a full disk.

use crate::{program, terminal::Session};

const TERMINATING: [&str; 18] = [
    "HUP", "INT", "QUIT", "TERM", "USR1", "USR2", "ALRM", "XCPU", "VTALRM", "PROF", "IO", "PWR", "ABRT", "STKFLT",
    "SYS", "TRAP", "34", "64",
];

#[test]
fn every_terminating_signal_restores_the_terminal() {
    for name in TERMINATING {
        for keys in ["", "\r", "?", "d"] {
            let mut session = Session::start(80, 24);
            session.send(keys);
            session.signal(name);
            assert!(!session.assert_clean_exit().success(), "{name} is told to the parent");
        }
    }
}

#[test]
fn a_file_size_signal_does_not_end_the_screen() {
    let mut session = Session::start(80, 24);
    session.signal("XFSZ");
    session.send("?");
    session.wait_for("Placing the balls");
    session.quit_with("\x03");
}

#[test]
fn a_file_size_limit_fails_a_command_without_partial_files() {
    let folder = program::folder();
    let mut shell = program::program(folder.path(), "sh".as_ref());
    let carom = env!("CARGO_BIN_EXE_carom");
    shell.args(["-c", "ulimit -f 0; exec \"$0\" drill export out.json", carom]);
    program::outcome(shell.spawn().unwrap()).fails(1, &["out.json cannot be written: ", "too large"]);
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| name == "carom" || name == "state"), "{left:?}");

    let mut shell = program::program(folder.path(), "sh".as_ref());
    shell.args(["-c", "ulimit -f 0; exec \"$0\" table > table.txt", carom]);
    program::outcome(shell.spawn().unwrap()).fails(1, &["the output cannot be written"]);
}
