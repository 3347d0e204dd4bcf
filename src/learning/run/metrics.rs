//! The metrics of a run, as JSON Lines with the names of Stable-Baselines3.

use std::{
    fs,
    io::{self, Seek, SeekFrom, Write as _},
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use crate::{printing, storage};

use super::{METRICS, number};

/// One line of a run's metrics. Means are over the shots or updates since the previous line. Numbers that are not finite are written as
/// their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Shots played so far.
    #[serde(rename = "time/total_timesteps")]
    pub shots: u64,
    /// Seconds of training so far, evaluations included.
    #[serde(rename = "time/time_elapsed", with = "number")]
    pub seconds: f64,
    /// Shots per second since the previous line, without the time of evaluations.
    #[serde(rename = "time/fps", with = "number")]
    pub shots_per_second: f64,
    /// Updates made so far.
    #[serde(rename = "train/n_updates")]
    pub updates: u64,
    /// Current learning rate of the critic.
    #[serde(rename = "train/learning_rate", with = "number")]
    pub learning_rate: f64,
    /// Loss of the critic or of the Q-function: the mean cross entropy of a critic of successes, nats, or a squared error.
    #[serde(rename = "train/critic_loss", with = "number")]
    pub critic_loss: f64,
    /// Loss of the actor, for agents that have one.
    #[serde(rename = "train/actor_loss", with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub actor_loss: Option<f64>,
    /// Mean value that the agent assigns to its own choices. `Stable-Baselines3` does not log it; `CleanRL` logs it as
    /// `losses/qf1_values` next to its losses, whose group is called `train` here.
    #[serde(rename = "train/q_value", with = "number")]
    pub q_value: f64,
    /// Mean reward of the shots played, exploration included.
    #[serde(rename = "rollout/ep_rew_mean", with = "number")]
    pub rollout_reward: f64,
    /// Strength of the exploration, see [`Progress`](crate::learning::learner::Progress::exploration).
    #[serde(rename = "rollout/exploration_rate")]
    #[serde(with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub exploration: Option<f64>,
    /// Filled share of the replay buffer, for agents that have one.
    #[serde(rename = "train/replay_buffer_fill")]
    #[serde(with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub replay_fill: Option<f64>,
    /// Mean reward of the agent's first choice on held-out layouts, without exploration.
    #[serde(rename = "eval/mean_reward", with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub held_out_reward: Option<f64>,
    /// Share of those layouts on which any of the best proposals earns 1 or more (best-of-k success), which a perfect choice among them
    /// would reach. The name in the file is from a time when every head made one proposal.
    #[serde(rename = "eval/any_head", with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub best_of_k: Option<f64>,
}

/// Reads all complete lines of a file; lines that are not records are left out. A missing file counts as empty.
pub(super) fn read(path: &Path) -> io::Result<Vec<Record>> {
    Ok(records(&content(path)?).collect())
}

fn records(bytes: &[u8]) -> impl Iterator<Item = Record> {
    complete_lines(bytes).filter_map(|line| serde_json::from_slice(line).ok())
}

/// Returns warnings about the file of a run that resumes after `shots` shots: if it ends within a line, or if lines are missing (one is due
/// every `log_every` shots). A file that cannot be read is reported when it is opened.
pub(super) fn notices(path: &Path, shots: u64, log_every: u64) -> Vec<String> {
    let Ok(bytes) = content(path) else { return Vec::new() };
    let is_torn = bytes.last().is_some_and(|byte| *byte != b'\n');
    let torn = is_torn.then(|| format!("the last line of {METRICS} is cut off and is left out"));
    let last = records(&bytes).map(|record| record.shots).filter(|last| *last <= shots).max();
    let missing = lacks_lines(last, shots, log_every).then(|| {
        let problem = match last {
            None if !path.exists() => {
                format!("{METRICS} is missing: there is no line of the {shots} shots played")
            }
            last => cut_off_notice(last.unwrap_or(0), shots),
        };
        format!("{problem}; those lines are lost, which does not affect the training")
    });
    torn.into_iter().chain(missing).collect()
}

/// Whether lines are missing after the `last` one of a run that resumes after `shots` shots. All lines before a checkpoint are written
/// before it, so none is missing if no line was due between the last one and the checkpoint.
fn lacks_lines(last: Option<u64>, shots: u64, log_every: u64) -> bool {
    let number = |shots: u64| shots / log_every.max(1);
    number(last.unwrap_or(0)) != number(shots)
}

/// Returns the message about a file with missing lines, whose last line is of `last` of the `shots` shots played.
pub(super) fn cut_off_notice(last: u64, shots: u64) -> String {
    format!("{METRICS} has been emptied or cut off: it ends after {last} of the {shots} shots played")
}

/// Writer of a run's metrics file. Lines that cannot be written wait in memory.
#[derive(Debug)]
pub(super) struct MetricsFile {
    path: PathBuf,
    /// Bytes of complete lines in the file.
    length: u64,
    /// Lines that are not written yet.
    pending: Vec<u8>,
}

impl MetricsFile {
    /// Opens the file of a run that resumes after `shots` shots. Removes later lines and an incomplete last line, so that no line
    /// occurs twice. Also returns the remaining records. A missing file counts as empty.
    pub fn open(path: &Path, shots: u64) -> io::Result<(Self, Vec<Record>)> {
        let bytes = content(path)?;
        let (mut length, mut left) = (0, Vec::new());
        for line in complete_lines(&bytes) {
            match serde_json::from_slice::<Record>(line) {
                Ok(record) if record.shots > shots => break,
                Ok(record) => left.push(record),
                // A line of unknown origin is kept.
                Err(_) => {}
            }
            length += line.len() as u64;
        }
        if length < bytes.len() as u64 {
            fs::OpenOptions::new().write(true).open(path)?.set_len(length)?;
        }
        Ok((Self { path: path.to_owned(), length, pending: Vec::new() }, left))
    }

