//! Tests of runs that are stopped, resumed, controlled by requests or disturbed. `tests/binary/training` kills the whole program.

use std::{cell::Cell, fs, thread, time::Duration};

use super::{
    examples::Examples,
    follow::{Condition, Followed, Follower},
    metrics::Record,
    request::Request,
    status::{Phase, RunStatus},
    *,
};
use crate::{
    game::Reward,
    learning::{
        agents::AGENTS,
        ddpg::trainer::{Trainer, tests::small_task},
        learner::{Iteration, TrainingPlan},
        policy::Policy,
    },
    printing::VERSION,
    table::Table,
};

/// A run of ten iterations, with a line after every second and an evaluation after every fourth.
fn small_run(folder: &Path) -> Run {
    let learner = Trainer::new(small_task(), Table::default()).unwrap();
    let schedule = Schedule { log_every: 32, evaluate_every: 64, evaluation_layouts: 20 };
    Run::create(folder, Box::new(learner), schedule, None).unwrap()
}

const FOREVER: Limits<'_> = Limits { time: None, stop: &|| false };

fn is_finished(ending: Ending) -> bool {
    matches!(ending, Ending::Finished(_))
}

/// Trains a run to its end; returns how it ended, its lines of metrics and its warnings.
fn finish(run: &mut Run) -> (Ending, Vec<Record>, Vec<String>) {
    let (mut lines, mut warnings) = (Vec::new(), Vec::new());
    let ending = run.train(&FOREVER, &mut |report| match report {
        Report::Line(record) => lines.push(record.clone()),
        Report::Warning(sentence) => warnings.push(sentence.to_owned()),
    });
    (ending.unwrap(), lines, warnings)
}

#[test]
fn a_run_leaves_metrics_a_policy_and_a_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = small_run(folder.path());
    let (ending, lines, warnings) = finish(&mut run);
    assert!(is_finished(ending) && warnings.is_empty());
    let shots: Vec<_> = lines.iter().map(|line| (line.shots, line.held_out_reward.is_some())).collect();
    assert_eq!(shots, [(32, false), (64, true), (96, false), (128, true), (160, true)]);
    let policy = Policy::load(&run.policy_path()).unwrap();
    assert!(matches!(ending, Ending::Finished(score) if score.mean_reward == policy.origin().held_out_reward));
}

/// Trains a run whose `stop` function returns `true` at its call number `times`, counted from 0.
fn stopped_after(run: &mut Run, times: u32) -> Result<Ending, RunError> {
    let calls = Cell::new(0);
    let stop = || calls.replace(calls.get() + 1) == times;
    run.train(&Limits { time: None, stop: &stop }, &mut |_| {})
}

/// Content that must not depend on where a run was stopped: the policy, the checkpoint, and the metrics except their times.
type Files = (Option<Vec<u8>>, Vec<u8>, Vec<Record>);

/// The files of a run that is stopped and resumed after each of these numbers of iterations, and then finishes.
fn files_of(start: &dyn Fn(&Path) -> Run, stops: &[u32]) -> Files {
    let folder = tempfile::tempdir().unwrap();
    let mut run = start(folder.path());
    for after in stops {
        assert!(matches!(stopped_after(&mut run, *after).unwrap(), Ending::Stopped(_)));
        drop(run);
        run = Run::resume(folder.path()).unwrap().0;
    }
    assert!(is_finished(finish(&mut run).0));
    let lines = metrics::read(&folder.path().join(METRICS)).unwrap();
    let lines = lines.into_iter().map(|line| Record { seconds: 0.0, shots_per_second: 0.0, ..line }).collect();
    let read = |name| fs::read(folder.path().join(name));
    (read(POLICY).ok(), read(checkpoint::CURRENT).unwrap(), lines)
}

