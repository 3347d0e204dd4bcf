//! Sharing of the table with other players: writes it after each change, while the player allows it.

use std::{
    fs,
    path::PathBuf,
    time::{Duration, Instant},
};

use crate::{
    storage::Lock,
    terminal::{
        App,
        shared_table::{FILE, SharedTable},
    },
};

/// Smallest interval between two writes; viewers do not read more often.
const INTERVAL: Duration = Duration::from_millis(100);

/// Writer of the shared table.
#[derive(Debug)]
pub struct TableSharing {
    folder: PathBuf,
    open: Option<Open>,
}

/// State while the table is shared.
#[derive(Debug)]
struct Open {
    /// Signals that the table is still shared; released when the process ends, however that happens.
    _lock: Lock,
    written: Option<SharedTable>,
    when: Instant,
}

impl TableSharing {
    /// Creates a writer for `folder`; nothing is shared yet.
    pub const fn new(folder: PathBuf) -> Self {
        Self { folder, open: None }
    }

    /// Time of the next write; `None` if there is nothing to write.
    pub fn due(&self, app: &App) -> Option<Instant> {
        self.due_for(app.shared_table().as_ref())
    }

    fn due_for(&self, now: Option<&SharedTable>) -> Option<Instant> {
        match (now, &self.open) {
            (None, None) => None,
            (Some(now), Some(open)) => {
                let is_seen = |seen: &SharedTable| !seen.is_outdated_by(open.when.elapsed(), now);
                (!open.written.as_ref().is_some_and(is_seen)).then(|| open.when + INTERVAL)
            }
            _ => Some(Instant::now()),
        }
    }

    /// Writes the table if a write is due.
    ///
    /// # Errors
    /// A message that says why the table cannot be shared; sharing then ends.
    pub fn write(&mut self, app: &App) -> Result<(), String> {
        let now = app.shared_table();
        if self.due_for(now.as_ref()).is_none_or(|due| due > Instant::now()) {
            return Ok(());
        }
        let Some(now) = now else {
            self.stop();
            return Ok(());
        };
        let shown = self.show(now);
        if shown.is_err() {
            self.stop();
        }
        shown
    }

    fn show(&mut self, now: SharedTable) -> Result<(), String> {
        let refusal =
            |error: std::io::Error| format!("{}: {error}; others cannot see the table", self.folder.display());
        if self.open.is_none() {
            fs::create_dir_all(&self.folder).map_err(refusal)?;
            let lock = Lock::try_acquire(&self.folder).map_err(refusal)?;
            let lock = lock.ok_or("another session of yours already shows its table")?;
            self.open = Some(Open { _lock: lock, written: None, when: Instant::now() });
        }
        now.write(&self.folder).map_err(refusal)?;
        if let Some(open) = &mut self.open {
            (open.written, open.when) = (Some(now), Instant::now());
        }
        Ok(())
    }

    /// Stops sharing.
    pub fn stop(&mut self) {
        if self.open.is_some() {
            // If the file cannot be removed, readers still ignore it without its lock.
            let _ = fs::remove_file(self.folder.join(FILE));
            self.open = None;
        }
    }
}
