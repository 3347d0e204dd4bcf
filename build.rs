//! Tells the program what it is built from and for: the commit (from git, or from the note that a package of the crate has), and
//! the target.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// What cargo notes in a package of the crate: the commit that it was made from.
const PACKAGED: &str = ".cargo_vcs_info.json";

/// Letters of a commit's name that tell it from all others here; git shows as many.
const SHORT: usize = 7;

fn main() {
    // Whatever goes into the program can make it "dirty".
    for part in ["build.rs", "Cargo.toml", "Cargo.lock", "src", "models"] {
        println!("cargo::rerun-if-changed={part}");
    }
    let source = checked_out().or_else(packaged);
    if let Some(source) = &source {
        println!("cargo::rustc-env=CAROM_SOURCE={source}");
    }
    let target = std::env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=CAROM_TARGET={target}");
    let version = std::env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let source = source.map_or_else(
        || "commit not known: built outside a git checkout".to_owned(),
        |source| format!("commit {source}"),
    );
    println!("cargo::rustc-env=CAROM_VERSION={version} ({source}, {target})");
}

/// What `git describe` says, where this folder is the top of a git checkout.
fn checked_out() -> Option<String> {
    let top = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?);
    // An unpacked archive may lie within somebody else's repository.
    if !is_same(&top, Path::new(".")) {
        return None;
    }
    // Commits that change no file above still change the description. In a linked worktree this lies elsewhere.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists()) {
        println!("cargo::rerun-if-changed={log}");
    }
    git(&["describe", "--always", "--dirty", "--tags"])
}

/// The commit that a package of the crate was made from.
fn packaged() -> Option<String> {
    let note = fs::read_to_string(PACKAGED).ok()?;
    println!("cargo::rerun-if-changed={PACKAGED}");
    let (_, rest) = note.split_once("\"sha1\"")?;
    let commit = rest.split('"').nth(1)?;
    let is_commit = commit.len() >= SHORT && commit.bytes().all(|letter| letter.is_ascii_hexdigit());
    let dirty = if note.contains("\"dirty\": true") { "-dirty" } else { "" };
    is_commit.then(|| format!("{}{dirty}", &commit[..SHORT]))
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
