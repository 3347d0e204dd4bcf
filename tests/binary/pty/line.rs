//! Lines that are slow, stand still, or are cut.

use std::{fs, time::Duration};

use crate::{
    terminal::{OPENING, PATIENCE, REST, Session, carom},
    training::common::{SHORT, done, folder},
};

/// Time in which a program without a terminal has to be gone; a loaded machine may take long.
const SOON: Duration = Duration::from_secs(5);

/// The white ball is moved, so that there is something to keep, and these keys are typed, of which the space bar plays a
/// shot that is there.
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
        // Either is right: whichever of the signal and the end of the input is noticed first.
        assert!(!status.success(), "{keys:?}: {status:?}");
        assert!(session.last().contains(",0.0824"), "{keys:?}: {}", session.last());
    }
}

#[test]
fn without_a_signal_too_the_end_of_the_line_is_the_end() {
    // Nobody is told that a terminal is gone which controls nobody.
    let mut command = carom();
    command.set_controlling_tty(false);
    let mut session = Session::start_command(command, 80, 24);
    session.wait_for(OPENING);
    session.cut();
    session.ends_within(SOON);
}

#[test]
fn on_a_slow_line_pictures_are_left_out_and_a_key_is_answered_as_soon_as_the_line_allows() {
    let mut session = begun(&["\r", " "]);
    // At 2 KB/s, of which playback could fill three times as many.
    for _ in 0..40 {
        let start = std::time::Instant::now();
        let bytes = session.take(Duration::from_millis(100)).map_or(0, |bytes| bytes.len());
        std::thread::sleep(Duration::from_millis(bytes as u64 / 2).saturating_sub(start.elapsed()));
    }
    let before = session.bytes;
    session.send("q");
    assert!(session.assert_left_without_trace().success());
    // What a pseudo-terminal holds, and a picture.
    assert!(session.bytes - before < 16_000, "{} bytes were on their way", session.bytes - before);
}

#[test]
fn on_a_line_that_stands_still_the_program_can_be_ended_and_gives_the_terminal_back() {
    let mut session = begun(&["\r", " "]);
    // Nobody reads: the line is full when the program writes no more. Each view is a picture of its own.
    let (mut written, mut silent) = (session.written(), 0);
    for _ in 0..60 {
        session.send("v");
        std::thread::sleep(Duration::from_millis(50));
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
    // What the line still holds ends with that.
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
    session.settle(REST);
    session.cut();
    assert!(!session.ends_within(PATIENCE).success());
}
