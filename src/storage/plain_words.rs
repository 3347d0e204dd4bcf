//! Explanations of errors in files, without the jargon of the parsing libraries.

use serde_json::error::Category;

/// Phrases of the libraries, and their replacements.
const WORDS: [(&str, &str); 17] = [
    ("expected usize", "expected a whole number from 0 on"),
    ("expected u64", "expected a whole number from 0 on"),
    ("expected u32", "expected a whole number from 0 on"),
    ("expected f64", "expected a number"),
    ("expected f32", "expected a number"),
    ("expected a boolean", "expected true or false"),
    ("unknown variant", "unknown word"),
    ("unclosed array table", "the name of a section has no end"),
    ("unclosed table", "the name of a section has no end"),
    ("unclosed inline table", "the braces have no end"),
    ("unclosed array", "the list has no end"),
    ("key with no value", "a name without a value"),
    ("missing value for key", "a name without a value"),
    ("missing assignment between key-value pairs", "two values without a name between them"),
    ("extra assignment between key-value pairs", "a second `=`"),
    ("unexpected key or value", "more than one value"),
    ("duplicate key", "a name that is already used"),
];

/// The replacement for unknown names in files. It is separate because training runs say "setting" instead.
const NAME: [&str; 2] = ["unknown field", "unknown name"];

/// Rewrites a message of serde in plain words.
pub fn in_plain_words(message: &str) -> String {
    let missing = message.strip_prefix("missing field ");
    let message = missing.map_or_else(|| message.to_owned(), |name| format!("{name} is missing"));
    WORDS.iter().fold(message, |message, (theirs, ours)| message.replace(theirs, ours))
}

/// Removes the error numbers of the operating system from a sentence: its words have the same meaning.
pub fn without_error_numbers(mut sentence: String) -> String {
    while let Some(start) = sentence.find(" (os error ")
        && let Some(length) = sentence[start..].find(')')
    {
        sentence.replace_range(start..=start + length, "");
    }
    sentence
}

/// Describes what is wrong with a TOML text: the line, the key in that line, and the reason.
pub fn describe_toml_error(text: &str, error: &toml::de::Error) -> String {
    let reason = in_plain_words(error.message()).replace(NAME[0], NAME[1]);
    let is_missing = error.message().starts_with("missing field ");
    // A value that is missing in the whole file belongs to no line, and one that is missing in a section is not the fault of another key.
    let Some(start) = error.span().map(|span| span.start).filter(|start| !is_missing || *start > 0) else {
        return reason;
    };
    let line = text.bytes().take(start).filter(|&byte| byte == b'\n').count();
    let key = text.lines().nth(line).and_then(|words| words.split_once('=')).filter(|_| !is_missing);
    let key = key.map_or(String::new(), |(key, _)| format!(", {}", key.trim()));
    format!("line {}{key}: {reason}", line + 1)
}

/// Describes what is wrong with a JSON text: the position and the reason.
pub fn describe_json_error(error: &serde_json::Error) -> String {
    let (line, column) = (error.line(), error.column());
    match error.classify() {
        Category::Eof if (line, column) == (1, 0) => "it is empty".to_owned(),
        Category::Eof => format!("it ends in the middle of line {line}"),
        Category::Syntax | Category::Io => format!("line {line}, column {column} is not JSON"),
        Category::Data => {
            let text = error.to_string();
            let reason = in_plain_words(text.split(" at line ").next().unwrap_or_default()).replace(NAME[0], NAME[1]);
            // Errors inside nested parts have no position.
            if line > 0 { format!("at line {line}, column {column}, {reason}") } else { reason }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Two {
        #[serde(rename = "name")]
        _name: String,
        #[serde(rename = "count")]
        _count: usize,
    }

    #[test]
    fn error_messages_are_free_of_library_jargon() {
        let toml = |text: &str| describe_toml_error(text, &toml::from_str::<Two>(text).unwrap_err());
        assert_eq!(toml(""), "`name` is missing");
        assert_eq!(toml("name = \"a\""), "`count` is missing");
        assert_eq!(
            toml("name = \"a\"\ncount = -1"),
            "line 2, count: invalid value: integer `-1`, expected a whole number from 0 on"
        );
        assert!(toml("nmae = \"a\"\ncount = 1").starts_with("line 1, nmae: unknown name `nmae`"));
        assert_eq!(toml("name = \"a\"\n[two\n"), "line 2: the name of a section has no end, expected `]`");
        let json = |text: &str| describe_json_error(&serde_json::from_str::<Two>(text).unwrap_err());
        assert_eq!(json(""), "it is empty");
        assert_eq!(json("{\"name\":\n"), "it ends in the middle of line 2");
        assert_eq!(json("{\"name\" 3}"), "line 1, column 9 is not JSON");
        assert_eq!(json("{nam: 3}"), "line 1, column 2 is not JSON");
        let said = std::io::Error::from_raw_os_error(2).to_string();
        assert!(said.contains("os error"), "{said}");
        let said = without_error_numbers(format!("a: {said}; b"));
        assert!(said.ends_with("; b") && !said.contains("os error") && said.len() > 6, "{said}");
        assert_eq!(json("{\"name\":\"a\"}"), "at line 1, column 12, `count` is missing");
    }
}
