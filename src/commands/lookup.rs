//! Look-up of runs, policies and skills by name.

use std::{
    fmt::Display,
    path::{Path, PathBuf},
};

use super::Failure;
use crate::{
    coach::{Skill, SkillError},
    drills::Store,
    game::Rule,
    learning::{
        Policy,
        policy::{
            bundled_names,
            library::{self, BUNDLED},
        },
        run::{Config, POLICY, agent_of_checkpoint, list::latest_in},
    },
    printing::did_you_mean,
    storage::DataPaths,
    table::Table,
};

/// The name for the run that was trained most recently.
pub const LATEST: &str = "latest";

/// Returns the file or folder `name`, the folder of that name among the user's runs, or the most recent run for `latest`.
fn run_path(name: &Path) -> Option<PathBuf> {
    let runs = DataPaths::of_this_user().runs;
    let named = [name.to_owned(), runs.join(name)].into_iter().find(|path| path.exists());
    named.or_else(|| if name == Path::new(LATEST) { latest_in(&runs) } else { None })
}

/// Returns the names of the files in `folder` with this extension, or of the folders in it without one.
fn names_in(folder: &Path, extension: Option<&str>) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let of_kind = |path: &PathBuf| match extension {
        Some(extension) => path.extension().is_some_and(|own| own == extension),
        None => path.is_dir(),
    };
    let name = |path: PathBuf| {
        if extension.is_some() { path.file_stem()?.to_str() } else { path.file_name()?.to_str() }.map(str::to_owned)
    };
    entries.filter(of_kind).filter_map(name).collect()
}

/// Returns the file of the policy that the user has saved under this name.
fn saved_policy_path(name: &Path) -> Option<PathBuf> {
    library::find(&DataPaths::of_this_user().policies, name.to_str()?)
}

/// Reports that nothing is called `name`, and what would be accepted.
fn not_found(what: impl Display, name: &str, accepted: &str) -> Failure {
    let (paths, bundled) = (DataPaths::of_this_user(), bundled_names().collect::<Vec<_>>());
    let saved = names_in(&paths.policies, Some(library::EXTENSION));
    let known = bundled.iter().map(|name| (*name).to_owned()).chain(names_in(&paths.runs, None)).chain(saved);
    Failure::failed(format_args!(
        "there is {what}, neither here nor among the runs in {}; accepted are a run (its folder, its name or {LATEST}), {accepted} a \
         policy (its file, the name of one that was kept, {BUNDLED}, or one of {}){}",
        paths.runs.display(),
        bundled.join(", "),
        did_you_mean(name, known)
    ))
}

/// Returns the folder of an existing run: the path itself, a name among the user's runs, or the most recent run for `latest`.
///
/// # Errors
/// Fails if there is no such folder.
pub fn existing_run(name: &Path) -> Result<PathBuf, Failure> {
    if let Some(folder) = run_path(name) {
        return Ok(folder);
    }
    let runs = DataPaths::of_this_user().runs;
    Err(if name == Path::new(LATEST) {
        Failure::failed(format_args!("there are no runs in {} yet; start one with carom train", runs.display()))
    } else {
        Failure::failed(format_args!(
            "there is no run {}, neither here nor in {}; carom train --list shows all runs{}",
            name.display(),
            runs.display(),
            did_you_mean(&name.to_string_lossy(), names_in(&runs, None))
        ))
    })
}

/// Source of the initial weights of a training run.
pub enum Source {
    /// A file or the folder of a run.
    Path(PathBuf),
    /// A bundled policy.
    Bundled(&'static str),
}

/// Returns the source that `--from` names: a file or folder, one of the user's runs, the most recent one for `latest`, a saved policy or a bundled one. The name `bundled`
/// means the bundled policy for a run on `table` under `rule`.
///
/// # Errors
/// Fails if nothing of this name exists.
pub fn weights_by_name(name: &Path, table: &Table, rule: Rule) -> Result<Source, Failure> {
    if name == Path::new(BUNDLED) {
        let found = bundled_policy(table, rule, false)?.bundled_name();
        return Ok(Source::Bundled(found.unwrap_or(BUNDLED)));
    }
    if let Some(path) = run_path(name).or_else(|| saved_policy_path(name)) {
        return Ok(Source::Path(path));
    }
    let bundled = bundled_names().find(|bundled| name == Path::new(bundled)).map(Source::Bundled);
    let called = name.to_string_lossy();
    let what = format_args!("nothing called {called} to start from");
    bundled.ok_or_else(|| not_found(what, &called, "a checkpoint file and"))
}

/// Returns the bundled policy for `rule` on `table`, for a player with execution errors if `errs`.
///
/// # Errors
/// Fails if no policy is bundled for this table.
pub fn bundled_policy(table: &Table, rule: Rule, errs: bool) -> Result<Policy, Failure> {
    let bundled = Policy::bundled_for(table, rule, errs).ok_or_else(|| {
        Failure::wrong_input(format_args!(
            "no policy is bundled for this table \"{}\"; use --table match, textbook or thesis, or a policy from `carom train`",
            table.name
        ))
    })?;
    Ok(bundled?)
}

/// Returns the policy in the file `name`, the one that the user has saved under this name, that of the run `name`, or the bundled policy of
/// this name.
///
/// # Errors
/// Fails if there is none, or if it cannot be used.
pub fn policy_by_name(name: &str) -> Result<Policy, Failure> {
    let path = Path::new(name);
    // A run's folder may have the same name as a saved policy, which takes precedence.
    let file = Some(path.to_owned()).filter(|path| path.is_file());
    let Some(found) = file.or_else(|| saved_policy_path(path)).or_else(|| run_path(path)) else {
        let bundled =
            Policy::bundled_by_name(name).ok_or_else(|| not_found(format_args!("no policy {name}"), name, "and"))?;
        return Ok(bundled?);
    };
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

/// Returns the policy in a run's folder.
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

/// The only agent whose runs write policies.
const WRITES_POLICIES: &str = "ddpg";

/// Explains why a run of another agent has no policy.
fn no_policies_of(agent: &str) -> String {
    format!(
        "its agent is {agent}, and only the agent {WRITES_POLICIES} writes policies: as RUN/{POLICY}, in the folder of its run"
    )
}

/// The name for the skill that the user has saved.
const OWN: &str = "own";

/// Returns the skill called `name`, or the user's own skill for `own`.
///
/// # Errors
/// Fails if there is none.
pub fn skill_by_name(name: &str) -> Result<Skill, Failure> {
    if name == OWN {
        return own_skill()?.ok_or_else(|| {
            Failure::failed("no skill of your own is saved yet; carom drill skill --keep estimates and saves it")
        });
    }
    name.parse().map_err(|error| match error {
        SkillError::Unknown(_) => {
            let names = Skill::NAMED.map(|(name, _)| name).into_iter().chain([OWN]);
            let meant = did_you_mean(name, names);
            Failure::wrong_input(format_args!("{error}; \"{OWN}\" is what carom drill skill --keep saved{meant}"))
        }
        error => Failure::wrong_input(error),
    })
}

/// Returns the skill that the user has saved, if any.
///
/// # Errors
/// Fails if its file cannot be read.
pub fn own_skill() -> Result<Option<Skill>, Failure> {
    let own = Store::new(&DataPaths::of_this_user()).own_skill().map_err(Failure::failed)?;
    Ok(own.map(|own| own.skill))
}
