//! Polls a run's files and reports what has changed.

use std::{
    io,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use super::{
    Condition, Update,
    condition::{RunSigns, condition},
    stamp::Stamp,
    tail::Tail,
};
use crate::{
    learning::run::{
        METRICS,
        config::{self, Config},
        contains_run,
        examples::{self, Examples},
        metrics,
        status::{self, RunStatus},
    },
    storage::Lock,
};

/// Time between two looks at the lock and at files that change seldom. Each look at the lock takes it for an instant.
const SLOW_INTERVAL: Duration = Duration::from_secs(1);

/// Polls a run's files. It only reads them, so any number of followers may follow one run.
#[derive(Debug, Default)]
pub struct Follower {
    folder: PathBuf,
    tail: Tail,
    last_slow_poll: Option<Instant>,
    config: Option<Stamp>,
    status: Option<Stamp>,
    examples: Option<Stamp>,
    /// When a change of the status file was last seen, and how old the file was then; `None` before the first status.
    status_changed: Option<(Instant, Duration)>,
    /// Lines of metrics read.
    lines: u64,
    /// Shots played, and shots at the last line of metrics, according to the status file.
    played: u64,
    logged: u64,
    signs: RunSigns,
    condition: Condition,
    /// Problem of each file, in the order of the notices.
    problems: [Option<String>; 4],
    /// The notices as last reported.
    reported: Vec<String>,
}

impl Follower {
    /// Creates a follower of the run in `folder`, which need not exist yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), tail: Tail::new(&folder.join(METRICS)), ..Self::default() }
    }

    /// Looks once; `None` if nothing has changed. Never fails: problems become notices.
    pub fn poll(&mut self) -> Option<Update> {
        let mut update = Update::default();
        if self.last_slow_poll.is_none_or(|last| last.elapsed() >= SLOW_INTERVAL) {
            self.last_slow_poll = Some(Instant::now());
            self.poll_slow_files(&mut update);
        }
        self.poll_status(&mut update);
        let is_there = self.poll_metrics(&mut update);
        self.signs.silent = self.status_changed.map_or(Duration::ZERO, |(seen, age)| age + seen.elapsed());
        let now = condition(&self.signs);
        if now != self.condition {
            self.condition = now;
            update.condition = Some(now);
        }
        self.problems[2] = self.metrics_problem(is_there);
        let notices: Vec<String> = self.problems.iter().flatten().cloned().collect();
        if notices != self.reported {
            self.reported.clone_from(&notices);
            update.notices = Some(notices);
        }
        (update != Update::default()).then_some(update)
    }

    /// Returns the run's condition at the last look, given the known numbers of shots played and planned.
    pub(in crate::learning::run) fn condition_after(&self, shots: u64, planned: u64) -> Condition {
        condition(&RunSigns { shots: Some(shots), planned: Some(planned), ..self.signs.clone() })
    }

    /// Looks at what changes once a minute or never.
    fn poll_slow_files(&mut self, update: &mut Update) {
        self.signs.is_locked = Lock::is_held(&self.folder);
        self.signs.is_run = contains_run(&self.folder);
        self.signs.is_there = self.folder.is_dir();
        self.signs.was_there |= self.signs.is_there;
        let stamp = Stamp::of(&self.folder.join(config::FILE));
        if stamp != self.config {
            self.config = stamp;
            match Config::read(&self.folder) {
                Ok(config) => {
                    self.signs.planned = Some(config.plan.shots);
                    self.problems[0] = config.newer_version().map(|version| {
                        format!(
                            "the run was started by carom {version}, which is newer than this one: some of it may not be shown"
                        )
                    });
                    update.config = Some(Box::new(config));
                }
                // A missing file is no problem.
                Err(_) if stamp.is_none() => self.problems[0] = None,
                Err(error) => {
                    let reason = config::unreadable_message(&self.folder, &error);
                    self.problems[0] = Some(format!("{reason}; the charts are shown without it"));
                }
            }
        }
        let stamp = Stamp::of(&self.folder.join(examples::FILE));
        if stamp != self.examples {
            self.examples = stamp;
            let read = Examples::read(&self.folder);
            let problem = read.as_ref().err().filter(|_| stamp.is_some());
            self.problems[3] = problem.map(|error| format!("{} cannot be read: {error}", examples::FILE));
            update.examples = read.ok();
        }
    }

    fn poll_status(&mut self, update: &mut Update) {
        let stamp = Stamp::of(&self.folder.join(status::FILE));
        if stamp == self.status {
            return;
        }
        let is_first = self.status.is_none();
        self.status = stamp;
        // At the first look, the age of the file counts: a run without heartbeat for an hour has been silent for an hour.
        let age = stamp.filter(|_| is_first).map_or(Duration::ZERO, |stamp| stamp.age());
        self.status_changed = Some((Instant::now(), age));
        match RunStatus::read(&self.folder) {
            Ok(status) => {
                self.signs.phase = Some(status.phase);
                (self.played, self.logged) = (status.shots, status.logged);
                self.problems[1] = None;
                update.status = Some(status);
            }
            Err(_) if stamp.is_none() => {
                // A resumed run has removed the lines after its checkpoint, and its next status will contain their number.
                (self.signs.phase, self.logged) = (None, 0);
                self.problems[1] = None;
            }
            Err(error) => self.problems[1] = Some(format!("{} cannot be read: {error}", status::FILE)),
        }
    }

    /// Reads new lines; `false` if there is no file.
    fn poll_metrics(&mut self, update: &mut Update) -> io::Result<bool> {
        let (mut is_restarted, mut records) = (false, Vec::new());
        let is_there = self.tail.poll(&mut is_restarted, &mut records);
        let last = records.last().map(|record| record.shots);
        let is_first = self.lines == 0 && last.is_some();
        update.replaces_records = is_first || is_restarted && (last.is_some() || is_there.is_ok());
        if is_restarted {
            (self.lines, self.signs.shots) = (0, None);
        }
        self.lines += records.len() as u64;
        self.signs.shots = last.or(self.signs.shots);
        update.records = records;
        is_there
    }

    fn metrics_problem(&self, is_there: io::Result<bool>) -> Option<String> {
        let read = self.signs.shots.unwrap_or(0);
        let is_behind = self.logged > read;
        match is_there {
            Err(error) => Some(format!("{METRICS} cannot be read: {error}; what was read before is still shown")),
            Ok(false) if self.lines > 0 => {
                Some(format!("{METRICS} has been removed; what was read before is still shown"))
            }
            Ok(false) if is_behind => {
                Some(format!("{METRICS} is missing: there is nothing to show of the {} shots played", self.played))
            }
            Ok(_) => match self.tail.unreadable {
                0 if self.condition.is_over() && self.tail.ends_mid_line() => {
                    Some(format!("the last line of {METRICS} is cut off and is left out"))
                }
                0 if is_behind => Some(metrics::cut_off_notice(read, self.played)),
                0 => None,
                1 => Some(format!("1 line of {METRICS} cannot be read and is left out")),
                lines => Some(format!("{lines} lines of {METRICS} cannot be read and are left out")),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::learning::run::{follow::Followed, metrics::Record};

    #[test]
    fn only_lines_that_were_written_are_reported_missing() {
        let folder = tempfile::tempdir().unwrap();
        let notices = |read: u64, logged: u64| {
            let line = Record { shots: read, ..Record::default() };
            fs::write(folder.path().join(METRICS), serde_json::to_string(&line).unwrap() + "\n").unwrap();
            RunStatus { shots: 3072, logged, ..RunStatus::default() }.write(folder.path()).unwrap();
            let mut followed = Followed::new(folder.path());
            followed.apply(Follower::new(folder.path()).poll().unwrap());
            followed.notices
        };
        // No notice if shots were played since the last line, or if an earlier version has not stored the number of logged shots.
        assert_eq!((notices(2880, 2880), notices(960, 0)), (vec![], vec![]));
        assert_eq!(
            notices(960, 2880),
            ["metrics.jsonl has been emptied or cut off: it ends after 960 of the 3072 shots played"]
        );
        // No notice while a resumed run has removed lines but has not written its status yet.
        let (mut follower, mut followed) = (Follower::new(folder.path()), Followed::new(folder.path()));
        followed.apply(follower.poll().unwrap());
        assert_eq!(followed.notices.len(), 1);
        fs::remove_file(folder.path().join(status::FILE)).unwrap();
        followed.apply(follower.poll().unwrap());
        assert_eq!(followed.notices, Vec::<String>::new());
    }
}
