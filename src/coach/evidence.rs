//! Estimates how often a stroke is made from all attempts at strokes near it: importance sampling.
//!
//! An attempt at one stroke, with its errors, also counts for another stroke. Its weight is the density of its outcome
//! under that stroke, divided by the density under all strokes that were tried (the balance heuristic of Veach and
//! Guibas 1995, normalised by the sum of the weights). A few hundred attempts thus estimate the make rate of every
//! stroke among them, and which is made most often.

use super::{Skill, candidates::with_errors, draws::ErrorSize};
use crate::{
    physics::{CueInputs, signed_angle},
    player::errors::Errors,
    statistics::SuccessRate,
    table::Table,
};

/// Rounds of expectation maximization between two rounds of attempts: more would fit noise.
const CLIMBING_ROUNDS: usize = 2;

/// Maximum move of a stroke before it is tried again, in its standard errors: further away, the attempts contain little
/// information.
const MAX_MOVE: f64 = 1.0;

/// Width in which strokes are compared by an input that the player executes exactly, as a share of an expert's error. If such an input
/// did not count, a soft and a hard stroke would be the same for a player with exact speed. If only equal values were alike, a cue raised
/// by a hair would lose all attempts so far.
const EXACT_INPUT_WIDTH: f64 = 0.1;

/// The five inputs of a stroke that errors change: a, b, theta, phi and V.
type InputVector = [f64; 5];

/// An intended stroke and the distribution of its outcomes.
#[derive(Clone, Copy, Debug)]
pub struct Distribution {
    cue: CueInputs,
    at: InputVector,
    /// The standard errors; zero for an input without error.
    deviations: InputVector,
    /// Their reciprocals; for an input without error, that of the width in which it is compared.
    inverse_deviations: InputVector,
    /// Product of the reciprocals, under the player's own errors and under the larger ones.
    height: [f64; 2],
}

impl Distribution {
    /// Creates the distribution of `cue` for a player with this skill and balls of `radius` m.
    pub fn new(skill: &Skill, radius: f64, cue: &CueInputs) -> Self {
        let deviations_of = |Skill { a, b, theta, phi, speed, .. }: Skill| [a / radius, b / radius, theta, phi, speed];
        let (deviations, expert) = (deviations_of(skill.at(cue)), deviations_of(Skill::EXPERT));
        let inverse_deviations = std::array::from_fn(|input| {
            let is_exact = deviations[input] == 0.0;
            (if is_exact { EXACT_INPUT_WIDTH * expert[input] } else { deviations[input] }).recip()
        });
        let height = deviations.into_iter().filter(|deviation| *deviation > 0.0).map(f64::recip);
        let height = height
            .fold([1.0, 1.0], |[own, larger], inverse| [own * inverse, larger * inverse / ErrorSize::Larger.factor()]);
        Self { cue: *cue, at: [cue.a, cue.b, cue.theta, cue.phi, cue.speed], deviations, inverse_deviations, height }
    }

    /// Returns the stroke that results with these errors.
    fn outcome(&self, errors: &Errors) -> InputVector {
        std::array::from_fn(|input| self.at[input] + self.deviations[input] * errors[input])
    }

    /// Returns the difference of an outcome or another stroke from this one, in standard errors.
    fn errors_to(&self, place: &InputVector) -> Errors {
        let mut errors: Errors = std::array::from_fn(|input| place[input] - self.at[input]);
        // Directions wrap around: half a turn to the left equals half a turn to the right.
        errors[3] = signed_angle(self.at[3], place[3]);
        std::array::from_fn(|input| errors[input] * self.inverse_deviations[input])
    }

    /// Returns the distance to another intended stroke, in standard errors.
    pub fn distance(&self, other: &Self) -> f64 {
        squared(&self.errors_to(&other.at)).sqrt()
    }

    /// Returns the density of an outcome under the player's errors and under the larger ones, up to a factor that all
    /// strokes share.
    #[inline]
    fn densities(&self, outcome: &InputVector) -> [f64; 2] {
        // The variance of the larger errors is three times that of the player's own.
        let larger = libm::exp(squared(&self.errors_to(outcome)) / -6.0);
        [self.height[0] * larger * larger * larger, self.height[1] * larger]
    }
}

fn squared(errors: &Errors) -> f64 {
    errors.iter().map(|error| error * error).sum()
}

/// How often a stroke is made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rate {
    /// As a share, 0 to 1.
    pub share: f64,
    /// Effective sample size: the number of the stroke's own attempts that would be as precise.
    pub attempts: f64,
}

