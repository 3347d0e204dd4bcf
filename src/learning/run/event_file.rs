//! A run's metrics for `TensorBoard`: an event file next to `metrics.jsonl`, with the same names.
//!
//! The file is a series of records (length, masked checksum, content, masked checksum), each an `Event` in the encoding of
//! protocol buffers: <https://github.com/tensorflow/tensorflow/blob/master/tensorflow/core/util/event.proto>.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write as _},
    path::Path,
    time::{SystemTime, UNIX_EPOCH},
};

use crc::{CRC_32_ISCSI, Crc};

use super::metrics::Record;
use crate::storage::write_atomic_unsynced;

/// File name; `TensorBoard` finds files by a part of it.
pub const FILE: &str = "events.out.tfevents.carom";

const CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISCSI);

/// The event file, opened for writing.
#[derive(Debug)]
pub struct EventFile(File);

impl EventFile {
    /// Opens the file of a run that begins or resumes after `shots` shots and has written `records` so far. If there is no file, it is
    /// written from them. An existing one is continued in place, because an open `TensorBoard` would go on reading a file that was
    /// replaced, and because it may contain lines that the metrics have lost. A record that was cut off is removed, and those of later shots
    /// count no more.
    pub fn open(folder: &Path, records: &[Record], shots: u64) -> io::Result<Self> {
        let path = folder.join(FILE);
        if !path.exists() {
            write_atomic_unsynced(&path, &Self::content(records))?;
            return Ok(Self(OpenOptions::new().append(true).open(path)?));
        }
        let length = length_of_whole_records(&fs::read(&path)?);
        let mut file = OpenOptions::new().append(true).open(path)?;
        file.set_len(length as u64)?;
        file.write_all(&framed(&restart(shots + 1)))?;
        Ok(Self(file))
    }

    /// Returns the content of a file with all these records.
    fn content(records: &[Record]) -> Vec<u8> {
        let version = [field(WALL_TIME, DOUBLE, &now().to_le_bytes()), sized(FILE_VERSION, b"brain.Event:2")].concat();
        let mut bytes = framed(&version);
        // The times of the run's sessions are unknown, so the records get times as if the run had not been interrupted.
        let begin = now() - records.last().map_or(0.0, |last| last.seconds);
        for record in records {
            bytes.extend(framed(&event(record, begin + record.seconds)));
        }
        bytes
    }

    pub fn push(&mut self, record: &Record) -> io::Result<()> {
        self.0.write_all(&framed(&event(record, now())))
    }
}

/// Returns the length of the records at the beginning of `bytes` that are complete.
fn length_of_whole_records(bytes: &[u8]) -> usize {
    let mut whole = 0;
    while let Some(length) = bytes[whole..].first_chunk::<8>() {
        let content = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
        let end = whole.saturating_add(content).saturating_add(FRAME);
        if end > bytes.len() {
            break;
        }
        whole = end;
    }
    whole
}

/// Encodes the event after which readers discard what the file contains from this step on.
fn restart(step: u64) -> Vec<u8> {
    let step = field(STEP, VARINT, &varint(step));
    let start = field(STATUS, VARINT, &varint(START));
    [field(WALL_TIME, DOUBLE, &now().to_le_bytes()), step, sized(SESSION_LOG, &start)].concat()
}

fn now() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

/// Bytes of a record around its content: the length and both checksums.
const FRAME: usize = 16;

/// Frames an event as a record of the file.
fn framed(content: &[u8]) -> Vec<u8> {
    let length = (content.len() as u64).to_le_bytes();
    [&length, &masked(&length)[..], content, &masked(content)].concat()
}

/// Returns the masked checksum that the format requires: rotated and offset, so that checksums of data that contain
/// checksums stay useful.
fn masked(bytes: &[u8]) -> [u8; 4] {
    CHECKSUM.checksum(bytes).rotate_right(15).wrapping_add(0xa282_ead8).to_le_bytes()
}

/// Field numbers of an `Event`, of its `Summary`, of a value in the summary, and of its `SessionLog` with the status of a start.
const WALL_TIME: u8 = 1;
const STEP: u8 = 2;
const FILE_VERSION: u8 = 3;
const SUMMARY: u8 = 5;
const SESSION_LOG: u8 = 7;
const STATUS: u8 = 1;
const START: u64 = 1;
const VALUE: u8 = 1;
const TAG: u8 = 1;
const SIMPLE_VALUE: u8 = 2;

/// Wire types of fields.
const VARINT: u8 = 0;
const DOUBLE: u8 = 1;
const BYTES: u8 = 2;
const FLOAT: u8 = 5;

