//! Dates and times, for records in files and the names of runs.

use std::time::{SystemTime, UNIX_EPOCH};

/// Returns the current time in UTC as `2026-11-20T14:30:05Z`.
pub fn now() -> String {
    format_utc(SystemTime::now())
}

/// Returns a time in UTC as `2026-11-20T14:30:05Z`; times before 1970 become the start of 1970.
pub fn format_utc(time: SystemTime) -> String {
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (year, month, day) = date(seconds / 86_400);
    let (hour, minute, second) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// Returns the current time in UTC as `20261120-143005`, which sorts by time and is a valid file name everywhere.
pub fn timestamp() -> String {
    format_timestamp(SystemTime::now())
}

/// Returns a time in the form of [`timestamp`]; times before 1970 become the start of 1970.
pub fn format_timestamp(time: SystemTime) -> String {
    format_utc(time).replace(['-', ':', 'Z'], "").replace('T', "-")
}

/// Returns year, month and day of the Gregorian calendar, `days` after 1970-01-01 (Hinnant, "chrono-compatible low-level date algorithms").
const fn date(days: u64) -> (u64, u64, u64) {
    // Years start in March here, so that the leap day is the last day. Eras have 400 years and start in the year 0.
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    (era * 400 + year_of_era + if month <= 2 { 1 } else { 0 }, month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_right_around_leap_days() {
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(date(11_016), (2000, 2, 29));
        assert_eq!(date(11_017), (2000, 3, 1));
        assert_eq!(date(20_777), (2026, 11, 20));
        assert_eq!(date(47_541), (2100, 3, 1));
        assert_eq!(
            format_utc(UNIX_EPOCH + std::time::Duration::from_secs(11_016 * 86_400 + 3_661)),
            "2000-02-29T01:01:01Z"
        );
        assert_eq!(timestamp().len(), 15);
    }
}
