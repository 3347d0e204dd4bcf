//! The real binary in a pseudo-terminal: a session from start to end, and every way of leaving.

use std::{
    io::{Read, Write},
    num::NonZero,
    path::Path,
    process::Command,
    sync::mpsc::{Receiver, RecvTimeoutError, channel},
    thread,
    time::{Duration, Instant},
};

use carom::learning::run::list::{Stage, runs_in};
use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use tempfile::TempDir;

/// Longest time that a test waits for a picture, s; a loaded machine may take long to start a process.
const PATIENCE: Duration = Duration::from_secs(20);

fn cells(count: u16) -> NonZero<u16> {
    NonZero::new(count).unwrap()
}

struct Session {
    master: Box<dyn MasterPty + Send>,
    child: Box<dyn Child + Send + Sync>,
    writer: Box<dyn Write + Send>,
    output: Receiver<Vec<u8>>,
    screen: vt100::Parser,
    /// Settings, the last session and the log: not those of whoever runs the tests.
    home: Option<TempDir>,
    /// Bytes and writes seen so far.
    bytes: usize,
}

impl Session {
    fn start(width: u16, height: u16) -> Self {
        Self::start_command(CommandBuilder::new(env!("CARGO_BIN_EXE_carom")), width, height)
    }

    fn start_command(command: CommandBuilder, width: u16, height: u16) -> Self {
        let home = tempfile::tempdir().unwrap();
        let mut session = Self::start_at(home.path(), command, width, height);
        session.home = Some(home);
        session
    }