/// Encodes a line of metrics: every finite number under its name in `metrics.jsonl`, with the number of shots as the step.
fn event(record: &Record, wall_time: f64) -> Vec<u8> {
    let mut summary = Vec::new();
    let fields = serde_json::to_value(record).unwrap_or_default();
    let numbers = fields.as_object().into_iter().flatten().filter_map(|(name, value)| Some((name, value.as_f64()?)));
    for (name, value) in numbers {
        let value = [sized(TAG, name.as_bytes()), field(SIMPLE_VALUE, FLOAT, &(value as f32).to_le_bytes())].concat();
        summary.extend(sized(VALUE, &value));
    }
    let step = field(STEP, VARINT, &varint(record.shots));
    [field(WALL_TIME, DOUBLE, &wall_time.to_le_bytes()), step, sized(SUMMARY, &summary)].concat()
}

fn field(number: u8, kind: u8, content: &[u8]) -> Vec<u8> {
    [&[number << 3 | kind], content].concat()
}

fn sized(number: u8, content: &[u8]) -> Vec<u8> {
    field(number, BYTES, &[varint(content.len() as u64), content.to_vec()].concat())
}

/// Encodes an integer with seven bits per byte, the lowest first; all bytes but the last have the highest bit set.
fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_and_numbers_are_encoded_as_published() {
        // RFC 3720, B.4: 32 bytes of zeros.
        assert_eq!(CHECKSUM.checksum(&[0; 32]), 0x8a91_36aa);
        // Protocol buffers' own example.
        assert_eq!(varint(150), [0x96, 0x01]);
        assert_eq!(varint(0), [0]);
    }

    #[test]
    fn a_resumed_run_continues_the_same_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(FILE);
        let record = Record { shots: 300, ..Record::default() };
        EventFile::open(folder.path(), &[], 0).unwrap().push(&record).unwrap();
        let before = fs::read(&path).unwrap();
        // The process was killed in the middle of a record.
        fs::write(&path, [before.as_slice(), &framed(b"event")[..11]].concat()).unwrap();
        // Its metrics are lost, too; the line in this file stays valid.
        EventFile::open(folder.path(), &[], 300).unwrap().push(&record).unwrap();
        let after = fs::read(&path).unwrap();
        assert!(after.starts_with(&before), "what was written stays");
        assert_eq!(length_of_whole_records(&after), after.len(), "no record is cut off");
        let restart_at_301 = [STEP << 3, 0xad, 0x02, SESSION_LOG << 3 | BYTES, 2, STATUS << 3, START as u8];
        assert!(after[before.len()..].windows(7).any(|part| part == restart_at_301));
        fs::remove_file(&path).unwrap();
        EventFile::open(folder.path(), &[record], 300).unwrap();
        assert_eq!(fs::read(&path).unwrap().len(), before.len(), "a lost file is written anew");
    }

    #[test]
    fn a_file_has_a_version_and_one_event_per_line() {
        let folder = tempfile::tempdir().unwrap();
        let record = Record { shots: 300, critic_loss: f64::NAN, rollout_reward: 0.25, ..Record::default() };
        let mut file = EventFile::open(folder.path(), std::slice::from_ref(&record), 300).unwrap();
        file.push(&record).unwrap();
        let bytes = std::fs::read(folder.path().join(FILE)).unwrap();
        let (mut rest, mut events) = (bytes.as_slice(), Vec::new());
        while let Some((length, after)) = rest.split_first_chunk::<8>() {
            assert_eq!(after[..4], masked(length));
            let content = &after[4..][..u64::from_le_bytes(*length) as usize];
            let end = &after[4 + content.len()..];
            assert_eq!(end[..4], masked(content));
            events.push(content);
            rest = &end[4..];
        }
        assert_eq!(events.len(), 3);
        let has = |event: &[u8], part: &[u8]| event.windows(part.len()).any(|window| window == part);
        assert!(has(events[0], b"brain.Event:2"));
        let wall_times: Vec<f64> =
            events.iter().map(|event| f64::from_le_bytes(event[1..9].try_into().unwrap())).collect();
        assert!(wall_times.iter().all(|time| (now() - time).abs() < 60.0), "{wall_times:?}");
        for event in &events[1..] {
            assert!(has(event, b"rollout/ep_rew_mean") && has(event, &0.25_f32.to_le_bytes()));
            assert!(has(event, &[STEP << 3, 0xac, 0x02]), "300 shots");
            assert!(!has(event, b"critic_loss"), "NaN is left out");
        }
    }
}
