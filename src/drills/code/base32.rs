//! Crockford's base 32: bytes as letters and digits that survive chats and handwriting.
//!
//! Its letters are easy to tell apart, case does not matter, and no character has a special meaning in chat programs.

use super::CodeError;

const LETTERS: &[u8; 32] = b"0123456789abcdefghjkmnpqrstvwxyz";

/// Encodes five bits per letter, highest first; the last letter is padded with zero bits.
pub fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len() * 8 / 5 + 1);
    let (mut waiting, mut bits) = (0_u32, 0);
    for byte in bytes {
        waiting = waiting << 8 | u32::from(*byte);
        bits += 8;
        while bits >= 5 {
            bits -= 5;
            text.push(letter(waiting >> bits));
        }
    }
    if bits > 0 {
        text.push(letter(waiting << (5 - bits)));
    }
    text
}

fn letter(value: u32) -> char {
    char::from(LETTERS[(value & 31) as usize])
}

/// Decodes the output of [`encode`]; reads `o` as 0, and `i` and `l` as 1.
///
/// # Errors
/// Fails if a letter is not in the alphabet, or if [`encode`] cannot produce this length or last letter.
pub fn decode(text: &str) -> Result<Vec<u8>, CodeError> {
    let mut bytes = Vec::with_capacity(text.len() * 5 / 8);
    let (mut waiting, mut bits) = (0_u32, 0);
    for letter in text.chars() {
        let read = match letter.to_ascii_lowercase() {
            'o' => '0',
            'i' | 'l' => '1',
            other => other,
        };
        let value = LETTERS.iter().position(|known| char::from(*known) == read).ok_or(CodeError::Letter(letter))?;
        waiting = waiting << 5 | value as u32;
        bits += 5;
        if bits >= 8 {
            bits -= 8;
            bytes.push((waiting >> bits) as u8);
            waiting &= (1 << bits) - 1;
        }
    }
    if bits < 5 && waiting == 0 { Ok(bytes) } else { Err(CodeError::Damaged) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_of_any_length_and_value_round_trip() {
        let bytes: Vec<u8> = (0..=255).collect();
        for length in 0..=256 {
            assert_eq!(decode(&encode(&bytes[..length])).unwrap(), bytes[..length]);
        }
        assert_eq!(encode(b"foobar"), "csqpyrk1e8");
        assert_eq!(decode("CSQPYRKIE8").unwrap(), b"foobar");
    }

    #[test]
    fn impossible_letter_sequences_are_refused() {
        assert!(matches!(decode("csqpyrk1eu"), Err(CodeError::Letter('u'))));
        for damaged in ["csqpyrk1e80", "csqpyrk1e9", "0"] {
            assert!(matches!(decode(damaged), Err(CodeError::Damaged)), "{damaged}");
        }
    }
}
