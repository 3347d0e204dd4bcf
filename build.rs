//! Sets the build-time variables of the program: its version, its commit (from git, or from the note in a published package) and its
//! target.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The file in which cargo records the commit that a published package was made from.
const PACKAGED: &str = ".cargo_vcs_info.json";

/// Length of an abbreviated commit hash; git displays as many characters.
const SHORT: usize = 7;

fn main() {
    // A change in any of these files can make the checkout "dirty".
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

/// Returns the output of `git describe` if this folder is the top of a git checkout.
fn checked_out() -> Option<String> {
    let top = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?);
    // The folder may be an unpacked archive inside an unrelated repository.
    if !is_same(&top, Path::new(".")) {
        return None;
    }
    // A commit that changes none of the files above still changes the description. A linked worktree keeps this log elsewhere.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists()) {
        println!("cargo::rerun-if-changed={log}");
    }
    git(&["describe", "--always", "--dirty", "--tags"])
}

/// Returns the commit that cargo recorded in the published package.
fn packaged() -> Option<String> {
    let note = fs::read_to_string(PACKAGED).ok()?;
    println!("cargo::rerun-if-changed={PACKAGED}");
    let (_, rest) = note.split_once("\"sha1\"")?;
    let commit = rest.split('"').nth(1)?;
    let is_commit = commit.len() >= SHORT && commit.bytes().all(|letter| letter.is_ascii_hexdigit());
    let dirty = if note.contains("\"dirty\": true") { "-dirty" } else { "" };
    is_commit.then(|| format!("{}{dirty}", &commit[..SHORT]))
}

/// Returns the single line that git prints; `None` if there is no git or no repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    let line = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (!line.is_empty() && !line.contains('\n')).then_some(line)
}

fn is_same(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
