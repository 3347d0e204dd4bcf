//! Builds the specification of a new run from the command line.

use std::{
    fs::canonicalize,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};

use super::{Args, failure};
use crate::{
    commands::{
        Failure,
        input::table_by_name,
        lookup::{Source, weights_by_name},
        output::print_note,
    },
    game::Reward,
    learning::{
        learner::{AgentKind, TrainingPlan, merge_settings},
        run::{
            Config, Provenance, RunError, Schedule, config_of,
            origin::Weights,
            run_name,
            seeds::{GroupFile, TrainingSpec, is_group, read_description},
        },
    },
    printing::timestamp,
    storage::{self, DataPaths, describe_toml_error},
    table::Table,
};

/// A training run to start: its specification, its initial weights and its folder.
pub struct TrainingRequest {
    pub spec: TrainingSpec,
    pub weights: Option<Weights>,
    pub folder: PathBuf,
    /// Whether the user chose the folder.
    pub is_named: bool,
}

impl TrainingRequest {
    /// Calls `start` with the folder. If the user did not choose it and it exists, a number is appended: the default name has a resolution
    /// of one second, and another training may have started in the same second.
    pub fn begin<T>(&self, start: impl Fn(&Path) -> Result<T, RunError>) -> Result<T, RunError> {
        if self.is_named { start(&self.folder) } else { start_in_free_folder(&self.folder, start) }
    }
}

/// Calls `start` with `folder`, or with the first free name with -2, -3 and so on appended.
fn start_in_free_folder<T>(folder: &Path, start: impl Fn(&Path) -> Result<T, RunError>) -> Result<T, RunError> {
    let mut begun = start(folder);
    for number in 2_u32.. {
        if !matches!(begun, Err(RunError::Occupied(_) | RunError::Foreign { .. } | RunError::Busy(_))) {
            break;
        }
        let mut name = folder.as_os_str().to_owned();
        name.push(format!("-{number}"));
        begun = start(Path::new(&name));
    }
    begun
}

/// Reads the request from the command line. Missing values are those of the run that the weights come from, or the defaults.
pub fn read(args: &Args) -> Result<TrainingRequest, Failure> {
    let weights = source(args)?.and_then(weights_of).transpose().map_err(failure)?;
    if let Some(notice) = weights.as_ref().and_then(|weights| weights.notice.as_ref()) {
        print_note(format_args!("warning: {notice}"));
    }
    let base = weights.as_ref().map(|weights| base_of(weights, args)).transpose()?;
    let spec = build_spec(args, base)?;
    let folder = args.run.clone().unwrap_or_else(|| {
        let name = run_name(&timestamp(), &spec.agent, &spec.table.name, spec.plan.reward, args.seed);
        DataPaths::of_this_user().runs.join(name)
    });
    Ok(TrainingRequest { spec, weights, folder, is_named: args.run.is_some() })
}

/// Returns the source that `--from` names, if it is given.
fn source(args: &Args) -> Result<Option<Source>, Failure> {
    let Some(name) = &args.from else { return Ok(None) };
    let table = table_by_name(args.table.as_deref().unwrap_or("match"))?;
    weights_by_name(name, &table, args.reward.unwrap_or_default().rule().unwrap_or_default()).map(Some)
}

/// Loads the weights of a source.
fn weights_of(source: Source) -> Option<Result<Weights, RunError>> {
    match source {
        Source::Path(path) => Some(Weights::load(&path)),
        Source::Bundled(name) => Weights::bundled(name),
    }
}

/// The defaults for a run, if it starts from weights.
struct Base {
    agent: String,
    reward: Reward,
    table: Table,
    settings: Value,
}

/// Returns the defaults that the weights bring along. Their own table is not looked up if another one is named.
fn base_of(weights: &Weights, args: &Args) -> Result<Base, Failure> {
    let Weights { start: Provenance { agent, reward, table, .. }, settings, .. } = weights.clone();
    let table = match (&args.table, &weights.table) {
        (Some(name), _) => table_by_name(name)?,
        (None, Some(table)) => table.clone(),
        (None, None) => table_by_name(&table)?,
    };
    let mut settings = settings;
    if let (Value::Object(settings), Ok(kind)) = (&mut settings, AgentKind::named(&agent)) {
        settings.retain(|name, _| !kind.not_inherited.contains(&name.as_str()));
    }
    Ok(Base { agent, reward, table, settings })
}

