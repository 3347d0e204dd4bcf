//! The user's own positions, share codes, export and import.

use std::fs;

use crate::program::{SAVE, count_attempts, drill, folder};

#[test]
fn positions_are_shared_added_replaced_and_removed() {
    let folder = folder();
    let code = drill(folder.path(), &["share", "mine"]).out;
    assert_eq!(code.lines().count(), 1);
    // Split in two, as a chat may wrap it.
    let (begin, end) = code.trim().split_at(30);
    assert_eq!(drill(folder.path(), &["add", begin, end]).code, Some(1), "there is one of this name");
    drill(folder.path(), &["add", begin, end, "--name", "yours"]).ok();
    let show = |name: &str| drill(folder.path(), &["show", name, "--json"]).json().remove(0);
    let (mine, yours) = (show("mine"), show("yours"));
    assert_eq!((&mine["layout"], &mine["rule"]), (&yours["layout"], &yours["rule"]));
    assert_eq!(mine["diamonds"][1], serde_json::json!([4.0, 2.0]), "the middle of the table");
    let again = [SAVE, &["--title", "Another", "--replace"]].concat();
    drill(folder.path(), &again).ok();
    assert_eq!(show("mine")["title"], "Another");
    assert_eq!(drill(folder.path(), &["list", "--category", "own", "--json"]).json().len(), 2);
    drill(folder.path(), &["log", "yours", "make"]);
    drill(folder.path(), &["remove", "yours"]).ok();
    assert_eq!(drill(folder.path(), &["show", "yours"]).code, Some(1));
    assert_eq!(drill(folder.path(), &["history", "yours", "--json"]).json().len(), 1, "its history stays");
}

#[test]
fn a_tag_is_one_word_with_or_without_hash() {
    let folder = folder();
    let tagged = |tag: &str| drill(folder.path(), &[SAVE, &["--replace", "--tag", tag]].concat());
    tagged("#steep-one").ok();
    for tag in ["steep-one", "#steep-one"] {
        let found = drill(folder.path(), &["list", "--tag", tag, "--json"]);
        assert_eq!(found.json().iter().map(|row| &row["tags"][0]).collect::<Vec<_>>(), ["steep-one"], "{}", found.err);
    }
    for tag in ["a b", "#", ""] {
        tagged(tag).fails(2, &["accepted is one word"]);
    }
}

#[test]
fn blank_titles_are_ignored_and_long_ones_refused() {
    let folder = folder();
    let titled = |title: &str| drill(folder.path(), &[SAVE, &["--replace", "--title", title]].concat());
    for (title, shown) in [("", "mine"), ("  ", "mine"), (" Mine ", "Mine")] {
        titled(title).ok();
        assert_eq!(drill(folder.path(), &["show", "mine", "--json"]).json()[0]["title"], shown);
    }
    let refused = titled(&"x".repeat(5000)).fails(2, &["has 5000 bytes; accepted are up to 400"]);
    assert!(refused.err.len() < 200, "{}", refused.err);
}

#[test]
fn only_positions_of_older_versions_trigger_the_notice() {
    let folder = folder();
    drill(folder.path(), &["log", "mine", "make"]);
    let listed_anew = || {
        fs::remove_dir_all(folder.path().join("state")).unwrap();
        drill(folder.path(), &["list", "--category", "own"]).err
    };
    assert_eq!(listed_anew(), "", "all is of this version");
    let position = folder.path().join("carom/positions/mine.json");
    let version = format!("  \"carom\": \"{}\",\n", env!("CARGO_PKG_VERSION"));
    let text = fs::read_to_string(&position).unwrap();
    assert!(text.contains(&version), "{text}");
    fs::write(&position, text.replace(&version, "")).unwrap();
    assert!(listed_anew().contains("\"match\" is now a table with constants from filmed shots"));
    assert_eq!(drill(folder.path(), &["list", "--category", "own"]).err, "", "once");
    assert_eq!(count_attempts(folder.path()), 1);
}

#[test]
fn importing_a_file_that_is_no_export_is_refused() {
    let folder = folder();
    for (text, says) in [
        ("name = \"mine\"", "line 1, column 2 is not JSON"),
        ("[1,2]", "does not begin with a \"format\" and a \"version\""),
        (r#"{"format":"carom-library","version":1,"exercises":[{"name":3}]}"#, "at line 1, column "),
        (r#"{"format":"carom-library","version":1,"sessions":3}"#, "invalid type"),
    ] {
        fs::write(folder.path().join("other"), text).unwrap();
        let refused = drill(folder.path(), &["import", "other"]).fails(2, &[says]);
        assert!(refused.err.contains("accepted is a JSON file as carom drill export writes it"), "{}", refused.err);
    }
}

#[test]
fn an_export_overwrites_only_another_export() {
    let folder = folder();
    let library = r#"{"format":"carom-library","version":1,"exercises":[]}"#;
    fs::write(folder.path().join("library.json"), library).unwrap();
    drill(folder.path(), &["export", "library.json"]).fails(1, &["is not an export"]);
    assert_eq!(fs::read_to_string(folder.path().join("library.json")).unwrap(), library);
    for _ in 0..2 {
        drill(folder.path(), &["export", "all.json"]).ok();
    }
}

#[test]
fn an_export_is_imported_only_once() {
    let (here, there) = (folder(), tempfile::tempdir().unwrap());
    drill(here.path(), &["log", "mine", "make", "miss"]);
    drill(here.path(), &["log", "mine", "make"]);
    drill(here.path(), &["export", "all.json"]).ok();
    drill(here.path(), &["export", "al/l.json"]).fails(1, &["there is no folder al"]);
    assert!(!here.path().join("al").exists());
    let file = here.path().join("all.json");
    let file = file.to_str().unwrap();
    let import = || drill(there.path(), &["import", file, "--json"]).json().remove(0);
    let first = import();
    assert_eq!([&first["positions"], &first["sessions"], &first["known"]], [1, 2, 0]);
    assert_eq!((count_attempts(there.path()), import()["known"].as_u64()), (3, Some(3)));
    assert_eq!(drill(there.path(), &["export", "-"]).out, drill(there.path(), &["export"]).out);
    assert_eq!(drill(there.path(), &["export"]).out.trim(), fs::read_to_string(file).unwrap().trim());
    // Of sessions that have grown here since, the longer version is kept; a file of a newer version is refused completely.
    let text = fs::read_to_string(file).unwrap();
    fs::write(file, text.replace("\"version\":1", "\"version\":2")).unwrap();
    drill(there.path(), &["import", file]).fails(2, &["version 2"]);
    assert_eq!(count_attempts(there.path()), 3);
}
