//! Numbers along a cushion.

/// Numbers and their positions along a cushion, in diamonds, both ascending, with linear interpolation.
#[derive(Clone, Copy, Debug)]
pub struct Scale(pub &'static [(f64, f64)]);

impl Scale {
    /// Returns the number at a position; `None` beyond the ends.
    pub fn number(&self, place: f64) -> Option<f64> {
        between(self.0.iter().map(|(number, place)| (*place, *number)), place)
    }

    /// Returns the position of a number; `None` beyond the ends.
    pub fn position(&self, number: f64) -> Option<f64> {
        between(self.0.iter().copied(), number)
    }

    /// Returns the positions of both ends.
    pub fn ends(&self) -> [f64; 2] {
        [self.0[0].1, self.0[self.0.len() - 1].1]
    }
}

/// Interpolates linearly at `x` between points whose first coordinates ascend; `None` beyond the ends.
pub fn between(points: impl Iterator<Item = (f64, f64)> + Clone, x: f64) -> Option<f64> {
    // Tolerance for rounding at the ends.
    const ROUNDING: f64 = 1e-9;
    points.clone().zip(points.skip(1)).find_map(|((from, low), (to, high))| {
        let is_there = from - ROUNDING <= x && x <= to + ROUNDING;
        is_there.then(|| low + (x - from) / (to - from) * (high - low))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_positions_are_inverse_within_the_scale() {
        let scale = Scale(&[(0.0, 0.2), (10.0, 1.0), (20.0, 3.0)]);
        for number in [0.0, 3.0, 10.0, 19.5, 20.0] {
            assert!((scale.number(scale.position(number).unwrap()).unwrap() - number).abs() < 1e-12);
        }
        assert_eq!((scale.number(0.1), scale.position(20.1), scale.ends()), (None, None, [0.2, 3.0]));
    }
}
