//! A program in a pseudo-terminal, for benchmarks: its output with timestamps, and its processor time.

// Each bench uses only a part of this module.
#![allow(dead_code)]

use std::{
    fs,
    io::{Read, Write},
    num::NonZero,
    sync::mpsc::{Receiver, RecvTimeoutError, channel},
    thread,
    time::{Duration, Instant},
};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use tempfile::TempDir;

/// Path of the program.
pub const CAROM: &str = env!("CARGO_BIN_EXE_carom");
/// Start and end of every frame (synchronized output).
const BEGIN: &[u8] = b"\x1b[?2026h";
const END: &[u8] = b"\x1b[?2026l";
/// Timeout for an expected picture.
const PATIENCE: Duration = Duration::from_secs(30);

/// A program in its own pseudo-terminal; dropping this ends the program.
pub struct Terminal {
    child: Box<dyn Child + Send + Sync>,
    writer: Box<dyn Write + Send>,
    output: Receiver<(Instant, Vec<u8>)>,
    screen: vt100::Parser,
    _master: Box<dyn MasterPty + Send>,
    /// Settings and the last session, separate from those of the user who runs the bench.
    _home: TempDir,
}

impl Terminal {
    /// Starts `carom` with these arguments in a true-colour terminal, with `settings` as its configuration.
    pub fn start(arguments: &[&str], (columns, rows): (u16, u16), settings: &str) -> Self {
        let home = tempfile::tempdir().expect("a folder for the settings");
        fs::create_dir_all(home.path().join("config/carom")).expect("a folder for the settings");
        fs::write(home.path().join("config/carom/config.toml"), settings).expect("the settings are written");
        let mut command = CommandBuilder::new(CAROM);
        command.args(arguments);
        for (name, value) in [("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("LC_ALL", "C.UTF-8")] {
            command.env(name, value);
        }
        for name in ["NO_COLOR", "CAROM_GLYPHS"] {
            command.env_remove(name);
        }
        for (name, folder) in [("XDG_STATE_HOME", "state"), ("XDG_CONFIG_HOME", "config"), ("XDG_DATA_HOME", "data")] {
            command.env(name, home.path().join(folder));
        }
        let size = PtySize { rows, cols: columns, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).expect("a pseudo-terminal");
        let mut reader = pair.master.try_clone_reader().expect("its output");
        let writer = pair.master.take_writer().expect("its input");
        let (sender, output) = channel();
        thread::spawn(move || {
            let mut buffer = vec![0; 1 << 16];
            while let Ok(count @ 1..) = reader.read(&mut buffer) {
                if sender.send((Instant::now(), buffer[..count].to_vec())).is_err() {
                    break;
                }
            }
        });
        let cells = |count| NonZero::new(count).expect("a terminal has cells");
        let screen = vt100::Parser::new(cells(rows), cells(columns), 0);
        let child = pair.slave.spawn_command(command).expect("carom starts");
        Self { child, writer, output, screen, _master: pair.master, _home: home }
    }

    /// Returns its process id.
    pub fn process(&self) -> u32 {
        self.child.process_id().expect("it has not been waited for")
    }

    /// Returns the current screen.
    pub fn screen(&self) -> &vt100::Screen {
        self.screen.screen()
    }

    /// Types `keys` and returns the time.
    pub fn send(&mut self, keys: &str) -> Instant {
        let now = Instant::now();
        self.writer.write_all(keys.as_bytes()).and_then(|()| self.writer.flush()).expect("it reads its keys");
        now
    }

    /// Returns its next output and the time of arrival; `None` if there is no output within `time`.
    pub fn next(&mut self, time: Duration) -> Option<(Instant, Vec<u8>)> {
        match self.output.recv_timeout(time) {
            Ok((at, bytes)) => {
                self.screen.process(&bytes);
                Some((at, bytes))
            }
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => panic!("carom has ended by itself"),
        }
    }

    /// Returns all output within `time`.
    pub fn take(&mut self, time: Duration) -> Vec<u8> {
        let (end, mut all) = (Instant::now() + time, Vec::new());
        while let Some((_, bytes)) = self.next(end.saturating_duration_since(Instant::now())) {
            all.extend(bytes);
        }
        all
    }

    /// Returns all output until there is none for `silence`, and the time until the last output.
    pub fn take_until_silent(&mut self, silence: Duration) -> (Vec<u8>, Duration) {
        let (start, mut last, mut all) = (Instant::now(), Instant::now(), Vec::new());
        while let Some((at, bytes)) = self.next(silence) {
            last = at;
            all.extend(bytes);
        }
        (all, last.saturating_duration_since(start))
    }

    /// Waits for a frame in which `is_there` is true, and returns the time of its arrival.
    pub fn wait_until(&mut self, is_there: impl Fn(&vt100::Screen) -> bool) -> Instant {
        let start = Instant::now();
        loop {
            if let Some((at, bytes)) = self.next(PATIENCE)
                && bytes.ends_with(END)
                && is_there(self.screen())
            {
                return at;
            }
            assert!(start.elapsed() < PATIENCE, "never came; there is\n{}", self.screen().contents());
        }
    }

    /// Like [`Self::wait_until`], for a text on the screen.
    pub fn wait_for(&mut self, text: &str) -> Instant {
        self.wait_until(|screen| screen.contents().contains(text))
    }

    /// Returns user and system time of its process, s.
    pub fn seconds(&self) -> Option<f64> {
        seconds_of(self.process())
    }

    /// Returns the number of write system calls of its process, and its resident memory, MB.
    pub fn writes_and_memory(&self) -> Option<(u64, f64)> {
        let number = |file: &str, name: &str| {
            let text = fs::read_to_string(format!("/proc/{}/{file}", self.process())).ok()?;
            text.lines().find_map(|line| line.strip_prefix(name)?.split_whitespace().next()?.parse::<u64>().ok())
        };
        Some((number("io", "syscw:")?, number("status", "VmRSS:")? as f64 / 1024.0))
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Returns user and system time of a process, s, from `/proc`; `None` on systems without it.
pub fn seconds_of(process: u32) -> Option<f64> {
    // A tick is a hundredth of a second on every existing Linux; the process name before the last bracket may contain spaces.
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / 100.0)
}

/// Returns the sizes of the frames in bytes, sorted.
pub fn frames(bytes: &[u8]) -> Vec<usize> {
    let begins = bytes.windows(BEGIN.len()).enumerate().filter(|(_, window)| *window == BEGIN).map(|(at, _)| at);
    let begins: Vec<usize> = begins.collect();
    let ends = begins.iter().skip(1).copied().chain([bytes.len()]);
    let mut frames: Vec<usize> = begins.iter().zip(ends).map(|(begin, end)| end - begin).collect();
    frames.sort_unstable();
    frames
}

/// Returns the quantile `share` of a sorted list; for an empty list the default value of the type.
pub fn part<T: Copy + Default>(sorted: &[T], share: f64) -> T {
    let last = sorted.len().saturating_sub(1);
    sorted.get((share * last as f64).round() as usize).copied().unwrap_or_default()
}
