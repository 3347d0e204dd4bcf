//! The user's library of policies: saves policy files under names and finds them.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::{Policy, file::PolicyError};
use crate::storage::{NAME_RULE, is_name, write_atomic};

/// Extension of the files.
pub const EXTENSION: &str = "safetensors";

/// The reserved name that selects the bundled policies.
pub const BUNDLED: &str = "bundled";

/// A policy cannot be saved in the library.
#[derive(Debug, thiserror::Error)]
pub enum SavePolicyError {
    /// The name is not valid.
    #[error("\"{0}\" is no name for a policy; accepted are {NAME_RULE}")]
    Name(String),
    /// The name is reserved for the bundled policies.
    #[error("\"{BUNDLED}\" is reserved for the bundled policies; use another name")]
    Bundled,
    /// A policy of this name exists.
    #[error("a policy \"{0}\" already exists")]
    Exists(String),
    /// The file is not a usable policy.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The file cannot be written.
    #[error("{path}: {reason}")]
    File {
        /// Path of the file.
        path: String,
        /// Error of the operating system.
        reason: io::Error,
    },
}

/// Returns the path of the policy `name` in `folder`, if it exists.
pub fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    Some(file(folder, name)).filter(|kept| is_name(name) && kept.exists())
}

/// Copies the policy file `policy` to `folder` under `name` and returns the new path. Replaces a policy of the same name only if
/// `replaces`. After an error, an existing policy is unchanged.
pub fn save(folder: &Path, policy: &Path, name: &str, replaces: bool) -> Result<PathBuf, SavePolicyError> {
    if !is_name(name) {
        return Err(SavePolicyError::Name(name.to_owned()));
    }
    if name == BUNDLED {
        return Err(SavePolicyError::Bundled);
    }
    let kept = file(folder, name);
    if kept.exists() && !replaces {
        return Err(SavePolicyError::Exists(name.to_owned()));
    }
    let (_, bytes) = Policy::load_with_bytes(policy)?;
    write_atomic(&kept, &bytes).map_err(|reason| SavePolicyError::File { path: kept.display().to_string(), reason })?;
    Ok(kept)
}

fn file(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.{EXTENSION}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn policies_are_saved_found_and_replaced_on_demand() {
        let folder = tempfile::tempdir().unwrap();
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
        let [first, second] = ["match-r3", "thesis-r3"].map(|name| models.join(name).with_extension(EXTENSION));
        let kept = save(folder.path(), &first, "mine", false).unwrap();
        assert_eq!(find(folder.path(), "mine").as_ref(), Some(&kept));
        assert_eq!(std::fs::read(&kept).unwrap(), std::fs::read(&first).unwrap());
        assert!(matches!(save(folder.path(), &second, "mine", false), Err(SavePolicyError::Exists(_))));
        save(folder.path(), &second, "mine", true).unwrap();
        assert_eq!(std::fs::read(&kept).unwrap(), std::fs::read(&second).unwrap());
        assert_eq!([find(folder.path(), "other"), find(folder.path(), "../mine")], [None, None]);
    }

    #[test]
    fn other_names_and_other_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["", "a/b", "..", "../up", ".hidden", "with blank", &"x".repeat(101)] {
            let error = save(folder.path(), Path::new("nowhere"), name, true).unwrap_err().to_string();
            assert!(error.contains("no name for a policy"), "{name}: {error}");
        }
        assert!(matches!(save(folder.path(), Path::new("nowhere"), BUNDLED, true), Err(SavePolicyError::Bundled)));
        let note = folder.path().join("note");
        std::fs::write(&note, "no policy").unwrap();
        assert!(matches!(save(folder.path(), &note, "note", false), Err(SavePolicyError::Policy(_))));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
