//! Fullness, tips and clock positions in words.

use crate::coach::aim::{FULL, THICK, THIN};

/// Fullness in players' words, by sixteenths of a ball.
pub const SIXTEENTHS: [&str; 17] = [
    "a graze",
    "very thin",
    "an eighth full",
    "a little thinner than a quarter",
    "a quarter full",
    "a little thicker than a quarter",
    "three eighths full",
    "a little thinner than half",
    "half full",
    "a little thicker than half",
    "five eighths full",
    "a little thinner than three quarters",
    "three quarters full",
    "a little thicker than three quarters",
    "seven eighths full",
    "almost full",
    "full",
];

/// Whole numbers up to ten.
pub const NUMBERS: [&str; 11] = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];

/// Returns the fullness in words, to a sixteenth, and whether it is full, which has no side.
pub fn fullness_words(fullness: f64) -> (&'static str, bool) {
    let sixteenths = (16.0 * fullness.clamp(0.0, 1.0)).round() as usize;
    (SIXTEENTHS[sixteenths], sixteenths == 16)
}

/// Returns the fullness in one word.
pub fn fullness_word(fullness: f64) -> &'static str {
    match fullness {
        _ if fullness < THIN => "thin",
        _ if fullness < THICK => "half",
        _ if fullness < FULL => "thick",
        _ => "full",
    }
}

/// Returns a whole number in words up to ten.
pub fn number_word(number: u32) -> String {
    NUMBERS.get(number as usize).map_or_else(|| number.to_string(), |word| (*word).to_owned())
}

/// Formats a number of half tips, in words: "half a tip", "two and a half tips".
pub fn tips_words(halves: u32) -> String {
    let whole = number_word(halves / 2);
    match (halves, halves % 2) {
        (1, _) => "half a tip".to_owned(),
        (2, _) => "one tip".to_owned(),
        (_, 0) => format!("{whole} tips"),
        _ => format!("{whole} and a half tips"),
    }
}

/// Returns the clock position of the tip on the ball, to half an hour, as seen along the cue; `right` and `up` are its
/// coordinates. `None` at the centre.
pub fn clock(right: f64, up: f64) -> Option<f64> {
    (right != 0.0 || up != 0.0).then(|| {
        let hours = right.atan2(up).to_degrees() / 30.0;
        let half = (2.0 * hours).round().rem_euclid(24.0) / 2.0;
        if half < 1.0 { half + 12.0 } else { half }
    })
}

/// Formats a clock position in words: "2 o'clock", "half past 2".
pub fn clock_words(hours: f64) -> String {
    let whole = hours.trunc();
    if hours > whole { format!("half past {whole}") } else { format!("{whole} o'clock") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fullness_is_named_in_sixteenths() {
        let told = [0.01, 0.13, 0.25, 0.44, 0.5, 0.56, 0.76, 0.97, 1.0].map(|fullness| fullness_words(fullness).0);
        let wanted = ["a graze", "an eighth full", "a quarter full", "a little thinner than half", "half full"];
        assert_eq!(told[..5], wanted);
        let wanted = ["a little thicker than half", "three quarters full", "full", "full"];
        assert_eq!(told[5..], wanted);
        assert!(!fullness_words(0.94).1 && fullness_words(0.98).1);
    }

    #[test]
    fn tips_and_clock_positions_use_halves() {
        assert_eq!(
            [1, 2, 3, 4, 5].map(tips_words).join(", "),
            "half a tip, one tip, one and a half tips, two tips, two and a half tips"
        );
        let told = [(0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (-1.0, 1.0), (0.0, -2.0), (-2.0, -0.2), (-0.2, 1.0)]
            .map(|(right, up)| clock_words(clock(right, up).unwrap()));
        let wanted =
            ["12 o'clock", "3 o'clock", "half past 1", "half past 10", "6 o'clock", "9 o'clock", "half past 11"];
        assert_eq!(told, wanted);
        assert_eq!(clock(0.0, 0.0), None);
    }
}
