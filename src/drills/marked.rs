//! Files that say what they are and of which version: one of a newer version is distinguished from one that is damaged.

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::{printing::VERSION, storage::json_flaw};

/// Newest version that is understood of all files that are marked here, and the one that is written.
pub const NEWEST: u32 = 1;

/// Why a file's text cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum MarkError {
    /// It is no JSON, or not of this form.
    #[error("it is damaged: {}", json_flaw(_0))]
    Syntax(#[from] serde_json::Error),
    /// It is something else.
    #[error("its format is \"{found}\"; accepted is \"{accepted}\"")]
    Format {
        /// What the file says.
        found: String,
        /// What was looked for.
        accepted: &'static str,
    },
    /// Another program wrote it, most likely a newer one.
    #[error("it is of version {0}; versions 1 to {NEWEST} are understood, a newer carom may have written it")]
    Version(u32),
}

#[derive(Serialize)]
struct Marked<'a, T> {
    format: &'static str,
    version: u32,
    /// The version of carom that writes it.
    carom: &'static str,
    #[serde(flatten)]
    content: &'a T,
}

#[derive(Deserialize)]
struct Header {
    format: String,
    version: u32,
}

/// The text of a file.
///
/// # Errors
/// Where a value has no JSON form.
pub fn write<T: Serialize>(format: &'static str, content: &T) -> Result<Vec<u8>, serde_json::Error> {
    let mut bytes = serde_json::to_vec(&Marked { format, version: NEWEST, carom: VERSION, content })?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Whether a file's text is of this format and of a version that is understood, whatever else it holds.
///
/// # Errors
/// [`MarkError`].
pub fn check(format: &'static str, text: &[u8]) -> Result<(), MarkError> {
    let header: Header = serde_json::from_slice(text)?;
    if header.format != format {
        return Err(MarkError::Format { found: header.format, accepted: format });
    }
    if !(1..=NEWEST).contains(&header.version) {
        return Err(MarkError::Version(header.version));
    }
    Ok(())
}

/// What a file's text holds besides its marks.
///
/// # Errors
/// [`MarkError`].
pub fn read<T: DeserializeOwned>(format: &'static str, text: &[u8]) -> Result<T, MarkError> {
    check(format, text)?;
    Ok(serde_json::from_slice(text)?)
}