#[test]
fn a_run_stopped_anywhere_ends_with_the_same_files() {
    let whole = files_of(&small_run, &[]);
    assert_eq!(whole.2.len(), 5);
    for stops in [[0, 0, 1], [1, 2, 3], [3, 1, 5], [4, 4, 1]] {
        assert!(files_of(&small_run, &stops) == whole, "{stops:?}");
    }
}

#[test]
fn every_agent_resumes_to_the_same_files() {
    for agent in AGENTS {
        let start = |folder: &Path| {
            let plan = TrainingPlan { reward: Reward::R1, seed: 3, shots: 1_000 };
            let learner = (agent.start)(plan, Table::default(), &serde_json::json!({})).unwrap();
            let schedule = Schedule { log_every: 150, evaluate_every: 400, evaluation_layouts: 5 };
            Run::create(folder, learner, schedule, None).unwrap()
        };
        assert!(files_of(&start, &[1, 3]) == files_of(&start, &[]), "{}", agent.name);
    }
}

#[test]
fn a_stopped_run_is_saved_before_its_evaluation() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = small_run(folder.path());
    // The policy cannot be written, so only what was saved before the evaluation remains.
    fs::create_dir(folder.path().join(POLICY)).unwrap();
    let error = stopped_after(&mut run, 3).unwrap_err().to_string();
    assert!(error.contains("after 48 shots") && error.contains(POLICY) && error.contains("--resume"), "{error}");
    drop(run);
    assert_eq!(Run::resume(folder.path()).unwrap().0.learner().shots(), 48);
}

#[test]
fn a_finished_run_is_saved_before_its_calibration() {
    let (folder, whole) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let mut run = small_run(folder.path());
    // Stops after ten iterations, at the second call of the calibration's `go_on`.
    let ending = stopped_after(&mut run, 11).unwrap();
    assert!(matches!(ending, Ending::Stopped(_)) && run.learner().is_finished() && run.result().is_none());
    drop(run);
    let mut run = Run::resume(folder.path()).unwrap().0;
    assert_eq!((run.learner().shots(), is_finished(finish(&mut run).0)), (160, true));
    assert!(run.result().is_some());
    finish(&mut small_run(whole.path()));
    let policy = |folder: &Path| fs::read(folder.join(POLICY)).unwrap();
    assert!(policy(folder.path()) == policy(whole.path()), "the calibration must equal that of an uninterrupted run");
}

#[test]
fn resuming_a_finished_run_returns_its_stored_result() {
    let folder = tempfile::tempdir().unwrap();
    let ending = finish(&mut small_run(folder.path())).0;
    let path = |name: &str| folder.path().join(name);
    let result = fs::read_to_string(path(RESULT)).unwrap().replace(VERSION, "0.0.1");
    fs::write(path(RESULT), &result).unwrap();
    fs::remove_file(path(METRICS)).unwrap();
    let events = fs::read(path(event_file::FILE)).unwrap();
    assert_eq!(finish(&mut Run::resume(folder.path()).unwrap().0).0, ending);
    assert_eq!(fs::read_to_string(path(RESULT)).unwrap(), result);
    assert!(fs::read(path(event_file::FILE)).unwrap() == events, "the event file must keep the lost lines");
    // A result file without a result is written again.
    fs::write(path(RESULT), "{}").unwrap();
    assert_eq!(finish(&mut Run::resume(folder.path()).unwrap().0).0, ending);
    assert!(fs::read_to_string(path(RESULT)).unwrap().contains(VERSION));
}

#[test]
fn a_checkpoint_is_written_only_after_its_policy() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = small_run(folder.path());
    fs::create_dir(folder.path().join(POLICY)).unwrap();
    let path = folder.path().join(checkpoint::CURRENT);
    let before = fs::read(&path).unwrap();
    let mut warnings = Vec::new();
    let mut witness = |report: Report<'_>| {
        if let Report::Warning(sentence) = report {
            warnings.push((sentence.to_owned(), fs::read(&path).unwrap()));
        }
    };
    assert!(run.train(&FOREVER, &mut witness).unwrap_err().to_string().contains(POLICY));
    let (sentence, then) = &warnings[0];
    assert!(sentence.contains(POLICY) && *then == before, "{sentence}");
}

