//! Transliteration to ASCII, for terminals whose locale has no UTF-8.

use std::{borrow::Cow, sync::OnceLock};

/// The replacements. Other non-ASCII characters come from names that users chose; they stay unchanged.
const REPLACEMENTS: [(&str, &str); 17] = [
    ("\u{2013}", "-"),
    ("mass\u{e9}", "masse"),
    ("\u{b1}", "+-"),
    ("\u{d7}", "x"),
    ("\u{b2}", "^2"),
    ("\u{2026}", "..."),
    ("\u{b5}", "u"),
    ("\u{221a}", "sqrt "),
    ("\u{3b5}", "eps"),
    // Bars of a history chart, from low to high.
    ("\u{2581}", "."),
    ("\u{2582}", ":"),
    ("\u{2583}", "-"),
    ("\u{2584}", "="),
    ("\u{2585}", "+"),
    ("\u{2586}", "*"),
    ("\u{2587}", "%"),
    ("\u{2588}", "#"),
];

/// Replaces the non-ASCII characters that the program itself writes by ASCII.
pub fn to_ascii(text: &str) -> Cow<'_, str> {
    if text.is_ascii() {
        return Cow::Borrowed(text);
    }
    Cow::Owned(
        REPLACEMENTS.iter().fold(spell_out_degrees(text), |text, (character, word)| text.replace(character, word)),
    )
}

/// Replaces degree signs by words: "degree" after the number 1, otherwise "degrees".
fn spell_out_degrees(text: &str) -> String {
    let mut parts = text.split('\u{b0}').peekable();
    let mut spelled = String::new();
    while let Some(part) = parts.next() {
        spelled += part;
        if parts.peek().is_some() {
            let is_one = part
                .strip_suffix('1')
                .is_some_and(|rest| !rest.ends_with(|last: char| last.is_ascii_digit() || last == '.'));
            spelled += if is_one { " degree" } else { " degrees" };
        }
    }
    spelled
}

/// Whether text may contain non-ASCII characters, according to the environment variables.
pub fn is_unicode(variable: impl Fn(&str) -> Option<String>) -> bool {
    let locale = locale(&variable);
    locale.contains("utf-8") || locale.contains("utf8") || is_windows_terminal(&variable)
}

/// Whether this is Windows Terminal, which identifies itself but sets no locale.
pub fn is_windows_terminal(variable: impl Fn(&str) -> Option<String>) -> bool {
    locale(&variable).is_empty() && variable("WT_SESSION").is_some_and(|value| !value.is_empty())
}

/// Returns the first of `LC_ALL`, `LC_CTYPE` and `LANG` that is set, in lower case; empty if none is.
fn locale(variable: impl Fn(&str) -> Option<String>) -> String {
    let set = |name: &str| variable(name).filter(|value| !value.is_empty());
    ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(set).unwrap_or_default().to_lowercase()
}

/// Whether the environment of this process requires transliteration.
pub(super) fn needs_ascii() -> bool {
    static NEEDS_ASCII: OnceLock<bool> = OnceLock::new();
    *NEEDS_ASCII.get_or_init(|| !is_unicode(|name| std::env::var(name).ok()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_symbols_are_transliterated_and_names_stay() {
        assert_eq!(to_ascii("red \u{2013} 3\u{b0}, 1.0 \u{b1} 0.2, a\u{b2}"), "red - 3 degrees, 1.0 +- 0.2, a^2");
        assert_eq!(
            to_ascii("1\u{b0}, 11\u{b0}, 0.1\u{b0}, 1.0\u{b0}"),
            "1 degree, 11 degrees, 0.1 degrees, 1.0 degrees"
        );
        assert_eq!(to_ascii("cue raised 1\u{b0}."), "cue raised 1 degree.");
        assert_eq!(to_ascii("a mass\u{e9} by Andr\u{e9}"), "a masse by Andr\u{e9}");
        assert!(matches!(to_ascii("plain"), Cow::Borrowed("plain")));
    }

    #[test]
    fn the_first_variable_set_determines_the_locale() {
        let unicode = |set: &[(&str, &str)]| {
            is_unicode(|name| set.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned()))
        };
        assert!(
            unicode(&[("LANG", "de_DE.UTF-8")]) && unicode(&[("LC_ALL", ""), ("LC_CTYPE", "C.utf8"), ("LANG", "C")])
        );
        assert!(!unicode(&[("LC_ALL", "C"), ("LANG", "de_DE.UTF-8")]) && !unicode(&[]));
        assert!(unicode(&[("WT_SESSION", "1")]) && !unicode(&[("WT_SESSION", "1"), ("LANG", "C")]));
    }
}
