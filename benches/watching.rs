//! Cost of watching a run: `carom watch` in a pseudo-terminal while `carom train` runs. Measures bytes and frames per second, the processor
//! time of the watcher, and the training's own processor time per shot with and without the watcher.
//!
//! `cargo bench --bench watching` takes four minutes. Processor times come from `/proc` and are left out on other systems.

mod pty;

use std::{
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use carom::learning::run::status::RunStatus;

use pty::{CAROM, Terminal, frames, part, seconds_of};

/// Number of pairs of intervals with and without a watcher, and the length of each interval.
const PAIRS: usize = 10;
const STRETCH: Duration = Duration::from_secs(10);
/// Time in which the first picture is drawn and the first shots are replayed; it is reported separately.
const SETTLING: Duration = Duration::from_secs(3);

fn main() {
    let folder = tempfile::tempdir().expect("a folder for the run");
    let run = folder.path().join("run");
    let training = Training(train(&run));
    for (width, height) in [(80, 24), (120, 40)] {
        let mut watcher = watch(&run, width, height);
        let first = watcher.take(SETTLING);
        let (cpu, begin) = (watcher.seconds(), Instant::now());
        let (bytes, passed) = (watcher.take(3 * STRETCH), begin.elapsed().as_secs_f64());
        let frames = frames(&bytes);
        println!(
            "{width}x{height}: first {} s {} bytes; then {:.0} bytes/s in {:.1} frames/s, a frame {} bytes on average, \
             median {}, 99 % {}, largest {}",
            SETTLING.as_secs(),
            first.len(),
            bytes.len() as f64 / passed,
            frames.len() as f64 / passed,
            bytes.len() / frames.len().max(1),
            part(&frames, 0.5),
            part(&frames, 0.99),
            part(&frames, 1.0)
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

/// A training process; dropping this ends it.
struct Training(Child);

impl Drop for Training {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts the default agent with its usual schedule.
fn train(run: &Path) -> Child {
    let mut command = Command::new(CAROM);
    command.args(["train", "--steps", "5000000", "--run"]).arg(run).stdout(Stdio::null()).stderr(Stdio::null());
    let child = command.spawn().expect("carom train starts");
    while RunStatus::read(run).is_ok_and(|standing| standing.updates < 100) || !run.join("metrics.jsonl").exists() {
        thread::sleep(Duration::from_millis(100));
    }
    child
}

/// Returns the ratio of the training's processor time per shot with a watcher to that without, in two successive intervals.
fn ratio(run: &Path, training: u32) -> Option<f64> {
    let a_shot = || {
        let before = (seconds_of(training)?, RunStatus::read(run).ok()?.shots);
        thread::sleep(STRETCH);
        let after = (seconds_of(training)?, RunStatus::read(run).ok()?.shots);
        Some((after.0 - before.0) / (after.1 - before.1) as f64)
    };
    let alone = a_shot()?;
    let mut watcher = watch(run, 120, 40);
    watcher.take(SETTLING);
    Some(a_shot()? / alone)
}

/// Starts `carom watch` in a pseudo-terminal.
fn watch(run: &Path, columns: u16, rows: u16) -> Terminal {
    Terminal::start(&["watch", &run.to_string_lossy()], (columns, rows), "")
}
