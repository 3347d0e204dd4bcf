//! Names that users give to stored items. Each is also a file name.

/// Longest name, bytes; file systems accept somewhat longer ones.
pub const MAX_NAME_BYTES: usize = 100;

/// The rule of [`is_name`] in words.
pub const NAME_RULE: &str =
    "1 to 100 letters, digits, '-', '_' and '.', with no '.' at the beginning; a letter like é counts as two or more";

/// Whether `name` is accepted as a name.
pub fn is_name(name: &str) -> bool {
    (1..=MAX_NAME_BYTES).contains(&name.len()) && !name.starts_with('.') && name.chars().all(is_letter)
}

/// Whether the character may be part of a name.
pub fn is_letter(letter: char) -> bool {
    letter.is_alphanumeric() || "-_.".contains(letter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_text_matches_the_check() {
        assert!(NAME_RULE.starts_with(&format!("1 to {MAX_NAME_BYTES} letters")));
        let longest = "x".repeat(MAX_NAME_BYTES);
        for name in ["a", "0.-_", "größe", &*longest, &"ö".repeat(MAX_NAME_BYTES / 2)] {
            assert!(is_name(name), "{name}");
        }
        for name in ["", ".hidden", "a b", "a/b", &*(longest.clone() + "x"), &"ö".repeat(MAX_NAME_BYTES / 2 + 1)] {
            assert!(!is_name(name), "{name}");
        }
    }
}
