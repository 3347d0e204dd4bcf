//! Reads new lines of a metrics file that another process writes: only complete lines, each once, even if the file is cut off or replaced.

use std::{
    fs::File,
    io::{self, ErrorKind, Read, Seek, SeekFrom},
    path::{Path, PathBuf},
};

use super::stamp::Stamp;
use crate::{learning::run::metrics::Record, storage};

/// Bytes that are read at a time; no line of metrics is longer than a thousandth of it.
const CHUNK: usize = 1 << 20;

/// Number of the last read bytes that are compared before more is read. Without this check a file that was cut off and has
/// grown again would count as the same.
const MARK: usize = 256;

/// Reader of a growing file.
#[derive(Debug, Default)]
pub struct Tail {
    path: PathBuf,
    /// Bytes of complete lines read.
    offset: u64,
    /// The last [`MARK`] of these bytes.
    mark: Vec<u8>,
    /// The stamp of the file when it was last read.
    stamp: Option<Stamp>,
    /// Number of lines that are not records of this version.
    pub unreadable: u64,
}

impl Tail {
    /// Creates a reader of the file at `path`, from its beginning.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), ..Self::default() }
    }

    /// Whether the file ends in the middle of a line.
    pub fn ends_mid_line(&self) -> bool {
        self.stamp.is_some_and(|stamp| self.offset < stamp.length)
    }

    /// Adds new records to `records`, including those before a read error. Returns `false` if there is no file. If the file was cut off or
    /// replaced, sets `is_restarted` and adds all its records; those read earlier are then obsolete.
    pub fn poll(&mut self, is_restarted: &mut bool, records: &mut Vec<Record>) -> io::Result<bool> {
        let stamp = Stamp::of(&self.path);
        if stamp == self.stamp {
            return Ok(stamp.is_some());
        }
        let mut file = match storage::open(&self.path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                self.stamp = None;
                return Ok(false);
            }
            file => file?,
        };
        // Taken from the opened file, because another one may have replaced it by now.
        let stamp = Stamp::from(&file.metadata()?);
        if !self.is_the_same(&mut file, stamp.length)? {
            *self = Self::new(&self.path);
            *is_restarted = true;
        }
        self.read(&mut file, records)?;
        // Set only after a successful read, so that a failed one is repeated.
        self.stamp = Some(stamp);
        Ok(true)
    }

    /// Whether the file still contains the bytes read last.
    fn is_the_same(&self, file: &mut File, length: u64) -> io::Result<bool> {
        if length < self.offset {
            return Ok(false);
        }
        let mut found = vec![0; self.mark.len()];
        file.seek(SeekFrom::Start(self.offset - found.len() as u64))?;
        file.read_exact(&mut found)?;
        Ok(found == self.mark)
    }

    fn read(&mut self, file: &mut File, records: &mut Vec<Record>) -> io::Result<()> {
        file.seek(SeekFrom::Start(self.offset))?;
        let mut buffer = Vec::new();
        loop {
            let start = buffer.len();
            if file.take(CHUNK as u64).read_to_end(&mut buffer)? == 0 {
                return Ok(());
            }
            let end = match buffer[start..].iter().rposition(|byte| *byte == b'\n') {
                Some(end) => start + end + 1,
                // Waits for the end of an incomplete line, up to a length that no line of metrics has.
                None if buffer.len() >= 4 * CHUNK => buffer.len(),
                None => continue,
            };
            for line in buffer[..end].split_inclusive(|byte| *byte == b'\n') {
                match serde_json::from_slice(line) {
                    Ok(record) => records.push(record),
                    Err(_) if line.trim_ascii().is_empty() => {}
                    Err(_) => self.unreadable += 1,
                }
            }
            self.offset += end as u64;
            self.mark.extend_from_slice(&buffer[..end]);
            self.mark.drain(..self.mark.len().saturating_sub(MARK));
            buffer.drain(..end);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn line(shots: u64) -> String {
        format!(
            "{{\"time/total_timesteps\":{shots},\"time/time_elapsed\":1.5,\"time/fps\":2.0,\"train/n_updates\":3,\
             \"train/learning_rate\":0.001,\"train/critic_loss\":\"NaN\",\"train/q_value\":0.5,\
             \"rollout/ep_rew_mean\":0.25}}\n"
        )
    }

    /// A new folder, the path of a file in it, and a reader of that file.
    fn fresh() -> (tempfile::TempDir, PathBuf, Tail) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.jsonl");
        let tail = Tail::new(&path);
        (folder, path, tail)
    }

    /// Whether the file was read from its beginning again, and its new lines; `None` if there is no file.
    fn look(tail: &mut Tail) -> Option<(bool, Vec<u64>)> {
        let (mut is_restarted, mut records) = (false, Vec::new());
        let is_there = tail.poll(&mut is_restarted, &mut records).unwrap();
        is_there.then(|| (is_restarted, records.iter().map(|record| record.shots).collect()))
    }

    #[test]
    fn only_complete_lines_are_read_and_each_once() {
        let (_folder, path, mut tail) = fresh();
        assert_eq!(look(&mut tail), None);
        let (first, second) = (line(1), line(2));
        let (half, rest) = second.split_at(30);
        fs::write(&path, first.clone() + half).unwrap();
        assert_eq!(look(&mut tail), Some((false, vec![1])));
        assert!(tail.ends_mid_line());
        assert_eq!(look(&mut tail), Some((false, vec![])));
        fs::write(&path, first + half + rest + "no line of ours\n\n" + &line(3)).unwrap();
        assert_eq!(look(&mut tail), Some((false, vec![2, 3])));
        assert_eq!((tail.ends_mid_line(), tail.unreadable), (false, 1));
    }

    #[test]
    fn truncated_or_replaced_files_are_read_again() {
        let (_folder, path, mut tail) = fresh();
        fs::write(&path, line(1) + &line(2) + &line(3)).unwrap();
        assert_eq!(look(&mut tail), Some((false, vec![1, 2, 3])));
        fs::write(&path, line(1)).unwrap();
        assert_eq!(look(&mut tail), Some((true, vec![1])));
        // The file was cut off and has grown again between two looks: it is longer than before but not the same.
        fs::write(&path, line(7) + &line(8)).unwrap();
        assert_eq!(look(&mut tail), Some((true, vec![7, 8])));
        fs::remove_file(&path).unwrap();
        assert_eq!(look(&mut tail), None);
        fs::write(&path, line(7) + &line(8) + &line(9)).unwrap();
        assert_eq!(look(&mut tail), Some((false, vec![9])));
        fs::remove_file(&path).unwrap();
        look(&mut tail);
        fs::write(&path, line(1)).unwrap();
        assert_eq!(look(&mut tail), Some((true, vec![1])));
    }

    #[test]
    fn a_failed_read_is_repeated() {
        let (_folder, path, mut tail) = fresh();
        std::fs::create_dir(&path).unwrap();
        for _ in 0..2 {
            assert!(tail.poll(&mut false, &mut Vec::new()).is_err());
        }
        assert!(!tail.ends_mid_line());
        std::fs::remove_dir(&path).unwrap();
        fs::write(&path, line(1)).unwrap();
        assert_eq!(look(&mut tail), Some((false, vec![1])));
    }

    #[test]
    fn long_files_and_endless_lines_are_read() {
        let (_folder, path, mut tail) = fresh();
        let many: String = (1..=10_000).map(line).collect();
        assert!(many.len() > CHUNK + CHUNK / 2);
        fs::write(&path, many).unwrap();
        assert_eq!(look(&mut tail).unwrap().1, (1..=10_000).collect::<Vec<_>>());
        fs::write(&path, vec![b'x'; 9 * CHUNK]).unwrap();
        assert_eq!(look(&mut tail), Some((true, vec![])));
        assert_eq!(tail.unreadable, 2);
    }
}
