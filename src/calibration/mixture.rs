//! Several normal distributions, each with a weight, told by what they have together: means and covariance.

/// A mixture of normal distributions.
#[derive(Clone, Debug)]
pub struct Mixture {
    weight: f64,
    /// The weighted sums of the numbers and of their products.
    sums: Vec<f64>,
    products: Vec<Vec<f64>>,
}

impl Mixture {
    /// An empty one of so many numbers.
    pub fn new(count: usize) -> Self {
        Self { weight: 0.0, sums: vec![0.0; count], products: vec![vec![0.0; count]; count] }
    }

    /// Adds a normal distribution.
    pub fn add(&mut self, weight: f64, mean: &[f64], covariance: &[Vec<f64>]) {
        self.weight += weight;
        for (row, line) in covariance.iter().enumerate() {
            self.sums[row] += weight * mean[row];
            for (column, entry) in line.iter().enumerate() {
                self.products[row][column] += weight * (entry + mean[row] * mean[column]);
            }
        }
    }

    /// Means and covariance.
    pub fn moments(self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let Self { weight, sums, products } = self;
        let means: Vec<f64> = sums.iter().map(|sum| sum / weight).collect();
        let line = |(row, line): (usize, Vec<f64>)| {
            line.iter().zip(&means).map(|(entry, mean)| entry / weight - means[row] * mean).collect()
        };
        let covariance = products.into_iter().enumerate().map(line).collect();
        (means, covariance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_valleys_apart_are_as_wide_as_their_distance_says() {
        let mut mixture = Mixture::new(2);
        mixture.add(3.0, &[1.0, 0.0], &[vec![0.5, 0.1], vec![0.1, 1.0]]);
        mixture.add(1.0, &[-3.0, 0.0], &[vec![0.5, 0.1], vec![0.1, 1.0]]);
        let (means, covariance) = mixture.moments();
        assert_eq!(means, [0.0, 0.0]);
        // Three quarters at 1, a quarter at -3: a variance of 3 besides their own.
        assert_eq!(covariance, [vec![3.5, 0.1], vec![0.1, 1.0]]);
    }
}
