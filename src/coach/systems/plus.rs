//! The grid of the Plus system, which has no scale on the first cushion that is valid for every start.

use super::scale::between;

/// Positions on the first (short) cushion from the far corner down, in diamonds.
const FIRST: [f64; 5] = [4.0, 3.5, 3.0, 2.5, 2.0];

/// Start numbers, and for each the arrival on the third cushion from each position in [`FIRST`], in diamonds. The
/// nines, beyond the corner, are not in the source: they continue the rows, for a table on which the aim must be a
/// little higher.
const ARRIVALS: [(f64, &[f64]); 7] = [
    (2.0, &[3.7, 4.0, 5.0, 6.0, 7.0]),
    (3.0, &[4.5, 5.0, 6.0, 7.0, 8.0]),
    (4.0, &[5.0, 6.0, 7.0, 8.0, 9.0]),
    (5.0, &[5.5, 7.0, 8.0, 9.0]),
    (6.0, &[6.0, 7.0, 8.0, 9.0]),
    (7.0, &[7.0, 8.0, 9.0]),
    (8.0, &[8.0, 9.0]),
];

/// Returns the arrival of a ball with the start number `start` that is aimed at the position `first`, both in diamonds.
pub fn third(start: f64, first: f64) -> Option<f64> {
    let column = |arrivals: &'static [f64]| {
        // In reverse order, so that the positions ascend.
        between(FIRST.iter().zip(arrivals).rev().map(|(place, third)| (*place, *third)), first)
    };
    let rows = ARRIVALS.windows(2).find(|rows| (rows[0].0..=rows[1].0).contains(&start))?;
    let [one, other] = [rows[0], rows[1]];
    let part = (start - one.0) / (other.0 - one.0);
    match (column(one.1), column(other.1)) {
        (Some(low), Some(high)) => Some(low + part * (high - low)),
        (Some(low), None) if part < 1e-9 => Some(low),
        (None, Some(high)) if part > 1.0 - 1e-9 => Some(high),
        _ => None,
    }
}

/// The lowest and the highest position on the first cushion.
pub const ENDS: [f64; 2] = [FIRST[4], FIRST[0]];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrival_is_interpolated_between_start_numbers() {
        assert_eq!([third(2.0, 3.0), third(3.0, 3.0), third(2.5, 3.0)], [Some(5.0), Some(6.0), Some(5.5)]);
        assert_eq!([third(8.0, 4.0), third(7.5, 4.0)], [Some(8.0), Some(7.5)]);
        assert_eq!([third(8.0, 3.4), third(1.9, 3.0), third(5.0, 2.4), third(3.0, 4.1)], [None; 4]);
    }
}
