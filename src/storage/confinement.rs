//! File access of a process that serves a guest: only files in folders that are set once.

use std::{
    ffi::OsString,
    io,
    path::{Path, PathBuf},
    sync::OnceLock,
};

/// The folders, with all symbolic links resolved.
#[derive(Debug)]
struct Confinement {
    written: PathBuf,
    read: Vec<PathBuf>,
}

/// A process is confined at most once, and for its whole life.
static CONFINEMENT: OnceLock<Confinement> = OnceLock::new();

/// Confines this process: from now on it writes into `written` only, and reads from there and from `read` only. A second call has no
/// effect.
///
/// # Errors
/// Returns any error of the file system about `written`, which is created if it is missing.
pub fn confine(written: &Path, read: &[&Path]) -> io::Result<()> {
    std::fs::create_dir_all(written)?;
    let written = written.canonicalize()?;
    // Missing folders contain nothing to read.
    let read = read.iter().filter_map(|folder| folder.canonicalize().ok()).collect();
    CONFINEMENT.get_or_init(|| Confinement { written, read });
    Ok(())
}

/// Refuses to read outside the folders.
///
/// # Errors
/// Fails with an explanation if `path` is outside them.
pub fn check_read_allowed(path: &Path) -> io::Result<()> {
    CONFINEMENT.get().map_or(Ok(()), |confinement| confinement.check_read(path))
}

/// Refuses to write outside the folder.
///
/// # Errors
/// Fails with an explanation if `path` is outside it.
pub fn check_write_allowed(path: &Path) -> io::Result<()> {
    CONFINEMENT.get().map_or(Ok(()), |confinement| confinement.check_write(path))
}

impl Confinement {
    fn check_read(&self, path: &Path) -> io::Result<()> {
        let path = resolved(path);
        if std::iter::once(&self.written).chain(&self.read).any(|folder| path.starts_with(folder)) {
            return Ok(());
        }
        Err(refusal("a guest can read only their own files"))
    }

    fn check_write(&self, path: &Path) -> io::Result<()> {
        if resolved(path).starts_with(&self.written) {
            return Ok(());
        }
        Err(refusal("a guest can write only their own files"))
    }
}

fn refusal(sentence: &str) -> io::Error {
    io::Error::new(io::ErrorKind::PermissionDenied, sentence)
}

/// Resolves symbolic links in the existing part of the path and appends the missing part by name. If the missing part contains "..",
/// returns an empty path.
fn resolved(path: &Path) -> PathBuf {
    let mut missing: Vec<OsString> = Vec::new();
    let mut there = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    loop {
        if let Ok(mut found) = there.canonicalize() {
            found.extend(missing.iter().rev());
            return found;
        }
        match (there.file_name().map(ToOwned::to_owned), there.pop()) {
            (Some(name), true) => missing.push(name),
            _ => return PathBuf::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_guest_cannot_escape_by_names_links_or_dots() {
        let house = tempfile::tempdir().unwrap();
        let folder = |name: &str| {
            let folder = house.path().join(name);
            std::fs::create_dir(&folder).unwrap();
            folder.canonicalize().unwrap()
        };
        let (own, runs, other) = (folder("own"), folder("runs"), folder("own-too"));
        std::fs::write(other.join("secret"), "").unwrap();
        let confinement = Confinement { written: own.clone(), read: vec![runs.clone()] };
        assert!(
            confinement.check_write(&own.join("new/file")).is_ok() && confinement.check_read(&own.join("file")).is_ok()
        );
        assert!(confinement.check_read(&runs.join("one/config.json")).is_ok());
        assert!(confinement.check_write(&runs.join("one/request")).is_err());
        let strangers = [other.join("secret"), own.join("../own-too/secret"), own.join("new/../../own-too/secret")];
        for path in strangers.iter().map(PathBuf::as_path).chain([Path::new("/etc/passwd"), Path::new("secret")]) {
            assert!(
                confinement.check_read(path).is_err() && confinement.check_write(path).is_err(),
                "{}",
                path.display()
            );
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&other, own.join("link")).unwrap();
            assert!(confinement.check_read(&own.join("link/secret")).is_err());
            assert!(confinement.check_write(&own.join("link/new")).is_err());
        }
    }
}
