//! Names that people give to what is kept for them, each of which is a file's name, too.

/// Longest name, bytes; file systems take some more.
pub const LONGEST_NAME: usize = 100;

/// Whether something may be called so.
pub fn is_name(name: &str) -> bool {
    (1..=LONGEST_NAME).contains(&name.len()) && !name.starts_with('.') && name.chars().all(is_letter)
}

/// Whether the letter may stand in a name.
pub fn is_letter(letter: char) -> bool {
    letter.is_alphanumeric() || "-_.".contains(letter)
}
