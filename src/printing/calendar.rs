//! Dates and times: UTC in files and in the names of runs, the player's own time zone on screens and in printed tables.

use std::time::{SystemTime, UNIX_EPOCH};

use jiff::{Timestamp, tz::TimeZone};

/// Returns the current time in UTC as `2026-11-20T14:30:05Z`.
pub fn now() -> String {
    format_utc(unix_seconds(SystemTime::now()))
}

/// Returns the current time in UTC as `20261120-143005`, which sorts by time and is a valid file name everywhere.
pub fn timestamp() -> String {
    format_timestamp(unix_seconds(SystemTime::now()))
}

/// Returns the seconds from the start of 1970 to `time`; 0 for earlier times.
pub fn unix_seconds(time: SystemTime) -> u64 {
    time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

/// Formats a Unix time in UTC as `2026-11-20T14:30:05Z`; times after the year 9999 become its end.
pub fn format_utc(seconds: u64) -> String {
    moment(seconds).strftime("%Y-%m-%dT%H:%M:%SZ").to_string()
}

/// Formats a Unix time in UTC in the form of [`timestamp`].
pub fn format_timestamp(seconds: u64) -> String {
    moment(seconds).strftime("%Y%m%d-%H%M%S").to_string()
}

/// Formats a time like `2026-11-20T14:30:05Z` in the time zone of this computer, or of `TZ`, to the minute: `2026-11-20 15:30`. Text that
/// is no such time stays as it is.
pub fn local_time(utc: &str) -> String {
    in_zone(utc, TimeZone::system())
}

fn in_zone(utc: &str, zone: TimeZone) -> String {
    let local = |time: Timestamp| time.to_zoned_datetime(zone).strftime("%Y-%m-%d %H:%M").to_string();
    utc.parse().map_or_else(|_| utc.to_owned(), local)
}

fn moment(seconds: u64) -> Timestamp {
    i64::try_from(seconds).ok().and_then(|seconds| Timestamp::from_second(seconds).ok()).unwrap_or(Timestamp::MAX)
}

#[cfg(test)]
mod tests {
    use jiff::tz::offset;

    use super::*;

    #[test]
    fn times_are_utc_in_files_and_local_on_screens() {
        let leap_day = 11_016 * 86_400 + 3_661;
        let written = format_utc(leap_day);
        assert_eq!(written, "2000-02-29T01:01:01Z");
        assert_eq!(format_timestamp(leap_day), "20000229-010101");
        assert_eq!(in_zone(&written, TimeZone::UTC), "2000-02-29 01:01");
        assert_eq!(in_zone(&written, TimeZone::fixed(offset(-5))), "2000-02-28 20:01");
        assert_eq!(in_zone("yesterday", TimeZone::UTC), "yesterday");
        assert!(format_utc(u64::MAX).starts_with("9999-12-3"));
        assert_eq!(timestamp().len(), 15);
    }
}
