//! Whether a folder is writable and how much fits in it, found without leaving any file behind.

use std::{
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

use crate::platform;

/// State of a folder in which files are to be stored.
#[derive(Debug)]
pub struct FolderState {
    /// Whether the folder exists. It is created on the first write.
    pub exists: bool,
    /// Why the folder is not writable; `None` if it is.
    pub refusal: Option<io::Error>,
    /// Free bytes; `None` if the system does not report them.
    pub free: Option<u64>,
}

/// Checks the folder, or the nearest existing folder above it.
pub fn folder_state(folder: &Path) -> FolderState {
    let above = match existing(folder) {
        Ok(above) => above,
        Err(error) => return FolderState { exists: false, refusal: Some(error), free: None },
    };
    let free = platform::free_space(&above);
    // The temporary file has no name on systems that support this. On every system it is deleted at the end of this statement.
    let refusal = tempfile::tempfile_in(&above).err();
    FolderState { exists: above == folder, refusal, free }
}

/// Returns the folder, or the nearest existing one above it.
fn existing(folder: &Path) -> io::Result<PathBuf> {
    let mut above = folder;
    loop {
        match std::fs::metadata(above) {
            Ok(found) if found.is_dir() => return Ok(above.to_owned()),
            Ok(_) => {
                return Err(io::Error::new(ErrorKind::NotADirectory, format!("{} is not a folder", above.display())));
            }
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
    fn a_missing_folder_is_judged_by_its_parent() {
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
    fn a_file_in_place_of_the_folder_is_refused() {
        let home = tempfile::tempdir().unwrap();
        std::fs::write(home.path().join("taken"), "").unwrap();
        let state = folder_state(&home.path().join("taken/inside"));
        assert!(state.refusal.is_some(), "{state:?}");
    }
}
