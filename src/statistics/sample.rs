//! Estimates from a sample.

/// Returns the mean of the numbers and the sample standard deviation, which is `None` for fewer than two numbers. The mean of equal numbers
/// is exactly that number, despite rounding of the sum. `numbers` must not be empty.
pub fn mean_and_deviation(numbers: &[f64]) -> (f64, Option<f64>) {
    let count = numbers.len() as f64;
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mean = (numbers.iter().sum::<f64>() / count).max(least).min(most);
    let squares: f64 = numbers.iter().map(|number| (number - mean).powi(2)).sum();
    (mean, (numbers.len() > 1).then(|| (squares / (count - 1.0)).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_deviation_uses_the_sample_formula() {
        let (mean, deviation) = mean_and_deviation(&[0.1, 0.2, 0.6]);
        assert!((mean - 0.3).abs() < 1e-15 && (deviation.unwrap() - 0.07_f64.sqrt()).abs() < 1e-15);
        assert_eq!(mean_and_deviation(&[0.1; 3]), (0.1, Some(0.0)));
        assert_eq!(mean_and_deviation(&[0.5]), (0.5, None));
    }
}
