//! The program in a pseudo-terminal: typing, reading its screen, and the ways in which a connection ends.

use std::{
    io::{Read, Write},
    num::NonZero,
    path::Path,
    process::Command,
    sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    thread,
    time::{Duration, Instant},
};

use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system};
use tempfile::TempDir;

/// Timeout for an expected picture; a loaded machine may need long to start a process.
pub const TIMEOUT: Duration = Duration::from_secs(20);
/// Text of the coach's screen at the start.
pub const START_TEXT: &str = "white at x -710.0 mm";
/// Silence after which no more output is expected.
pub const QUIET_TIME: Duration = Duration::from_millis(150);

pub fn carom() -> CommandBuilder {
    CommandBuilder::new(env!("CARGO_BIN_EXE_carom"))
}

pub fn guest(name: &str) -> CommandBuilder {
    let mut command = carom();
    command.args(["--guest", "--player", name]);
    command
}

fn cells(count: u16) -> NonZero<u16> {
    NonZero::new(count).unwrap()
}

/// The terminal's side of the connection. It reads only on demand, so that an unread connection stalls.
struct Connection {
    master: Box<dyn MasterPty + Send>,
    writer: Box<dyn Write + Send>,
    request: Sender<()>,
    output: Receiver<Vec<u8>>,
    is_read_requested: bool,
}

pub struct Session {
    /// `None` once the connection is cut.
    connection: Option<Connection>,
    pub child: Box<dyn Child + Send + Sync>,
    screen: vt100::Parser,
    /// Settings, the last session and the log: not those of the user who runs the tests.
    home: Option<TempDir>,
    /// Number of bytes read so far.
    pub bytes: usize,
}

impl Session {
    /// Starts the program and waits for the coach's screen.
    pub fn start(width: u16, height: u16) -> Self {
        Self::start_command(carom(), width, height).ready()
    }

    pub fn start_command(command: CommandBuilder, width: u16, height: u16) -> Self {
        let home = tempfile::tempdir().unwrap();
        let mut session = Self::start_at(home.path(), command, width, height);
        session.home = Some(home);
        session
    }

    /// Returns the user's home folder, if the session has its own.
    pub fn home(&self) -> Option<&Path> {
        self.home.as_ref().map(TempDir::path)
    }

