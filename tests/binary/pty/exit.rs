//! Every way to leave the program restores the terminal and saves the work.

use std::time::{Duration, Instant};

use portable_pty::CommandBuilder;

use crate::terminal::{QUIET_TIME, START_TEXT, Session, TIMEOUT, carom};

#[test]
fn the_session_can_be_resumed_and_warnings_are_logged() {
    let home = tempfile::tempdir().unwrap();
    let start = || Session::start_at(home.path(), carom(), 80, 24);
    let mut first = start();
    first.wait_for("white at x -710.0 mm, y 182.5 mm");
    first.send("\x1b[1;2B");
    first.wait_for("white at x -710.0 mm, y 82.5 mm");
    first.send("[");
    first.wait_for("there is no");
    first.signal("HUP");
    first.assert_clean_exit();
    // A session without any action changes nothing.
    for _ in 0..2 {
        let mut second = start();
        second.wait_for("c goes on from where the last session ended");
        second.quit_with("q");
    }
    let mut third = start();
    third.wait_for("c goes on");
    third.send("c");
    third.wait_for("this is where the last session ended");
    third.send("\t\x1b[Z");
    third.wait_for("white at x -710.0 mm, y 82.5 mm");
    third.quit_with("q");
    let log = std::fs::read_to_string(home.path().join("state/carom/carom.log")).unwrap();
    assert!(log.contains("the screen opens") && log.contains("WARN there is no"), "{log}");
}

#[test]
fn suspending_restores_the_terminal_and_continuing_repaints() {
    let mut session = Session::start(80, 24);
    session.send("\x1a");
    session.wait_until("the shell's screen", |screen| {
        let has_mouse = screen.mouse_protocol_mode() != vt100::MouseProtocolMode::None;
        !screen.alternate_screen() && !screen.hide_cursor() && !has_mouse
    });
    session.resume_until(START_TEXT);
    session.send("\x1b[C");
    session.wait_for("white at x -700.0 mm");
    session.quit_with("\x03");
}

#[test]
fn raw_mode_is_off_after_the_program_ends() {
    let mut command = CommandBuilder::new("sh");
    command.args(["-c", "\"$0\"; stty -a", env!("CARGO_BIN_EXE_carom")]);
    let mut session = Session::start_command(command, 120, 40).ready();
    session.send("q");
    session.wait_for(" icanon");
    session.wait_for(" echo ");
}

#[test]
fn sigterm_ends_the_program_on_every_screen() {
    let press_the_white_ball = "\x1b[<0;34;13M\x1b[<32;40;13M";
    for (keys, text) in [
        (&[":", "the"][..], " of "),
        (&["?"], "Placing the balls"),
        (&["d", "/", "half"], "The half ball"),
        (&["d", "a"], "the code of a position"),
        (&["d", "\r", " ", " "], "the shot is running"),
        (&["t", "n"], "Enter"),
        (&[press_the_white_ball], "white at x -5"),
        (&["\r"], "Esc"),
    ] {
        let mut session = Session::start(120, 40);
        for key in keys {
            session.press(key);
        }
        session.wait_for(text);
        session.signal("TERM");
        let status = session.assert_clean_exit();
        assert!(status.signal().is_some(), "{keys:?}: {status:?}");
    }
}

#[test]
fn every_screen_is_restored_after_suspending() {
    for (keys, text) in [
        (&[":"][..], " of "),
        (&["?"], "Placing the balls"),
        (&["d"], "The half ball"),
        (&["d", "\r"], "set the stroke"),
        (&["t"], "No agent"),
    ] {
        let mut session = Session::start(80, 24);
        for key in keys {
            session.press(key);
        }
        session.wait_for(text);
        session.wait_until_quiet(QUIET_TIME);
        let before = session.screen().contents();
        session.signal("TSTP");
        session.wait_until("the shell's screen", |screen| !screen.alternate_screen());
        session.assert_terminal_restored();
        session.resume_until(text);
        assert_eq!(session.screen().contents(), before);
        session.signal("TERM");
        session.assert_clean_exit();
    }
}

#[test]
fn a_shot_resumes_where_it_was_suspended() {
    let mut session = Session::start(80, 24);
    session.send("\r");
    session.wait_for_advice();
    session.send(" ");
    session.wait_until("it plays", |screen| clock(screen).is_some_and(|time| time > 0.0));
    let (start, before) = (Instant::now(), clock(session.screen()).unwrap());
    session.send("\x1a");
    session.wait_until("the shell's screen", |screen| !screen.alternate_screen());
    let (played, stopped) = (start.elapsed().as_secs_f64(), Instant::now());
    // The time in which the shot would continue.
    std::thread::sleep(Duration::from_secs(1));
    let stood = stopped.elapsed().as_secs_f64();
    session.resume_until("Contacts");
    session.wait_until("the clock", |screen| clock(screen).is_some());
    let passed = clock(session.screen()).unwrap() - before;
    let running = played + stopped.elapsed().as_secs_f64() - stood;
    assert!(passed < running + 0.5 * stood, "the shot ran on: {passed} s in {running} s");
}

