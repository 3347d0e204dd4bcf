//! Numbers in the form in which people write them.

/// Formats a number as it appears in a file: very large and very small ones with a power of ten.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

/// Parses a number that somebody typed, with a decimal point or a decimal comma.
pub fn parse_number(text: &str) -> Option<f64> {
    text.trim().replace(',', ".").parse().ok()
}

/// Formats the number with `decimals` digits, never as minus zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.starts_with('-') && !text.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) {
        text[1..].to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_zero_is_printed_as_zero() {
        assert_eq!(fixed(-0.000_4, 3), "0.000");
        assert_eq!(fixed(-0.000_6, 3), "-0.001");
        assert_eq!(fixed(f64::NAN, 1), "NaN");
    }

    #[test]
    fn a_decimal_comma_is_accepted() {
        assert_eq!(
            ["0,6", " 9.1 ", "-3", "1,2,3", "much"].map(parse_number),
            [Some(0.6), Some(9.1), Some(-3.0), None, None]
        );
    }

    #[test]
    fn extreme_numbers_use_powers_of_ten() {
        let said = [3.0, 0.25, 1e308, 1e-300, f64::NAN].map(number);
        assert_eq!(said, ["3", "0.25", "1e308", "1e-300", "NaN"]);
    }
}
