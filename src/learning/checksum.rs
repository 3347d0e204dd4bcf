//! A checksum within the file that it guards: any changed byte is noticed, wherever it stands.

/// What a checkpoint's checksum is called: the first field of a JSON note, which stands as a text in the JSON of the header.
pub const OF_CHECKPOINT: &str = "checksum";

/// A policy's.
pub const OF_POLICY: &str = "policy_checksum";

/// Hexadecimal digits of a checksum.
const DIGITS: usize = 16;

/// What stands in the note until the checksum is written.
pub const NO_CHECKSUM: &str = "0000000000000000";

/// Puts the checksum of this name in its place. `false` where there is no place for it.
pub fn write_checksum(name: &str, bytes: &mut [u8]) -> bool {
    let Some(place) = place(name, bytes) else { return false };
    bytes[place..place + DIGITS].copy_from_slice(NO_CHECKSUM.as_bytes());
    let digits = checksum(bytes);
    bytes[place..place + DIGITS].copy_from_slice(digits.as_bytes());
    true
}

/// The checksum of a file's bytes, in [`DIGITS`] digits.
pub fn checksum(bytes: &[u8]) -> String {
    format!("{:016x}", hash([bytes].into_iter()))
}

/// Whether the content fits its checksum of this name; `None` where there is none.
pub fn is_whole(name: &str, bytes: &[u8]) -> Option<bool> {
    let place = place(name, bytes)?;
    let digits = &bytes[place..place + DIGITS];
    let parts = [&bytes[..place], NO_CHECKSUM.as_bytes(), &bytes[place + DIGITS..]];
    Some(digits == format!("{:016x}", hash(parts.into_iter())).as_bytes())
}

fn place(name: &str, bytes: &[u8]) -> Option<usize> {
    let mark = format!("{{\\\"{name}\\\":\\\"").into_bytes();
    let place = bytes.windows(mark.len()).position(|window| window == mark)? + mark.len();
    (place + DIGITS <= bytes.len()).then_some(place)
}

/// FNV-1a with 64 bits. For a given byte every step maps sums one to one, so that a single changed byte always changes
/// the result; several do but for one chance in 2^64. It guards against accidents, not against an adversary.
fn hash<'a>(parts: impl Iterator<Item = &'a [u8]>) -> u64 {
    parts
        .flatten()
        .fold(0xcbf2_9ce4_8422_2325, |sum: u64, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_changed_byte_is_noticed() {
        // The published value of this hash for "foobar".
        assert_eq!(hash([b"foo".as_slice(), b"bar"].into_iter()), 0x8594_4171_f739_67e8);
        let mut bytes = format!("{{\"note\":\"{{\\\"checksum\\\":\\\"{NO_CHECKSUM}\\\"}}\"}}  weights").into_bytes();
        assert!(write_checksum(OF_CHECKPOINT, &mut bytes));
        assert_eq!(is_whole(OF_CHECKPOINT, &bytes), Some(true));
        assert_eq!(is_whole(OF_POLICY, &bytes), None);
        for index in 0..bytes.len() {
            for change in [1, 0x20, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[index] ^= change;
                assert_ne!(is_whole(OF_CHECKPOINT, &damaged), Some(true), "byte {index}");
            }
            assert_ne!(is_whole(OF_CHECKPOINT, &bytes[..index]), Some(true), "cut at {index}");
        }
        assert!(!write_checksum(OF_CHECKPOINT, &mut b"nothing to seal".to_vec()));
    }
}