    fn start_at(home: &Path, mut command: CommandBuilder, width: u16, height: u16) -> Self {
        command.env("XDG_STATE_HOME", home.join("state"));
        command.env("XDG_CONFIG_HOME", home.join("config"));
        let size = PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        for (name, value) in [("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("LC_ALL", "C.UTF-8")] {
            command.env(name, value);
        }
        command.env_remove("NO_COLOR");
        command.env_remove("CAROM_GLYPHS");
        let child = pair.slave.spawn_command(command).unwrap();
        let mut reader = pair.master.try_clone_reader().unwrap();
        let (sender, output) = channel();
        thread::spawn(move || {
            let mut buffer = vec![0; 65536];
            while let Ok(count @ 1..) = reader.read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        let writer = pair.master.take_writer().unwrap();
        let screen = vt100::Parser::new(cells(height), cells(width), 0);
        Self { master: pair.master, child, writer, output, screen, home: None, bytes: 0 }
    }

    fn send(&mut self, keys: &str) {
        self.writer.write_all(keys.as_bytes()).unwrap();
        self.writer.flush().unwrap();
    }

    fn signal(&self, name: &str) {
        let id = self.child.process_id().unwrap().to_string();
        assert!(Command::new("kill").args([&format!("-{name}"), &id]).status().unwrap().success());
    }

    /// Reads what comes within `time`; `false` once the other side is closed.
    fn read(&mut self, time: Duration) -> bool {
        match self.output.recv_timeout(time) {
            Ok(bytes) => {
                self.bytes += bytes.len();
                self.screen.process(&bytes);
                true
            }
            Err(RecvTimeoutError::Timeout) => true,
            Err(RecvTimeoutError::Disconnected) => false,
        }
    }

    fn wait_until(&mut self, what: &str, condition: impl Fn(&vt100::Screen) -> bool) {
        let start = Instant::now();
        while !condition(self.screen.screen()) {
            assert!(start.elapsed() < PATIENCE, "never came: {what}\n{}", self.screen.screen().contents());
            self.read(Duration::from_millis(50));
        }
    }

    fn wait_for(&mut self, text: &str) {
        self.wait_until(text, |screen| screen.contents().contains(text));
    }

    /// Bytes that come within `time`.
    fn count(&mut self, time: Duration) -> usize {
        let (start, before) = (Instant::now(), self.bytes);
        while start.elapsed() < time {
            self.read(time.saturating_sub(start.elapsed()));
        }
        self.bytes - before
    }

    /// Waits for the end of the process and of its output; the terminal has to be as it was.
    fn assert_left_without_trace(&mut self) -> portable_pty::ExitStatus {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < PATIENCE, "it does not end\n{}", self.screen.screen().contents());
            self.read(Duration::from_millis(20));
        };
        while self.read(Duration::from_millis(100)) && self.count(Duration::from_millis(50)) > 0 {}
        let screen = self.screen.screen();
        assert!(!screen.alternate_screen(), "the alternate screen was left on");
        assert!(!screen.hide_cursor(), "the cursor was left hidden");
        assert_eq!(screen.mouse_protocol_mode(), vt100::MouseProtocolMode::None);
        status
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // It has ended already where the test went well.
        let _ = self.child.kill();
    }
}

#[test]
fn a_player_places_a_ball_gets_a_shot_watches_it_and_quits() {
    let mut session = Session::start(80, 24);
    session.wait_for("white at x -710.0 mm, y 0.0 mm");
    assert!(session.screen.screen().alternate_screen() && session.screen.screen().hide_cursor());
    session.send("\x1b[B\x1b[1;2B");
    session.wait_for("white at x -710.0 mm, y -110.0 mm");
    session.send("\r");
    session.wait_for("Events 0/");
    session.wait_for("‖");
    session.send(".");
    session.wait_for("Events 1/");
    session.send(" ");
    session.wait_until("it plays", |screen| !screen.contents().contains('‖'));
    session.wait_until("the next event", |screen| !screen.contents().contains("Events 1/"));
    session.send(" ?");
    session.wait_for("Placing the balls");
    // Escape and q at once would be Alt-q.
    session.send("?q");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn it_costs_nothing_while_nothing_moves() {
    let mut session = Session::start(120, 40);
    session.wait_for("white at x -710.0 mm");
    session.count(Duration::from_millis(200));
    assert_eq!(session.count(Duration::from_millis(500)), 0);
}

#[test]
fn playback_stays_small_enough_for_a_slow_link() {
    let mut session = Session::start(120, 40);
    session.wait_for("white at x -710.0 mm");
    session.send("\r");
    session.wait_for("‖");
    session.send(" ");
    session.wait_until("it plays", |screen| !screen.contents().contains('‖'));
    let frame = session.count(Duration::from_secs(1)) / 30;
    // 230 in the first seconds of a shot, when most balls move; 540 with crossterm's backend.
    assert!((20..450).contains(&frame), "{frame} bytes a frame");
}

#[test]
fn a_resize_repaints_and_a_small_terminal_says_so() {
    let mut session = Session::start(80, 24);
    session.wait_for("white at x -710.0 mm");
    for (width, height, text) in [(60, 20, "60×20"), (120, 40, "Shift x10")] {
        session.master.resize(PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 }).unwrap();
        session.screen.screen_mut().set_size(cells(height), cells(width));
        session.wait_for(text);
    }
    session.send("q");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn signals_restore_the_terminal_and_still_end_the_program() {
    for name in ["TERM", "INT", "HUP"] {
        let mut session = Session::start(80, 24);
        session.wait_for("white at x -710.0 mm");
        session.signal(name);
        let status = session.assert_left_without_trace();
        assert!(!status.success(), "{name}: {status:?}");
    }
}

#[test]
fn what_was_done_is_offered_again_after_any_end_and_trouble_is_written_down() {
    let home = tempfile::tempdir().unwrap();
    let start = || Session::start_at(home.path(), CommandBuilder::new(env!("CARGO_BIN_EXE_carom")), 80, 24);
    let mut first = start();
    first.wait_for("white at x -710.0 mm, y 0.0 mm");
    first.send("\x1b[1;2B");
    first.wait_for("white at x -710.0 mm, y -100.0 mm");
    first.send("[");
    first.wait_for("there is no");
    first.signal("HUP");
    first.assert_left_without_trace();
    // Looking in without doing anything changes nothing.
    for _ in 0..2 {
        let mut second = start();
        second.wait_for("c goes on from where the last session ended");
        second.send("q");
        assert!(second.assert_left_without_trace().success());
    }
    let mut third = start();
    third.wait_for("c goes on");
    third.send("c");
    third.wait_for("this is where the last session ended");
    third.send("\t\x1b[Z");
    third.wait_for("white at x -710.0 mm, y -100.0 mm");
    third.send("q");
    assert!(third.assert_left_without_trace().success());
    let log = std::fs::read_to_string(home.path().join("state/carom/carom.log")).unwrap();
    assert!(log.contains("the screen opens") && log.contains("WARN there is no"), "{log}");
}

#[test]
fn suspending_gives_the_terminal_back_and_continuing_repaints() {
    let mut session = Session::start(80, 24);
    session.wait_for("white at x -710.0 mm");
    session.send("\x1a");
    session.wait_until("the shell's screen", |screen| {
        let has_mouse = screen.mouse_protocol_mode() != vt100::MouseProtocolMode::None;
        !screen.alternate_screen() && !screen.hide_cursor() && !has_mouse
    });
    // A signal that comes before the process has stopped continues nothing: as often as needed.
    let start = Instant::now();
    while !session.screen.screen().contents().contains("white at x -710.0 mm") {
        assert!(start.elapsed() < PATIENCE, "the table does not come back");
        session.signal("CONT");
        session.count(Duration::from_millis(50));
    }
    assert!(session.screen.screen().alternate_screen());
    session.send("\x1b[C");
    session.wait_for("white at x -700.0 mm");
    session.send("\x03");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn the_mouse_drags_a_ball_draws_no_more_than_keys_and_is_given_back() {
    let mut session = Session::start(120, 40);
    session.wait_for("white at x -710.0 mm, y 0.0 mm");
    let screen = session.screen.screen();
    assert_eq!(screen.mouse_protocol_mode(), vt100::MouseProtocolMode::ButtonMotion, "not every motion");
    assert_eq!(screen.mouse_protocol_encoding(), vt100::MouseProtocolEncoding::Sgr);
    session.count(Duration::from_millis(200));
    // What comes at once is below the 1,024 bytes that the input library reads at a time.
    let reports: Vec<_> = (0..70).map(|n| format!("\x1b[<32;{};{}M", 34 + n / 7, 16 + n % 2)).collect();
    let before = session.bytes;
    session.send(&format!("\x1b[<0;34;16M{}\x1b[<32;44;16M\x1b[<0;44;16m", reports.concat()));
    session.wait_for("white at x -447.0 mm, y 0.0 mm");
    session.count(Duration::from_millis(200));
    let drag = session.bytes - before;
    // A picture is about 300 bytes.
    assert!(drag < 5_000, "{drag} bytes");
    session.send("q");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn a_user_may_keep_the_mouse() {
    let home = tempfile::tempdir().unwrap();
    std::fs::create_dir(home.path().join("carom")).unwrap();
    std::fs::write(home.path().join("carom/config.toml"), "mouse = false\n").unwrap();
    let mut command = CommandBuilder::new("sh");
    command.args(["-c", "XDG_CONFIG_HOME=\"$1\" exec \"$0\"", env!("CARGO_BIN_EXE_carom")]);
    command.arg(home.path());
    let mut session = Session::start_command(command, 80, 24);
    session.wait_for("placing balls");
    assert_eq!(session.screen.screen().mouse_protocol_mode(), vt100::MouseProtocolMode::None);
}

#[test]
fn a_setting_holds_at_once_and_a_toast_goes_by_itself() {
    let home = tempfile::tempdir().unwrap();
    let mut session = Session::start_at(home.path(), CommandBuilder::new(env!("CARGO_BIN_EXE_carom")), 80, 24);
    session.wait_for("white at x -710.0 mm");
    session.send("\x1b[15~");
    session.wait_for("what is set holds at once");
    // The last setting is the mouse.
    session.send("\x1b[F\x1b[C");
    session.wait_until("the mouse is left to the terminal", |screen| {
        screen.mouse_protocol_mode() == vt100::MouseProtocolMode::None
    });
    let file = home.path().join("config/carom/config.toml");
    let start = Instant::now();
    while !std::fs::read_to_string(&file).unwrap_or_default().contains("mouse = false") {
        assert!(start.elapsed() < PATIENCE, "it is not written");
        thread::sleep(Duration::from_millis(20));
    }
    session.send("\x1bOQ");
    session.wait_for("white at x -710.0 mm");
    session.send("u");
    session.wait_for("there is nothing to take back");
    session.wait_until("the toast goes", |screen| !screen.contents().contains("there is nothing to take back"));
    assert!(session.screen.screen().contents().contains("white at x -710.0 mm"));
    session.count(Duration::from_millis(200));
    assert_eq!(session.count(Duration::from_millis(500)), 0, "and nothing is left to wake up for");
    session.send("q");
    assert!(session.assert_left_without_trace().success());
}

#[test]
fn raw_mode_is_off_again_after_the_end() {
    let mut command = CommandBuilder::new("sh");
    command.args(["-c", "\"$0\"; stty -a", env!("CARGO_BIN_EXE_carom")]);
    let mut session = Session::start_command(command, 120, 40);
    session.wait_for("white at x -710.0 mm");
    session.send("q");
    session.wait_for(" icanon");
    session.wait_for(" echo ");
}

#[test]
fn without_a_terminal_it_names_the_command_line() {
    for term in ["xterm", "dumb"] {
        let output = Command::new(env!("CARGO_BIN_EXE_carom")).env("TERM", term).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(output.stdout.is_empty());
        assert!(String::from_utf8_lossy(&output.stderr).contains("carom recommend --layout"));
    }
    let mut command = CommandBuilder::new("sh");
    command.args(["-c", "TERM=dumb \"$0\"; echo code $?", env!("CARGO_BIN_EXE_carom")]);
    let mut session = Session::start_command(command, 120, 40);
    session.wait_for("carom recommend --layout");
    session.wait_for("code 2");
}

#[test]
fn a_run_that_was_started_in_the_program_goes_on_when_the_program_has_ended() {
    let data = tempfile::tempdir().unwrap();
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_carom"));
    command.env("XDG_DATA_HOME", data.path());
    let mut session = Session::start_command(command, 80, 24);
    session.wait_for("white at x -710.0 mm");
    session.send("t");
    session.wait_for("No agent has been trained here yet.");
    session.send("n\x1b[B\x1b[B\x1b[B\x7f\x7f\x7f\x7f\x7f\x7f\x7f20000\r");
    session.wait_for("Numbers");
    session.send("q");
    assert!(session.assert_left_without_trace().success());
    // The pseudo-terminal goes with the session.
    drop(session);
    let start = Instant::now();
    loop {
        let runs = runs_in(&data.path().join("carom/runs")).unwrap_or_default().runs;
        if runs.first().is_some_and(|run| run.state == Stage::Finished && run.best_reward.is_some()) {
            break;
        }
        assert!(start.elapsed() < 9 * PATIENCE, "it does not finish: {runs:?}");
        thread::sleep(Duration::from_millis(100));
    }
}

#[test]
fn a_run_is_watched_from_two_terminals_as_it_trains_and_costs_nothing_when_it_has_ended() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    let settings = folder.path().join("small.toml");
    let small = "actor_layers = [16]\ncritic_layers = [16]\nbatch = 32\nactor_batch = 8\nshots_per_update = 16\n";
    std::fs::write(&settings, small).unwrap();
    let mut training = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(["train", "--steps", "60000", "--evaluate-every", "10000", "--evaluation-layouts", "50", "--config"])
        .args([&settings, &"--run".into(), &run])
        .stderr(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    while !run.join("metrics.jsonl").exists() {
        assert!(training.try_wait().unwrap().is_none(), "the run ended by itself");
        thread::sleep(Duration::from_millis(10));
    }
    let watch = |width, height| {
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_carom"));
        command.arg("watch");
        command.arg(&run);
        Session::start_command(command, width, height)
    };
    let mut watchers = [watch(80, 24), watch(120, 40)];
    for watcher in &mut watchers {
        watcher.wait_for("1 mean reward");
        watcher.wait_for("training");
        watcher.wait_for("Shot 1 of 8");
    }
    // Where nobody looks on any more, the training goes on; whoever still does sees it end.
    let [left, mut stays] = watchers;
    drop(left);
    let watched = stays.count(Duration::from_secs(2));
    assert!(training.wait().unwrap().success());
    stays.wait_for("finished");
    stays.send(".");
    stays.count(Duration::from_millis(500));
    assert_eq!(stays.count(Duration::from_secs(2)), 0, "the run has ended, and no shot plays");
    // Each second ten pictures of some hundreds of bytes at most; 2,300 bytes a second were measured.
    assert!((100..40_000).contains(&watched), "{watched} bytes in two seconds");
    stays.send("q");
    assert!(stays.assert_left_without_trace().success());
}
