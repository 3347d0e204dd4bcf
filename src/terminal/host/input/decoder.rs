//! Decodes input bytes into events, one byte at a time.

use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyModifiers};

use crate::terminal::host::input::{
    csi,
    keys::{alt, character, control, key, with},
    mouse,
    paste::{self, Paste},
};

/// Silence after which an escape character counts as the Esc key.
const ESCAPE_TIMEOUT: Duration = Duration::from_millis(30);
/// Silence after which the rest of a sequence no longer counts as coming.
const SEQUENCE_TIMEOUT: Duration = Duration::from_millis(100);
/// Longest meaningful parameters, bytes.
const MAX_SEQUENCE_BYTES: usize = 64;

const ESCAPE: u8 = 0x1b;

/// State of the decoder: the sequence begun.
#[derive(Debug, Default)]
enum State {
    #[default]
    Ground,
    /// After an escape character.
    Escape,
    /// After `ESC [`, with the parameters so far.
    Csi(Vec<u8>),
    /// After `ESC [ [`: function keys of the Linux console.
    Console,
    /// After `ESC O`.
    Ss3,
    /// After `ESC [ M`: a mouse report of three bytes in the oldest form.
    Mouse(Vec<u8>),
    /// A reply string of the terminal, up to its terminator: its introducer, whether it has any content, and whether its last byte was an
    /// escape character.
    Reply {
        introducer: u8,
        has_content: bool,
        escape: bool,
    },
    /// A multi-byte character, with or without a preceding escape character.
    Character {
        bytes: Vec<u8>,
        is_alt: bool,
    },
    Paste(Paste),
}

/// Decoder of input bytes.
#[derive(Debug, Default)]
pub struct Decoder {
    state: State,
    /// Whether the last paste lost its end marker, so that the next bytes may belong to it.
    cut_paste: bool,
}

impl Decoder {
    /// Decodes the bytes of one read.
    pub fn feed(&mut self, bytes: &[u8], events: &mut Vec<Event>) {
        // The rest of a stalled paste must not be taken for keys.
        if std::mem::take(&mut self.cut_paste) && matches!(self.state, State::Ground) && paste::has_end(bytes) {
            self.state = State::Paste(Paste::default());
        }
        for &byte in bytes {
            self.state = match std::mem::take(&mut self.state) {
                State::Ground => ground(byte, false, events),
                State::Escape => after_escape(byte, events),
                State::Csi(parameters) => in_csi(parameters, byte, events),
                State::Console => {
                    if (b'A'..=b'E').contains(&byte) {
                        events.push(key(KeyCode::F(byte - b'A' + 1)));
                        State::Ground
                    } else {
                        abandon(byte, events)
                    }
                }
                State::Ss3 => match csi::ss3(byte) {
                    Some(event) => {
                        events.push(event);
                        State::Ground
                    }
                    None => abandon(byte, events),
                },
                State::Mouse(bytes) => in_mouse(bytes, byte, events),
                State::Reply { introducer, has_content, escape } => {
                    in_reply(introducer, has_content, escape, byte, events)
                }
                State::Character { bytes, is_alt } => in_character(bytes, is_alt, byte, events),
                State::Paste(mut paste) => match paste.push(byte) {
                    Some(text) => {
                        events.push(Event::Paste(text));
                        State::Ground
                    }
                    None => State::Paste(paste),
                },
            };
        }
    }

    /// Time to wait for more bytes before calling [`Decoder::on_timeout`]; `None` if no sequence has begun.
    pub fn timeout(&self) -> Option<Duration> {
        match &self.state {
            State::Ground => None,
            State::Escape => Some(ESCAPE_TIMEOUT),
            State::Paste(paste) => Some(paste.timeout()),
            _ => Some(SEQUENCE_TIMEOUT),
        }
    }

    /// Ends the sequence begun, because no byte arrived for [`Decoder::timeout`].
    pub fn on_timeout(&mut self, events: &mut Vec<Event>) {
        match std::mem::take(&mut self.state) {
            State::Escape => events.push(key(KeyCode::Esc)),
            State::Csi(parameters) if parameters.is_empty() => events.push(alt(b'[')),
            State::Ss3 => events.push(alt(b'O')),
            State::Reply { introducer, has_content: false, .. } => events.push(alt(introducer)),
            State::Paste(paste) => {
                self.cut_paste = !paste.is_broken_off();
                events.push(paste.cut());
            }
            _ => {}
        }
    }
}

