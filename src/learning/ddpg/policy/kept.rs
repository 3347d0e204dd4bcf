//! The policies that a user has kept, by their names.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::{Policy, file::PolicyError};
use crate::storage::{NAME_RULE, is_name, write_atomic};

/// What the files are called after their names.
const EXTENSION: &str = "safetensors";

/// The word for the policies that the program brings along, where one is chosen by its name.
pub const BUNDLED: &str = "bundled";

/// Why a policy cannot be kept.
#[derive(Debug, thiserror::Error)]
pub enum KeepError {
    /// No file could be called so.
    #[error("\"{0}\" is no name for a policy; accepted are {NAME_RULE}")]
    Name(String),
    /// The program calls its own ones so.
    #[error("\"{BUNDLED}\" is what the bundled policies are called; take another name")]
    Bundled,
    /// There is one of that name.
    #[error("there is a policy \"{0}\" already")]
    Taken(String),
    /// It is no policy that can be used.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The file cannot be written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// What the system says.
        reason: io::Error,
    },
}

/// The policy that is kept under `name` in `folder`, if there is one.
pub fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    Some(file(folder, name)).filter(|kept| is_name(name) && kept.exists())
}

/// Keeps the policy in the file `policy` under `name` in `folder`, and returns where. One of the same name is replaced only
/// if `replaces` says so.
///
/// # Errors
/// [`KeepError`]; what was kept before is then untouched.
pub fn keep(folder: &Path, policy: &Path, name: &str, replaces: bool) -> Result<PathBuf, KeepError> {
    if !is_name(name) {
        return Err(KeepError::Name(name.to_owned()));
    }
    if name == BUNDLED {
        return Err(KeepError::Bundled);
    }
    let kept = file(folder, name);
    if kept.exists() && !replaces {
        return Err(KeepError::Taken(name.to_owned()));
    }
    let (_, bytes) = Policy::load_with_bytes(policy)?;
    write_atomic(&kept, &bytes).map_err(|reason| KeepError::File { path: kept.display().to_string(), reason })?;
    Ok(kept)
}

fn file(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.{EXTENSION}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_policy_is_kept_found_and_replaced_only_on_demand() {
        let folder = tempfile::tempdir().unwrap();
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
        let [first, second] = ["match-r3", "thesis-r3"].map(|name| models.join(name).with_extension(EXTENSION));
        let kept = keep(folder.path(), &first, "mine", false).unwrap();
        assert_eq!(find(folder.path(), "mine").as_ref(), Some(&kept));
        assert_eq!(std::fs::read(&kept).unwrap(), std::fs::read(&first).unwrap());
        assert!(matches!(keep(folder.path(), &second, "mine", false), Err(KeepError::Taken(_))));
        keep(folder.path(), &second, "mine", true).unwrap();
        assert_eq!(std::fs::read(&kept).unwrap(), std::fs::read(&second).unwrap());
        assert_eq!([find(folder.path(), "other"), find(folder.path(), "../mine")], [None, None]);
    }

    #[test]
    fn other_names_and_other_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["", "a/b", "..", "../up", ".hidden", "with blank", &"x".repeat(101)] {
            let error = keep(folder.path(), Path::new("nowhere"), name, true).unwrap_err().to_string();
            assert!(error.contains("no name for a policy"), "{name}: {error}");
        }
        assert!(matches!(keep(folder.path(), Path::new("nowhere"), BUNDLED, true), Err(KeepError::Bundled)));
        let note = folder.path().join("note");
        std::fs::write(&note, "no policy").unwrap();
        assert!(matches!(keep(folder.path(), &note, "note", false), Err(KeepError::Policy(_))));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
