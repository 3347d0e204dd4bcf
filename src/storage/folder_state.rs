//! Whether a folder can be written into, and how much fits there, found out without leaving anything behind.

use std::{
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

use crate::platform;

/// What is known of a place where files are to be kept.
#[derive(Debug)]
pub struct FolderState {
    /// Whether there is such a folder already. It is made when something is kept.
    pub exists: bool,
    /// Why nothing can be written there; nothing where it can.
    pub refusal: Option<io::Error>,
    /// Bytes that fit there; none where the system does not tell.
    pub free: Option<u64>,
}

/// Looks at the folder, or at the one above it in which it would be made.
pub fn folder_state(folder: &Path) -> FolderState {
    let above = match existing(folder) {
        Ok(above) => above,
        Err(error) => return FolderState { exists: false, refusal: Some(error), free: None },
    };
    let free = platform::free_space(&above).ok().flatten();
    // The file has no name where the system knows such files, and is gone with this line everywhere.
    let refusal = tempfile::tempfile_in(&above).err();
    FolderState { exists: above == folder, refusal, free }
}

/// The folder, or the nearest above it that is there.
fn existing(folder: &Path) -> io::Result<PathBuf> {
    let mut above = folder;
    loop {
        match std::fs::metadata(above) {
            Ok(found) if found.is_dir() => return Ok(above.to_owned()),
            Ok(_) => return Err(io::Error::new(ErrorKind::NotADirectory, format!("{} is no folder", above.display()))),
            Err(error) if error.kind() == ErrorKind::NotFound => match above.parent() {
                Some(parent) if parent.as_os_str().is_empty() => above = Path::new("."),
                Some(parent) => above = parent,
                None => return Err(error),
            },
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_not_there_is_judged_by_the_one_above_and_not_made() {
        let home = tempfile::tempdir().unwrap();
        let deep = home.path().join("deep/folder");
        let state = folder_state(&deep);
        assert!(!state.exists && state.refusal.is_none(), "{state:?}");
        assert!(!home.path().join("deep").exists());
        let state = folder_state(home.path());
        assert!(state.exists && state.refusal.is_none(), "{state:?}");
        assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 0);
    }

    #[test]
    fn where_a_file_stands_in_the_way_nothing_can_be_written() {
        let home = tempfile::tempdir().unwrap();
        std::fs::write(home.path().join("taken"), "").unwrap();
        let state = folder_state(&home.path().join("taken/inside"));
        assert!(state.refusal.is_some(), "{state:?}");
    }
}
