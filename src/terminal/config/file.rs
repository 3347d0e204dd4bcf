//! Reads and changes the settings file while the program runs, one task after the other.

use std::path::{Path, PathBuf};

use crate::{
    storage::{self, DataPaths, write_atomic},
    terminal::{
        Change, Mistake, Settings,
        config::{
            change::{changed, is_changeable},
            read::{line_at, read},
        },
    },
};

/// A task on the settings file.
#[derive(Clone, Debug)]
pub struct SettingsTask {
    /// Identifies the report of this task.
    pub number: u64,
    /// Locations of the settings file and of the player's own tables.
    pub paths: DataPaths,
    /// The change to make; `None` to read the file.
    pub change: Option<Change>,
}

/// The result of a task.
#[derive(Clone, Debug)]
pub struct SettingsReport {
    /// Number of the task.
    pub number: u64,
    /// The settings in the file; `None` if it cannot be read or is not valid TOML.
    pub settings: Option<Settings>,
    /// Whether the file can be changed, as far as known.
    pub is_writable: bool,
    /// Problems, one sentence each.
    pub troubles: Vec<String>,
    /// Files of the player's own tables.
    pub tables: Vec<PathBuf>,
}

/// State of the settings file.
#[derive(Debug, Default)]
pub struct SettingsFile {
    /// Whether the last attempt to write the file failed.
    has_failed: bool,
}

impl SettingsFile {
    /// Runs a task. A change is applied to the present text of the file, so that changes by other programs are kept.
    pub fn run(&mut self, task: &SettingsTask) -> SettingsReport {
        let SettingsTask { number, paths, change } = task;
        let path = &paths.settings;
        let report = |settings, is_writable, troubles| SettingsReport {
            number: *number,
            settings,
            is_writable,
            troubles,
            tables: paths.own_tables(),
        };
        let unwritten = |settings, sentence: String| {
            let sentence =
                format!("this change lasts until the program ends; {} was not written: {sentence}", path.display());
            report(settings, false, vec![sentence])
        };
        let found = match storage::read_if_exists(path, storage::MAX_SMALL_FILE) {
            Ok(found) => found,
            Err(error) if change.is_some() => return unwritten(None, error.to_string()),
            Err(error) => {
                let sentence = format!("{}: {}", path.display(), Mistake::of_file(&error));
                return report(None, false, vec![sentence]);
            }
        };
        let is_sound = str::from_utf8(found.as_deref().unwrap_or_default()).is_ok_and(is_changeable);
        let known = is_sound.then(|| settings(found.as_deref()));
        let Some(change) = change else {
            return report(known, is_sound && !self.has_failed, troubles(path, found.as_deref()));
        };
        let text = found.as_deref().map(str::from_utf8).transpose();
        let text = match text {
            Ok(text) => text,
            Err(error) => {
                let line = line_at(&String::from_utf8_lossy(found.as_deref().unwrap_or_default()), error.valid_up_to());
                return unwritten(known, format!("line {line} is not UTF-8"));
            }
        };
        let new = match changed(text, change) {
            Ok(new) => new,
            Err(error) => return unwritten(known, error.to_string()),
        };
        if text != Some(&new) {
            // A symbolic link stays a link.
            let target = storage::resolve_symlinks(path);
            let written = write_atomic(&target, new.as_bytes());
            self.has_failed = written.is_err();
            if let Err(error) = written {
                return unwritten(known, error.to_string());
            }
        }
        report(Some(settings(Some(new.as_bytes()))), !self.has_failed, Vec::new())
    }
}

fn settings(bytes: Option<&[u8]>) -> Settings {
    read(&String::from_utf8_lossy(bytes.unwrap_or_default())).0
}

/// The mistakes in the file.
fn troubles(path: &Path, bytes: Option<&[u8]>) -> Vec<String> {
    let (_, mistakes) = read(&String::from_utf8_lossy(bytes.unwrap_or_default()));
    Mistake::sentences(path, &mistakes)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::terminal::ThemeName;

    fn task(path: &Path, change: impl Into<Option<Change>>) -> SettingsTask {
        let paths = DataPaths { settings: path.to_owned(), ..DataPaths::under(path.parent().unwrap()) };
        SettingsTask { number: 1, paths, change: change.into() }
    }

    fn theme(name: &str) -> Change {
        Change::Value("theme", format!("\"{name}\""))
    }

    #[test]
    fn a_settings_file_is_created_read_and_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/config.toml");
        let mut file = SettingsFile::default();
        assert_eq!(file.run(&task(&path, None)).settings, Some(Settings::default()));
        let report = file.run(&task(&path, theme("light")));
        assert_eq!((report.settings.unwrap().theme, report.troubles.len()), (ThemeName::Light, 0));
    }

    #[cfg(unix)]
    #[test]
    fn symbolic_links_to_settings_stay() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("config.toml");
        let mut file = SettingsFile::default();
        file.run(&task(&path, None));
        file.run(&task(&path, theme("light")));
        let linked = folder.path().join("linked.toml");
        std::os::unix::fs::symlink(&path, &linked).unwrap();
        let mut file = SettingsFile::default();
        file.run(&task(&linked, None));
        assert!(file.run(&task(&linked, theme("mono"))).troubles.is_empty());
        assert!(fs::symlink_metadata(&linked).unwrap().is_symlink());
        assert!(fs::read_to_string(&path).unwrap().contains("theme = \"mono\""));
    }

    #[test]
    fn a_damaged_settings_file_is_reported_with_its_line_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("config.toml");
        for (bytes, line) in [(&b"plan = true\nspeed = = 2\n"[..], "line 2"), (b"plan = true\n# \xff\n", "line 2")] {
            fs::write(&path, bytes).unwrap();
            let mut file = SettingsFile::default();
            assert!(!file.run(&task(&path, None)).is_writable);
            let report = file.run(&task(&path, theme("light")));
            assert!(!report.is_writable && report.troubles[0].contains(line), "{report:?}");
            assert_eq!(fs::read(&path).unwrap(), bytes);
        }
        let report = SettingsFile::default().run(&task(folder.path(), theme("light")));
        assert!(
            report.settings.is_none() && report.troubles[0].contains("this change lasts until the program ends"),
            "{report:?}"
        );
    }
}
