//! Folders and files that are not what a command expects.

use std::{fs, os::unix::fs::symlink, path::Path, process::Command};

use crate::program::{carom, folder};

const TRAIN: [&str; 8] = ["train", "--steps", "100", "--evaluation-layouts", "2", "--evaluate-every", "100", "--run"];

fn train(home: &Path, run: &str) -> crate::program::Outcome {
    carom(home, &[&TRAIN[..], &[run]].concat())
}

#[test]
fn a_new_run_refuses_folders_with_foreign_files() {
    let home = folder();
    for name in ["state.json", "shots.json", "request", "metrics.jsonl", "notes.txt"] {
        let run = home.path().join(format!("run-{name}"));
        fs::create_dir(&run).unwrap();
        fs::write(run.join(name), "mine").unwrap();
        train(home.path(), run.to_str().unwrap()).fails(1, &["not empty", name]);
        assert_eq!(fs::read_to_string(run.join(name)).unwrap(), "mine");
        let several = carom(home.path(), &[&TRAIN[..], &[run.to_str().unwrap(), "--seeds", "2"]].concat());
        assert_eq!(several.code, Some(1), "{}", several.err);
        assert!(!run.join("seeds.json").exists());
    }
    let (mine, run) = (home.path().join("mine.json"), home.path().join("linked"));
    fs::write(&mine, "mine").unwrap();
    fs::create_dir(&run).unwrap();
    symlink(&mine, run.join("state.json")).unwrap();
    assert_eq!(train(home.path(), run.to_str().unwrap()).code, Some(1));
    assert_eq!(fs::read_to_string(&mine).unwrap(), "mine");
    fs::create_dir(home.path().join("empty")).unwrap();
    assert_eq!(train(home.path(), "empty").code, Some(0), "an empty folder is as good as none");
    assert_eq!(train(home.path(), "empty").code, Some(1), "and is a run then");
}

#[test]
fn pipes_and_devices_are_refused_without_blocking() {
    let home = folder();
    let pipe = home.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let shot = ["--shot", "0,0,0,0,1"];
    for path in [pipe.to_str().unwrap(), "/dev/zero"] {
        for args in [
            &[&["simulate", "--table", path], &shot[..]].concat()[..],
            &["table", "check", path],
            &["train", "--config", path],
            &["train", "--from", path],
            &["recommend", "--policy", path],
            &["drill", "import", path],
        ] {
            let output = carom(home.path(), args);
            assert!(matches!(output.code, Some(1 | 2)), "{args:?}: {}", output.err);
            assert!(output.err.contains("regular file"), "{args:?}: {}", output.err);
        }
    }
    // The same in place of the files of a run.
    let run = home.path().join("runs/one");
    train(home.path(), run.to_str().unwrap()).ok();
    for name in ["config.json", "state.json", "metrics.jsonl", "checkpoint.safetensors", "lock"] {
        let file = run.join(name);
        let _ = fs::remove_file(&file);
        fs::rename(&pipe, &file).unwrap();
        carom(home.path(), &["train", "--list", "runs"]);
        if name != "metrics.jsonl" {
            carom(home.path(), &["train", "--resume", "runs/one"]);
        }
        // Whether the run can work without the file is another question: the program must not hang.
        fs::rename(&file, &pipe).unwrap();
    }
}

#[test]
fn a_batch_is_read_from_a_pipe_and_may_begin_with_a_byte_order_mark() {
    let home = folder();
    let pipe = home.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let writer = std::thread::spawn({
        let line = r#"{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"cue":{"a":0,"b":0.3,"theta_deg":5,"phi_deg":1,"speed":4}}"#;
        let pipe = pipe.clone();
        move || fs::write(pipe, format!("\u{feff}{line}\n{line}\n")).unwrap()
    });
    let answers = carom(home.path(), &["simulate", "--batch", pipe.to_str().unwrap()]).ok().json();
    writer.join().unwrap();
    assert!(answers.len() == 2 && answers[0] == answers[1] && answers[0].get("error").is_none(), "{answers:?}");
}

#[test]
fn an_export_follows_symbolic_links() {
    let home = folder();
    fs::write(home.path().join("real.json"), "").unwrap();
    symlink("real.json", home.path().join("link.json")).unwrap();
    carom(home.path(), &["drill", "export", "link.json"]).ok();
    assert!(home.path().join("link.json").is_symlink());
    assert!(fs::read_to_string(home.path().join("real.json")).unwrap().contains("carom"));
    // Overwrites another export, but nothing else.
    carom(home.path(), &["drill", "export", "real.json"]).ok();
    fs::write(home.path().join("notes.txt"), "mine").unwrap();
    carom(home.path(), &["drill", "export", "notes.txt"]).fails(1, &["is not an export, so it stays as it is"]);
    assert_eq!(fs::read_to_string(home.path().join("notes.txt")).unwrap(), "mine");
}

#[test]
fn a_table_name_cannot_escape_the_runs_folder() {
    let home = folder();
    let table = carom(home.path(), &["table", "show", "match"]).out;
    fs::write(home.path().join("t.toml"), table.replace("\"match\"", "\"../../../gone\\u001b\"")).unwrap();
    let args = ["train", "--table", "t.toml", "--steps", "100", "--evaluation-layouts", "2", "--evaluate-every", "100"];
    carom(home.path(), &args).ok();
    let runs = fs::read_dir(home.path().join("carom/runs")).unwrap();
    let names: Vec<_> = runs.map(|run| run.unwrap().file_name().into_string().unwrap()).collect();
    assert!(names.len() == 1 && names[0].contains("gone"), "{names:?}");
    assert!(home.path().join("carom/runs").join(&names[0]).join("config.json").exists());
}
