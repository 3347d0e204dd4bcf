//! Showing the table to others: written where they look, when it changes, as long as the player allows it.

use std::{
    fs,
    path::PathBuf,
    time::{Duration, Instant},
};

use crate::{
    storage::Lock,
    terminal::{
        App,
        shown::{FILE, ShownTable},
    },
};

/// Least time between two times that the table is written: whoever looks on looks no more often.
const INTERVAL: Duration = Duration::from_millis(100);

/// The table as others see it.
#[derive(Debug)]
pub struct Showing {
    folder: PathBuf,
    open: Option<Open>,
}

/// What others see at present.
#[derive(Debug)]
struct Open {
    /// Says that it is shown still: it ends with the process, however that ends.
    _lock: Lock,
    written: Option<ShownTable>,
    when: Instant,
}

impl Showing {
    /// Nothing is shown yet; it will be in `folder`.
    pub const fn new(folder: PathBuf) -> Self {
        Self { folder, open: None }
    }

    /// When something is to be written; `None` where nothing is.
    pub fn due(&self, app: &App) -> Option<Instant> {
        self.due_for(app.shown_table().as_ref())
    }

    fn due_for(&self, now: Option<&ShownTable>) -> Option<Instant> {
        match (now, &self.open) {
            (None, None) => None,
            (Some(now), Some(open)) => {
                let is_seen = |seen: &ShownTable| !seen.is_outdated_by(open.when.elapsed(), now);
                (!open.written.as_ref().is_some_and(is_seen)).then(|| open.when + INTERVAL)
            }
            _ => Some(Instant::now()),
        }
    }

    /// Writes what is due.
    ///
    /// # Errors
    /// A sentence why it cannot be shown; nothing is then.
    pub fn write(&mut self, app: &App) -> Result<(), String> {
        let now = app.shown_table();
        if self.due_for(now.as_ref()).is_none_or(|due| due > Instant::now()) {
            return Ok(());
        }
        let Some(now) = now else {
            self.end();
            return Ok(());
        };
        let shown = self.show(now);
        if shown.is_err() {
            self.end();
        }
        shown
    }

    fn show(&mut self, now: ShownTable) -> Result<(), String> {
        let refusal =
            |error: std::io::Error| format!("{}: {error}; others see nothing of the table", self.folder.display());
        if self.open.is_none() {
            fs::create_dir_all(&self.folder).map_err(refusal)?;
            let lock = Lock::take(&self.folder).map_err(refusal)?;
            let lock = lock.ok_or("others see the table of another session of yours already")?;
            self.open = Some(Open { _lock: lock, written: None, when: Instant::now() });
        }
        now.write(&self.folder).map_err(refusal)?;
        if let Some(open) = &mut self.open {
            (open.written, open.when) = (Some(now), Instant::now());
        }
        Ok(())
    }

    /// Takes it away from the others' eyes.
    pub fn end(&mut self) {
        if self.open.is_some() {
            // What cannot be removed is not shown without its lock.
            let _ = fs::remove_file(self.folder.join(FILE));
            self.open = None;
        }
    }
}
