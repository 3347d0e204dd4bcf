//! Runs that are stopped, go on, and meet trouble; kills of the whole program are in `tests/training.rs`.

use std::{cell::Cell, fs};

use super::*;
use crate::{
    learning::{
        policy::Policy,
        trainer::{Trainer, tests::small_task},
    },
    table::Table,
};

/// What a run told its watcher.
#[derive(Default)]
struct Told {
    lines: Vec<Record>,
    warnings: Vec<String>,
}

impl Watcher for Told {
    fn line(&mut self, record: &Record) {
        self.lines.push(record.clone());
    }

    fn warn(&mut self, sentence: &str) {
        self.warnings.push(sentence.to_owned());
    }
}

/// A run of ten turns, a line after every other one and a measurement after every fourth.
fn small_run(folder: &Path) -> Run {
    let learner = Trainer::new(small_task(), Table::default()).unwrap();
    let schedule = Schedule { log_every: 32, evaluate_every: 64, evaluation_layouts: 20 };
    Run::create(folder, Box::new(learner), schedule, None).unwrap()
}

fn finish(run: &mut Run) -> (Ending, Told) {
    let mut told = Told::default();
    (run.practise(None, &|| false, &mut told).unwrap(), told)
}

#[test]
fn a_run_leaves_its_configuration_metrics_checkpoint_and_policy() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = small_run(folder.path());
    let (ending, told) = finish(&mut run);
    assert!(ending.finished && told.warnings.is_empty());
    let shots: Vec<_> = told.lines.iter().map(|line| (line.shots, line.held_out_reward.is_some())).collect();
    assert_eq!(shots, [(32, false), (64, true), (96, false), (128, true), (160, true)]);
    let policy = Policy::load(&run.policy_path()).unwrap();
    assert_eq!(policy.origin().held_out_reward, ending.score.mean_reward);
    let config = Config::read(folder.path()).unwrap();
    assert_eq!((config.agent.as_str(), config.plan.seed, config.settings["batch"].as_u64()), ("ddpg", 5, Some(32)));
    drop(run);
    let learner = Trainer::new(small_task(), Table::default()).unwrap();
    let again = Run::create(folder.path(), Box::new(learner), Schedule::for_shots(1), None).unwrap_err();
    assert!(again.to_string().contains("--resume"));
    let (mut run, _) = Run::resume(folder.path()).unwrap();
    assert_eq!(finish(&mut run).0, ending);
}

#[test]
fn a_run_that_is_stopped_at_any_turn_goes_on_to_the_same_files() {
    let files = |stops: &[u32]| {
        let folder = tempfile::tempdir().unwrap();
        let mut run = small_run(folder.path());
        for after in stops {
            let asked = Cell::new(0);
            let stop = || asked.replace(asked.get() + 1) == *after;
            assert!(!run.practise(None, &stop, &mut Told::default()).unwrap().finished);
            drop(run);
            run = Run::resume(folder.path()).unwrap().0;
        }
        assert!(finish(&mut run).0.finished);
        let lines = fs::read_to_string(folder.path().join(METRICS)).unwrap();
        let lines: Vec<_> = lines
            .lines()
            .map(|line| Record { seconds: 0.0, shots_per_second: 0.0, ..serde_json::from_str(line).unwrap() })
            .collect();
        let read = |name| fs::read(folder.path().join(name)).unwrap();
        (read(POLICY), read(checkpoint::CURRENT), lines)
    };
    let whole = files(&[]);
    for stops in [[0, 0, 1], [1, 2, 3], [3, 1, 5], [4, 4, 1]] {
        assert!(files(&stops) == whole, "{stops:?}");
    }
}

#[test]
fn a_checkpoint_that_cannot_be_written_is_told_and_training_goes_on_to_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = small_run(folder.path());
    // A folder in the policy's place cannot be replaced by a file: the save fails, for every user.
    let in_the_way = folder.path().join(POLICY);
    fs::create_dir(&in_the_way).unwrap();
    fs::write(in_the_way.join("inside"), b"").unwrap();
    let before = fs::read(folder.path().join(checkpoint::CURRENT)).unwrap();
    let mut told = Told::default();
    let error = run.practise(None, &|| false, &mut told).unwrap_err().to_string();
    assert_eq!(told.warnings.len(), 2, "{:?}", told.warnings);
    assert!(told.warnings[0].contains("after 64 shots") && told.warnings[0].contains(POLICY), "{:?}", told.warnings);
    assert!(error.contains("160 shots") && error.contains("--resume"), "{error}");
    assert!(fs::read(folder.path().join(checkpoint::CURRENT)).unwrap() == before);
    assert!(fs::read_dir(folder.path()).unwrap().all(|entry| !entry.unwrap().path().ends_with(".partial")));

    fs::remove_dir_all(in_the_way).unwrap();
    drop(run);
    let (ending, told) = finish(&mut Run::resume(folder.path()).unwrap().0);
    assert!(ending.finished && told.lines.len() == 5);
    assert_eq!(fs::read_to_string(folder.path().join(METRICS)).unwrap().lines().count(), 5);
}

#[test]
fn a_folder_belongs_to_one_run_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let run = small_run(folder.path());
    assert!(matches!(Run::resume(folder.path()), Err(RunError::Busy(_))));
    drop(run);
    // What a kill between the first checkpoint and the configuration leaves can be gone on from as well.
    fs::remove_file(folder.path().join(config::FILE)).unwrap();
    let (run, notice) = Run::resume(folder.path()).unwrap();
    assert_eq!((notice, run.config().agent.as_str()), (None, "ddpg"));
    assert!(folder.path().join(config::FILE).exists());
}
