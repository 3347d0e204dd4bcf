//! Nearly valid inputs: a valid input with damage gets further than mere noise.

use proptest::prelude::*;

/// Replacements for a number, a name or a bracket.
const TOKENS: [&str; 25] = [
    "0",
    "-1",
    "-0.0",
    "1e308",
    "-1e400",
    "1e-320",
    "18446744073709551615",
    "18446744073709551616",
    "NaN",
    "inf",
    "null",
    "true",
    "[]",
    "{}",
    "\"\"",
    "\"\\u001b]0;pwn\\u0007\"",
    "\u{1b}[2J",
    "\u{9b}31m",
    "\u{202e}",
    "[[",
    "}",
    "\"",
    "\\",
    "\n",
    ",",
];

/// A single damage.
#[derive(Clone, Debug)]
enum Damage {
    Byte(usize, u8),
    Cut(usize),
    Remove(usize, usize),
    Repeat(usize, usize),
    Token(usize, &'static str),
    /// Replaces the number at or after this position.
    Number(usize, &'static str),
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = any::<usize>;
    let token = || prop::sample::select(TOKENS.to_vec());
    prop_oneof![
        2 => (at(), any::<u8>()).prop_map(|(at, byte)| Damage::Byte(at, byte)),
        1 => at().prop_map(Damage::Cut),
        1 => (at(), 1_usize..40).prop_map(|(at, length)| Damage::Remove(at, length)),
        1 => (at(), 1_usize..40).prop_map(|(at, length)| Damage::Repeat(at, length)),
        2 => (at(), token()).prop_map(|(at, token)| Damage::Token(at, token)),
        3 => (at(), token()).prop_map(|(at, token)| Damage::Number(at, token)),
    ]
}

/// Generates `valid` with up to four damages, and sometimes noise.
pub fn mutated(valid: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let damaged = prop::collection::vec(damage(), 0..5)
        .prop_map(move |all| all.iter().fold(valid.clone(), |bytes, damage| damage.apply_to(bytes)));
    prop_oneof![9 => damaged, 1 => prop::collection::vec(any::<u8>(), 0..200)]
}

/// Like [`mutated`], as text.
pub fn mutated_text(valid: &str) -> impl Strategy<Value = String> + use<> {
    mutated(valid.as_bytes().to_vec()).prop_map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
}

impl Damage {
    fn apply_to(&self, mut bytes: Vec<u8>) -> Vec<u8> {
        let wrapped = |at: usize, bytes: &[u8]| at % (bytes.len() + 1);
        match *self {
            Self::Byte(at, byte) => {
                let at = wrapped(at, &bytes);
                if let Some(old) = bytes.get_mut(at) {
                    *old = byte;
                }
            }
            Self::Cut(at) => bytes.truncate(wrapped(at, &bytes)),
            Self::Remove(at, length) => {
                let at = wrapped(at, &bytes);
                bytes.drain(at..(at + length).min(bytes.len()));
            }
            Self::Repeat(at, length) => {
                let at = wrapped(at, &bytes);
                let part = bytes[at..(at + length).min(bytes.len())].to_vec();
                bytes.splice(at..at, part);
            }
            Self::Token(at, token) => {
                let at = wrapped(at, &bytes);
                bytes.splice(at..at, token.bytes());
            }
            Self::Number(at, token) => {
                let from = wrapped(at, &bytes);
                let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
                if let Some(start) = bytes[from..].iter().position(u8::is_ascii_digit).map(|found| from + found) {
                    let length = bytes[start..].iter().position(|byte| !is_part(byte)).unwrap_or(bytes.len() - start);
                    bytes.splice(start..start + length, token.bytes());
                }
            }
        }
        bytes
    }
}
