//! The JSON file format of exercises, for the bundled library, export and import.

use std::io::{self, Write};

use serde::{Deserialize, Serialize};
use serde_json::ser::Formatter;

use super::{
    Exercise,
    header::{self, HeaderError, NEWEST_VERSION},
};
use crate::{printing::VERSION, storage::describe_json_error};

/// The content of a file of exercises.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LibraryFile {
    /// The format's name: [`LibraryFile::FORMAT`].
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// The version of carom that wrote the file. Missing in files from before the "match" table was fitted to filmed
    /// balls, and in bundled files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub carom: Option<String>,
    /// The exercises; may be missing in a file with other content.
    #[serde(default)]
    pub exercises: Vec<Exercise>,
}

/// Why a file of exercises cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum LibraryFileError {
    /// The file is not JSON, or has the wrong structure.
    #[error("this is not a file of exercises: {}; {ACCEPTED}", describe_json_error(_0))]
    Syntax(#[from] serde_json::Error),
    /// The file is JSON without the fields that identify its format.
    #[error("this is not a file of exercises: it does not begin with a \"format\" and a \"version\"; {ACCEPTED}")]
    NoHeader,
    /// The format is another one, or its version is not supported.
    #[error(transparent)]
    Header(HeaderError),
}

/// The accepted input.
const ACCEPTED: &str = "accepted is a JSON file as carom drill export writes it";

impl LibraryFile {
    /// The value of `format`.
    pub const FORMAT: &str = "carom-library";

    /// Creates a file of this version.
    pub fn new(exercises: Vec<Exercise>) -> Self {
        let carom = Some(VERSION.to_owned());
        Self { format: Self::FORMAT.to_owned(), version: NEWEST_VERSION, carom, exercises }
    }

    /// Parses a file's text. Unknown fields are skipped; the exercises are not validated: see [`Exercise::validate`].
    ///
    /// # Errors
    /// Fails if the text is in another format or in an unsupported version, whatever else it contains.
    pub fn parse(text: &str) -> Result<Self, LibraryFileError> {
        header::check(Self::FORMAT, text.as_bytes()).map_err(|error| match error {
            HeaderError::Syntax(error) if error.is_data() => LibraryFileError::NoHeader,
            HeaderError::Syntax(error) => error.into(),
            error => LibraryFileError::Header(error),
        })?;
        Ok(serde_json::from_str(text)?)
    }

    /// Returns the file's text, with a line for each field of an exercise.
    ///
    /// # Errors
    /// Fails if a value has no JSON form; none of this type's values does.
    pub fn to_text(&self) -> Result<String, serde_json::Error> {
        let mut bytes = Vec::new();
        self.serialize(&mut serde_json::Serializer::with_formatter(&mut bytes, Lines::default()))?;
        bytes.push(b'\n');
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

/// Maximum depth at which each value of an object or array has its own line: the file, its exercises and their fields.
const MAX_LINE_DEPTH: usize = 3;

/// Formats JSON in readable lines; values deeper than an exercise's fields are on one line.
#[derive(Default)]
struct Lines {
    depth: usize,
}

impl Lines {
    fn separate<W: ?Sized + Write>(&self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        if self.depth <= MAX_LINE_DEPTH {
            write!(writer, "\n{:1$}", "", 2 * self.depth)
        } else if first {
            Ok(())
        } else {
            writer.write_all(b" ")
        }
    }

    fn begin<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        writer.write_all(bracket)
    }

    fn end<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth -= 1;
        if self.depth < MAX_LINE_DEPTH {
            write!(writer, "\n{:1$}", "", 2 * self.depth)?;
        }
        writer.write_all(bracket)
    }
}

impl Formatter for Lines {
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.begin(writer, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.end(writer, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.separate(writer, first)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.begin(writer, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.end(writer, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.separate(writer, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }

    /// Writes twelve decimals, so that degrees are written as they were read, despite the conversion to radians.
    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        // Adding zero removes the sign of a negative zero.
        let rounded = (value * 1e12).round() / 1e12 + 0.0;
        write!(writer, "{}", if rounded.is_finite() { rounded } else { value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"{
  "format": "carom-library",
  "version": 1,
  "exercises": [
    {
      "name": "half-ball",
      "title": "Half a ball",
      "category": "first-caroms",
      "grade": 1,
      "rule": "straight",
      "table": "match",
      "layout": [[-0.71, 0.1], [0, 0], [0.4, -0.123]],
      "point": "Aim at the edge.",
      "tags": ["soft", "plain"],
      "shot": {"a": 0, "b": 0.25, "theta_deg": 3.3, "phi_deg": -12.34, "speed": 2.15},
      "par": {"beginner": 0.5, "club": 0.75, "world-class": 0.9}
    }
  ]
}
"#;

    #[test]
    fn library_file_round_trips() {
        let file = LibraryFile::parse(TEXT).unwrap();
        assert_eq!(file.to_text().unwrap(), TEXT);
        let none = LibraryFile::new(Vec::new());
        assert_eq!(LibraryFile::parse(&none.to_text().unwrap()).unwrap(), none);
    }

    #[test]
    fn unknown_formats_and_versions_are_refused_by_name() {
        let said = |text: &str| LibraryFile::parse(text).unwrap_err().to_string();
        let newer = said(r#"{"format": "carom-library", "version": 7, "exercises": {"other": "form"}}"#);
        assert!(newer.contains("version 7") && newer.contains("1 to 1"), "{newer}");
        assert!(said(r#"{"format": "pool", "version": 1}"#).contains("\"pool\""));
        assert!(said("half a fi").contains(
            "this is not a file of exercises: line 1, column 1 is not JSON; accepted is a JSON file as carom drill"
        ));
        for text in ["[1,2]", "3", r#"{"version": 1}"#, r#"{"format": 3, "version": 1}"#] {
            assert!(said(text).contains("does not begin with a \"format\""), "{}", said(text));
            assert!(said(text).contains("carom drill export"), "{}", said(text));
        }
        assert!(said(&TEXT.replace("first-caroms", "bowling")).contains("bowling"));
    }
}
