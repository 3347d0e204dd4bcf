//! Files with a format and a version in their header, so that files of newer versions are distinguished from damaged ones.

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::{printing::VERSION, storage::describe_json_error};

/// Newest version of all these formats that can be read, and the one that is written.
pub const NEWEST_VERSION: u32 = 1;

/// Why a file's text cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum HeaderError {
    /// The text is not JSON, or has the wrong structure.
    #[error("it is damaged: {}", describe_json_error(_0))]
    Syntax(#[from] serde_json::Error),
    /// The format is another one.
    #[error("its format is \"{found}\"; accepted is \"{accepted}\"")]
    Format {
        /// The format in the file.
        found: String,
        /// The expected format.
        accepted: &'static str,
    },
    /// The version is not supported.
    #[error(
        "it has version {found}; versions 1 to {NEWEST_VERSION} can be read{newer}",
        found = .0,
        newer = cause(*_0)
    )]
    Version(u32),
}

/// Returns the likely cause of an unsupported version, as the end of a sentence.
const fn cause(version: u32) -> &'static str {
    if version > NEWEST_VERSION { ", a newer carom may have written it" } else { "" }
}

#[derive(Serialize)]
struct WithHeader<'a, T> {
    format: &'static str,
    version: u32,
    /// The version of carom that writes the file.
    carom: &'static str,
    #[serde(flatten)]
    content: &'a T,
}

#[derive(Deserialize)]
struct Header {
    format: String,
    version: u32,
}

/// Serializes `content` with the header.
///
/// # Errors
/// Fails if a value has no JSON form.
pub fn write<T: Serialize>(format: &'static str, content: &T) -> Result<Vec<u8>, serde_json::Error> {
    let mut bytes = serde_json::to_vec(&WithHeader { format, version: NEWEST_VERSION, carom: VERSION, content })?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Checks that a text has this format and a supported version, whatever else it contains.
///
/// # Errors
/// [`HeaderError`].
pub fn check(format: &'static str, text: &[u8]) -> Result<(), HeaderError> {
    let header: Header = serde_json::from_slice(text)?;
    if header.format != format {
        return Err(HeaderError::Format { found: header.format, accepted: format });
    }
    if !(1..=NEWEST_VERSION).contains(&header.version) {
        return Err(HeaderError::Version(header.version));
    }
    Ok(())
}

/// Parses the content of a text without its header.
///
/// # Errors
/// [`HeaderError`].
pub fn read<T: DeserializeOwned>(format: &'static str, text: &[u8]) -> Result<T, HeaderError> {
    check(format, text)?;
    Ok(serde_json::from_slice(text)?)
}
