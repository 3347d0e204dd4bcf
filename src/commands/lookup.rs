//! Runs, policies and skills by the names that people call them.

use std::path::{Path, PathBuf};

use super::Failure;
use crate::{
    coach::{Skill, SkillError},
    drills::Store,
    learning::{
        Policy,
        policy::kept::{self, BUNDLED},
        run::list::latest_in,
    },
    storage::Places,
};

/// The word for the run that was last at work.
const LATEST: &str = "latest";

/// The folder `name`, or the one called so among the user's runs.
pub fn run_named(name: &Path) -> PathBuf {
    if name.exists() {
        return name.to_owned();
    }
    let known = Places::of_this_user().runs.join(name);
    if known.exists() { known } else { name.to_owned() }
}

/// The folder of a run that is there: as [`run_named`], or the user's latest for `latest`.
///
/// # Errors
/// Where there is no such folder.
pub fn existing_run(name: &Path) -> Result<PathBuf, Failure> {
    let folder = run_named(name);
    if folder.exists() {
        return Ok(folder);
    }
    let runs = Places::of_this_user().runs;
    if name == Path::new(LATEST) {
        return latest_in(&runs).ok_or_else(|| {
            Failure::failed(format_args!("there are no runs in {} yet; start one with carom train", runs.display()))
        });
    }
    Err(Failure::failed(format_args!(
        "there is no run {}, neither here nor in {}; carom train --list shows the runs there are",
        name.display(),
        runs.display()
    )))
}

/// The policy in the file `name`, or the one that the user has kept under this name.
///
/// # Errors
/// Where there is none, or none that can be used.
pub fn policy_called(name: &str) -> Result<Policy, Failure> {
    let file = kept::find(&Places::of_this_user().policies, name);
    if !file.exists() {
        return Err(Failure::failed(format_args!(
            "there is no policy {name}; accepted are {BUNDLED}, a file that carom train wrote, and the name of one that was kept"
        )));
    }
    Policy::load(&file).map_err(Failure::failed)
}

/// The word for the skill that the user has kept.
const OWN: &str = "own";

/// The skill called `name`, or the user's own for `own`.
///
/// # Errors
/// Where there is none.
pub fn skill_called(name: &str) -> Result<Skill, Failure> {
    if name == OWN {
        return own_skill()?.ok_or_else(|| {
            Failure::wrong_input("no skill of your own is kept yet; carom drill skill --keep estimates and keeps it")
        });
    }
    name.parse().map_err(|error| match error {
        SkillError::Unknown(_) => {
            Failure::wrong_input(format_args!("{error}; \"{OWN}\" is what carom drill skill --keep kept"))
        }
        SkillError::Range { .. } => Failure::wrong_input(error),
    })
}

/// The skill that the user has kept.
///
/// # Errors
/// Where its file cannot be read.
pub fn own_skill() -> Result<Option<Skill>, Failure> {
    let own = Store::new(&Places::of_this_user()).own_skill().map_err(Failure::failed)?;
    Ok(own.map(|own| own.skill))
}
