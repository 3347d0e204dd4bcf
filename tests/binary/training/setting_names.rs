//! Settings under the names that they had in earlier versions.

use std::fs;

use super::common::{RunFiles, SMALL, carom, folder, read_json, run_ok};

fn with_earlier_names(text: &str) -> String {
    text.replace("batch_size", "batch").replace("buffer_size", "replay").replace("tau", "target_rate")
}

#[test]
fn settings_are_accepted_under_their_earlier_names() {
    let folder = folder();
    let here = folder.path();
    fs::write(here.join("earlier.toml"), with_earlier_names(SMALL)).unwrap();
    let short = "--steps 64 --evaluation-layouts 5";
    let line = format!("train --config small.toml --set tau=0.01 {short} --run now");
    run_ok(here, &line);
    run_ok(here, &format!("train --config earlier.toml --set target_rate=0.01 {short} --run earlier"));
    assert!(RunFiles::of(&here.join("now")) == RunFiles::of(&here.join("earlier")));
    // The earlier names are accepted for a run with the current ones, and the other way round.
    run_ok(here, &(with_earlier_names(&line) + " --continue").replace("small", "earlier"));
    let config = here.join("now/config.json");
    fs::write(&config, with_earlier_names(&fs::read_to_string(&config).unwrap())).unwrap();
    run_ok(here, &format!("{line} --continue"));

    let batch_size = |run: &str| read_json(here.join(run).join("config.json"))["settings"]["batch_size"].clone();
    for (run, line) in [
        ("a", "--config earlier.toml --set batch_size=16"),
        ("b", "--config small.toml --set batch=16"),
        ("c", "--from now --set batch=16"),
    ] {
        run_ok(here, &format!("train {line} {short} --run {run}"));
        assert_eq!(batch_size(run), 16, "{line}: --set takes precedence");
    }
}

#[test]
fn both_names_of_one_setting_are_refused() {
    let folder = folder();
    let here = folder.path();
    fs::write(here.join("both.toml"), "batch = 16\nbatch_size = 16\n").unwrap();
    for line in ["--set batch=16 --set batch_size=32", "--set batch_size=16 --set batch=16", "--config both.toml"] {
        let refused = carom(here, &format!("train {line} --run new"));
        assert!(refused.code == Some(2) && refused.err.lines().count() == 1, "{line}: {}", refused.err);
        assert!(refused.err.contains("batch is the earlier name of batch_size, and both are given"), "{}", refused.err);
    }
    assert!(!here.join("new").exists());
}
