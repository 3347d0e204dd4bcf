//! A bracketed paste while it arrives: its bytes are text and never keys.

use std::time::Duration;

use crossterm::event::Event;

use crate::terminal::host::input::keys::control;

/// Marker of the end of a paste.
const END: &[u8] = b"\x1b[201~";
/// Silence after which the end marker counts as lost. Links stall for some tenths of a second; typing takes longer.
const END_TIMEOUT: Duration = Duration::from_secs(1);
/// Silence after which a Ctrl-C at the end counts as typed: in pasted text more would follow, at least the end marker.
const CTRL_C_TIMEOUT: Duration = Duration::from_millis(100);
/// Longest text kept, bytes; every field accepts less.
const MAX_PASTE_BYTES: usize = 1 << 20;

const CTRL_C: u8 = 0x03;

/// The text received so far.
#[derive(Debug, Default)]
pub struct Paste {
    text: Vec<u8>,
    /// Number of bytes of the end marker received.
    ended: usize,
    last: u8,
}

impl Paste {
    /// Adds a byte; returns the whole text after the end marker.
    pub fn push(&mut self, byte: u8) -> Option<String> {
        self.last = byte;
        if byte == END[self.ended] {
            self.ended += 1;
            return (self.ended == END.len()).then(|| self.words());
        }
        let begun = std::mem::take(&mut self.ended);
        self.keep(&END[..begun]);
        // The marker's first byte occurs in it only once.
        if byte == END[0] {
            self.ended = 1;
        } else {
            self.keep(&[byte]);
        }
        None
    }

    fn keep(&mut self, bytes: &[u8]) {
        let room = MAX_PASTE_BYTES.saturating_sub(self.text.len());
        self.text.extend_from_slice(&bytes[..bytes.len().min(room)]);
    }

    fn words(&self) -> String {
        String::from_utf8_lossy(&self.text).into_owned()
    }

    /// Time to wait for more bytes.
    pub const fn timeout(&self) -> Duration {
        if self.is_broken_off() { CTRL_C_TIMEOUT } else { END_TIMEOUT }
    }

    /// Whether the last byte was a Ctrl-C.
    pub const fn is_broken_off(&self) -> bool {
        self.last == CTRL_C
    }

    /// The event if no more bytes arrive.
    pub fn cut(self) -> Event {
        control(CTRL_C).filter(|_| self.is_broken_off()).unwrap_or_else(|| Event::Paste(self.words()))
    }
}

/// Whether `bytes` contain the end marker of a paste.
pub fn has_end(bytes: &[u8]) -> bool {
    bytes.windows(END.len()).any(|window| window == END)
}
