//! The channel of all events: keys, resizes, signals, the coach's answers, and news of training.

use std::{
    io,
    sync::mpsc::{Receiver, Sender, channel},
    thread,
};

use crate::{
    platform::{self, Input, Signal, TerminalInput},
    terminal::{host::input::Decoder, tasks::event::Event},
};

/// Size of the read buffer, bytes.
const READ_SIZE: usize = 65_536;

/// Starts the threads that read the terminal and the signals, and returns their common channel.
///
/// # Errors
/// Fails if a thread or a signal handler cannot be set up.
pub fn open() -> io::Result<(Sender<Event>, Receiver<Event>)> {
    let (sender, receiver) = channel();
    // The input thread detects resizes too, but only after its first read; an earlier one would be lost.
    let to_screen = sender.clone();
    platform::handle_signals(move |signal| {
        let is_heard = to_screen.send(Event::Signal(signal)).is_ok();
        if is_heard && matches!(signal, Signal::End(_)) {
            platform::discard_pending_output();
        }
        is_heard
    })?;
    let to_screen = sender.clone();
    thread::Builder::new().name("input".into()).spawn(move || {
        // The end of the input closes the screen; a closed screen needs no event.
        let _ = read_input(&to_screen);
        let _ = to_screen.send(Event::InputEnded);
    })?;
    Ok((sender, receiver))
}

/// Reads the terminal until its input ends.
///
/// # Errors
/// Any error of the terminal.
fn read_input(to_screen: &Sender<Event>) -> io::Result<()> {
    let mut input = Input::open();
    let (mut decoder, mut events) = (Decoder::default(), Vec::new());
    let mut bytes = vec![0; READ_SIZE];
    loop {
        match input.next(&mut bytes, decoder.timeout())? {
            TerminalInput::Timeout => decoder.on_timeout(&mut events),
            TerminalInput::Closed => return Ok(()),
            TerminalInput::Bytes(count) => decoder.feed(&bytes[..count], &mut events),
            TerminalInput::Event(event) => events.push(event),
        }
        for event in events.drain(..) {
            if to_screen.send(Event::Input(event)).is_err() {
                return Ok(());
            }
        }
    }
}
