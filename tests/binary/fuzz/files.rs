//! Files written by others, or only half of one: settings, practice, runs, policies.

use std::{fs, sync::LazyLock};

use carom::{
    drills::Store,
    learning::{
        Policy,
        run::{
            Run,
            follow::{Followed, Follower},
            list::runs_in,
        },
    },
    storage::DataPaths,
    terminal::Settings,
};
use proptest::prelude::*;
use tempfile::TempDir;

use super::mutation::mutated;
use crate::program::carom;

/// Tests with files are a thousand times slower than those with text in memory.
fn fewer_cases() -> ProptestConfig {
    let default = ProptestConfig::default();
    ProptestConfig { cases: (default.cases / 4).max(16), ..default }
}

/// A valid run and a valid session, written by the program.
static VALID: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let small = "actor_layers = [4]\ncritic_layers = [4]\nbatch_size = 8\nactor_batch_size = 4\nbuffer_size = 1000\n";
    fs::write(folder.path().join("small.toml"), small).unwrap();
    let carom = |args: &[&str]| carom(folder.path(), args).ok();
    let train = ["train", "--config", "small.toml", "--steps", "200", "--evaluate-every", "100"];
    carom(&[&train[..], &["--evaluation-layouts", "2", "--run", "run"]].concat());
    carom(&["drill", "save", "mine", "--layout", "-0.5,0 0,0 0.5,0.03"]);
    carom(&["drill", "log", "mine", "make", "miss"]);
    folder
});

fn valid_file(name: &str) -> Vec<u8> {
    fs::read(VALID.path().join(name)).unwrap()
}

/// Returns the only file in a folder of practice data.
fn only_json_file(folder: &str) -> (String, Vec<u8>) {
    let mut files = fs::read_dir(VALID.path().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let file = files.find(|file| file.extension().is_some_and(|extension| extension == "json")).unwrap();
    (file.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(file).unwrap())
}

/// Files that identify a run.
const RUN_FILES: [&str; 5] = ["config.json", "metrics.jsonl", "state.json", "shots.json", "checkpoint.safetensors"];

/// One of these files, damaged.
fn damaged_run_file() -> impl Strategy<Value = (&'static str, Vec<u8>)> {
    prop::sample::select(&RUN_FILES).prop_flat_map(|name| (Just(name), mutated(valid_file(&format!("run/{name}")))))
}

/// Returns a folder that contains a valid run called `run`.
fn run_folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("run")).unwrap();
    for name in RUN_FILES {
        fs::write(folder.path().join("run").join(name), valid_file(&format!("run/{name}"))).unwrap();
    }
    folder
}

proptest! {
    #![proptest_config(fewer_cases())]

    #[test]
    fn settings(bytes in mutated(Settings::default().document().into_bytes())) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("config.toml");
        fs::write(&path, bytes).unwrap();
        let _ = Settings::load(&path).0.table();
    }

    #[test]
    fn practice(session in mutated(only_json_file("carom/sessions").1), position in mutated(only_json_file("carom/positions").1)) {
        let folder = tempfile::tempdir().unwrap();
        for (kind, bytes) in [("sessions", &session), ("positions", &position)] {
            fs::create_dir(folder.path().join(kind)).unwrap();
            fs::write(folder.path().join(kind).join(only_json_file(&format!("carom/{kind}")).0), bytes).unwrap();
        }
        let store = Store::new(&DataPaths::under(folder.path()));
        let found = store.sessions();
        prop_assert_eq!(found.items.len() + found.notes.len(), 1, "the file is either read or reported");
        for session in &found.items {
            let _ = (session.record(), session.position());
        }
        store.library();
    }

    #[test]
    fn runs((name, bytes) in damaged_run_file()) {
        let folder = run_folder();
        let run = folder.path().join("run");
        fs::write(run.join(name), bytes).unwrap();
        let _ = runs_in(folder.path());
        let _ = Run::resume(&run);
    }

    #[test]
    fn policies(bytes in mutated(valid_file("run/policy.safetensors"))) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("policy.safetensors");
        fs::write(&path, bytes).unwrap();
        let _ = Policy::load(&path);
    }

    #[test]
    fn followed_runs(states in prop::collection::vec((damaged_run_file(), any::<bool>()), 1..6)) {
        let folder = run_folder();
        let run = folder.path().join("run");
        let (mut follower, mut followed) = (Follower::new(&run), Followed::new(&run));
        for ((name, bytes), is_there) in states {
            if is_there {
                fs::write(run.join(name), bytes).unwrap();
            } else {
                let _ = fs::remove_file(run.join(name));
            }
            // Files that rarely change are read once a second, but at once by a new follower.
            for follower in [&mut follower, &mut Follower::new(&run)] {
                if let Some(update) = follower.poll() {
                    followed.apply(update);
                }
                prop_assert!(!followed.sentence().is_empty());
                let _ = (followed.shots(), followed.time_left());
            }
        }
    }
}
