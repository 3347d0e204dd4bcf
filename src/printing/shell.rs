//! Quoting for the shell.

/// Returns `word` as one shell argument: quoted if necessary, and with `./` before a leading hyphen, so that it is not read as an option.
pub fn shell_word(word: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "-_./".contains(letter);
    let word = if word.starts_with('-') { format!("./{word}") } else { word.to_owned() };
    if word.chars().all(is_plain) { word } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_words_survive_the_shell() {
        assert_eq!(shell_word("runs/2026-11-27_a.b"), "runs/2026-11-27_a.b");
        assert_eq!(shell_word("it's $HOME `id`"), r"'it'\''s $HOME `id`'");
        assert_eq!(shell_word("-d2"), "./-d2");
    }
}
