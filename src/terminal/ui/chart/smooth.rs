//! The exponential mean of a curve.

use crate::learning::run::history::Point;

/// Exponential mean over `length` shots at the end of each point, computed from the means of the points; `None` for a point without one.
///
/// A point is weighted by the number of shots since the previous one, so that thinned and full data give the same curve. The mean uses past
/// points only, so that a drawn curve never changes. It is divided by the collected weight, so that the start is not biased towards zero
/// (Kingma & Ba, "Adam", 2015, section 3).
pub fn smooth(points: &[Point], length: f64) -> Vec<Option<f64>> {
    let ends = || points.iter().filter(|point| point.finite.is_some()).map(|point| point.shots.1);
    // The weight of the first point is unknown; that of the second is used.
    let first = ends().zip(ends().skip(1)).next().map_or(1, |(first, second)| second - first);
    let (mut sum, mut weight, mut before) = (0.0, 0.0, None);
    let mut next = |point: &Point| {
        let mean = point.finite?.mean;
        let end = point.shots.1;
        let shots = before.map_or(first, |before| end.saturating_sub(before)).max(1);
        before = Some(end);
        let kept = (-(shots as f64) / length).exp();
        sum = sum * kept + mean * (1.0 - kept);
        weight = weight * kept + (1.0 - kept);
        Some(if weight > 0.0 { sum / weight } else { mean })
    };
    points.iter().map(&mut next).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::ui::chart::tests::line;

    #[test]
    fn smoothing_keeps_a_constant_from_its_first_point() {
        let points: Vec<_> = (1..50).map(|n| line(100 * n * n, 0.25)).collect();
        for value in smooth(&points, 3000.0) {
            assert!((value.unwrap() - 0.25).abs() < 1e-12);
        }
    }

    #[test]
    fn smoothing_reaches_63_percent_of_a_step_after_the_length() {
        let points: Vec<_> = (1..=4000).map(|n| line(n, if n <= 3000 { 1.0 } else { 3.0 })).collect();
        let smoothed = smooth(&points, 500.0);
        let wanted = 1.0 + 2.0 * (1.0 - (-1.0_f64).exp());
        assert!((smoothed[3499].unwrap() - wanted).abs() < 0.01, "{:?}", smoothed[3499]);
    }

    #[test]
    fn smoothing_is_causal_and_keeps_gaps() {
        let mut points: Vec<_> = (1..100).map(|n| line(10 * n, (n as f64).sin())).collect();
        points[40] = line(410, f64::NAN);
        let all = smooth(&points, 100.0);
        assert_eq!(smooth(&points[..60], 100.0), all[..60]);
        assert_eq!((all[40], all[41].is_some()), (None, true));
    }

    #[test]
    fn a_thinned_stretch_weighs_as_much_as_its_records() {
        let value = |n: u64| if n < 800 { 0.0 } else { 1.0 };
        let exact: Vec<_> = (1..=1000).map(|n| line(n, value(n))).collect();
        let mut thinned: Vec<_> = (0..40).map(|n| line(20 * n + 20, 0.0)).collect();
        thinned.extend((801..=1000).map(|n| line(n, value(n))));
        let (exact, thinned) = (smooth(&exact, 100.0), smooth(&thinned, 100.0));
        assert!((exact[999].unwrap() - thinned[239].unwrap()).abs() < 0.01);
    }
}
