//! JSON that is safe to show on a terminal: control characters are escaped by JSON's own rules.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Serializer, ser::Formatter};

use super::visible::{is_hidden, split_at_hidden};

/// Writes `value` as one line of JSON, or nothing if it fails.
///
/// # Errors
/// Returns the error of the output, or of a value that JSON cannot represent.
pub fn json_line(out: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    writeln!(out, "{}", json_text(value)?)
}

/// Returns `value` as JSON text, for outputs that accept a whole line at once.
///
/// # Errors
/// Fails for a value that JSON cannot represent.
pub fn json_text(value: &impl Serialize) -> io::Result<String> {
    let mut bytes = Vec::new();
    value.serialize(&mut Serializer::with_formatter(&mut bytes, Escaping))?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// Compact JSON. `serde_json` escapes only the control characters below the space; this formatter escapes the others, too.
struct Escaping;

impl Formatter for Escaping {
    fn write_string_fragment<W: ?Sized + Write>(&mut self, out: &mut W, fragment: &str) -> io::Result<()> {
        for (plain, hidden) in split_at_hidden(fragment, is_hidden) {
            out.write_all(plain.as_bytes())?;
            if let Some(hidden) = hidden {
                for unit in hidden.encode_utf16(&mut [0; 2]) {
                    write!(out, "\\u{unit:04x}")?;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn c1_and_bidirectional_marks_are_escaped() {
        let text = json_text(&"a\u{1b}\u{9b}\u{202e}\u{7f}\u{e0041}é\n").unwrap();
        assert_eq!(text, r#""a\u001b\u009b\u202e\u007f\udb40\udc41é\n""#);
    }

    #[test]
    fn unserializable_values_write_nothing() {
        let mut out = Vec::new();
        let no_key = std::collections::BTreeMap::from([((1, 2), 3)]);
        assert!(json_line(&mut out, &("before", no_key)).is_err());
        assert!(out.is_empty(), "{out:?}");
    }

    proptest! {
        #[test]
        fn strings_survive_a_round_trip(text in any::<String>()) {
            let written = json_text(&text).unwrap();
            prop_assert!(!written.chars().any(is_hidden));
            prop_assert_eq!(serde_json::from_str::<String>(&written).unwrap(), text);
        }
    }
}
