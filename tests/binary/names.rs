//! Names that are mistyped, ambiguous or found in more than one way.

use std::fs;

use crate::program::{carom, drill, folder, run_with_input, stdout};

#[test]
fn similar_names_are_suggested() {
    let home = folder();
    fs::create_dir_all(home.path().join("carom/runs/evening")).unwrap();
    for (args, code, meant) in [
        (&["table", "show", "mtach"][..], 1, "match"),
        (&["recommend", "--skill", "begginer"], 2, "beginner"),
        (&["recommend", "--policy", "match-3"], 1, "match-r3"),
        (&["recommend", "--policy", "evning"], 1, "evening"),
        (&["train", "--agent", "thesis-dpg"], 2, "thesis-ddpg"),
        (&["train", "--from", "evening1"], 1, "evening"),
        (&["watch", "--plain", "evnening"], 1, "evening"),
        (&["man", "recomend"], 2, "recommend"),
    ] {
        carom(home.path(), args).fails(code, &[&format!("did you mean \"{meant}\"?")]);
    }
    for args in [&["table", "show", "xyzzy"][..], &["recommend", "--skill", "xyzzy"], &["watch", "xyzzy"]] {
        let refused = carom(home.path(), args);
        assert!(refused.code != Some(0) && !refused.err.contains("did you mean"), "{}", refused.err);
    }
}

#[test]
fn an_own_table_is_found_by_the_name_in_the_output() {
    let home = folder();
    let tables = home.path().join("carom/tables");
    fs::create_dir_all(&tables).unwrap();
    let named = |name: &str| {
        let text = stdout(&["table", "show", "match"]).replace("name = \"match\"", &format!("name = \"{name}\""));
        text.replace("e_rail = 0.8505", "e_rail = 0.85")
    };
    fs::write(tables.join("monday.toml"), named("our club, table 2")).unwrap();
    let try_it = |table: &str| {
        let args = ["try", "mine", "--shot", "0,0.3,3,0.3,4", "--json", "--table", table];
        drill(home.path(), &args).ok().json()[0]["table"].as_str().unwrap().to_owned()
    };
    let name = try_it("monday");
    assert_eq!((name.as_str(), try_it(&name)), ("our club, table 2", name.clone()));
    carom(home.path(), &["table", "show", "our club, table 3"]).fails(1, &["did you mean \"our club, table 2\"?"]);
    fs::write(tables.join("tuesday.toml"), named(&name)).unwrap();
    carom(home.path(), &["table", "show", &name]).fails(1, &["several", "monday.toml", "tuesday.toml"]);
    assert_eq!(try_it("tuesday"), name, "the name of a file has precedence");
}

#[test]
fn the_latest_run_is_found_wherever_a_run_is_named() {
    let home = folder();
    let runs = home.path().join("carom/runs");
    for args in [&["watch", "latest"][..], &["evaluate", "--policy", "latest"], &["train", "--from", "latest"]] {
        carom(home.path(), args).fails(1, &["runs in"]);
    }
    fs::create_dir_all(runs.join("evening")).unwrap();
    fs::write(runs.join("evening/checkpoint.safetensors"), "").unwrap();
    for args in [&["evaluate", "--policy", "latest", "--policy-only"][..], &["train", "--from", "latest"]] {
        carom(home.path(), args).fails(1, &["evening"]);
    }
}

#[test]
fn a_list_without_entries_is_no_failure() {
    let home = tempfile::tempdir().unwrap();
    for args in [&["drill", "list", "--category", "own"][..], &["drill", "history"], &["train", "--list"], &["follow"]]
    {
        let listed = carom(home.path(), args).ok();
        assert!(listed.out.is_empty() && listed.err.lines().count() == 1, "{args:?}: {}{}", listed.out, listed.err);
    }
}

#[test]
fn a_library_is_imported_despite_a_byte_order_mark() {
    let home = folder();
    let library = "\u{feff}{\"format\": \"carom-library\", \"version\": 1, \"exercises\": []}";
    fs::write(home.path().join("library.json"), library).unwrap();
    drill(home.path(), &["import", "library.json"]).ok();
    let command = |file: &str| crate::program::command(home.path(), &["drill", "import", file]);
    assert_eq!(run_with_input(command("-"), library).code, Some(0));
    fs::write(home.path().join("library.json"), library.replace('1', "0")).unwrap();
    let refused = drill(home.path(), &["import", "library.json"]).fails(2, &["version 0; versions 1 to 1 can be read"]);
    assert!(!refused.err.contains("newer"), "{}", refused.err);
}