/// Returns the seconds since the stroke from the first row: "1.25 / 6.50 s", or "1.25/6.50" if there is less room.
fn clock(screen: &vt100::Screen) -> Option<f64> {
    let row = screen.rows(0, 80).next()?;
    row.split('/').next()?.split_whitespace().last()?.parse().ok()
}

#[test]
fn a_kill_loses_at_most_two_seconds_of_work() {
    let mut session = Session::start(80, 24);
    // The second move follows the first one at once, and nothing else happens that would trigger a save.
    session.send("\x1b[1;2B");
    session.wait_for("y 82.5 mm");
    session.send("\x1b[1;2C");
    session.wait_for("x -610.0 mm");
    let start = Instant::now();
    while !session.saved_session().contains("[-0.61,0.0824") {
        assert!(start.elapsed() < Duration::from_secs(4), "{}", session.saved_session());
        session.count_bytes(Duration::from_millis(50));
    }
    session.signal("KILL");
    session.wait_for_exit(TIMEOUT);
}

#[test]
fn a_session_that_is_left_is_not_offered_again() {
    let mut session = Session::start(80, 24);
    let file = session.home().unwrap().join("state/carom/last.json");
    let saved = || std::fs::read_to_string(&file).unwrap_or_default();
    session.send("d");
    session.wait_for("The half ball");
    session.send("\r");
    session.wait_until("the drill is saved", |_| saved().contains("half-ball"));
    session.send("\x1b");
    session.wait_for("Enter open");
    session.wait_until("nothing is saved", |_| saved().is_empty());
    session.send("\x03");
    session.wait_for_exit(TIMEOUT);
}

#[test]
fn an_interrupted_exam_can_be_resumed() {
    let home = tempfile::tempdir().unwrap();
    let start = || Session::start_at(home.path(), carom(), 80, 24);
    let mut first = start();
    first.wait_for(START_TEXT);
    first.send("d");
    first.wait_for("The half ball");
    first.send("e");
    first.wait_for("Enter begins");
    first.send("\r");
    first.wait_for("exercise 1 of 20:");
    first.send("  ");
    first.wait_for("to the end");
    first.send("\r");
    first.wait_for("next");
    first.send("\r");
    first.wait_for("exercise 2 of 20");
    first.signal("HUP");
    first.assert_clean_exit();
    // The exam remains available, whatever is done meanwhile.
    let mut second = start();
    second.wait_for("c goes on with the exam");
    second.send("\x1b[1;2B");
    second.wait_for("white at x -710.0 mm, y 82.5 mm");
    second.send("d");
    second.wait_for("The half ball");
    second.send("\r  ");
    second.wait_for("to the end");
    second.quit_with("q");
    let mut third = start();
    third.wait_for("c goes on with the exam");
    third.send("c");
    third.wait_for("exercise 2 of 20");
    third.quit_with("q");
}

#[test]
fn an_unwritable_state_folder_is_reported_once() {
    let home = tempfile::tempdir().unwrap();
    std::fs::create_dir(home.path().join("state")).unwrap();
    std::fs::write(home.path().join("state/carom"), "in the way").unwrap();
    let mut session = Session::start_at(home.path(), carom(), 80, 24).ready();
    session.send("\x1b[C");
    // A word of the sentence, which is broken into rows.
    session.wait_for("cannot");
    session.quit_with("q");
}

#[test]
fn attempts_that_the_disk_has_refused_are_saved_or_named_at_the_end() {
    for is_mended in [true, false] {
        let home = tempfile::tempdir().unwrap();
        let sessions = home.path().join("data/carom/sessions");
        std::fs::create_dir_all(sessions.parent().unwrap()).unwrap();
        std::fs::write(&sessions, "in the way").unwrap();
        let mut session = Session::start_at(home.path(), carom(), 80, 24).ready();
        session.send("d");
        session.wait_for("The half ball");
        session.send("\rm");
        session.wait_for("the note counts here");
        if is_mended {
            std::fs::remove_file(&sessions).unwrap();
        }
        session.quit_with("q");
        let is_told = session.screen().contents().contains("not saved: 1 attempt at ");
        assert_eq!((sessions.is_dir(), is_told), (is_mended, !is_mended), "{}", session.screen().contents());
    }
}
