//! What it costs to be watched: `carom watch` in a pseudo-terminal beside `carom train`. Bytes and frames a second, the
//! processor time of the watcher, and the training's own processor time a shot with the watcher and without.
//!
//! `cargo bench --bench watching` takes four minutes. Processor times come from `/proc` and are left out elsewhere.

use std::{
    fs,
    io::Read,
    path::Path,
    process::{Child, Command, Stdio},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use carom::learning::run::standing::Standing;
use portable_pty::{CommandBuilder, MasterPty, PtySize, native_pty_system};

const CAROM: &str = env!("CARGO_BIN_EXE_carom");
/// Pairs of stretches with and without a watcher, and the length of each.
const PAIRS: usize = 10;
const STRETCH: Duration = Duration::from_secs(10);
/// Time in which the first picture is painted and the first shots are replayed: it is told apart.
const SETTLING: Duration = Duration::from_secs(3);
/// What every frame begins with (synchronized output).
const FRAME: &[u8] = b"\x1b[?2026h";

fn main() {
    let folder = tempfile::tempdir().expect("a folder for the run");
    let run = folder.path().join("run");
    let training = Training(train(&run));
    for (width, height) in [(80, 24), (120, 40)] {
        let watcher = Watcher::start(&run, width, height);
        thread::sleep(SETTLING);
        let first = watcher.take();
        let (cpu, begin) = (watcher.seconds(), Instant::now());
        thread::sleep(3 * STRETCH);
        let (bytes, passed) = (watcher.take(), begin.elapsed().as_secs_f64());
        let mut frames = frames(&bytes);
        frames.sort_unstable();
        let part = |share: f64| frames.get((share * (frames.len().max(1) - 1) as f64) as usize).copied().unwrap_or(0);
        println!(
            "{width}x{height}: first {} s {} bytes; then {:.0} bytes/s in {:.1} frames/s, a frame {} bytes on average, \
             median {}, 99 % {}, largest {}",
            SETTLING.as_secs(),
            first.len(),
            bytes.len() as f64 / passed,
            frames.len() as f64 / passed,
            bytes.len() / frames.len().max(1),
            part(0.5),
            part(0.99),
            part(1.0)
        );
        if let (Some(before), Some(after)) = (cpu, watcher.seconds()) {
            println!("{width}x{height}: the watcher takes {:.2} % of a processor", 100.0 * (after - before) / passed);
        }
    }
    let mut ratios: Vec<f64> = (0..PAIRS).filter_map(|_| ratio(&run, training.0.id())).collect();
    ratios.sort_by(f64::total_cmp);
    if let (Some(first), Some(last)) = (ratios.first(), ratios.last()) {
        println!(
            "processor time a shot of the training, watched against not: median {:.4} of {} pairs, {first:.4} to {last:.4}",
            ratios[ratios.len() / 2],
            ratios.len()
        );
    }
}

/// A training that ends with the bench, however that ends.
struct Training(Child);

impl Drop for Training {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The default agent in its usual schedule.
fn train(run: &Path) -> Child {
    let mut command = Command::new(CAROM);
    command.args(["train", "--steps", "5000000", "--run"]).arg(run).stdout(Stdio::null()).stderr(Stdio::null());
    let child = command.spawn().expect("carom train starts");
    while Standing::read(run).is_ok_and(|standing| standing.updates < 100) || !run.join("metrics.jsonl").exists() {
        thread::sleep(Duration::from_millis(100));
    }
    child
}

/// The training's processor time a shot with a watcher, in terms of that without, in two stretches one after the other.
fn ratio(run: &Path, training: u32) -> Option<f64> {
    let a_shot = || {
        let before = (seconds_of(training)?, Standing::read(run).ok()?.shots);
        thread::sleep(STRETCH);
        let after = (seconds_of(training)?, Standing::read(run).ok()?.shots);
        Some((after.0 - before.0) / (after.1 - before.1) as f64)
    };
    let alone = a_shot()?;
    let _watcher = Watcher::start(run, 120, 40);
    thread::sleep(SETTLING);
    Some(a_shot()? / alone)
}

/// User and system time of a process, s.
fn seconds_of(process: u32) -> Option<f64> {
    // Ticks of a hundredth of a second on every Linux there is; the name before the last bracket may have blanks.
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / 100.0)
}

fn frames(bytes: &[u8]) -> Vec<usize> {
    let starts: Vec<usize> =
        bytes.windows(FRAME.len()).enumerate().filter(|(_, window)| *window == FRAME).map(|(at, _)| at).collect();
    starts.iter().zip(starts.iter().skip(1).chain([&bytes.len()])).map(|(start, end)| end - start).collect()
}

/// `carom watch` in a pseudo-terminal.
struct Watcher {
    child: Box<dyn portable_pty::Child + Send + Sync>,
    bytes: Arc<Mutex<Vec<u8>>>,
    ended: Arc<AtomicBool>,
    _master: Box<dyn MasterPty + Send>,
}

impl Watcher {
    fn start(run: &Path, columns: u16, rows: u16) -> Self {
        let pair = native_pty_system()
            .openpty(PtySize { rows, cols: columns, pixel_width: 0, pixel_height: 0 })
            .expect("a pseudo-terminal");
        let mut command = CommandBuilder::new(CAROM);
        command.arg("watch");
        command.arg(run);
        for (name, value) in [("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("LC_ALL", "C.UTF-8")] {
            command.env(name, value);
        }
        let child = pair.slave.spawn_command(command).expect("carom watch starts");
        let mut reader = pair.master.try_clone_reader().expect("its output");
        let (bytes, ended) = (Arc::default(), Arc::new(AtomicBool::new(false)));
        let (kept, over) = (Arc::clone(&bytes), Arc::clone(&ended));
        thread::spawn(move || {
            let mut buffer = vec![0; 65536];
            while let Ok(count @ 1..) = reader.read(&mut buffer) {
                let kept: &Mutex<Vec<u8>> = &kept;
                kept.lock().expect("nobody panics with it").extend_from_slice(&buffer[..count]);
            }
            over.store(true, Ordering::Relaxed);
        });
        Self { child, bytes, ended, _master: pair.master }
    }

    /// What it has written since the last call.
    fn take(&self) -> Vec<u8> {
        assert!(!self.ended.load(Ordering::Relaxed), "carom watch has ended by itself");
        std::mem::take(&mut self.bytes.lock().expect("nobody panics with it"))
    }

    fn seconds(&self) -> Option<f64> {
        seconds_of(self.child.process_id()?)
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
