//! Connections that are slow, stalled, or cut.

use std::{
    fs, thread,
    time::{Duration, Instant},
};

use crate::{
    terminal::{OPENING, PATIENCE, REST, Session, carom},
    training::common::{SHORT, done, folder},
};

/// Time in which a program without a terminal must end; a loaded machine may need long.
const SOON: Duration = Duration::from_secs(5);

/// Starts a session, moves the white ball so that there is something to save, and types these keys; the space bar plays the shot.
fn begun(keys: &[&str]) -> Session {
    let mut session = Session::start(120, 40);
    session.wait_for(OPENING);
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
fn a_line_that_is_cut_ends_the_program_and_what_was_done_is_kept() {
    for keys in [&[][..], &["\r"], &["\r", " "], &["d", "\r"], &["t"], &[":"]] {
        let mut session = begun(keys);
        session.cut();
        let status = session.ends_within(SOON);
        // Either is right: the program may notice the signal or the end of the input first.
        assert!(!status.success(), "{keys:?}: {status:?}");
        assert!(session.last().contains(",0.0824"), "{keys:?}: {}", session.last());
    }
}

#[test]
fn without_a_signal_too_the_end_of_the_line_is_the_end() {
    // The program does not control the terminal, so it gets no signal when the terminal is gone.
    let mut command = carom();
    command.set_controlling_tty(false);
    let mut session = Session::start_command(command, 80, 24);
    session.wait_for(OPENING);
    session.cut();
    session.ends_within(SOON);
}

/// Largest size of a picture in bytes, and largest delay of the screen, s.
const PICTURE: u64 = 3_000;
const LATE: f64 = 0.5;

/// Reads nothing until the connection is full and the program stops writing; returns the total number of bytes that it has written so far.
fn fill(session: &Session) -> u64 {
    let (mut written, mut silent) = (session.written(), 0);
    let start = Instant::now();
    while silent < 10 {
        assert!(start.elapsed() < PATIENCE, "the line is never full");
        thread::sleep(Duration::from_millis(50));
        let now = session.written();
        silent = if now == written { silent + 1 } else { 0 };
        written = now;
    }
    written.unwrap()
}

/// Reads output until the screen shows something; returns the number of bytes before that.
fn taken_until(session: &mut Session, what: &str, is_shown: impl Fn(&Session) -> bool) -> u64 {
    let (start, before) = (Instant::now(), session.bytes);
    while !is_shown(session) {
        assert!(start.elapsed() < PATIENCE, "never came: {what}\n{}", session.screen().contents());
        session.take(Duration::from_millis(20)).unwrap();
    }
    (session.bytes - before) as u64
}

/// Returns the time of the shot in the header, and the length of the shot, s.
fn shown(session: &Session) -> Option<(f64, f64)> {
    let header = session.screen().rows(0, 120).next()?;
    let (before, behind) = header.split_once('/')?;
    let number = |word: Option<&str>| word?.trim().parse().ok();
    Some((number(before.split_whitespace().next_back())?, number(behind.split_whitespace().next())?))
}

#[test]
fn on_a_slow_line_pictures_are_left_out_and_a_key_is_answered_as_soon_as_the_line_allows() {
    let mut session = begun(&["\r"]);
    session.wait_for_advice();
    session.settle(REST);
    let Some(before) = session.written() else { return };
    session.send(" ");
    let start = Instant::now();
    let held = fill(&session) - before;
    // One more second, in which thirty pictures would be drawn.
    thread::sleep(Duration::from_secs(1));
    // The buffered output shows the past; the picture after it shows the present.
    let is_late = |(moment, _): (f64, f64)| -> bool { start.elapsed().as_secs_f64() - moment > LATE };
    let bytes = taken_until(&mut session, "the present", |session| shown(session).is_some_and(|shown| !is_late(shown)));
    assert!(bytes < held + PICTURE, "{bytes} bytes came, of which the line held {held}");
    let (moment, length) = shown(&session).unwrap();
    assert!(moment < length, "the shot goes on: {moment} of {length} s");
    // A key that is pressed while the connection is full is answered by the first picture after that.
    let before = session.written().unwrap();
    let held = fill(&session) - before;
    session.send(" ");
    let bytes = taken_until(&mut session, "the pause", |session| session.screen().contents().contains('‖'));
    assert!(bytes < held + PICTURE, "{bytes} bytes came before the answer, of which the line held {held}");
    session.send("q");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn on_a_line_that_stands_still_the_program_can_be_ended_and_gives_the_terminal_back() {
    let mut session = begun(&["\r", " "]);
    // Nothing is read: the connection is full when the program stops writing. Each view is another picture.
    let (mut written, mut silent) = (session.written(), 0);
    for _ in 0..60 {
        session.send("v");
        thread::sleep(Duration::from_millis(50));
        let now = session.written();
        silent = if now.is_some() && now == written { silent + 1 } else { 0 };
        written = now;
        if silent == 10 {
            break;
        }
    }
    session.signal("TERM");
    let status = session.ends_within(SOON);
    assert!(status.signal().is_some(), "{status:?}");
    assert!(session.last().contains(",0.0824"), "{}", session.last());
    // The output that is still buffered ends with the restored terminal.
    session.assert_left_without_trace();
}

#[test]
fn a_line_that_is_cut_while_a_run_is_watched_ends_the_watching() {
    let folder = folder();
    let run = folder.path().join("run");
    done(folder.path(), &format!("{SHORT} --run run"));
    assert!(fs::exists(run.join("metrics.jsonl")).unwrap());
    let mut command = carom();
    command.arg("watch");
    command.arg(&run);
    let mut session = Session::start_command(command, 120, 40);
    session.wait_for("finished");
    session.cut();
    assert!(!session.ends_within(PATIENCE).success());
}
