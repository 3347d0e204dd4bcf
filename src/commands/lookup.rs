//! Runs, policies and skills by the names that people call them.

use std::path::{Path, PathBuf};

use super::Failure;
use crate::{
    coach::{Skill, SkillError},
    drills::Store,
    learning::{
        Policy,
        policy::kept::{self, BUNDLED},
        run::{Config, POLICY, agent_of_checkpoint, list::latest_in},
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

/// What `--from` names: a folder or a file that is there, as [`run_named`] finds it.
///
/// # Errors
/// Where there is none.
pub fn weights_named(name: &Path) -> Result<PathBuf, Failure> {
    let found = run_named(name);
    if found.exists() {
        return Ok(found);
    }
    Err(Failure::failed(format_args!(
        "there is nothing called {} to start from, neither here nor among the runs in {}; accepted are a run (its folder or its \
         name), a checkpoint file and a policy file",
        name.display(),
        Places::of_this_user().runs.display()
    )))
}

/// The policy in the file `name`, that of the run in the folder `name`, or the one that the user has kept under this name.
///
/// # Errors
/// Where there is none, or none that can be used.
pub fn policy_called(name: &str) -> Result<Policy, Failure> {
    let found = kept::find(&Places::of_this_user().policies, name);
    let found = if found.exists() { found } else { run_named(Path::new(name)) };
    if !found.exists() {
        return Err(Failure::failed(format_args!(
            "there is no policy {name}; accepted are {BUNDLED}, a file that carom train wrote, a run's folder, and the name of \
             one that was kept"
        )));
    }
    if found.is_dir() {
        return policy_of_run(&found);
    }
    if let Some(agent) = agent_of_checkpoint(&found) {
        let shown = found.display();
        let advice = if agent == WRITES_POLICIES {
            format!("its run's policy is {}", found.with_file_name(POLICY).display())
        } else {
            no_policies_of(&agent)
        };
        return Err(Failure::wrong_input(format_args!("{shown} is a checkpoint, not a policy; {advice}")));
    }
    Ok(Policy::load(&found)?)
}

/// The policy in a run's folder.
fn policy_of_run(folder: &Path) -> Result<Policy, Failure> {
    let (file, shown) = (folder.join(POLICY), folder.display());
    if file.exists() {
        return Ok(Policy::load(&file)?);
    }
    let agent = Config::read(folder).map(|config| config.agent);
    Err(Failure::failed(match agent {
        Ok(agent) if agent == WRITES_POLICIES => format!(
            "the run {shown} has no {POLICY} yet: it is written at the first measurement, and when the run is stopped"
        ),
        Ok(agent) => format!("the run {shown} has no policy; {}", no_policies_of(&agent)),
        Err(_) => format!("{shown} is a folder without a {POLICY}; accepted are a policy file and the folder of a run"),
    }))
}

/// The agent whose runs write policies.
const WRITES_POLICIES: &str = "ddpg";

/// Why a run of another agent has no policy.
fn no_policies_of(agent: &str) -> String {
    format!(
        "its agent is {agent}, and only the agent {WRITES_POLICIES} writes policies: as RUN/{POLICY}, in the folder of its run"
    )
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
            Failure::failed("no skill of your own is kept yet; carom drill skill --keep estimates and keeps it")
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