impl Rate {
    /// Sums up attempts by their weights.
    fn of(weights: impl Iterator<Item = (f64, bool)>) -> Self {
        let (mut made, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for (weight, is_made) in weights {
            made += if is_made { weight } else { 0.0 };
            sum += weight;
            squares += weight * weight;
        }
        if sum > 0.0 { Self { share: made / sum, attempts: sum * sum / squares } } else { Self::default() }
    }

    /// Returns the equivalent counted rate, with its confidence interval.
    pub fn to_success_rate(self) -> SuccessRate {
        let tried = self.attempts.round();
        SuccessRate::new((self.share * tried).round() as usize, tried as usize)
    }
}

/// One attempt: its errors and their size, and whether it made the point.
pub type Trial = (Errors, ErrorSize, bool);

/// One attempt, by its outcome.
#[derive(Clone, Copy, Debug)]
struct Sample {
    outcome: InputVector,
    made: bool,
    /// Density of its outcome under all attempts together.
    density: f64,
}

/// Attempts at strokes near each other.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// The strokes that were tried, and the number of attempts with errors of either size.
    tried: Vec<(Distribution, [f64; 2])>,
    samples: Vec<Sample>,
}

impl Evidence {
    /// Adds attempts at one stroke.
    pub fn add(&mut self, stroke: &Distribution, trials: &[Trial]) {
        let mut counts = [0.0; 2];
        for (_, size, _) in trials {
            counts[*size as usize] += 1.0;
        }
        let density = |(stroke, counts): &(Distribution, [f64; 2]), outcome: &InputVector| {
            let [own, larger] = stroke.densities(outcome);
            counts[0] * own + counts[1] * larger
        };
        for sample in &mut self.samples {
            sample.density += density(&(*stroke, counts), &sample.outcome);
        }
        self.tried.push((*stroke, counts));
        for (errors, _, made) in trials {
            let outcome = stroke.outcome(errors);
            let density = self.tried.iter().map(|tried| density(tried, &outcome)).sum();
            self.samples.push(Sample { outcome, made: *made, density });
        }
    }

    /// Estimates the make rate of a stroke under the player's errors, and under the larger ones.
    pub fn rates(&self, stroke: &Distribution) -> [Rate; 2] {
        let weights: Vec<([f64; 2], bool)> = self
            .samples
            .iter()
            .map(|sample| (stroke.densities(&sample.outcome).map(|density| density / sample.density), sample.made))
            .collect();
        [0, 1].map(|size| Rate::of(weights.iter().map(|(weights, made)| (weights[size], *made))))
    }

    /// Returns the errors that would turn `stroke` into a stroke that is made more often. Takes steps of expectation
    /// maximization (Dayan and Hinton 1997) to the mean of the successful outcomes, without further attempts.
    fn climb(&self, stroke: &Distribution) -> Errors {
        let mut errors = [0.0; 5];
        let mut climber = *stroke;
        for _ in 0..CLIMBING_ROUNDS {
            let (mut sum, mut weights) = ([0.0; 5], 0.0);
            for sample in self.samples.iter().filter(|sample| sample.made) {
                let weight = climber.densities(&sample.outcome)[0] / sample.density;
                weights += weight;
                let own = stroke.errors_to(&sample.outcome);
                sum.iter_mut().zip(own).for_each(|(sum, error)| *sum += weight * error);
            }
            if weights <= 0.0 {
                break;
            }
            errors = sum.map(|sum| sum / weights);
            let distance = squared(&errors).sqrt();
            if distance > MAX_MOVE {
                return errors.map(|error| error * MAX_MOVE / distance);
            }
            climber.at = stroke.outcome(&errors);
        }
        errors
    }

