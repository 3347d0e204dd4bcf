//! Every catchable signal restores the terminal; a file size limit is reported like a full disk.

use crate::{
    program,
    terminal::{OPENING, Session},
};

const ENDING: [&str; 18] = [
    "HUP", "INT", "QUIT", "TERM", "USR1", "USR2", "ALRM", "XCPU", "VTALRM", "PROF", "IO", "PWR", "ABRT", "STKFLT",
    "SYS", "TRAP", "34", "64",
];

#[test]
fn every_signal_that_ends_the_program_gives_the_terminal_back() {
    for name in ENDING {
        for keys in ["", "\r", "?", "d"] {
            let mut session = Session::start(80, 24);
            session.wait_for(OPENING);
            session.send(keys);
            session.signal(name);
            assert!(!session.assert_left_without_trace().success(), "{name} is told to the parent");
        }
    }
}

#[test]
fn a_limit_on_the_size_of_files_ends_nothing_in_the_screen() {
    let mut session = Session::start(80, 24);
    session.wait_for(OPENING);
    session.signal("XFSZ");
    session.send("?");
    session.wait_for("Placing the balls");
    session.send("\x03");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn on_the_command_line_it_is_an_error_with_a_sentence_and_leaves_nothing_half_done() {
    let folder = program::folder();
    let mut shell = program::program(folder.path(), "sh".as_ref());
    let carom = env!("CARGO_BIN_EXE_carom");
    shell.args(["-c", "ulimit -f 0; exec \"$0\" drill export out.json", carom]);
    let said = program::outcome(shell.spawn().unwrap());
    assert_eq!(said.code, Some(1), "{}", said.err);
    assert!(said.err.contains("out.json cannot be written: ") && said.err.contains("too large"), "{}", said.err);
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| name == "carom" || name == "state"), "{left:?}");

    let mut shell = program::program(folder.path(), "sh".as_ref());
    shell.args(["-c", "ulimit -f 0; exec \"$0\" table > table.txt", carom]);
    let said = program::outcome(shell.spawn().unwrap());
    assert_eq!(said.code, Some(1), "{}", said.err);
    assert!(said.err.contains("the output cannot be written"), "{}", said.err);
}