/// Returns the specification in the command line; missing values come from `base` or the defaults.
fn build_spec(args: &Args, base: Option<Base>) -> Result<TrainingSpec, Failure> {
    let agent = args.agent.clone().or_else(|| base.as_ref().map(|base| base.agent.clone()));
    let agent = agent.unwrap_or_else(|| "ddpg".to_owned());
    let reward = args.reward.or_else(|| base.as_ref().map(|base| base.reward)).unwrap_or_default();
    let table = match (&args.table, &base) {
        (Some(name), _) => table_by_name(name)?,
        (None, Some(base)) => base.table.clone(),
        (None, None) => table_by_name("match")?,
    };
    // Settings of another agent are meaningless here. That its weights cannot be used either is reported when they are loaded.
    let known = base.filter(|base| base.agent == agent).map(|base| base.settings);
    let settings = settings(args, known.unwrap_or_else(|| json!({})), &agent)?;
    let layouts = args.evaluation_layouts as usize;
    let every = args.evaluate_every.unwrap_or(Schedule::default_interval(args.steps));
    let plan = TrainingPlan { reward, seed: args.seed, shots: args.steps };
    Ok(TrainingSpec { agent, plan, settings, schedule: Schedule::new(every, layouts), table })
}

/// Refuses to resume the run, or the group of seeds, in `folder` if it was started with other settings. The weights it started from may be
/// missing or changed by now; then values that the command omits count as equal to those of the run.
pub fn check_same_spec(args: &Args, folder: &Path) -> Result<(), Failure> {
    // A folder that cannot be read is reported by the code that resumes it.
    let Some((theirs, start, their_seeds)) = stored_spec(folder) else { return Ok(()) };
    let as_before = source(args).ok().flatten().and_then(|source| weights_of(source)?.ok());
    let are_same = |start: &Provenance, weights: &Weights| {
        *start == Provenance { path: start.path.clone(), ..weights.start.clone() }
    };
    let as_before = as_before.filter(|weights| start.as_ref().is_some_and(|start| are_same(start, weights)));
    let base = args.from.as_ref().and(start.as_ref()).map(|_| {
        as_before.and_then(|weights| base_of(&weights, args).ok()).unwrap_or_else(|| Base {
            agent: theirs.agent.clone(),
            reward: theirs.plan.reward,
            table: theirs.table.clone(),
            settings: theirs.settings.clone(),
        })
    });
    let ours = build_spec(args, base)?;
    let options = |TrainingSpec { agent, plan, schedule, table, .. }: &TrainingSpec| {
        [
            ("agent", agent.clone()),
            ("reward", plan.reward.to_string()),
            ("seed", plan.seed.to_string()),
            ("steps", plan.shots.to_string()),
            ("evaluate-every", schedule.evaluate_every.to_string()),
            ("evaluation-layouts", schedule.evaluation_layouts.to_string()),
            ("table", table.name.clone()),
        ]
    };
    let pairs = options(&theirs).into_iter().zip(options(&ours)).filter(|(theirs, ours)| theirs != ours);
    let mut differences: Vec<String> =
        pairs.map(|((what, theirs), (_, ours))| format!("with {what} {theirs}, not {ours}")).collect();
    if theirs.table.name == ours.table.name && theirs.table != ours.table {
        differences.push(format!("on another table of the name {}", ours.table.name));
    }
    differences.extend(match (their_seeds, args.seeds) {
        (Some(theirs), Some(ours)) => (theirs != ours).then(|| format!("with {theirs} seeds, not {ours}")),
        (Some(theirs), None) => Some(format!("with {theirs} seeds, not as a single run")),
        (None, Some(ours)) => Some(format!("as a single run, not with {ours} seeds")),
        (None, None) => None,
    });
    differences.extend(match (start.as_ref().map(|start| start.path.as_str()), &args.from) {
        (Some(theirs), Some(ours)) => {
            (!is_same_source(theirs, args)).then(|| format!("from {theirs}, not from {}", ours.display()))
        }
        (Some(theirs), None) => Some(format!("from {theirs}, not without --from")),
        (None, Some(ours)) => Some(format!("without --from, not from {}", ours.display())),
        (None, None) => None,
    });
    if theirs.agent == ours.agent {
        let [theirs, ours] = [&theirs, &ours].map(|spec| spec.all_settings().map_err(failure));
        add_setting_differences(&mut differences, "", &theirs?, &ours?);
    }
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(format_args!(
        "the run in {} was started {}: --continue resumes a run that was started with the same settings; choose another folder with --run",
        folder.display(),
        differences.join("; ")
    )))
}

/// Adds the settings that differ; `above` is the prefix of their names.
fn add_setting_differences(differences: &mut Vec<String>, above: &str, theirs: &Value, ours: &Value) {
    for (name, theirs) in theirs.as_object().into_iter().flatten() {
        match &ours[name.as_str()] {
            ours if ours == theirs => {}
            ours if ours.is_object() => add_setting_differences(differences, &format!("{above}{name}."), theirs, ours),
            ours => differences.push(format!("with {above}{name} = {theirs}, not {ours}")),
        }
    }
}

