//! The one channel of everything that happens: keys, resizes, signals, the coach's answers, and news of training.

use std::{
    io,
    sync::mpsc::{Receiver, Sender, channel},
    thread,
};

use crate::{
    platform::{self, Came, Input, Signal},
    terminal::{host::input::Decoder, tasks::event::Event},
};

/// Bytes that are read at once.
const AT_ONCE: usize = 65_536;

/// Starts the threads that read the terminal and the signals into one channel.
///
/// # Errors
/// A thread or a signal handler that could not be set up.
pub fn open() -> io::Result<(Sender<Event>, Receiver<Event>)> {
    let (sender, receiver) = channel();
    // The input thread learns of a resize too, but only from its first read on: one before that would be lost.
    let to_screen = sender.clone();
    platform::listen(move |signal| {
        let is_heard = to_screen.send(Event::Signal(signal)).is_ok();
        if is_heard && matches!(signal, Signal::End(_)) {
            platform::free_the_screen();
        }
        is_heard
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
    let mut input = Input::open();
    let (mut decoder, mut events) = (Decoder::default(), Vec::new());
    let mut bytes = vec![0; AT_ONCE];
    loop {
        match input.next(&mut bytes, decoder.patience())? {
            Came::Silence => decoder.silence(&mut events),
            Came::Gone => return Ok(()),
            Came::Bytes(count) => decoder.feed(&bytes[..count], &mut events),
            Came::Event(event) => events.push(event),
        }
        for event in events.drain(..) {
            if to_screen.send(Event::Input(event)).is_err() {
                return Ok(());
            }
        }
    }
}
