//! Standard normal errors of the five cue inputs: quasi-random for comparing shots, independent for judging one.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::statistics::{normal_pair, normal_quantile};

/// Errors in a, b, theta, phi and V, in units of the player's standard errors.
pub type Errors = [f64; 5];

/// The bases of Halton's sequence, one per input.
const BASES: [u32; 5] = [2, 3, 5, 7, 11];

/// Quasi-random normal errors: Halton's sequence (1960) with a random shift (Cranley and Patterson 1976), so that a
/// mean over them is unbiased. They cover the distribution more evenly than independent numbers. Every prefix of the
/// sequence is evenly spread too, but a subsequence such as every fourth is not. For comparing shots on the same
/// errors.
#[derive(Clone, Copy, Debug)]
pub struct Halton {
    shift: [f64; 5],
}

impl Halton {
    /// Creates the sequence with the shift that `seed` draws.
    pub fn new(seed: u64) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        Self { shift: std::array::from_fn(|_| rng.random()) }
    }

    /// Returns the `n`th errors of the sequence.
    pub fn errors(&self, n: usize) -> Errors {
        let place = |index: usize| (self.shift[index] + radical_inverse(n as u32 + 1, BASES[index])).fract();
        std::array::from_fn(|index| normal_quantile(place(index)))
    }
}

/// Quasi-random streams of standard normal numbers, each evenly spread, for the uncertainty of table and positions:
/// Richtmyer's sequence (1951), the multiples of a prime's square root, with a random shift.
#[derive(Debug)]
pub struct Streams {
    rng: Xoshiro256PlusPlus,
    /// The square root and the shift of each stream.
    streams: Vec<(f64, f64)>,
}

impl Streams {
    /// Creates streams whose shifts `seed` draws.
    pub fn new(seed: u64) -> Self {
        Self { rng: Xoshiro256PlusPlus::seed_from_u64(seed), streams: Vec::new() }
    }

    /// Returns the `n`th number of a stream.
    pub fn number(&mut self, stream: usize, n: usize) -> f64 {
        while self.streams.len() <= stream {
            let last = self.streams.last().map_or(1, |(root, _)| (root * root).round() as u32);
            // A prime exists between every number and its double (Bertrand).
            let prime = (last + 1..=2 * last).find(|&n| (2..n).all(|divisor| n % divisor != 0)).unwrap_or(2);
            self.streams.push((f64::from(prime).sqrt(), self.rng.random()));
        }
        let (root, shift) = self.streams[stream];
        normal_quantile((shift + n as f64 * root).fract())
    }
}

/// Returns the radical inverse: the digits of `n` in a base, mirrored at the point.
fn radical_inverse(mut n: u32, base: u32) -> f64 {
    let (mut value, mut place) = (0.0, 1.0);
    while n > 0 {
        place /= f64::from(base);
        value += place * f64::from(n % base);
        n /= base;
    }
    value
}

/// Draws `count` independent errors, for judging a shot: the confidence interval of a success rate assumes independent
/// attempts.
pub fn independent(count: usize, seed: u64) -> Vec<Errors> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..count).map(|_| random(&mut rng)).collect()
}

/// Draws the errors of one stroke.
pub fn random(rng: &mut Xoshiro256PlusPlus) -> Errors {
    std::array::from_fn(|_| standard_normal(rng))
}

/// Draws a standard normal number.
pub fn standard_normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    normal_pair(rng)[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_uncorrelated_standard_normal() {
        let mut streams = Streams::new(4);
        let all: Vec<[f64; 20]> = (0..768).map(|n| std::array::from_fn(|stream| streams.number(stream, n))).collect();
        let mean = |f: &dyn Fn(&[f64; 20]) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
        for i in 0..20 {
            assert!(mean(&|e| e[i]).abs() < 0.02 && (mean(&|e| e[i] * e[i]) - 1.0).abs() < 0.05, "{i}");
            for j in 0..i {
                assert!(mean(&|e| e[i] * e[j]).abs() < 0.12, "{i} {j}: {}", mean(&|e| e[i] * e[j]));
            }
        }
    }

    #[test]
    fn halton_and_independent_errors_are_standard_normal() {
        // The means of independent errors typically deviate by 0.5 %.
        let halton = Halton::new(3);
        let spread = (0..4096).map(|n| halton.errors(n)).collect();
        for (errors, tolerance, correlation) in [(spread, 0.005, 0.025), (independent(40_000, 3), 0.03, 0.03)] {
            let mean = |f: &dyn Fn(&Errors) -> f64| errors.iter().map(f).sum::<f64>() / errors.len() as f64;
            for i in 0..5 {
                assert!(mean(&|e| e[i]).abs() < tolerance && (mean(&|e| e[i] * e[i]) - 1.0).abs() < tolerance);
                for j in 0..i {
                    assert!(mean(&|e| e[i] * e[j]).abs() < correlation, "{i} {j}: {}", mean(&|e| e[i] * e[j]));
                }
            }
        }
    }
}
