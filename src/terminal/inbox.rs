//! The one channel of everything that happens: keys, resizes, signals, the coach's answers, and news of training.

use std::{
    io,
    os::fd::AsFd,
    sync::mpsc::{Receiver, Sender, channel},
    thread,
    time::Duration,
};

use crossterm::event::{self, Event};
use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    io::Errno,
    termios::{Action, QueueSelector, tcflow, tcflush},
};
use signal_hook::{
    consts::{SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGWINCH},
    iterator::Signals,
};

use super::{drills::DrillReport, recommender::Answer, settings::SettingsReport, training::Report};

/// Time in which a key that has begun to arrive is read, once there is something to read.
const READING: Duration = Duration::from_millis(1);

/// Time that the screen has to end after a signal, before output that the terminal does not take is thrown away.
const ENDING: Duration = Duration::from_millis(300);

/// Something that the screen has to deal with.
#[derive(Debug)]
pub enum News {
    /// A key, a resize or another report of the terminal.
    Input(Event),
    /// The terminal gives no input any more.
    InputEnded,
    /// A signal.
    Signal(i32),
    /// The coach has answered.
    Answer(Answer),
    /// Something has come of what the training screen wanted.
    Report(Report),
    /// Something has come of an errand of the drill screens.
    Drill(DrillReport),
    /// Something has come of an errand of the settings.
    Settings(SettingsReport),
}

/// Starts the threads that read the terminal and the signals into one channel.
///
/// # Errors
/// A thread or a signal handler that could not be set up.
pub fn open() -> io::Result<(Sender<News>, Receiver<News>)> {
    let (sender, receiver) = channel();
    // The input thread learns of a resize too, but only from its first read on: one before that would be lost.
    let mut signals = Signals::new([SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGTSTP, SIGCONT, SIGWINCH])?;
    let to_screen = sender.clone();
    thread::Builder::new().name("signals".into()).spawn(move || {
        for signal in signals.forever() {
            if to_screen.send(News::Signal(signal)).is_err() {
                break;
            }
            if matches!(signal, SIGTERM | SIGINT | SIGHUP | SIGQUIT) {
                free_the_screen();
            }
        }
    })?;
    let to_screen = sender.clone();
    thread::Builder::new().name("input".into()).spawn(move || {
        // The screen is told of whatever ends it; where it is gone already, nobody is.
        let _ = read_input(&to_screen);
        let _ = to_screen.send(News::InputEnded);
    })?;
    Ok((sender, receiver))
}

/// Reads the terminal until it gives no more.
///
/// crossterm takes the end of the input for no input and would ask for more for ever, so it is asked only while there is
/// something to read.
///
/// # Errors
/// What the terminal answers.
fn read_input(to_screen: &Sender<News>) -> io::Result<()> {
    while is_open(io::stdin())? {
        while event::poll(READING)? {
            if to_screen.send(News::Input(event::read()?)).is_err() {
                return Ok(());
            }
        }
    }
    Ok(())
}

/// Waits for input; `false` where there will be none any more: the terminal is gone.
fn is_open(input: impl AsFd) -> io::Result<bool> {
    let mut input = [PollFd::new(&input, PollFlags::IN)];
    loop {
        match poll(&mut input, None) {
            Ok(_) => return Ok(!input[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL)),
            Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
    }
}

/// Lets a screen end that waits for a terminal which takes nothing any more, as over a link that stands still: what has
/// not been taken is thrown away, as often as that is in the way. The process ends meanwhile, and this thread with it.
fn free_the_screen() -> ! {
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
