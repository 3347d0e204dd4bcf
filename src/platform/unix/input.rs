//! Terminal input with a timeout, and terminal output that can be discarded.

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

use crate::platform::TerminalInput;

/// Time that the screen has to end after a signal, before output that the terminal does not accept is discarded.
const EXIT_GRACE: Duration = Duration::from_millis(300);

/// Terminal input as bytes.
#[derive(Debug)]
pub struct Input(Stdin);

impl Input {
    /// Returns the standard input.
    pub fn open() -> Self {
        Self(io::stdin())
    }

    /// Waits for bytes, at most `timeout` if it is given, and reads them into `bytes`.
    ///
    /// # Errors
    /// Returns the error of the terminal.
    pub fn next(&mut self, bytes: &mut [u8], timeout: Option<Duration>) -> io::Result<TerminalInput> {
        let timeout = timeout.and_then(|time| Timespec::try_from(time).ok());
        let mut input = [PollFd::new(&self.0, PollFlags::IN)];
        loop {
            match poll(&mut input, timeout.as_ref()) {
                Ok(0) => return Ok(TerminalInput::Timeout),
                Ok(_) if input[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL) => {
                    return Ok(TerminalInput::Closed);
                }
                Ok(_) => {}
                Err(Errno::INTR) => continue,
                Err(error) => return Err(error.into()),
            }
            match rustix::io::read(&self.0, &mut *bytes) {
                Ok(0) => return Ok(TerminalInput::Closed),
                Ok(count) => return Ok(TerminalInput::Bytes(count)),
                Err(Errno::INTR | Errno::AGAIN) => {}
                Err(error) => return Err(error.into()),
            }
        }
    }
}

/// Returns the terminal for drawing the screen, without any buffer.
///
/// # Errors
/// Fails if the process cannot open another file.
#[expect(clippy::disallowed_methods, reason = "a screen is control characters; text goes through the ANSI backend")]
pub fn terminal_output() -> io::Result<File> {
    Ok(File::from(io::stdout().as_fd().try_clone_to_owned()?))
}

/// Lets a screen end that is blocked on a terminal which accepts no more output, for example over a stalled link. Discards the pending
/// output whenever the terminal is full, until the process ends and this thread with it.
#[expect(clippy::disallowed_methods, reason = "nothing is written")]
pub fn discard_pending_output() -> ! {
    let output = io::stdout();
    loop {
        thread::sleep(EXIT_GRACE);
        let mut room = [PollFd::new(&output, PollFlags::OUT)];
        let is_full = poll(&mut room, Some(&Timespec::default())).is_ok() && room[0].revents().is_empty();
        // Stopping and restarting the output wakes the blocked writer. If the terminal is gone, there is nothing to do.
        if is_full && tcflush(&output, QueueSelector::OFlush).is_ok() && tcflow(&output, Action::OOff).is_ok() {
            let _ = tcflow(&output, Action::OOn);
        }
    }
}
