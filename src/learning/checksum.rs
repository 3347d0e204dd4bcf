//! A checksum that is stored inside the file that it protects. It detects any changed byte, including those of the checksum.

/// Field name of a checkpoint's checksum: the first field of a JSON note, which is stored as a string in the header's JSON.
pub const CHECKPOINT_FIELD: &str = "checksum";

/// Field name of a policy's checksum.
pub const POLICY_FIELD: &str = "policy_checksum";

/// Hexadecimal digits of a checksum.
const DIGITS: usize = 16;

/// Placeholder in the note until the checksum is written.
pub const CHECKSUM_PLACEHOLDER: &str = "0000000000000000";

/// Writes the checksum into the field `name`. Returns `false` if `bytes` have no such field.
pub fn write_checksum(name: &str, bytes: &mut [u8]) -> bool {
    let Some(offset) = digits_offset(name, bytes) else { return false };
    bytes[offset..offset + DIGITS].copy_from_slice(CHECKSUM_PLACEHOLDER.as_bytes());
    let digits = checksum(bytes);
    bytes[offset..offset + DIGITS].copy_from_slice(digits.as_bytes());
    true
}

/// Returns the checksum of a file's bytes, in [`DIGITS`] hexadecimal digits: FNV-1a with 64 bits. For a given byte each step is one-to-one,
/// so a single changed byte always changes the result. Several changed bytes go undetected with a probability of 2^-64. It protects
/// against accidents, not against an adversary.
pub fn checksum(bytes: &[u8]) -> String {
    let step = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    format!("{:016x}", bytes.iter().fold(0xcbf2_9ce4_8422_2325, step))
}

/// Whether the content matches the checksum in the field `name`; `None` if there is no such field.
pub fn is_intact(name: &str, bytes: &[u8]) -> Option<bool> {
    let mut sealed = bytes.to_vec();
    write_checksum(name, &mut sealed).then(|| sealed == bytes)
}

/// Returns the offset of the checksum's first digit.
fn digits_offset(name: &str, bytes: &[u8]) -> Option<usize> {
    let prefix = format!("{{\\\"{name}\\\":\\\"").into_bytes();
    let offset = bytes.windows(prefix.len()).position(|window| window == prefix)? + prefix.len();
    (offset + DIGITS <= bytes.len()).then_some(offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_changed_byte_is_detected() {
        // The published value of this hash for "foobar".
        assert_eq!(checksum(b"foobar"), "85944171f73967e8");
        let mut bytes =
            format!("{{\"note\":\"{{\\\"checksum\\\":\\\"{CHECKSUM_PLACEHOLDER}\\\"}}\"}}  weights").into_bytes();
        assert!(write_checksum(CHECKPOINT_FIELD, &mut bytes));
        assert_eq!(is_intact(CHECKPOINT_FIELD, &bytes), Some(true));
        assert_eq!(is_intact(POLICY_FIELD, &bytes), None);
        for index in 0..bytes.len() {
            for change in [1, 0x20, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[index] ^= change;
                assert_ne!(is_intact(CHECKPOINT_FIELD, &damaged), Some(true), "byte {index}");
            }
            assert_ne!(is_intact(CHECKPOINT_FIELD, &bytes[..index]), Some(true), "cut at {index}");
        }
        assert!(!write_checksum(CHECKPOINT_FIELD, &mut b"nothing to seal".to_vec()));
    }
}
