//! The one channel of everything that happens: keys, resizes, signals, the coach's answers, and news of training.

use std::{
    io,
    sync::mpsc::{Receiver, Sender, channel},
    thread,
};

use crossterm::event::{self, Event};
use signal_hook::{
    consts::{SIGCONT, SIGHUP, SIGINT, SIGTERM, SIGTSTP, SIGWINCH},
    iterator::Signals,
};

use super::{drills::DrillReport, recommender::Answer, settings::SettingsReport, training::Report};

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
    let mut signals = Signals::new([SIGTERM, SIGINT, SIGHUP, SIGTSTP, SIGCONT, SIGWINCH])?;
    let to_screen = sender.clone();
    thread::Builder::new().name("signals".into()).spawn(move || {
        for signal in signals.forever() {
            if to_screen.send(News::Signal(signal)).is_err() {
                break;
            }
        }
    })?;
    let to_screen = sender.clone();
    thread::Builder::new().name("input".into()).spawn(move || {
        loop {
            let news = event::read().map_or(News::InputEnded, News::Input);
            let ended = matches!(news, News::InputEnded);
            if to_screen.send(news).is_err() || ended {
                break;
            }
        }
    })?;
    Ok((sender, receiver))
}
