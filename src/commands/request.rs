//! Requests in lines of JSON, and explanations of requests that cannot be read.

use serde::{Deserialize, de::DeserializeOwned};
use serde_json::{Map, Value, error::Category};

use crate::{
    game::{Rule, UnknownRule},
    storage::in_plain_words,
    table::Layout,
};

/// The keys of a request.
pub trait Keys {
    /// The keys that have a meaning, with their values.
    const KEYS: &'static [Key];

    /// The required and the optional keys, in words.
    const FORM: &'static str;
}

/// A key that has a meaning, and its accepted values.
pub struct Key {
    name: &'static str,
    /// The accepted values, in words.
    accepted: &'static str,
    is_accepted: fn(&Value) -> bool,
}

impl Key {
    /// The table.
    pub const PRESET: Self = Self::of::<String>("preset", "a table's name or the path of its file, as a string");
    /// The positions of the balls.
    pub const LAYOUT: Self =
        Self::of::<Layout>("layout", "three pairs [x, y] of numbers in metres, the cue ball first");
    /// The rule of the game.
    pub const RULE: Self = Self::of::<RuleName>("rule", "\"straight\", \"one-cushion\" or \"three-cushion\"");

    /// A key whose value is a `T`.
    pub const fn of<T: DeserializeOwned>(name: &'static str, accepted: &'static str) -> Self {
        Self { name, accepted, is_accepted: |value| T::deserialize(value).is_ok() }
    }
}

/// A rule, by any of the names that the command line accepts.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(try_from = "String")]
pub struct RuleName(pub Rule);

impl TryFrom<String> for RuleName {
    type Error = UnknownRule;

    fn try_from(name: String) -> Result<Self, UnknownRule> {
        name.parse().map(Self)
    }
}

/// Other keys that a request may contain and that are ignored: those of files with answers, and of shots found by `carom accuracy
/// --stability`.
const IGNORED_KEYS: [&str; 13] = [
    "id",
    "cue",
    "rule",
    "duration",
    "condition",
    "events",
    "contacts",
    "final",
    "table",
    "what",
    "violations",
    "steps",
    "ms",
];

/// Maximum number of characters of a refused value that are repeated in the message.
const MAX_REPEATED: usize = 200;

/// Parses the request in a line.
pub fn parse_request<Q: DeserializeOwned + Keys>(line: &[u8]) -> Result<Q, String> {
    let accepted = format!("accepted is an object with {}", Q::FORM);
    if !line.trim_ascii_start().starts_with(b"{") {
        return Err(format!("it does not begin with a brace; {accepted}"));
    }
    let given: Map<String, Value> = serde_json::from_slice(line).map_err(|error| not_json(&error))?;
    let request = serde_json::from_slice(line).map_err(|error| {
        let refused = |key: &Key| {
            let value = given.get(key.name).filter(|value| !(key.is_accepted)(value))?;
            Some(format!("\"{}\" is {}; accepted is {}", key.name, beginning_of(&value.to_string()), key.accepted))
        };
        Q::KEYS.iter().find_map(refused).unwrap_or_else(|| {
            // No single value is wrong: a key is missing or occurs twice.
            let text = error.to_string();
            let text = text.split(" at line ").next().unwrap_or_default();
            let twice = text.strip_prefix("duplicate field `").and_then(|name| name.strip_suffix('`'));
            twice.map_or_else(
                || format!("{}; {accepted}", in_plain_words(text)),
                |name| format!("\"{name}\" occurs twice"),
            )
        })
    })?;
    let is_known = |name: &str| Q::KEYS.iter().any(|key| key.name == name) || IGNORED_KEYS.contains(&name);
    match given.keys().find(|name| !is_known(name)) {
        Some(name) => {
            let known: Vec<&str> = Q::KEYS.iter().map(|key| key.name).collect();
            Err(format!("\"{name}\" is not known; accepted are {}", known.join(", ")))
        }
        None => Ok(request),
    }
}

/// Explains why a line is not JSON. `serde_json` counts lines within this text, so only its column is useful.
fn not_json(error: &serde_json::Error) -> String {
    match error.classify() {
        Category::Eof => "it ends before its object does".to_owned(),
        _ if error.to_string().starts_with("number out of range") => {
            format!("the number that ends at column {} is out of range; accepted is up to 1.8e308", error.column())
        }
        _ => format!("column {} is not JSON", error.column()),
    }
}

/// Returns the value, shortened if it is long.
fn beginning_of(value: &str) -> String {
    match value.char_indices().nth(MAX_REPEATED) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::CueDegrees,
        study::stability::{Figures, Finding, Shot, Violation},
        table::Table,
    };

    #[test]
    fn incomplete_requests_are_refused_with_the_required_keys() {
        #[derive(Debug, serde::Deserialize)]
        struct Line {
            #[serde(rename = "preset")]
            _preset: String,
        }
        impl Keys for Line {
            const KEYS: &'static [Key] = &[Key::PRESET, Key::LAYOUT, Key::RULE];
            const FORM: &'static str = "preset; rule may be left out";
        }
        let said = |line: &str| parse_request::<Line>(line.as_bytes()).unwrap_err();
        let accepted = "accepted is an object with preset; rule may be left out";
        assert_eq!(said("{}"), format!("`preset` is missing; {accepted}"));
        assert_eq!(said("[]"), format!("it does not begin with a brace; {accepted}"));
        let name = "a table's name or the path of its file, as a string";
        assert_eq!(said(r#"{"preset": 3}"#), format!("\"preset\" is 3; accepted is {name}"));
        assert_eq!(said(r#"{"preset" 3}"#), "column 11 is not JSON");
        let cue = CueDegrees { a: 0.0, b: 0.0, theta_deg: 0.0, phi_deg: 0.0, speed: 2.0 };
        let (table, seconds) = (Table::default(), f64::INFINITY);
        let shot = Shot { layout: Layout::opening(&table), cue };
        let measured = Figures { seconds, ..Figures::default() };
        let finding = Finding::new(&table, &shot, &measured, vec![Violation::Unfinished]);
        assert!(parse_request::<Line>(&serde_json::to_vec(&finding).unwrap()).is_ok(), "{finding:?}");
        assert_eq!(
            said(r#"{"preset": 3e400}"#),
            "the number that ends at column 16 is out of range; accepted is up to 1.8e308"
        );
    }
}
