//! Numbers as people write them.

/// A number as it stands in a file: very large and very small ones by their powers of ten.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_is_a_line_of_zeros() {
        let said = [3.0, 0.25, 1e308, 1e-300, f64::NAN].map(number);
        assert_eq!(said, ["3", "0.25", "1e308", "1e-300", "NaN"]);
    }
}
