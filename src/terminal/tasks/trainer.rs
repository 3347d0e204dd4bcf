//! Processes that train. They are on their own: neither the end of the screen nor that of its terminal reaches them.

use std::{
    ffi::OsString,
    fs::File,
    io::{Read, Seek, SeekFrom},
    process::{Child, Command, Stdio},
};

use crate::{
    platform::{self, UNFINISHED},
    terminal::TrainerFailure,
};

/// Bytes at the end of what a process says in which its last sentence is looked for.
const LAST_BYTES: i64 = 4096;

/// A process that trains, and the file of what it says.
pub type Trainer = (Child, File);

/// Starts this program with `arguments`.
///
/// # Errors
/// Where it cannot be started.
pub fn start(arguments: &[OsString]) -> Result<Trainer, TrainerFailure> {
    let start = || {
        let program = std::env::current_exe()?;
        // What it says goes to a file that has no name. A pipe would break with the end of this screen, and a write to
        // it would then end the training.
        let said = tempfile::tempfile()?;
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(said.try_clone()?);
        // Signals of the terminal go to a group of processes: not to this one.
        Ok((platform::own_group(&mut command).spawn()?, said))
    };
    start().map_err(|error: std::io::Error| TrainerFailure {
        process: None,
        sentence: format!("training cannot be started: {error}"),
    })
}

/// Waits until it ends.
///
/// # Errors
/// Where it fails: with its own sentence where it says one.
pub fn wait((mut process, said): Trainer) -> Result<(), TrainerFailure> {
    let failure = {
        let process = Some(process.id());
        move |sentence| TrainerFailure { process, sentence }
    };
    match process.wait() {
        // One that was stopped can go on, and its page says so.
        Ok(status) if status.success() || status.code() == Some(i32::from(UNFINISHED)) => Ok(()),
        Ok(status) => {
            let killed = || format!("the process that trains has ended: {status}");
            Err(failure(last_sentence(said).unwrap_or_else(killed)))
        }
        Err(error) => Err(failure(format!("the training cannot be watched: {error}"))),
    }
}

/// The last sentence in a file that says why the program has failed; what it says while it trains is none.
fn last_sentence(mut file: File) -> Option<String> {
    let length = i64::try_from(file.metadata().ok()?.len()).ok()?;
    file.seek(SeekFrom::End(-length.min(LAST_BYTES))).ok()?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let reason = |line: &str| Some(line.strip_prefix("carom: ").or(line.strip_prefix("error: "))?.trim().to_owned());
    text.lines().rev().find_map(reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn the_reason_of_a_failure_is_found_however_much_was_said() {
        let mut file = tempfile::tempfile().unwrap();
        assert_eq!(last_sentence(file.try_clone().unwrap()), None);
        for n in 0..2000 {
            writeln!(file, "line {n}").unwrap();
        }
        assert_eq!(last_sentence(file.try_clone().unwrap()), None, "a killed process gives no reason");
        writeln!(file, "carom: the folder is full\n").unwrap();
        assert_eq!(last_sentence(file).unwrap(), "the folder is full");
    }
}