/// Handles a byte that begins a key or a sequence.
fn ground(byte: u8, is_alt: bool, events: &mut Vec<Event>) -> State {
    match byte {
        ESCAPE => return State::Escape,
        0x80.. => return in_character(Vec::new(), is_alt, byte, events),
        _ => {}
    }
    let event = control(byte).unwrap_or_else(|| character(char::from(byte)));
    events.push(if is_alt { with(event, KeyModifiers::ALT) } else { event });
    State::Ground
}

/// Drops the sequence begun and handles a byte that does not belong to it.
fn abandon(byte: u8, events: &mut Vec<Event>) -> State {
    match byte {
        // These bytes only end a sequence.
        0x18 | 0x1a => State::Ground,
        0..0x20 => ground(byte, false, events),
        _ => State::Ground,
    }
}

fn after_escape(byte: u8, events: &mut Vec<Event>) -> State {
    match byte {
        b'[' => State::Csi(Vec::new()),
        b'O' => State::Ss3,
        b']' | b'P' | b'X' | b'^' | b'_' => State::Reply { introducer: byte, has_content: false, escape: false },
        // Two keys, of which the second may begin a sequence. Ctrl-C must work after any byte.
        ESCAPE | 0x03 => {
            events.push(key(KeyCode::Esc));
            ground(byte, false, events)
        }
        _ => ground(byte, true, events),
    }
}

fn in_csi(mut parameters: Vec<u8>, byte: u8, events: &mut Vec<Event>) -> State {
    match byte {
        0x20..=0x3f => {
            // Keep one byte more than is meaningful, so that overlong parameters are recognized.
            if parameters.len() <= MAX_SEQUENCE_BYTES {
                parameters.push(byte);
            }
            State::Csi(parameters)
        }
        b'[' if parameters.is_empty() => State::Console,
        b'M' if parameters.is_empty() => State::Mouse(Vec::new()),
        b'~' if parameters == b"200" => State::Paste(Paste::default()),
        0x40..=0x7e => {
            events.extend(csi::event(&parameters, byte).filter(|_| parameters.len() <= MAX_SEQUENCE_BYTES));
            State::Ground
        }
        _ => abandon(byte, events),
    }
}

fn in_mouse(mut bytes: Vec<u8>, byte: u8, events: &mut Vec<Event>) -> State {
    if byte < 0x20 {
        return abandon(byte, events);
    }
    bytes.push(byte);
    let Ok([button, column, row]) = <[u8; 3]>::try_from(bytes.as_slice()) else { return State::Mouse(bytes) };
    events.extend(mouse::old(button, column, row));
    State::Ground
}

fn in_reply(introducer: u8, has_content: bool, escape: bool, byte: u8, events: &mut Vec<Event>) -> State {
    match byte {
        b'\\' if escape => State::Ground,
        0x07 => State::Ground,
        // First half of the terminator, or start of the next sequence.
        ESCAPE if !escape => State::Reply { introducer, has_content, escape: true },
        _ if escape => after_escape(byte, events),
        0..0x20 => abandon(byte, events),
        _ => State::Reply { introducer, has_content: true, escape: false },
    }
}

fn in_character(mut bytes: Vec<u8>, is_alt: bool, byte: u8, events: &mut Vec<Event>) -> State {
    bytes.push(byte);
    match std::str::from_utf8(&bytes) {
        Ok(text) => {
            let modifiers = if is_alt { KeyModifiers::ALT } else { KeyModifiers::NONE };
            events.extend(text.chars().map(|letter| with(character(letter), modifiers)));
            State::Ground
        }
        Err(error) if error.error_len().is_none() => State::Character { bytes, is_alt },
        // The invalid byte may be a key of its own.
        Err(_) if byte < 0x80 => ground(byte, false, events),
        Err(_) => State::Ground,
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
