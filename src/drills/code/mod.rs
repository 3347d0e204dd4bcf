//! Share codes: an exercise as one line of letters and digits that can be pasted into a chat.
//!
//! `carom:` is followed by bytes in [`base32`]: the version, the table, the rule, the flags, the layout, the shot, the
//! name, the title, the tags, and a checksum of all these. In every version, the first byte is the version and the last
//! four are the checksum.

mod base32;
mod bytes;

use crc::{CRC_32_ISO_HDLC, Crc};
use glam::DVec2;

use self::bytes::{Reader, Truncated, put_text};
use super::{Exercise, ExerciseError, bare_tag, exercise::match_table};
use crate::{game::Rule, physics::CueInputs, table::Layout};

/// The beginning of every code.
const PREFIX: &str = "carom:";

/// CRC-32 as in Ethernet and zip (IEEE 802.3). It detects all changes within 32 consecutive bits, such as a wrong
/// letter or two swapped letters, and all but one in four thousand million other changes.
const CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The newest version that can be read, and the one that is written.
const VERSION: u8 = 1;

/// Maximum length of a code with title and tags, characters. The longest name with a layout and a shot stays below it.
/// A text that is too long for its one-byte length is left out.
const MAX_CODE_LENGTH: usize = 300;

/// Flag in the byte after the rule: coordinates in full precision instead of tenths of a millimetre.
const EXACT: u8 = 1;
/// Flag: the code contains a shot.
const SHOT: u8 = 2;

/// Tenths of a millimetre in a metre.
const GRID: f64 = 1e4;

/// Resolution of a shot: a, b in 1e-5 R, theta and phi in 0.001°, V in 0.1 mm/s. Over the length of a `match` table,
/// 0.001° is 0.05 mm.
const SHOT_UNITS: [f64; 5] = [1e5, 1e5, 1e3, 1e3, 1e4];

/// Why a share code cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CodeError {
    /// The text is not a share code.
    #[error("\"{0}\" is not a share code; start with \"{PREFIX}\"")]
    Prefix(String),
    /// A letter that cannot occur in a code.
    #[error("a share code cannot contain '{0}'; it is made of letters and digits without u")]
    Letter(char),
    /// The code was changed in transit.
    #[error(
        "the share code is damaged: a letter is wrong, missing or extra; copy it again, from \"{PREFIX}\" to its end"
    )]
    Damaged,
    /// The code was written by a newer version.
    #[error("the share code has version {0}; versions 1 to {VERSION} can be read, a newer carom has written it")]
    Version(u8),
    /// The exercise in the code cannot be played.
    #[error(transparent)]
    Exercise(#[from] ExerciseError),
}

impl From<Truncated> for CodeError {
    fn from(_: Truncated) -> Self {
        Self::Damaged
    }
}

/// Encodes an exercise as a share code.
///
/// The code contains the table, the rule and the layout exactly; the shot rounded to 1e-5 R, 0.001° and 0.1 mm/s; the
/// name; and the title and the tags if the code stays within 300 characters. It does not contain the point, the grade
/// and the par.
///
/// # Errors
/// Fails if the exercise cannot be played.
pub fn encode(exercise: &Exercise) -> Result<String, ExerciseError> {
    exercise.validate()?;
    let full = code(exercise, &exercise.title, &exercise.tags);
    if full.len() <= MAX_CODE_LENGTH {
        return Ok(full);
    }
    let titled = code(exercise, &exercise.title, &[]);
    Ok(if titled.len() <= MAX_CODE_LENGTH { titled } else { code(exercise, "", &[]) })
}

fn code(exercise: &Exercise, title: &str, tags: &[String]) -> String {
    let coordinates = exercise.layout.balls.map(|ball| ball.to_array());
    let coordinates = coordinates.as_flattened();
    let on_grid = coordinates.iter().all(|&x| tenths(x).is_some_and(|n| f64::from(n) / GRID == x));
    let has = if on_grid { 0 } else { EXACT } | if exercise.shot.is_some() { SHOT } else { 0 };

    let mut bytes = vec![VERSION];
    put_text(&mut bytes, if exercise.table == match_table() { "" } else { &exercise.table });
    // The number of cushions identifies the rule.
    bytes.extend([exercise.rule.cushions() as u8, has]);
    for &x in coordinates {
        match tenths(x) {
            Some(tenths) if on_grid => bytes.extend(tenths.to_be_bytes()),
            _ => bytes.extend(x.to_be_bytes()),
        }
    }
    for number in exercise.shot.iter().flat_map(shot_in_units) {
        // At most 24 bits.
        bytes.extend(&number.to_be_bytes()[1..]);
    }
    put_text(&mut bytes, &exercise.name);
    put_text(&mut bytes, if title == exercise.name { "" } else { title });
    for tag in tags {
        put_text(&mut bytes, tag);
    }
    bytes.extend(CHECKSUM.checksum(&bytes).to_be_bytes());
    format!("{PREFIX}{}", base32::encode(&bytes))
}