#[test]
fn a_folder_belongs_to_one_run_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let run = small_run(folder.path());
    assert!(matches!(Run::resume(folder.path()), Err(RunError::Busy(_))));
    drop(run);
    // A run that was killed between the first checkpoint and the configuration can be resumed, too.
    fs::remove_file(folder.path().join(config::FILE)).unwrap();
    let (_run, notices) = Run::resume(folder.path()).unwrap();
    assert_eq!((notices.len(), Config::read(folder.path()).unwrap().agent.as_str()), (0, "ddpg"));
}

#[test]
fn an_unreadable_configuration_is_kept_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    drop(small_run(folder.path()));
    let path = folder.path().join(config::FILE);
    let newer = fs::read_to_string(&path).unwrap().replace("\"agent\"", "\"who\"").replace(VERSION, "90.1.0");
    let newer_message = "config.json was written by carom 90.1.0";
    for (text, message) in [("{", "config.json cannot be read"), (newer.as_str(), newer_message)] {
        fs::write(&path, text).unwrap();
        let (run, notices) = Run::resume(folder.path()).unwrap();
        assert!(notices.len() == 1 && notices[0].starts_with(message), "{notices:?}");
        assert_eq!((fs::read_to_string(&path).unwrap().as_str(), run.learner().shots()), (text, 0));
    }
}

#[test]
fn a_failed_run_resumes_from_its_last_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = small_run(folder.path());
    let odd = Iteration { critic_loss: f64::NAN, actor_loss: Some(f64::NEG_INFINITY), ..Iteration::default() };
    assert!(!run.state.accumulator.add(&odd, 1, 1));
    let error = run.train(&FOREVER, &mut |_| {}).unwrap_err().to_string();
    assert!(error.contains("after 16 shots"), "{error}");
    let lines = metrics::read(&folder.path().join(METRICS)).unwrap();
    assert!(lines[0].critic_loss.is_nan() && lines[0].actor_loss == Some(f64::NEG_INFINITY), "{lines:?}");
    let status = RunStatus::read(folder.path()).unwrap();
    assert_eq!((status.phase, status.reason), (Phase::Failed, Some(error)));
    drop(run);
    let (ending, lines, _) = finish(&mut Run::resume(folder.path()).unwrap().0);
    assert!(is_finished(ending) && lines.len() == 5);
    assert!(metrics::read(&folder.path().join(METRICS)).unwrap().iter().all(|line| line.critic_loss.is_finite()));
}

/// Sends a request to the run in `folder` from another thread as soon as it is in `phase`.
fn ask(folder: &Path, phase: Phase, request: Request) -> thread::JoinHandle<()> {
    let folder = folder.to_owned();
    thread::spawn(move || {
        for _ in 0..4000 {
            if RunStatus::read(&folder).is_ok_and(|status| status.phase == phase) {
                break;
            }
            thread::sleep(Duration::from_millis(5));
        }
        request.send(&folder).unwrap();
    })
}

/// Trains a run that receives a request in each of these phases. A delay between the iterations ensures that it does not end before.
fn asked(run: &mut Run, requests: &[(Phase, Request)]) -> Ending {
    let threads: Vec<_> = requests.iter().map(|(phase, request)| ask(run.folder(), *phase, *request)).collect();
    let delay = || {
        thread::sleep(Duration::from_millis(60));
        false
    };
    let ending = run.train(&Limits { time: None, stop: &delay }, &mut |_| {}).unwrap();
    for thread in threads {
        thread.join().unwrap();
    }
    ending
}

