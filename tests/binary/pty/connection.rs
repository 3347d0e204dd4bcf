//! Connections that are slow, stalled, or cut.

use std::{
    fs, thread,
    time::{Duration, Instant},
};

use crate::{
    terminal::{QUIET_TIME, Session, TIMEOUT, carom},
    training::common::{SHORT, folder, run_ok},
};

/// Time in which a program without a terminal must end; a loaded machine may need long.
const EXIT_TIMEOUT: Duration = Duration::from_secs(5);

/// Starts a session, moves the white ball so that there is something to save, and types these keys; the space bar plays the shot.
fn start_and_press(keys: &[&str]) -> Session {
    let mut session = Session::start(120, 40);
    session.send("\x1b[1;2B");
    session.wait_for("y 82.5 mm");
    for key in keys {
        if *key == " " {
            session.wait_for_advice();
        }
        session.press(key);
    }
    session
}

#[test]
fn a_cut_connection_ends_the_program_and_saves_the_session() {
    for keys in [&[][..], &["\r"], &["\r", " "], &["d", "\r"], &["t"], &[":"]] {
        let mut session = start_and_press(keys);
        session.disconnect();
        let status = session.wait_for_exit(EXIT_TIMEOUT);
        // Either is right: the program may notice the signal or the end of the input first.
        assert!(!status.success(), "{keys:?}: {status:?}");
        assert!(session.saved_session().contains(",0.0824"), "{keys:?}: {}", session.saved_session());
    }
}

#[test]
fn end_of_input_ends_the_program_without_a_signal() {
    // The program does not control the terminal, so it gets no signal when the terminal is gone.
    let mut command = carom();
    command.set_controlling_tty(false);
    let mut session = Session::start_command(command, 80, 24).ready();
    session.disconnect();
    session.wait_for_exit(EXIT_TIMEOUT);
}

/// Largest size of a picture in bytes, and largest delay of the screen, s.
const MAX_FRAME_BYTES: u64 = 3_000;
const MAX_DELAY: f64 = 0.5;

/// Reads nothing until the connection is full and the program stops writing; returns the total number of bytes that it has written so far.
fn wait_until_full(session: &Session) -> u64 {
    let (mut written, mut silent) = (session.bytes_written(), 0);
    let start = Instant::now();
    while silent < 10 {
        assert!(start.elapsed() < TIMEOUT, "the connection is never full");
        thread::sleep(Duration::from_millis(50));
        let now = session.bytes_written();
        silent = if now == written { silent + 1 } else { 0 };
        written = now;
    }
    written.unwrap()
}

/// Reads output until the screen shows something; returns the number of bytes before that.
fn read_until(session: &mut Session, what: &str, is_shown: impl Fn(&Session) -> bool) -> u64 {
    let (start, before) = (Instant::now(), session.bytes);
    while !is_shown(session) {
        assert!(start.elapsed() < TIMEOUT, "timed out waiting for: {what}\n{}", session.screen().contents());
        session.read_output(Duration::from_millis(20)).unwrap();
    }
    (session.bytes - before) as u64
}

/// Returns the time of the shot in the header, and the length of the shot, s.
fn shot_time(session: &Session) -> Option<(f64, f64)> {
    let header = session.screen().rows(0, 120).next()?;
    let (before, behind) = header.split_once('/')?;
    let number = |word: Option<&str>| word?.trim().parse().ok();
    Some((number(before.split_whitespace().next_back())?, number(behind.split_whitespace().next())?))
}

#[test]
fn a_slow_connection_skips_frames_and_keys_are_answered_promptly() {
    let mut session = start_and_press(&["\r"]);
    session.wait_for_advice();
    session.wait_until_quiet(QUIET_TIME);
    let Some(before) = session.bytes_written() else { return };
    session.send(" ");
    let start = Instant::now();
    let held = wait_until_full(&session) - before;
    // One more second, in which thirty pictures would be drawn.
    thread::sleep(Duration::from_secs(1));
    // The buffered output shows the past; the picture after it shows the present.
    let is_late = |(moment, _): (f64, f64)| -> bool { start.elapsed().as_secs_f64() - moment > MAX_DELAY };
    let bytes =
        read_until(&mut session, "the present", |session| shot_time(session).is_some_and(|shown| !is_late(shown)));
    assert!(bytes < held + MAX_FRAME_BYTES, "{bytes} bytes came, of which the line held {held}");
    let (moment, length) = shot_time(&session).unwrap();
    assert!(moment < length, "the shot goes on: {moment} of {length} s");
    // A key that is pressed while the connection is full is answered by the first picture after that.
    let before = session.bytes_written().unwrap();
    let held = wait_until_full(&session) - before;
    session.send(" ");
    let bytes = read_until(&mut session, "the pause", |session| session.screen().contents().contains('‖'));
    assert!(bytes < held + MAX_FRAME_BYTES, "{bytes} bytes came before the answer, of which the line held {held}");
    session.quit_with("q");
}

#[test]
fn a_stalled_connection_can_be_ended_and_restores_the_terminal() {
    let mut session = start_and_press(&["\r", " "]);
    // Nothing is read: the connection is full when the program stops writing. Each view is another picture.
    let (mut written, mut silent) = (session.bytes_written(), 0);
    for _ in 0..60 {
        session.send("v");
        thread::sleep(Duration::from_millis(50));
        let now = session.bytes_written();
        silent = if now.is_some() && now == written { silent + 1 } else { 0 };
        written = now;
        if silent == 10 {
            break;
        }
    }
    session.signal("TERM");
    let status = session.wait_for_exit(EXIT_TIMEOUT);
    assert!(status.signal().is_some(), "{status:?}");
    assert!(session.saved_session().contains(",0.0824"), "{}", session.saved_session());
    // The output that is still buffered ends with the restored terminal.
    session.assert_clean_exit();
}

#[test]
fn a_cut_connection_ends_the_watching_of_a_run() {
    let folder = folder();
    let run = folder.path().join("run");
    run_ok(folder.path(), &format!("{SHORT} --run run"));
    assert!(fs::exists(run.join("metrics.jsonl")).unwrap());
    let mut command = carom();
    command.arg("watch");
    command.arg(&run);
    let mut session = Session::start_command(command, 120, 40);
    session.wait_for("finished");
    session.disconnect();
    assert!(!session.wait_for_exit(TIMEOUT).success());
}