/// Whether a text looks like a share code.
pub fn is_code(text: &str) -> bool {
    text.trim_start().get(..PREFIX.len()).is_some_and(|start| start.eq_ignore_ascii_case(PREFIX))
}

/// Decodes a share code, ignoring spaces, line breaks and case. The result is an own exercise of the user that can be played.
///
/// # Errors
/// [`CodeError`]: the text is not a share code, was changed in transit, or has a newer version.
pub fn decode(text: &str) -> Result<Exercise, CodeError> {
    let letters: String = text.chars().filter(|letter| !letter.is_whitespace()).collect();
    let prefix = letters.get(..PREFIX.len()).filter(|start| start.eq_ignore_ascii_case(PREFIX));
    let Some(prefix) = prefix else {
        return Err(CodeError::Prefix(text.trim().chars().take(40).collect()));
    };
    let bytes = base32::decode(&letters[prefix.len()..])?;
    let (content, sum) = bytes.split_last_chunk().ok_or(CodeError::Damaged)?;
    if CHECKSUM.checksum(content) != u32::from_be_bytes(*sum) {
        return Err(CodeError::Damaged);
    }
    let mut reader = Reader::new(content);
    match reader.byte()? {
        VERSION => {}
        0 => return Err(CodeError::Damaged),
        newer => return Err(CodeError::Version(newer)),
    }
    let exercise = content_of(&mut reader)?;
    exercise.validate()?;
    Ok(exercise)
}

fn content_of(reader: &mut Reader) -> Result<Exercise, CodeError> {
    let table = Some(reader.text()?).filter(|table| !table.is_empty()).unwrap_or_else(match_table);
    let cushions = u32::from(reader.byte()?);
    let rule = Rule::ALL.into_iter().find(|rule| rule.cushions() == cushions).ok_or(CodeError::Damaged)?;
    let has = reader.byte()?;
    if has & !(EXACT | SHOT) != 0 {
        return Err(CodeError::Damaged);
    }
    let mut coordinate = || -> Result<f64, Truncated> {
        if has & EXACT == 0 {
            Ok(f64::from(i16::from_be_bytes(reader.chunk()?)) / GRID)
        } else {
            Ok(f64::from_be_bytes(reader.chunk()?))
        }
    };
    let mut balls = [DVec2::ZERO; 3];
    for ball in &mut balls {
        *ball = DVec2::new(coordinate()?, coordinate()?);
    }
    let shot = if has & SHOT == 0 {
        None
    } else {
        let mut numbers = [0.0; 5];
        for (number, unit) in numbers.iter_mut().zip(SHOT_UNITS) {
            *number = f64::from(reader.number()?) / unit;
        }
        let [a, b, theta, phi, speed] = numbers;
        Some(CueInputs { a, b, theta: theta.to_radians(), phi: phi.to_radians(), speed })
    };
    let name = reader.text()?;
    let title = Some(reader.text()?).filter(|title| !title.is_empty()).unwrap_or_else(|| name.clone());
    let mut tags = Vec::new();
    while !reader.is_at_end() {
        // A tag is one word, with or without a leading #.
        let text = reader.text()?;
        tags.extend(text.split_whitespace().map(bare_tag).filter(|tag| !tag.is_empty()).map(str::to_owned));
    }
    Ok(Exercise { title, tags, shot, ..Exercise::new_own(&name, rule, &table, Layout::new(balls)) })
}

/// Returns a coordinate in tenths of a millimetre; `None` if it is out of range.
fn tenths(x: f64) -> Option<i16> {
    let tenths = (x * GRID).round();
    (tenths.abs() <= f64::from(i16::MAX)).then_some(tenths as i16)
}

/// Converts a shot to [`SHOT_UNITS`]. The tip and the elevation are rounded towards zero, so that no limit is exceeded.
fn shot_in_units(shot: &CueInputs) -> [i32; 5] {
    // The tolerance keeps values that are integers up to rounding.
    let inward = |x: f64| ((x.abs() + 1e-6).floor() * x.signum()) as i32;
    let turn = (shot.phi.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
    let [a, b, theta, phi, speed] = SHOT_UNITS;
    [
        inward(shot.a * a),
        inward(shot.b * b),
        inward(shot.theta.to_degrees() * theta),
        (turn * phi).round() as i32,
        (shot.speed * speed).round().max(1.0) as i32,
    ]
}

#[cfg(test)]
mod tests;
