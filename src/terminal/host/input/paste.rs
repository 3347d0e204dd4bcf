//! A bracketed paste on its way: text that is no row of keys, whatever it says.

use std::time::Duration;

use crossterm::event::Event;

use crate::terminal::host::input::keys::control;

/// What ends it.
const END: &[u8] = b"\x1b[201~";
/// Silence after which it has lost its end. Links stand still for some tenths of a second; a hand needs longer.
const LOST: Duration = Duration::from_secs(1);
/// Silence after which a Ctrl-C at the end was typed: in text that is pasted more follows, its end at least.
const TYPED: Duration = Duration::from_millis(100);
/// Longest text that is kept, bytes; no field takes as much.
const LONGEST: usize = 1 << 20;

const CTRL_C: u8 = 0x03;

/// The text so far.
#[derive(Debug, Default)]
pub struct Paste {
    text: Vec<u8>,
    /// Bytes of the end that have come.
    ended: usize,
    last: u8,
}

impl Paste {
    /// Takes in a byte; the whole text once its end has come.
    pub fn push(&mut self, byte: u8) -> Option<String> {
        self.last = byte;
        if byte == END[self.ended] {
            self.ended += 1;
            return (self.ended == END.len()).then(|| self.words());
        }
        let begun = std::mem::take(&mut self.ended);
        self.keep(&END[..begun]);
        // The end begins with a byte that it has nowhere else.
        if byte == END[0] {
            self.ended = 1;
        } else {
            self.keep(&[byte]);
        }
        None
    }

    fn keep(&mut self, bytes: &[u8]) {
        let room = LONGEST.saturating_sub(self.text.len());
        self.text.extend_from_slice(&bytes[..bytes.len().min(room)]);
    }

    fn words(&self) -> String {
        String::from_utf8_lossy(&self.text).into_owned()
    }

    /// How long to wait for more.
    pub const fn patience(&self) -> Duration {
        if self.is_broken_off() { TYPED } else { LOST }
    }

    /// Whether a Ctrl-C was the last that came.
    pub const fn is_broken_off(&self) -> bool {
        self.last == CTRL_C
    }

    /// What it is where nothing more comes.
    pub fn cut(self) -> Event {
        control(CTRL_C).filter(|_| self.is_broken_off()).unwrap_or_else(|| Event::Paste(self.words()))
    }
}

/// Whether the end of a paste is among `bytes`.
pub fn has_end(bytes: &[u8]) -> bool {
    bytes.windows(END.len()).any(|window| window == END)
}
