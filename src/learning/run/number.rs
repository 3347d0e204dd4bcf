//! Numbers in JSON files, with names for those that are not finite: JSON has no notation for them, and the metrics of a diverging run
//! must show its divergence.

use serde::{
    Deserialize, Deserializer, Serializer,
    de::{Error as _, Unexpected},
};

/// Writes a number; one that is not finite as its name in protobuf's JSON.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it with a reference")]
pub fn serialize<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match *number {
        number if number.is_finite() => serializer.serialize_f64(number),
        number if number.is_nan() => serializer.serialize_str("NaN"),
        number => serializer.serialize_str(if number > 0.0 { "Infinity" } else { "-Infinity" }),
    }
}

/// Reads a number or its name. `null`, which many programs write instead of NaN, is read as NaN.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    match Number::deserialize(deserializer)? {
        Number::Finite(number) => Ok(number),
        Number::None(()) => Ok(f64::NAN),
        // Rust's parser also accepts other texts, such as ordinary numbers, which the filter rejects.
        Number::Name(name) => (name.parse().ok())
            .filter(|number: &f64| !number.is_finite())
            .ok_or_else(|| D::Error::invalid_value(Unexpected::Str(&name), &EXPECTED)),
    }
}

/// Accepted values, for error messages.
const EXPECTED: &str = "a number, \"NaN\", \"Infinity\" or \"-Infinity\"";

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number, \"NaN\", \"Infinity\" or \"-Infinity\"")]
enum Number {
    Finite(f64),
    Name(String),
    None(()),
}

/// The same for optional numbers, which the file leaves out if they are missing.
pub mod option {
    use serde::Serialize;

    use super::{Deserialize, Deserializer, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Present(#[serde(with = "super")] f64);

    /// Writes the number.
    #[expect(clippy::ref_option, reason = "serde calls it with a reference")]
    pub fn serialize<S: Serializer>(number: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        number.map(Present).serialize(serializer)
    }

    /// Reads a number, its name, or nothing.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
        Ok(Option::<Present>::deserialize(deserializer)?.map(|Present(number)| number))
    }
}

#[cfg(test)]
mod tests {
    use serde::Serialize;

    use super::*;

    #[derive(Serialize, Deserialize)]
    struct Pair {
        #[serde(with = "super")]
        one: f64,
        #[serde(with = "super::option", default, skip_serializing_if = "Option::is_none")]
        other: Option<f64>,
    }

    #[test]
    fn every_number_survives_a_file() {
        for number in [0.1, -3.0, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let text = serde_json::to_string(&Pair { one: number, other: Some(number) }).unwrap();
            let again: Pair = serde_json::from_str(&text).unwrap();
            assert_eq!(again.one.to_bits(), number.to_bits(), "{text}");
            assert_eq!(again.other.unwrap().to_bits(), number.to_bits(), "{text}");
        }
    }

    #[test]
    fn integers_and_null_are_read_and_other_words_refused() {
        let read = |text: &str| serde_json::from_str::<Pair>(text);
        assert_eq!(read("{\"one\": -2}").unwrap().one, -2.0);
        let none = read("{\"one\": null, \"other\": null}").unwrap();
        assert!(none.one.is_nan() && none.other.is_none());
        assert!(read("{\"one\": \"many\"}").is_err_and(|error| error.to_string().contains("many")));
        assert_eq!(serde_json::to_string(&Pair { one: 1.0, other: None }).unwrap(), "{\"one\":1.0}");
    }
}