    /// Adds a line to the pending ones.
    pub fn push(&mut self, record: &Record) {
        // Cannot fail: a record contains only numbers under fixed names, and the target is memory.
        let _ = printing::json_line(&mut self.pending, record);
    }

    /// Writes the pending lines. If that fails they stay pending, and the file contains complete lines only.
    pub fn flush(&mut self) -> io::Result<()> {
        self.write().map(|_| ())
    }

    /// Writes the pending lines and waits until they are on the disk, so that they survive a power failure.
    pub fn sync(&mut self) -> io::Result<()> {
        self.write()?.sync_data()
    }

    fn write(&mut self) -> io::Result<fs::File> {
        let mut file = fs::OpenOptions::new().create(true).truncate(false).write(true).open(&self.path)?;
        if !self.pending.is_empty() {
            let length = file.metadata()?.len();
            if length < self.length {
                // The file was emptied or cut off from outside. It must not be filled up with zeros, and no line may be added to an
                // incomplete one.
                let whole: usize = complete_lines(&content(&self.path)?).map(<[u8]>::len).sum();
                self.length = self.length.min(whole as u64);
            }
            file.set_len(self.length)?;
            file.seek(SeekFrom::End(0))?;
            // In one call, so that readers see whole lines.
            if let Err(error) = file.write_all(&self.pending) {
                let _ = file.set_len(self.length);
                return Err(error);
            }
            self.length += self.pending.len() as u64;
            self.pending.clear();
        }
        Ok(file)
    }
}

fn content(path: &Path) -> io::Result<Vec<u8>> {
    Ok(storage::read_if_exists(path, storage::MAX_LARGE_FILE)?.unwrap_or_default())
}

/// Iterates over the complete lines, each with its newline.
fn complete_lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(shots: u64) -> Record {
        Record { shots, actor_loss: Some(-0.5), rollout_reward: 0.25, ..Record::default() }
    }

    /// A new folder, the path of a file in it, and that file, opened for a run that resumes after `shots` shots.
    fn opened(shots: u64) -> (tempfile::TempDir, PathBuf, MetricsFile) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.jsonl");
        let (file, left) = MetricsFile::open(&path, shots).unwrap();
        assert_eq!(left, []);
        (folder, path, file)
    }

    /// Writes lines with these numbers of shots.
    fn write(file: &mut MetricsFile, shots: &[u64]) {
        for shots in shots {
            file.push(&record(*shots));
        }
        file.flush().unwrap();
    }

    #[test]
    fn resuming_drops_later_and_incomplete_lines() {
        let (_folder, path, mut file) = opened(5);
        for shots in [1, 2, 3] {
            write(&mut file, &[shots]);
        }
        let torn = fs::read_to_string(&path).unwrap() + "{\"time/total";
        assert!(notices(&path, 3, 100).is_empty());
        fs::write(&path, &torn).unwrap();
        assert!(notices(&path, 3, 100)[0].contains("is cut off"));
        assert_eq!(MetricsFile::open(&path, 3).unwrap().1, [record(1), record(2), record(3)]);
        fs::write(&path, torn).unwrap();
        let (mut file, left) = MetricsFile::open(&path, 2).unwrap();
        assert_eq!(left, [record(1), record(2)]);
        file.push(&record(4));
        file.sync().unwrap();
        assert_eq!(read(&path).unwrap(), [record(1), record(2), record(4)]);
    }

    #[test]
    fn lines_missing_before_a_checkpoint_are_reported() {
        let (_folder, path, mut file) = opened(0);
        assert!(notices(&path, 99, 100).is_empty(), "no line is due yet");
        assert!(notices(&path, 640, 100)[0].contains("is missing: there is no line of the 640 shots"));
        write(&mut file, &[192, 384, 576]);
        // Lines after the checkpoint leave no gap, because the resumed run writes them again.
        for (shots, is_whole) in [(192, true), (576, true), (599, true), (600, false)] {
            assert_eq!(notices(&path, shots, 100).is_empty(), is_whole, "{shots}");
        }
        assert!(notices(&path, 960, 60)[0].contains("it ends after 576 of the 960 shots played"));
    }

    #[test]
    fn a_truncated_file_continues_after_its_last_line() {
        let (_folder, path, mut file) = opened(0);
        write(&mut file, &[1, 2]);
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, &text[..text.len() - 20]).unwrap();
        write(&mut file, &[3]);
        assert_eq!(read(&path).unwrap(), [record(1), record(3)]);
        fs::write(&path, "").unwrap();
        write(&mut file, &[4]);
        assert_eq!(read(&path).unwrap(), [record(4)]);
    }

    #[test]
    fn unwritten_lines_are_written_later() {
        let (_folder, path, mut file) = opened(0);
        fs::create_dir(&path).unwrap();
        for shots in [1, 2] {
            file.push(&record(shots));
            assert!(file.sync().is_err());
        }
        fs::remove_dir(&path).unwrap();
        file.sync().unwrap();
        assert_eq!(read(&path).unwrap(), [record(1), record(2)]);
    }
}