/// Whether `--from` names the source `theirs` that a run was started from. If it no longer exists, only the names are compared.
fn is_same_source(theirs: &str, args: &Args) -> bool {
    let ours = match source(args) {
        Ok(Some(Source::Path(path))) => path,
        Ok(Some(Source::Bundled(name))) => name.into(),
        // The source no longer exists.
        _ => args.from.clone().unwrap_or_default(),
    };
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().replace(".safetensors", ""));
    match (canonicalize(theirs), canonicalize(&ours)) {
        (Ok(theirs), Ok(ours)) => theirs == ours,
        _ => name(Path::new(theirs)) == name(&ours),
    }
}

/// Returns how the run or the group in the folder was started: its specification, the origin of its weights, and the number of seeds.
fn stored_spec(folder: &Path) -> Option<(TrainingSpec, Option<Provenance>, Option<u64>)> {
    if is_group(folder) {
        let GroupFile { spec, seeds, from } = read_description(folder).ok()?;
        return Some((spec, from, Some(seeds)));
    }
    let Config { agent, plan, settings, schedule, table, from, .. } = config_of(folder)?;
    Some((TrainingSpec { agent, plan, settings, schedule, table }, from, None))
}

/// Returns the settings `known`, overridden by the file of --config and then by the pairs of --set, under their current names. If a default
/// of the agent is nested, a part can be set alone.
fn settings(args: &Args, known: Value, agent: &str) -> Result<Value, Failure> {
    // An unknown agent is refused by name when the run starts.
    let Ok(kind) = AgentKind::named(agent) else { return Ok(known) };
    let (mut from_file, mut from_pairs) = (json!({}), json!({}));
    let defaults = (kind.settings)(&json!({})).unwrap_or_default();
    if let Some(path) = &args.config {
        let shown = format!("the settings in {}", path.display());
        let text = storage::read_text(path, storage::MAX_SMALL_FILE)
            .map_err(|error| Failure::failed(format_args!("{shown} cannot be read: {error}")))?;
        replace(&mut from_file, &text, &shown, &defaults)?;
    }
    for pair in &args.set {
        let shown = format!("--set {pair}");
        let Some((name, value)) = pair.split_once('=').filter(|(name, _)| !name.trim().is_empty()) else {
            return Err(Failure::wrong_input(format_args!("{shown}: write NAME=VALUE, like heads=8")));
        };
        // A word needs no quotes here.
        let value: toml::Value = value.parse().unwrap_or_else(|_| toml::Value::String(value.to_owned()));
        replace(&mut from_pairs, &format!("{name} = {value}"), &shown, &defaults)?;
    }
    let current = |settings: &Value| (kind.current_names)(settings).map_err(|error| failure(error.into()));
    let mut settings = current(&known)?;
    for changes in [from_file, from_pairs] {
        merge_settings(&mut settings, &current(&changes)?, &defaults);
    }
    Ok(settings)
}

/// Overrides the settings of the same names by the values of a TOML text ([`merge_settings`]).
fn replace(settings: &mut Value, text: &str, origin: &str, defaults: &Value) -> Result<(), Failure> {
    let refuse = |reason: &str| Failure::wrong_input(format_args!("{origin}: {reason}"));
    let read: toml::Table = toml::from_str(text).map_err(|error| {
        refuse(&format!(
            "{}; accepted are lines like heads = 8, with words in quotes",
            describe_toml_error(text, &error)
        ))
    })?;
    for (name, value) in read {
        // JSON has no dates, and no setting is one: as text it is refused by the type of the setting.
        let value = if value.is_datetime() { value.to_string().into() } else { value };
        let value = serde_json::to_value(value).map_err(|error| refuse(&error.to_string()))?;
        // TOML has nan and inf, JSON does not.
        if value.is_null() {
            return Err(refuse(&format!("{name} is not a finite number")));
        }
        merge_settings(settings, &json!({ name: value }), defaults);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn automatic_folder_names_get_a_number_if_taken() {
        let taken = |folder: &Path| match folder.display().to_string() {
            name if name == "runs/a-1" => Err(RunError::Occupied(name)),
            name if name == "runs/a-1-2" => Err(RunError::Busy(name)),
            name => Ok(name),
        };
        assert_eq!(start_in_free_folder(Path::new("runs/a-1"), taken).unwrap(), "runs/a-1-3");
        assert_eq!(start_in_free_folder(Path::new("runs/b-1"), taken).unwrap(), "runs/b-1");
        let missing = |folder: &Path| Err::<(), _>(RunError::Missing(folder.display().to_string()));
        assert!(start_in_free_folder(Path::new("runs/a-1"), missing).is_err(), "no other name helps");
    }
}
