//! Binary serialization of numbers and texts.

/// Error: the bytes end too early, or a text is not UTF-8.
#[derive(Debug)]
pub struct Truncated;

/// Appends the length and the bytes of a text of at most 255 bytes. For a longer text the length is wrong.
pub fn put_text(bytes: &mut Vec<u8>, text: &str) {
    bytes.push(text.len() as u8);
    bytes.extend(text.as_bytes());
}

/// Reads values from bytes.
#[derive(Debug)]
pub struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    pub fn chunk<const N: usize>(&mut self) -> Result<[u8; N], Truncated> {
        let (chunk, rest) = self.rest.split_first_chunk().ok_or(Truncated)?;
        self.rest = rest;
        Ok(*chunk)
    }

    pub fn byte(&mut self) -> Result<u8, Truncated> {
        self.chunk().map(|[byte]| byte)
    }

    /// Reads a signed number of 24 bits.
    pub fn number(&mut self) -> Result<i32, Truncated> {
        // The arithmetic shift restores the sign.
        self.chunk().map(|[high, middle, low]| i32::from_be_bytes([high, middle, low, 0]) >> 8)
    }

    pub fn text(&mut self) -> Result<String, Truncated> {
        let length = usize::from(self.byte()?);
        let (text, rest) = self.rest.split_at_checked(length).ok_or(Truncated)?;
        self.rest = rest;
        String::from_utf8(text.to_vec()).map_err(|_| Truncated)
    }

    pub const fn is_at_end(&self) -> bool {
        self.rest.is_empty()
    }
}
