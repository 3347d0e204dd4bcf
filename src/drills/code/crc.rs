//! The checksum of a share code.

/// CRC-32 as in Ethernet and zip (IEEE 802.3). Changes within 32 consecutive bits are always noticed, a wrong letter and two
/// that have changed places among them; all others but for one in four thousand million.
pub fn crc32(bytes: &[u8]) -> u32 {
    const POLYNOMIAL: u32 = 0xedb8_8320;
    let mut sum = u32::MAX;
    for byte in bytes {
        sum ^= u32::from(*byte);
        for _ in 0..8 {
            sum = if sum & 1 == 1 { sum >> 1 ^ POLYNOMIAL } else { sum >> 1 };
        }
    }
    !sum
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_published_check_value_is_reproduced() {
        assert_eq!(super::crc32(b"123456789"), 0xcbf4_3926);
    }
}
