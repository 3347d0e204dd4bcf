//! A question in a line of JSON, and what is wrong with one that cannot be read.

use serde::{Deserialize, de::DeserializeOwned};
use serde_json::{Map, Value, error::Category};

use crate::{
    game::{Rule, UnknownRule},
    storage::in_plain_words,
    table::Layout,
};

/// What a question may hold.
pub trait Keys {
    /// The names that mean something, with their values.
    const KEYS: &'static [Key];

    /// Which of them it needs, and which it may have, in words.
    const FORM: &'static str;
}

/// A name that means something, and what values it has.
pub struct Key {
    name: &'static str,
    /// What is accepted, in words.
    accepted: &'static str,
    is_accepted: fn(&Value) -> bool,
}

impl Key {
    /// The table.
    pub const PRESET: Self = Self::of::<String>("preset", "a table's name or the path of its file, as a string");
    /// The balls.
    pub const LAYOUT: Self =
        Self::of::<Layout>("layout", "three pairs [x, y] of numbers in metres, the cue ball first");
    /// What counts.
    pub const RULE: Self = Self::of::<RuleName>("rule", "\"straight\", \"one-cushion\" or \"three-cushion\"");

    /// A name whose value is a `T`.
    pub const fn of<T: DeserializeOwned>(name: &'static str, accepted: &'static str) -> Self {
        Self { name, accepted, is_accepted: |value| T::deserialize(value).is_ok() }
    }
}

/// A rule by any of the names that the command line takes.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(try_from = "String")]
pub struct RuleName(pub Rule);

impl TryFrom<String> for RuleName {
    type Error = UnknownRule;

    fn try_from(name: String) -> Result<Self, UnknownRule> {
        name.parse().map(Self)
    }
}

/// Names that a question may hold besides: of files that hold the answers too, and of shots that `carom accuracy --stability` has found.
const ANSWERS: [&str; 13] = [
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

/// Most letters of a value that are repeated where it is refused.
const MOST_REPEATED: usize = 200;

/// The question in a line.
pub fn question<Q: DeserializeOwned + Keys>(line: &[u8]) -> Result<Q, String> {
    let accepted = format!("accepted is an object with {}", Q::FORM);
    if !line.trim_ascii_start().starts_with(b"{") {
        return Err(format!("it begins with no brace; {accepted}"));
    }
    let given: Map<String, Value> = serde_json::from_slice(line).map_err(|error| not_json(&error))?;
    let question = serde_json::from_slice(line).map_err(|error| {
        let refused = |key: &Key| {
            let value = given.get(key.name).filter(|value| !(key.is_accepted)(value))?;
            Some(format!("\"{}\" is {}; accepted is {}", key.name, beginning_of(&value.to_string()), key.accepted))
        };
        Q::KEYS.iter().find_map(refused).unwrap_or_else(|| {
            // No value is wrong: one is missing, or there is more than one.
            let text = error.to_string();
            let text = text.split(" at line ").next().unwrap_or_default();
            let twice = text.strip_prefix("duplicate field `").and_then(|name| name.strip_suffix('`'));
            twice.map_or_else(
                || format!("{}; {accepted}", in_plain_words(text)),
                |name| format!("\"{name}\" is there twice"),
            )
        })
    })?;
    let is_known = |name: &str| Q::KEYS.iter().any(|key| key.name == name) || ANSWERS.contains(&name);
    match given.keys().find(|name| !is_known(name)) {
        Some(name) => {
            let known: Vec<&str> = Q::KEYS.iter().map(|key| key.name).collect();
            Err(format!("\"{name}\" is not known; accepted are {}", known.join(", ")))
        }
        None => Ok(question),
    }
}

/// Why a line is no JSON. The reader counts lines within it: only its column helps.
fn not_json(error: &serde_json::Error) -> String {
    match error.classify() {
        Category::Eof => "it ends before its object does".to_owned(),
        _ if error.to_string().starts_with("number out of range") => {
            format!("the number that ends at column {} is out of range; accepted is up to 1.8e308", error.column())
        }
        _ => format!("column {} is no JSON", error.column()),
    }
}

/// The value, or the beginning of a long one.
fn beginning_of(value: &str) -> String {
    match value.char_indices().nth(MOST_REPEATED) {
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
    fn a_question_that_lacks_something_is_told_what_all_need() {
        #[derive(Debug, serde::Deserialize)]
        struct Line {
            #[serde(rename = "preset")]
            _preset: String,
        }
        impl Keys for Line {
            const KEYS: &'static [Key] = &[Key::PRESET, Key::LAYOUT, Key::RULE];
            const FORM: &'static str = "preset; rule may be left out";
        }
        let said = |line: &str| question::<Line>(line.as_bytes()).unwrap_err();
        let accepted = "accepted is an object with preset; rule may be left out";
        assert_eq!(said("{}"), format!("`preset` is missing; {accepted}"));
        assert_eq!(said("[]"), format!("it begins with no brace; {accepted}"));
        let name = "a table's name or the path of its file, as a string";
        assert_eq!(said(r#"{"preset": 3}"#), format!("\"preset\" is 3; accepted is {name}"));
        assert_eq!(said(r#"{"preset" 3}"#), "column 11 is no JSON");
        let cue = CueDegrees { a: 0.0, b: 0.0, theta_deg: 0.0, phi_deg: 0.0, speed: 2.0 };
        let (table, seconds) = (Table::default(), f64::INFINITY);
        let shot = Shot { layout: Layout::opening(&table), cue };
        let measured = Figures { seconds, ..Figures::default() };
        let finding = Finding::new(&table, &shot, &measured, vec![Violation::Unfinished]);
        assert!(question::<Line>(&serde_json::to_vec(&finding).unwrap()).is_ok(), "{finding:?}");
        assert_eq!(
            said(r#"{"preset": 3e400}"#),
            "the number that ends at column 16 is out of range; accepted is up to 1.8e308"
        );
    }
}
