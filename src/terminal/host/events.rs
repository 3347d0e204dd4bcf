//! The one channel of everything that happens: keys, resizes, signals, the coach's answers, and news of training.

use std::{
    io,
    os::fd::AsFd,
    sync::mpsc::{Receiver, Sender, channel},
    thread,
    time::Duration,
};

use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    io::Errno,
    termios::{Action, QueueSelector, tcflow, tcflush},
};
use signal_hook::consts::{SIGTTIN, SIGTTOU};

use crate::terminal::{
    host::{input::Decoder, signals},
    tasks::event::Event,
};

/// Bytes that are read at once.
const AT_ONCE: usize = 65_536;

/// Time that the screen has to end after a signal, before output that the terminal does not take is thrown away.
const ENDING: Duration = Duration::from_millis(300);

/// Starts the threads that read the terminal and the signals into one channel.
///
/// # Errors
/// A thread or a signal handler that could not be set up.
pub fn open() -> io::Result<(Sender<Event>, Receiver<Event>)> {
    let (sender, receiver) = channel();
    // The input thread learns of a resize too, but only from its first read on: one before that would be lost.
    let mut signals = signals::catch()?;
    let to_screen = sender.clone();
    thread::Builder::new().name("signals".into()).spawn(move || {
        for signal in signals.forever() {
            // The system says so that another process has the terminal now.
            if matches!(signal, SIGTTIN | SIGTTOU) && !signals::has_the_terminal() {
                let _ = signals::stop();
                continue;
            }
            if to_screen.send(Event::Signal(signal)).is_err() {
                break;
            }
            if signals::ends(signal) {
                free_the_screen();
            }
        }
    })?;
    let to_screen = sender.clone();
    thread::Builder::new().name("input".into()).spawn(move || {
        // The end of the input ends the screen; a screen that is gone already needs no event.
        let _ = read_input(&to_screen);
        let _ = to_screen.send(Event::InputEnded);
    })?;
    Ok((sender, receiver))
}

/// Reads the terminal until it gives no more.
///
/// # Errors
/// What the terminal answers.
fn read_input(to_screen: &Sender<Event>) -> io::Result<()> {
    let input = io::stdin();
    let (mut decoder, mut events) = (Decoder::default(), Vec::new());
    let mut bytes = vec![0; AT_ONCE];
    loop {
        match wait(&input, decoder.patience())? {
            Waited::Silence => decoder.silence(&mut events),
            Waited::Gone => return Ok(()),
            Waited::Input => match rustix::io::read(&input, &mut bytes) {
                Ok(0) => return Ok(()),
                Ok(count) => decoder.feed(&bytes[..count], &mut events),
                Err(Errno::INTR | Errno::AGAIN) => {}
                Err(error) => return Err(error.into()),
            },
        }
        for event in events.drain(..) {
            if to_screen.send(Event::Input(event)).is_err() {
                return Ok(());
            }
        }
    }
}

/// What comes of waiting for input.
enum Waited {
    Input,
    /// Nothing came in time.
    Silence,
    /// There will be no more: the terminal is gone.
    Gone,
}

fn wait(input: impl AsFd, patience: Option<Duration>) -> io::Result<Waited> {
    let patience = patience.and_then(|time| Timespec::try_from(time).ok());
    let mut input = [PollFd::new(&input, PollFlags::IN)];
    loop {
        match poll(&mut input, patience.as_ref()) {
            Ok(0) => return Ok(Waited::Silence),
            Ok(_) if input[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL) => {
                return Ok(Waited::Gone);
            }
            Ok(_) => return Ok(Waited::Input),
            Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
    }
}

/// Lets a screen end that waits for a terminal which takes nothing any more, as over a link that stands still: what has
/// not been taken is thrown away, as often as that is in the way. The process ends meanwhile, and this thread with it.
#[allow(clippy::disallowed_methods, reason = "nothing is written")]
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
