//! The policy that a run has learnt: reading it for the coach, and keeping it under a name.

use std::{fs, io::ErrorKind, path::Path, sync::Arc};

use crate::{
    learning::{Policy, run::POLICY},
    storage::write_atomic,
    terminal::training::{Keeping, Kept},
};

/// Where there is no policy.
const NONE: &str = "the run has no policy for the coach: it comes with the first measurement, and the thesis' agents \
                    have none";

/// The policy of the run in `folder`.
///
/// # Errors
/// A sentence where there is none, or none that can be used.
pub fn load(folder: &Path) -> Result<Arc<Policy>, String> {
    let path = folder.join(POLICY);
    if !path.exists() {
        return Err(NONE.to_owned());
    }
    Policy::load(&path).map(Arc::new).map_err(|error| error.to_string())
}

/// Copies a policy to where policies are kept, or says that its name is taken.
///
/// # Errors
/// A sentence where there is none, or the copy cannot be written.
pub fn keep(keeping: &Keeping) -> Result<Kept, String> {
    let Keeping { from, to, replace, .. } = keeping;
    let bytes = fs::read(from).map_err(|error| match error.kind() {
        ErrorKind::NotFound => NONE.to_owned(),
        _ => format!("{}: {error}", from.display()),
    })?;
    if to.exists() && !replace {
        return Ok(Kept::Taken);
    }
    write_atomic(to, &bytes).map_err(|error| format!("{}: {error}", to.display()))?;
    Ok(Kept::Done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_policy_is_kept_once_and_replaced_only_where_that_was_allowed() {
        let folder = tempfile::tempdir().unwrap();
        let (from, to) = (folder.path().join("run"), folder.path().join("policies/best.safetensors"));
        let mut keeping = Keeping { from: from.clone(), to: to.clone(), name: "best".into(), replace: false };
        assert!(keep(&keeping).unwrap_err().contains("no policy"));
        fs::write(&from, "one").unwrap();
        assert_eq!(keep(&keeping), Ok(Kept::Done));
        fs::write(&from, "two").unwrap();
        assert_eq!(keep(&keeping), Ok(Kept::Taken));
        assert_eq!(fs::read_to_string(&to).unwrap(), "one");
        keeping.replace = true;
        assert_eq!(keep(&keeping), Ok(Kept::Done));
        assert_eq!(fs::read_to_string(&to).unwrap(), "two");
    }
}
