//! Tells the program which source it is built from: `git describe`, where this folder is the top of a git checkout.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

fn main() {
    // Whatever goes into the program can make it "dirty".
    for part in ["build.rs", "Cargo.toml", "Cargo.lock", "src", "models"] {
        println!("cargo::rerun-if-changed={part}");
    }
    let top = git(&["rev-parse", "--show-toplevel"]).map(PathBuf::from);
    // An unpacked archive may lie within somebody else's repository.
    if top.is_none_or(|top| !is_same(&top, Path::new("."))) {
        return;
    }
    // Commits that change no file above still change the description. In a linked worktree this lies elsewhere.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists()) {
        println!("cargo::rerun-if-changed={log}");
    }
    if let Some(source) = git(&["describe", "--always", "--dirty", "--tags"]) {
        println!("cargo::rustc-env=CAROM_SOURCE={source}");
    }
}

/// What git says to this, in a line; nothing where there is no git or no repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    let line = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (!line.is_empty() && !line.contains('\n')).then_some(line)
}

fn is_same(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
