//! What a run reports, as JSON Lines with the names that users of Stable-Baselines3 know.

use std::{
    fs,
    io::{self, Seek, SeekFrom, Write as _},
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use crate::{printing, storage};

use super::{METRICS, number};

/// One line of a run's metrics. Means are over the updates since the line before. Numbers that are not finite stand in the
/// file by their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Shots played so far.
    #[serde(rename = "time/total_timesteps")]
    pub shots: u64,
    /// Seconds of training so far, evaluations included.
    #[serde(rename = "time/time_elapsed", with = "number")]
    pub seconds: f64,
    /// Shots a second since the line before, measurements left out.
    #[serde(rename = "time/fps", with = "number")]
    pub shots_per_second: f64,
    /// Updates made so far.
    #[serde(rename = "train/n_updates")]
    pub updates: u64,
    /// The critic's learning rate now.
    #[serde(rename = "train/learning_rate", with = "number")]
    pub learning_rate: f64,
    /// Loss of whatever judges actions: the mean cross entropy of a critic of successes, nats, or a squared error.
    #[serde(rename = "train/critic_loss", with = "number")]
    pub critic_loss: f64,
    /// Loss of the actor, for agents that have one.
    #[serde(rename = "train/actor_loss", with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub actor_loss: Option<f64>,
    /// Mean value that the agent gives its own choices. `Stable-Baselines3` logs none; `CleanRL` logs it as
    /// `losses/qf1_values` beside its losses, whose group is called `train` here.
    #[serde(rename = "train/q_value", with = "number")]
    pub q_value: f64,
    /// Mean reward of the shots played, exploration included.
    #[serde(rename = "rollout/ep_rew_mean", with = "number")]
    pub rollout_reward: f64,
    /// How strongly the agent explores, see [`Progress`](crate::learning::learner::Progress::exploration).
    #[serde(rename = "rollout/exploration_rate")]
    #[serde(with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub exploration: Option<f64>,
    /// Share of the replay buffer that is filled, for agents that have one.
    #[serde(rename = "train/replay_buffer_fill")]
    #[serde(with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub replay_fill: Option<f64>,
    /// Mean reward of the averaged networks' first choice on held-out layouts, without exploration.
    #[serde(rename = "eval/mean_reward", with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub held_out_reward: Option<f64>,
    /// Share of those layouts in which any of the best proposals earns at least 1: what a perfect choice among them would reach. The name
    /// is of a time when every head made one proposal.
    #[serde(rename = "eval/any_head", with = "number::option", default, skip_serializing_if = "Option::is_none")]
    pub best_of_k: Option<f64>,
}

/// All whole lines in a file; those that are no records are left out.
///
/// # Errors
/// Whatever the file system reports; a missing file is an empty one.
pub fn read(path: &Path) -> io::Result<Vec<Record>> {
    Ok(records(&content(path)?).collect())
}

fn records(bytes: &[u8]) -> impl Iterator<Item = Record> {
    whole_lines(bytes).filter_map(|line| serde_json::from_slice(line).ok())
}

/// Sentences about the file of a run that goes on after `shots` shots: where it ends within a line, and where lines are missing, of
/// which there is one for every `log_every` shots. What cannot be read is told by who opens it.
pub(super) fn notices(path: &Path, shots: u64, log_every: u64) -> Vec<String> {
    let Ok(bytes) = content(path) else { return Vec::new() };
    let is_torn = bytes.last().is_some_and(|byte| *byte != b'\n');
    let torn = is_torn.then(|| format!("the last line of {METRICS} is cut off and is left out"));
    let last = records(&bytes).map(|record| record.shots).filter(|last| *last <= shots).max();
    let missing = lacks_lines(last, shots, log_every).then(|| {
        let what = match last {
            None if !path.exists() => {
                format!("{METRICS} is missing: there is no line of the {shots} shots played")
            }
            last => cut_off(last.unwrap_or(0), shots),
        };
        format!("{what}; those lines are lost, and the training goes on as if they were there")
    });
    torn.into_iter().chain(missing).collect()
}

/// Whether lines are missing after the `last` one of a run that has played so many shots. A checkpoint is written after all lines before
/// it: none is missing where no line is due between the last one and it.
pub(super) fn lacks_lines(last: Option<u64>, shots: u64, log_every: u64) -> bool {
    let number = |shots: u64| shots / log_every.max(1);
    number(last.unwrap_or(0)) != number(shots)
}

/// The sentence about a file whose last line is of `last` shots, where `shots` were played and lines are missing.
pub(super) fn cut_off(last: u64, shots: u64) -> String {
    format!("{METRICS} has been emptied or cut off: it ends after {last} of the {shots} shots played")
}

