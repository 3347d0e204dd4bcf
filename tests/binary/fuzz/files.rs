//! Files written by others, or only half of one: settings, practice, runs, policies.

use std::{fs, process::Command, sync::LazyLock};

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
use crate::program::home;

/// Tests with files are a thousand times slower than those with text in memory.
fn few() -> ProptestConfig {
    let default = ProptestConfig::default();
    ProptestConfig { cases: (default.cases / 4).max(16), ..default }
}

/// A valid run and a valid session, written by the program.
static SOUND: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let small = "actor_layers = [4]\ncritic_layers = [4]\nbatch = 8\nactor_batch = 4\nreplay = 1000\n";
    fs::write(folder.path().join("small.toml"), small).unwrap();
    let carom = |args: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
        command.args(args).envs(home()).env("XDG_DATA_HOME", folder.path()).current_dir(folder.path());
        let said = command.output().unwrap();
        assert!(said.status.success(), "{args:?}: {}", String::from_utf8_lossy(&said.stderr));
    };
    let train = ["train", "--config", "small.toml", "--steps", "200", "--evaluate-every", "100"];
    carom(&[&train[..], &["--evaluation-layouts", "2", "--run", "run"]].concat());
    carom(&["drill", "save", "mine", "--layout", "-0.5,0 0,0 0.5,0.03"]);
    carom(&["drill", "log", "mine", "make", "miss"]);
    folder
});

fn sound(name: &str) -> Vec<u8> {
    fs::read(SOUND.path().join(name)).unwrap()
}

/// Returns the only file in a folder of practice data.
fn only(folder: &str) -> (String, Vec<u8>) {
    let mut files = fs::read_dir(SOUND.path().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let file = files.find(|file| file.extension().is_some_and(|extension| extension == "json")).unwrap();
    (file.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(file).unwrap())
}

/// Files that identify a run.
const OF_RUN: [&str; 5] = ["config.json", "metrics.jsonl", "state.json", "shots.json", "checkpoint.safetensors"];

/// One of these files, damaged.
fn one_of_run() -> impl Strategy<Value = (&'static str, Vec<u8>)> {
    prop::sample::select(&OF_RUN).prop_flat_map(|name| (Just(name), mutated(sound(&format!("run/{name}")))))
}

/// Returns a folder that contains a valid run called `run`.
fn folder_of_run() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("run")).unwrap();
    for name in OF_RUN {
        fs::write(folder.path().join("run").join(name), sound(&format!("run/{name}"))).unwrap();
    }
    folder
}

proptest! {
    #![proptest_config(few())]

    #[test]
    fn settings(bytes in mutated(Settings::default().document().into_bytes())) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("config.toml");
        fs::write(&path, bytes).unwrap();
        let _ = Settings::load(&path).0.table();
    }

    #[test]
    fn practice(session in mutated(only("carom/sessions").1), position in mutated(only("carom/positions").1)) {
        let folder = tempfile::tempdir().unwrap();
        for (kind, bytes) in [("sessions", &session), ("positions", &position)] {
            fs::create_dir(folder.path().join(kind)).unwrap();
            fs::write(folder.path().join(kind).join(only(&format!("carom/{kind}")).0), bytes).unwrap();
        }
        let store = Store::new(&DataPaths::under(folder.path()));
        let found = store.sessions();
        prop_assert_eq!(found.items.len() + found.notes.len(), 1, "it is read or told of");
        for session in &found.items {
            let _ = (session.record(), session.position());
        }
        store.library();
    }

    #[test]
    fn runs((name, bytes) in one_of_run()) {
        let folder = folder_of_run();
        let run = folder.path().join("run");
        fs::write(run.join(name), bytes).unwrap();
        let _ = runs_in(folder.path());
        let _ = Run::resume(&run);
    }

    #[test]
    fn policies(bytes in mutated(sound("run/policy.safetensors"))) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("policy.safetensors");
        fs::write(&path, bytes).unwrap();
        let _ = Policy::load(&path);
    }

    #[test]
    fn runs_that_are_followed(states in prop::collection::vec((one_of_run(), any::<bool>()), 1..6)) {
        let folder = folder_of_run();
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
