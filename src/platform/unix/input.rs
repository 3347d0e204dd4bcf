//! The terminal's two ends: bytes that come within a time, and an output that can be let go.

use std::{
    fs::File,
    io::{self, Stdin},
    os::fd::AsFd,
    thread,
    time::Duration,
};

use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    io::Errno,
    termios::{Action, QueueSelector, tcflow, tcflush},
};

use crate::platform::Came;

/// Time that the screen has to end after a signal, before output that the terminal does not take is thrown away.
const ENDING: Duration = Duration::from_millis(300);

/// What comes from the terminal, as bytes.
#[derive(Debug)]
pub struct Input(Stdin);

impl Input {
    /// The standard input.
    pub fn open() -> Self {
        Self(io::stdin())
    }

    /// Waits for bytes, up to `patience` if that is given, and reads them into `bytes`.
    ///
    /// # Errors
    /// What the terminal answers.
    pub fn next(&mut self, bytes: &mut [u8], patience: Option<Duration>) -> io::Result<Came> {
        let patience = patience.and_then(|time| Timespec::try_from(time).ok());
        let mut input = [PollFd::new(&self.0, PollFlags::IN)];
        loop {
            match poll(&mut input, patience.as_ref()) {
                Ok(0) => return Ok(Came::Silence),
                Ok(_) if input[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL) => {
                    return Ok(Came::Gone);
                }
                Ok(_) => {}
                Err(Errno::INTR) => continue,
                Err(error) => return Err(error.into()),
            }
            match rustix::io::read(&self.0, &mut *bytes) {
                Ok(0) => return Ok(Came::Gone),
                Ok(count) => return Ok(Came::Bytes(count)),
                Err(Errno::INTR | Errno::AGAIN) => {}
                Err(error) => return Err(error.into()),
            }
        }
    }
}

/// The terminal that pictures go to, past all buffers.
///
/// # Errors
/// Where the process has no room for another file.
#[expect(clippy::disallowed_methods, reason = "a screen is control characters; text goes through the ANSI backend")]
pub fn terminal_output() -> io::Result<File> {
    Ok(File::from(io::stdout().as_fd().try_clone_to_owned()?))
}

/// Lets a screen end that waits for a terminal which takes nothing any more, as over a link that stands still: what has
/// not been taken is thrown away, as often as that is in the way. The process ends meanwhile, and this thread with it.
#[expect(clippy::disallowed_methods, reason = "nothing is written")]
pub fn free_the_screen() -> ! {
    let output = io::stdout();
    loop {
        thread::sleep(ENDING);
        let mut room = [PollFd::new(&output, PollFlags::OUT)];
        let is_full = poll(&mut room, Some(&Timespec::default())).is_ok() && room[0].revents().is_empty();
        // The screen wakes when the output is stopped and started. Where the terminal is gone there is nothing to do.
        if is_full && tcflush(&output, QueueSelector::OFlush).is_ok() && tcflow(&output, Action::OOff).is_ok() {
            let _ = tcflow(&output, Action::OOn);
        }
    }
}
