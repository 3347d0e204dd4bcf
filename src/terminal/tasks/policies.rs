//! The policy that a run has learnt: reading it for the coach, and keeping it under a name.

use std::{path::Path, sync::Arc};

use crate::{
    learning::{
        Policy,
        policy::kept::{self, KeepError},
        run::POLICY,
    },
    terminal::{Keeping, tasks::training::NO_POLICY},
};

/// The policy of the run in `folder`.
///
/// # Errors
/// A sentence where there is none, or none that can be used.
pub fn load(folder: &Path) -> Result<Arc<Policy>, String> {
    let path = folder.join(POLICY);
    if !path.exists() {
        return Err(NO_POLICY.to_owned());
    }
    Policy::load(&path).map(Arc::new).map_err(|error| error.to_string())
}

/// Keeps a policy where policies are kept; `false` where its name is taken.
///
/// # Errors
/// A sentence where there is none, or the copy cannot be written.
pub fn keep(keeping: &Keeping) -> Result<bool, String> {
    let Keeping { from, folder, name, replace } = keeping;
    if !from.exists() {
        return Err(NO_POLICY.to_owned());
    }
    match kept::keep(folder, from, name, *replace) {
        Ok(_) => Ok(true),
        Err(KeepError::Taken(_)) => Ok(false),
        Err(error) => Err(error.to_string()),
    }
}