    /// Returns improved strokes, best first, as far as they can be recommended: the estimated optimum, the point half-way to
    /// it, and the successful outcome nearest to it. The last one is needed because the mean of successful outcomes
    /// need not make the point.
    pub fn improved_strokes(&self, table: &Table, skill: Skill, stroke: &Distribution) -> [CueInputs; 3] {
        let top = self.climb(stroke);
        let distance = |errors: &Errors| squared(&std::array::from_fn(|input| errors[input] - top[input]));
        let made = self.samples.iter().filter(|sample| sample.made).map(|sample| stroke.errors_to(&sample.outcome));
        let nearest = made.min_by(|one, other| distance(one).total_cmp(&distance(other))).unwrap_or_default();
        [top, top.map(|error| 0.5 * error), nearest].map(|errors| with_errors(table, skill, &stroke.cue, &errors))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::player::errors::Halton;

    const RADIUS: f64 = 0.03;
    const MEANT: CueInputs = CueInputs { a: 0.1, b: 0.2, theta: 0.1, phi: 1.0, speed: 2.5 };

    /// Attempts at `stroke` that make the point if the direction is within one standard error of `middle`.
    fn attempts(stroke: &Distribution, middle: f64, count: usize, seed: u64) -> Vec<Trial> {
        let own = (0..count).map(|n| (Halton::new(seed).errors(n), ErrorSize::Own));
        let larger = (0..count / 3).map(|n| (Halton::new(!seed).errors(n), ErrorSize::Larger));
        own.chain(larger)
            .map(|(errors, size)| {
                let errors = errors.map(|error| size.factor() * error);
                let phi = stroke.outcome(&errors)[3];
                (errors, size, (phi - middle).abs() < stroke.deviations[3])
            })
            .collect()
    }

    #[test]
    fn attempts_at_nearby_strokes_predict_a_third() {
        let skill = Skill::EXPERT;
        let stroke =
            |off: f64| Distribution::new(&skill, RADIUS, &CueInputs { phi: MEANT.phi + off * skill.phi, ..MEANT });
        let mut evidence = Evidence::default();
        for (off, seed) in [(-1.0, 1), (0.8, 2)] {
            evidence.add(&stroke(off), &attempts(&stroke(off), MEANT.phi, 3000, seed));
        }
        // The share of a normal distribution within one deviation of a point that is `off` deviations from its mean;
        // the larger errors have the square root of three as their deviation.
        for (off, own, larger) in [(0.0, 0.6827, 0.4363), (0.5, 0.6247, 0.4210)] {
            let rates = evidence.rates(&stroke(off));
            assert!((rates[0].share - own).abs() < 0.015 && (rates[1].share - larger).abs() < 0.03, "{off} {rates:?}");
            assert!((1000.0..8000.0).contains(&rates[0].attempts), "{rates:?}");
        }
        let best = evidence.climb(&stroke(0.8));
        assert!((-0.8..-0.5).contains(&best[3]) && best[4].abs() < 0.1, "{best:?}");
    }

    #[test]
    fn direction_difference_wraps_at_half_a_turn() {
        let skill = Skill::EXPERT;
        let stroke = |phi: f64| Distribution::new(&skill, RADIUS, &CueInputs { phi, ..MEANT });
        let [before, after] = [stroke(PI - 0.25 * skill.phi), stroke(-PI + 0.25 * skill.phi)];
        assert!((before.distance(&after) - 0.5).abs() < 0.1, "{}", before.distance(&after));
        let mut evidence = Evidence::default();
        evidence.add(&before, &attempts(&before, PI, 3000, 1));
        let [own, _] = evidence.rates(&after);
        assert!((own.share - evidence.rates(&before)[0].share).abs() < 0.1 && own.attempts > 1000.0, "{own:?}");
        assert!((0.0..0.5).contains(&evidence.climb(&before)[3]), "{:?}", evidence.climb(&before));
    }

    #[test]
    fn strokes_that_differ_in_an_exact_input_are_different() {
        let skill = Skill { phi: 0.0, speed: 0.0, ..Skill::EXPERT };
        let stroke = |phi: f64, speed| Distribution::new(&skill, RADIUS, &CueInputs { phi, speed, ..MEANT });
        let [soft, hard] = [1.0, 4.0].map(|speed| stroke(MEANT.phi, speed));
        let turned = stroke(MEANT.phi + 0.02, 1.0);
        assert!(soft.distance(&hard) > 10.0 && soft.distance(&turned) > 10.0 && soft.distance(&soft) == 0.0);
        // Always made softly, never hard.
        let attempts =
            |made| -> Vec<_> { (0..300).map(|n| (Halton::new(1).errors(n), ErrorSize::Own, made)).collect() };
        let mut evidence = Evidence::default();
        evidence.add(&soft, &attempts(true));
        evidence.add(&hard, &attempts(false));
        for (stroke, share, attempts) in [(soft, 1.0, 300.0), (hard, 0.0, 300.0), (turned, 0.0, 0.0)] {
            let [own, _] = evidence.rates(&stroke);
            assert!((own.share - share).abs() < 1e-9 && (own.attempts - attempts).abs() < 1e-6, "{own:?}");
        }
        let ways = evidence.improved_strokes(&Table::default(), skill, &hard);
        assert!(ways.iter().all(|cue| cue.speed == 4.0), "{ways:?}");
    }

    #[test]
    fn own_attempts_have_full_weight_and_exact_inputs_stay() {
        let skill = Skill { theta: 0.0, ..Skill::EXPERT };
        let stroke = Distribution::new(&skill, RADIUS, &MEANT);
        let own: Vec<_> =
            attempts(&stroke, MEANT.phi, 300, 3).into_iter().filter(|(_, size, _)| *size == ErrorSize::Own).collect();
        let mut evidence = Evidence::default();
        evidence.add(&stroke, &own);
        let made = own.iter().filter(|(_, _, made)| *made).count();
        let [rate, _] = evidence.rates(&stroke);
        assert!((rate.share - made as f64 / 300.0).abs() < 1e-12 && (rate.attempts - 300.0).abs() < 1e-9, "{rate:?}");
        let ways = evidence.improved_strokes(&Table::default(), skill, &stroke);
        assert!(ways.iter().all(|cue| cue.theta == MEANT.theta) && ways[0] != ways[1], "{ways:?}");
        let is_way = |errors: &Errors| (skill.stroke(RADIUS, &MEANT, errors).phi - ways[2].phi).abs() < 1e-12;
        assert!(own.iter().any(|(errors, _, made)| *made && is_way(errors)), "{ways:?}");
        assert_eq!(Evidence::default().rates(&stroke), [Rate::default(); 2]);
        assert_eq!(Evidence::default().climb(&stroke), [0.0; 5]);
    }
}
