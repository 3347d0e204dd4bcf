//! Training processes. They are independent: closing the screen or its terminal does not stop them.

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

/// Number of bytes at the end of a process' output that are searched for its last message.
const LAST_BYTES: i64 = 4096;

/// A training process and the file with its output.
pub type Trainer = (Child, File);

/// Starts this program with `arguments`.
///
/// # Errors
/// Fails if the process cannot be started.
pub fn start(arguments: &[OsString]) -> Result<Trainer, TrainerFailure> {
    let start = || {
        let program = std::env::current_exe()?;
        // Its output goes to a file without a name. A pipe would break when the screen closes, and the next write would end the training.
        let output = tempfile::tempfile()?;
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(output.try_clone()?);
        // The terminal sends signals to a process group; this process gets its own.
        Ok((platform::in_own_process_group(&mut command).spawn()?, output))
    };
    start().map_err(|error: std::io::Error| TrainerFailure {
        process: None,
        sentence: format!("training cannot be started: {error}"),
    })
}

/// Waits until the process ends.
///
/// # Errors
/// Fails if the process fails, with its own message if it has printed one.
pub fn wait((mut process, output): Trainer) -> Result<(), TrainerFailure> {
    let failure = {
        let process = Some(process.id());
        move |sentence| TrainerFailure { process, sentence }
    };
    match process.wait() {
        // A stopped run can be resumed, and its page shows that.
        Ok(status) if status.success() || status.code() == Some(i32::from(UNFINISHED)) => Ok(()),
        Ok(status) => {
            let killed = || format!("the training process has ended: {status}");
            Err(failure(last_sentence(output).unwrap_or_else(killed)))
        }
        Err(error) => Err(failure(format!("the training cannot be watched: {error}"))),
    }
}

/// The last error message of the program in a file; its other output does not count.
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
    fn the_reason_of_a_failure_is_found_after_long_output() {
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
