//! Standard normal errors of the five cue inputs: spread evenly for comparing shots, independent for judging one.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::learning::normal_pair;

/// Errors in a, b, theta, phi and V, in units of the player's standard errors.
pub type Errors = [f64; 5];

/// The bases of Halton's sequence, one an input.
const BASES: [u32; 5] = [2, 3, 5, 7, 11];

/// `count` errors that cover the normal distribution more evenly than chance: Halton's sequence (1960) with a random shift
/// (Cranley and Patterson 1976), so that a mean over them is unbiased. Every beginning of the list is spread evenly too,
/// but not every fourth of it or the like. For comparing shots on the same errors.
pub fn spread(count: usize, seed: u64) -> Vec<Errors> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let shift: [f64; 5] = std::array::from_fn(|_| rng.random());
    let place = |n: u32, index: usize| (shift[index] + radical_inverse(n, BASES[index])).fract();
    (1..=count as u32).map(|n| std::array::from_fn(|index| quantile(place(n, index)))).collect()
}

/// Streams of standard normal numbers, each spread evenly over the distribution, for what is in doubt besides the hand:
/// Richtmyer's sequence (1951), the multiples of a prime's square root, with a random shift.
#[derive(Debug)]
pub struct Streams {
    rng: Xoshiro256PlusPlus,
    /// Of each stream the square root and the shift.
    streams: Vec<(f64, f64)>,
}

impl Streams {
    /// Streams that are drawn by `seed`.
    pub fn new(seed: u64) -> Self {
        Self { rng: Xoshiro256PlusPlus::seed_from_u64(seed), streams: Vec::new() }
    }

    /// The `n`th number of a stream.
    pub fn number(&mut self, stream: usize, n: usize) -> f64 {
        while self.streams.len() <= stream {
            let last = self.streams.last().map_or(1, |(root, _)| (root * root).round() as u32);
            // There is one between every number and its double (Bertrand).
            let prime = (last + 1..=2 * last).find(|&n| (2..n).all(|divisor| n % divisor != 0)).unwrap_or(2);
            self.streams.push((f64::from(prime).sqrt(), self.rng.random()));
        }
        let (root, shift) = self.streams[stream];
        quantile((shift + n as f64 * root).fract())
    }
}

/// The digits of `n` in a base, mirrored at the point.
fn radical_inverse(mut n: u32, base: u32) -> f64 {
    let (mut value, mut place) = (0.0, 1.0);
    while n > 0 {
        place /= f64::from(base);
        value += place * f64::from(n % base);
        n /= base;
    }
    value
}

/// `count` independent errors. For judging a shot: the interval of a share of successes
/// supposes independent attempts.
pub fn independent(count: usize, seed: u64) -> Vec<Errors> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..count).map(|_| one(&mut rng)).collect()
}

/// One stroke's errors.
pub fn one(rng: &mut Xoshiro256PlusPlus) -> Errors {
    std::array::from_fn(|_| normal(rng))
}

/// A standard normal number.
pub fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    normal_pair(rng)[0]
}

/// The standard normal number below which a share `p` lies, by Acklam's rational approximation (2003), whose relative
/// error is below 1.2e-9. A `p` within 1e-9 of 0 or 1 gives about 6.
fn quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const B: [f64; 6] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
        1.0,
    ];
    const C: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 5] =
        [7.784_695_709_041_462e-3, 3.224_671_290_700_398e-1, 2.445_134_137_142_996, 3.754_408_661_907_416, 1.0];
    const TAIL: f64 = 0.024_25;
    let polynomial = |c: &[f64], x: f64| c.iter().fold(0.0, |sum, c| sum * x + c);
    let p = p.clamp(1e-9, 1.0 - 1e-9);
    let tail = |p: f64| {
        let q = (-2.0 * p.ln()).sqrt();
        polynomial(&C, q) / polynomial(&D, q)
    };
    if p < TAIL {
        tail(p)
    } else if p > 1.0 - TAIL {
        -tail(1.0 - p)
    } else {
        let q = p - 0.5;
        q * polynomial(&A, q * q) / polynomial(&B, q * q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (p, z) in
            [(0.5, 0.0), (0.975, 1.959_963_984_540_054), (0.001, -3.090_232_306_167_813), (0.84, 0.994_457_883)]
        {
            assert!((quantile(p) - z).abs() < 1e-8, "{p}: {}", quantile(p));
        }
    }

    #[test]
    fn streams_have_mean_nought_and_deviation_one_and_do_not_correlate() {
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
    fn both_kinds_have_mean_nought_and_deviation_one_and_do_not_correlate() {
        // Of independent errors the means deviate by 0.5 % as a rule.
        for (errors, tolerance, correlation) in [(spread(4096, 3), 0.005, 0.025), (independent(40_000, 3), 0.03, 0.03)]
        {
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