    pub fn start_at(home: &Path, mut command: CommandBuilder, width: u16, height: u16) -> Self {
        command.env("HOME", home);
        command.env("XDG_STATE_HOME", home.join("state"));
        command.env("XDG_CONFIG_HOME", home.join("config"));
        if command.get_env("XDG_DATA_HOME").is_none_or(|folder| !Path::new(folder).starts_with(std::env::temp_dir())) {
            command.env("XDG_DATA_HOME", home.join("data"));
        }
        let size = PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        for (name, value) in [("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("LC_ALL", "C.UTF-8")] {
            command.env(name, value);
        }
        command.env_remove("NO_COLOR");
        command.env_remove("CAROM_GLYPHS");
        let child = pair.slave.spawn_command(command).unwrap();
        let mut reader = pair.master.try_clone_reader().unwrap();
        let ((request, requested), (sender, output)) = (channel(), channel());
        thread::spawn(move || {
            let mut buffer = vec![0; 65536];
            while requested.recv().is_ok() {
                let Ok(count @ 1..) = reader.read(&mut buffer) else { break };
                if sender.send(buffer[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        let writer = pair.master.take_writer().unwrap();
        let connection = Some(Connection { master: pair.master, writer, request, output, is_read_requested: false });
        let screen = vt100::Parser::new(cells(height), cells(width), 0);
        Self { connection, child, screen, home: None, bytes: 0 }
    }

    /// Waits for the coach's screen at the start.
    pub fn ready(mut self) -> Self {
        self.wait_for(START_TEXT);
        self
    }

    pub fn screen(&self) -> &vt100::Screen {
        self.screen.screen()
    }

    /// Returns the file in which the next session looks for the last one.
    pub fn saved_session(&self) -> String {
        let home = self.home.as_ref().unwrap().path();
        std::fs::read_to_string(home.join("state/carom/last.json")).unwrap_or_default()
    }

    pub fn send(&mut self, keys: &str) {
        let writer = &mut self.connection.as_mut().unwrap().writer;
        writer.write_all(keys.as_bytes()).unwrap();
        writer.flush().unwrap();
    }

    /// Types these keys and waits until the program has answered with a picture.
    pub fn press(&mut self, keys: &str) {
        let before = self.bytes;
        self.send(keys);
        let start = Instant::now();
        while self.bytes == before {
            assert!(start.elapsed() < TIMEOUT, "no answer to {keys:?}\n{}", self.screen().contents());
            self.read_output(Duration::from_millis(50));
        }
    }

    pub fn resize(&mut self, width: u16, height: u16) {
        let size = PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 };
        self.connection.as_ref().unwrap().master.resize(size).unwrap();
        self.screen.screen_mut().set_size(cells(height), cells(width));
    }

    pub fn signal(&self, name: &str) {
        let id = self.child.process_id().unwrap().to_string();
        assert!(Command::new("kill").args([&format!("-{name}"), &id]).status().unwrap().success());
    }

    /// Returns the number of bytes that the program has written so far, to any file; `None` if the system does not report it.
    pub fn bytes_written(&self) -> Option<u64> {
        let text = std::fs::read_to_string(format!("/proc/{}/io", self.child.process_id()?)).ok()?;
        text.lines().find_map(|line| line.strip_prefix("wchar: ")?.parse().ok())
    }

    /// Closes the terminal. (The library ends it with an empty line and Ctrl-D.)
    pub fn disconnect(&mut self) {
        // A reader that waits for output holds the connection, so output is provoked by resizing.
        let mut sizes = [(100, 30), (120, 40)].into_iter().cycle();
        while self.connection.as_ref().is_some_and(|connection| connection.is_read_requested)
            && let Some((width, height)) = sizes.next()
        {
            self.resize(width, height);
            self.read_output(Duration::from_millis(200));
        }
        self.connection = None;
    }

    /// Reads the output that arrives within `time`; `None` once the other side is closed.
    pub fn read_output(&mut self, time: Duration) -> Option<Vec<u8>> {
        let connection = self.connection.as_mut()?;
        if !connection.is_read_requested {
            connection.request.send(()).ok()?;
            connection.is_read_requested = true;
        }
        match connection.output.recv_timeout(time) {
            Ok(bytes) => {
                connection.is_read_requested = false;
                self.bytes += bytes.len();
                self.screen.process(&bytes);
                Some(bytes)
            }
            Err(RecvTimeoutError::Timeout) => Some(Vec::new()),
            Err(RecvTimeoutError::Disconnected) => None,
        }
    }

    pub fn wait_until(&mut self, what: &str, condition: impl Fn(&vt100::Screen) -> bool) {
        let start = Instant::now();
        while !condition(self.screen()) {
            assert!(start.elapsed() < TIMEOUT, "timed out waiting for: {what}\n{}", self.screen().contents());
            self.read_output(Duration::from_millis(50));
        }
    }

    pub fn wait_for(&mut self, text: &str) {
        self.wait_until(text, |screen| screen.contents().contains(text));
    }

    /// Waits until the coach has found a shot, before it is played.
    pub fn wait_for_advice(&mut self) {
        self.wait_until("the advice", |screen| {
            let text = screen.contents();
            [" 0.00/", " 0.00 / "].iter().any(|start| text.contains(start)) && !text.contains("cancel")
        });
    }

    /// Waits until nothing has arrived for `silence`.
    pub fn wait_until_quiet(&mut self, silence: Duration) {
        let start = Instant::now();
        while self.read_output(silence).is_some_and(|bytes| !bytes.is_empty()) {
            assert!(start.elapsed() < TIMEOUT, "the output does not stop\n{}", self.screen().contents());
        }
    }

    /// Returns the number of bytes that arrive within `time`.
    pub fn count_bytes(&mut self, time: Duration) -> usize {
        let (start, before) = (Instant::now(), self.bytes);
        while start.elapsed() < time {
            self.read_output(time.saturating_sub(start.elapsed()));
        }
        self.bytes - before
    }

    /// Waits at most `time` for the end of the process, without reading its output.
    pub fn wait_for_exit(&mut self, time: Duration) -> ExitStatus {
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            assert!(start.elapsed() < time, "the program does not end\n{}", self.screen().contents());
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits for the end of the process and of its output; the terminal must be restored.
    pub fn assert_clean_exit(&mut self) -> ExitStatus {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < TIMEOUT, "the program does not end\n{}", self.screen().contents());
            self.read_output(Duration::from_millis(20));
        };
        while self.read_output(Duration::from_millis(100)).is_some() && self.count_bytes(Duration::from_millis(50)) > 0
        {
        }
        self.assert_terminal_restored();
        status
    }

    /// Types keys that quit the program, which must end without an error.
    #[track_caller]
    pub fn quit_with(&mut self, keys: &str) {
        self.send(keys);
        assert!(self.assert_clean_exit().success());
    }

    /// Asserts that the program has restored all terminal modes.
    pub fn assert_terminal_restored(&self) {
        let screen = self.screen();
        assert!(!screen.alternate_screen(), "the alternate screen was left on");
        assert!(!screen.hide_cursor(), "the cursor was left hidden");
        assert!(!screen.bracketed_paste(), "pastes are still marked");
        assert_eq!(screen.mouse_protocol_mode(), vt100::MouseProtocolMode::None);
    }

    /// Continues the program after Ctrl-Z has returned the terminal to the shell, until `text` is displayed again.
    pub fn resume_until(&mut self, text: &str) {
        // A signal that arrives before the process has stopped has no effect, so it is repeated.
        let start = Instant::now();
        while !self.screen().alternate_screen() || !self.screen().contents().contains(text) {
            assert!(start.elapsed() < TIMEOUT, "the program does not resume\n{}", self.screen().contents());
            self.signal("CONT");
            self.count_bytes(Duration::from_millis(50));
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // After a successful test it has already ended.
        let _ = self.child.kill();
    }
}