/// A run's file of metrics while the run writes it. Lines that cannot be written wait in memory.
#[derive(Debug)]
pub(super) struct MetricsFile {
    path: PathBuf,
    /// Bytes of whole lines in the file.
    length: u64,
    waiting: Vec<u8>,
}

impl MetricsFile {
    /// Opens the file of a run that goes on after `shots` shots: what was written later, and a last line that was cut
    /// off, is dropped, so that no line comes twice. Returns the records that are left, too. A missing file is an empty one.
    pub fn open(path: &Path, shots: u64) -> io::Result<(Self, Vec<Record>)> {
        let bytes = content(path)?;
        let (mut length, mut left) = (0, Vec::new());
        for line in whole_lines(&bytes) {
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
        Ok((Self { path: path.to_owned(), length, waiting: Vec::new() }, left))
    }

    /// Adds a line to those that wait.
    pub fn push(&mut self, record: &Record) {
        // A record has nothing but numbers under fixed names, and memory takes any number of bytes.
        let _ = printing::json_line(&mut self.waiting, record);
    }

    /// Writes the lines that wait. Where that fails they go on waiting, and the file has whole lines only.
    pub fn flush(&mut self) -> io::Result<()> {
        self.write().map(|_| ())
    }

    /// The same, and returns when they would outlive a power cut.
    pub fn sync(&mut self) -> io::Result<()> {
        self.write()?.sync_data()
    }

    fn write(&mut self) -> io::Result<fs::File> {
        let mut file = fs::OpenOptions::new().create(true).truncate(false).write(true).open(&self.path)?;
        if !self.waiting.is_empty() {
            let length = file.metadata()?.len();
            if length < self.length {
                // Somebody has emptied the file or cut it off: it is not filled up with zeros, and no line is added to half
                // a line.
                let whole: usize = whole_lines(&content(&self.path)?).map(<[u8]>::len).sum();
                self.length = self.length.min(whole as u64);
            }
            file.set_len(self.length)?;
            file.seek(SeekFrom::End(0))?;
            // In one call, so that readers see whole lines.
            if let Err(error) = file.write_all(&self.waiting) {
                let _ = file.set_len(self.length);
                return Err(error);
            }
            self.length += self.waiting.len() as u64;
            self.waiting.clear();
        }
        Ok(file)
    }
}

fn content(path: &Path) -> io::Result<Vec<u8>> {
    Ok(storage::read_if_there(path, storage::LARGE)?.unwrap_or_default())
}

/// The lines that have an end, with it.
fn whole_lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(shots: u64) -> Record {
        Record { shots, actor_loss: Some(-0.5), rollout_reward: 0.25, ..Record::default() }
    }

    /// A new folder, the path of a file in it, and that file, opened for a run that goes on after `shots` shots.
    fn opened(shots: u64) -> (tempfile::TempDir, PathBuf, MetricsFile) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.jsonl");
        let (file, left) = MetricsFile::open(&path, shots).unwrap();
        assert_eq!(left, []);
        (folder, path, file)
    }

    #[test]
    fn a_run_that_goes_on_drops_later_lines_and_a_torn_one() {
        let (_folder, path, mut file) = opened(5);
        for shots in [1, 2, 3] {
            file.push(&record(shots));
            file.flush().unwrap();
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
    fn lines_that_are_missing_before_a_checkpoint_are_told_with_the_gap() {
        let (_folder, path, mut file) = opened(0);
        assert!(notices(&path, 99, 100).is_empty(), "no line is due yet");
        assert!(notices(&path, 640, 100)[0].contains("is missing: there is no line of the 640 shots"));
        for shots in [192, 384, 576] {
            file.push(&record(shots));
        }
        file.flush().unwrap();
        // Lines that are younger than the checkpoint are no gap: they come again.
        for (shots, is_whole) in [(192, true), (576, true), (599, true), (600, false)] {
            assert_eq!(notices(&path, shots, 100).is_empty(), is_whole, "{shots}");
        }
        assert!(notices(&path, 960, 60)[0].contains("it ends after 576 of the 960 shots played"));
    }

    #[test]
    fn a_file_that_was_cut_off_meanwhile_goes_on_after_its_last_whole_line() {
        let (_folder, path, mut file) = opened(0);
        for shots in [1, 2] {
            file.push(&record(shots));
        }
        file.flush().unwrap();
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, &text[..text.len() - 20]).unwrap();
        file.push(&record(3));
        file.flush().unwrap();
        assert_eq!(read(&path).unwrap(), [record(1), record(3)]);
        fs::write(&path, "").unwrap();
        file.push(&record(4));
        file.flush().unwrap();
        assert_eq!(read(&path).unwrap(), [record(4)]);
    }

    #[test]
    fn lines_that_cannot_be_written_wait_and_come_later() {
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