#[test]
fn requests_do_not_change_the_result_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = small_run(folder.path());
    // A request to an earlier process is not carried out.
    Request::Abandon.send(folder.path()).unwrap();
    let ending = asked(&mut run, &[(Phase::Training, Request::Pause), (Phase::Paused, Request::Stop)]);
    assert!(matches!(ending, Ending::Stopped(_)));
    assert_eq!(RunStatus::read(folder.path()).unwrap().phase, Phase::Stopped);
    drop(run);
    let mut run = Run::resume(folder.path()).unwrap().0;
    assert!(is_finished(asked(&mut run, &[(Phase::Training, Request::Pause), (Phase::Paused, Request::Resume)])));
    assert_eq!(Request::receive(folder.path()), None);
    let other = tempfile::tempdir().unwrap();
    finish(&mut small_run(other.path()));
    let [own, whole] = [&folder, &other].map(|folder| fs::read(folder.path().join(checkpoint::CURRENT)).unwrap());
    assert!(own == whole);
}

#[test]
fn an_abandoned_run_leaves_only_foreign_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let mut run = small_run(path);
    fs::write(path.join("notes.txt"), "mine").unwrap();
    assert_eq!(asked(&mut run, &[(Phase::Training, Request::Abandon)]), Ending::Abandoned);
    assert!(discard(path).unwrap_err().to_string().contains("another process"));
    drop(run);
    discard(path).unwrap();
    let left: Vec<_> = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["notes.txt"]);
}

#[test]
fn a_run_abandoned_during_its_last_evaluation_is_unfinished() {
    let folder = tempfile::tempdir().unwrap();
    let mut give_up = |report: Report<'_>| {
        if matches!(report, Report::Line(record) if record.shots == 160) {
            Request::Abandon.send(folder.path()).unwrap();
        }
    };
    let ending = small_run(folder.path()).train(&FOREVER, &mut give_up).unwrap();
    assert_eq!(ending, Ending::Abandoned);
    assert!(!folder.path().join("result.json").exists());
    assert_eq!(RunStatus::read(folder.path()).unwrap().phase, Phase::Stopped);
}

#[test]
fn a_follower_sees_a_run_start_report_and_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let (mut follower, mut followed) = (Follower::new(&path), Followed::new(&path));
    followed.apply(follower.poll().unwrap());
    assert_eq!(followed.condition, Condition::Missing);
    assert!(follower.poll().is_none(), "nothing has changed");
    let mut run = small_run(&path);
    finish(&mut run);
    let status = RunStatus::read(&path).unwrap();
    assert_eq!((status.phase, status.shots, status.process), (Phase::Finished, 160, std::process::id()));
    assert!(status.updates > 0 && status.replay_fill == Some(1.0) && status.exploration > 0.0, "{status:?}");
    let Examples { after, shots } = Examples::read(&path).unwrap();
    assert_eq!((after, shots.len()), (160, examples::COUNT));
    let (reward, table) = (run.learner().plan().reward, run.learner().table());
    assert!(shots.iter().all(|shot| shot.reward == reward.of_playable(table, &shot.layout, &shot.cue, u32::MAX)));
    drop(run);
    let mut follower = Follower::new(&path);
    let update = follower.poll().unwrap();
    assert_eq!(update.records.len(), 5);
    followed.apply(update);
    assert_eq!(followed.condition, Condition::InPhase(Phase::Finished));
    assert_eq!(followed.config.as_ref().unwrap().plan.shots, 160);
    assert!(followed.examples.is_some() && followed.notices.is_empty());
    fs::remove_file(path.join("metrics.jsonl")).unwrap();
    followed.apply(follower.poll().unwrap());
    assert!(followed.notices[0].contains("metrics.jsonl has been removed"), "{:?}", followed.notices);
}

#[test]
fn a_full_disk_is_said_to_refuse_writing() {
    let said = |kind: std::io::ErrorKind| file(Path::new("metrics.jsonl"))(kind.into()).to_string();
    assert!(said(std::io::ErrorKind::StorageFull).starts_with("metrics.jsonl cannot be written: "));
    assert!(said(std::io::ErrorKind::PermissionDenied).starts_with("metrics.jsonl cannot be used: "));
}
