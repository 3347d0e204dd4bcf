//! One step of an ordinary differential equation, as exact as is asked for: extrapolation of the modified midpoint rule
//! (Gragg 1965, Bulirsch and Stoer 1966), and of the semi-implicit one (Bader and Deuflhard 1983) where the equation is
//! stiff.

use glam::DVec2;

use crate::{
    physics::{BallState, factorize, substitute},
    table::BALLS,
};

/// Positions, velocities and spins of all balls; as a slope, their rates of change.
pub type State = [BallState; BALLS];

/// Rounds of extrapolation at most: 2, 4, … 16 midpoints, which makes order 16.
const ROUNDS: usize = 8;

/// The state and the time since the step's start, s. Whatever parameter a step runs in, the time is one of its unknowns.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Positions, velocities and spins.
    pub balls: State,
    /// Time, s.
    pub time: f64,
}

/// A step's result.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// What is reached at its end.
    pub end: Phase,
    /// Estimated error: the largest of metres, m/s and R times rad/s.
    pub error: f64,
    /// Length of the step that would get on fastest, if the solution stays as smooth as it is.
    pub best_length: f64,
}

/// Midpoints of each round. Those of the semi-implicit rule are odd multiples of two, for which what is stiff fades.
const COUNTS: [usize; ROUNDS] = [2, 4, 6, 8, 10, 12, 14, 16];
const STIFF_COUNTS: [usize; ROUNDS] = [2, 6, 10, 14, 18, 22, 26, 30];

/// Motions that decay much faster than the rest, all of one kind: a deviation of the state is measured by a row and changes
/// the slope by a column. The part of the slope's derivative that is stiff is the sum of columns times rows; what else there is
/// to the derivative costs no accuracy, only the length of steps.
#[derive(Clone, Debug, Default)]
pub struct Stiff(pub Vec<Mode>);

/// One of them.
#[derive(Clone, Copy, Debug)]
pub struct Mode {
    /// What measures the deviation: its scalar product with velocities and spins.
    pub row: Phase,
    /// Change of the slope for a unit of it.
    pub column: Phase,
}

impl Stiff {
    /// `(1 - h J)⁻¹` of a change, for the derivative `J` that these modes make.
    fn damper(&self, h: f64) -> impl Fn(&Phase) -> Phase {
        let count = self.0.len();
        let mut matrix: Vec<f64> =
            self.0.iter().flat_map(|a| self.0.iter().map(|b| -h * a.row.dot(&b.column))).collect();
        (0..count).for_each(|index| matrix[index * (count + 1)] += 1.0);
        let mut pivots = vec![0; count];
        factorize(&mut matrix, &mut pivots);
        move |change| {
            let mut sizes: Vec<f64> = self.0.iter().map(|mode| mode.row.dot(change)).collect();
            substitute(&matrix, &pivots, &mut sizes);
            self.0.iter().zip(sizes).fold(*change, |sum, (mode, size)| plus(&sum, &mode.column, h * size))
        }
    }
}

impl Phase {
    /// Nothing at all: what a sum begins with.
    pub const ZERO: Self = Self { balls: [BallState::at_rest(DVec2::ZERO); BALLS], time: 0.0 };

    /// Adds so many times a slope.
    #[inline(always)]
    fn add(&mut self, slope: &Self, factor: f64) {
        for (sum, slope) in self.balls.iter_mut().zip(&slope.balls) {
            sum.position += factor * slope.position;
            sum.velocity += factor * slope.velocity;
            sum.spin += factor * slope.spin;
        }
        self.time += factor * slope.time;
    }

    /// One step of the Aitken-Neville scheme: becomes `newer` and so many times the difference of that and this.
    #[inline(always)]
    fn neville(&mut self, newer: &Self, factor: f64) {
        for (older, newer) in self.balls.iter_mut().zip(&newer.balls) {
            older.position = newer.position + factor * (newer.position - older.position);
            older.velocity = newer.velocity + factor * (newer.velocity - older.velocity);
            older.spin = newer.spin + factor * (newer.spin - older.spin);
        }
        self.time = newer.time + factor * (newer.time - self.time);
    }

    /// Scalar product of velocities and spins.
    pub fn dot(&self, other: &Self) -> f64 {
        self.balls.iter().zip(&other.balls).map(|(a, b)| a.velocity.dot(b.velocity) + a.spin.dot(b.spin)).sum()
    }
}

/// The error of a step of the proposed length, as a share of the tolerance, and how much longer than the last it can be.
const CAUTION: f64 = 0.25;
const MOST_GROWTH: f64 = 4.0;
const LEAST_GROWTH: f64 = 0.1;

/// How much of a step is tried next, at least, after one that was given up early: few rounds tell little of the right length, and to try
/// costs as little.
const LEAST_GROWTH_AFTER_FEW_ROUNDS: f64 = 0.25;

/// Whether an error stays above the tolerance in so many more rounds, even if each of them reduces it by the square of the factor by
/// which the last one did. Where the slope jumps within the step nothing converges. The first error has none to be compared with.
fn is_hopeless(error: f64, error_before: f64, rounds: usize, tolerance: f64) -> bool {
    error_before.is_finite() && error * libm::pow(error / error_before, (2 * rounds) as f64) > tolerance
}

/// Steps from `begin`, whose slope is `first`, over `length`, in as many rounds as bring the error below `tolerance`, or until it is
/// plain that none will. The balls have a `radius` in m; the slope of those that do not take part is zero. `stiff` is what decays fast, if
/// anything does.
pub fn extrapolate(
    begin: &Phase,
    first: &Phase,
    mut slope: impl FnMut(&Phase) -> Phase,
    stiff: Option<&Stiff>,
    length: f64,
    (radius, tolerance): (f64, f64),
) -> Step {
    // The last row of the Aitken-Neville table, what is extrapolated farthest first.
    let mut row = [Phase::ZERO; ROUNDS];
    let mut best = Step { end: *begin, error: f64::INFINITY, best_length: LEAST_GROWTH * length };
    let (mut least_work, mut done) = (f64::INFINITY, 0.0);
    let counts = if stiff.is_some() { STIFF_COUNTS } else { COUNTS };
    for (round, &count) in counts.iter().enumerate() {
        let h = length / count as f64;
        let error_before = best.error;
        done += count as f64;
        row[round] = match stiff {
            Some(stiff) => semi_implicit_midpoint(begin, first, &mut slope, stiff, (count, h)),
            None => modified_midpoint(begin, first, &mut slope, (count, h)),
        };
        for column in (0..round).rev() {
            let ratio = count as f64 / counts[column] as f64;
            let (older, newer) = row.split_at_mut(column + 1);
            older[column].neville(&newer[0], 1.0 / (ratio * ratio - 1.0));
        }
        if round > 0 {
            // An error of this round falls with the power 2 round + 1 of the length.
            best.error = distance(&row[0], &row[1], radius);
            let room = CAUTION * tolerance / best.error.max(f64::MIN_POSITIVE);
            let growth = libm::pow(room, 1.0 / (2 * round + 1) as f64).clamp(LEAST_GROWTH, MOST_GROWTH);
            let work = done / growth;
            if work < least_work {
                // Where another round would have paid, too, it is tried next time.
                let more = if work < 0.9 * least_work && round + 1 < ROUNDS {
                    (done + counts[round + 1] as f64) / done
                } else {
                    1.0
                };
                (least_work, best.best_length) = (work, (growth * more).min(MOST_GROWTH) * length);
            }
        }
        if best.error <= tolerance {
            break;
        }
        if is_hopeless(best.error, error_before, ROUNDS - 1 - round, tolerance) {
            best.best_length = best.best_length.max(LEAST_GROWTH_AFTER_FEW_ROUNDS * length);
            break;
        }
    }
    best.end = row[0];
    best
}

/// Gragg's method: `count` leaps of length `h` over the midpoint, smoothed at the end.
#[inline(always)]
fn modified_midpoint(
    begin: &Phase,
    first: &Phase,
    slope: &mut impl FnMut(&Phase) -> Phase,
    (count, h): (usize, f64),
) -> Phase {
    let (mut before, mut now) = (*begin, plus(begin, first, h));
    for _ in 1..count {
        before.add(&slope(&now), 2.0 * h);
        std::mem::swap(&mut before, &mut now);
    }
    before.add(&slope(&now), h);
    before.add(&plus(&now, &before, -1.0), 0.5);
    before
}

/// Bader's and Deuflhard's method: the same with the stiff part of the slope implicit.
fn semi_implicit_midpoint(
    begin: &Phase,
    first: &Phase,
    slope: &mut impl FnMut(&Phase) -> Phase,
    stiff: &Stiff,
    (count, h): (usize, f64),
) -> Phase {
    let damped = stiff.damper(h);
    let mut change = damped(&plus(&Phase::ZERO, first, h));
    let mut now = plus(begin, &change, 1.0);
    for _ in 1..count {
        let missing = plus(&plus(&Phase::ZERO, &slope(&now), h), &change, -1.0);
        change = plus(&change, &damped(&missing), 2.0);
        now = plus(&now, &change, 1.0);
    }
    let missing = plus(&plus(&Phase::ZERO, &slope(&now), h), &change, -1.0);
    plus(&now, &damped(&missing), 1.0)
}

#[inline(always)]
fn plus(base: &Phase, slope: &Phase, factor: f64) -> Phase {
    let mut sum = *base;
    sum.add(slope, factor);
    sum
}

fn distance(one: &Phase, other: &Phase, radius: f64) -> f64 {
    one.balls.iter().zip(&other.balls).fold((one.time - other.time).abs(), |size, (a, b)| {
        size.max(a.position.distance(b.position))
            .max(a.velocity.distance(b.velocity))
            .max(radius * a.spin.distance(b.spin))
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn a_pendulum_swings_as_the_cosine() {
        let slope = |phase: &Phase| Phase {
            balls: std::array::from_fn(|ball| BallState {
                position: phase.balls[ball].velocity,
                velocity: -phase.balls[ball].position,
                spin: DVec3::ZERO,
            }),
            time: 1.0,
        };
        let begin = Phase { balls: [BallState::at_rest(DVec2::X); BALLS], time: 0.0 };
        let step = extrapolate(&begin, &slope(&begin), slope, None, 0.5, (1.0, 1e-14));
        assert!((step.end.balls[1].position.x - 0.5_f64.cos()).abs() < 1e-14, "{step:?}");
        assert!((step.end.balls[2].velocity.x + 0.5_f64.sin()).abs() < 1e-14);
        assert!(step.error <= 1e-14 && step.best_length > 0.1 && (step.end.time - 0.5).abs() < 1e-15);
    }

    #[test]
    fn what_is_not_smooth_is_given_up_early() {
        let mut slopes = 0;
        let kinked = |phase: &Phase| {
            slopes += 1;
            let pull = if phase.time < 0.3 { DVec2::X } else { DVec2::NEG_X };
            Phase { balls: phase.balls.map(|_| BallState { velocity: pull, ..BallState::at_rest(pull) }), time: 1.0 }
        };
        let first =
            Phase { balls: [BallState { velocity: DVec2::X, ..BallState::at_rest(DVec2::X) }; BALLS], time: 1.0 };
        let step = extrapolate(&Phase::ZERO, &first, kinked, None, 0.5, (1.0, 1e-12));
        assert!(step.error > 1e-12 && step.best_length < 0.5, "{step:?}");
        // All rounds take 72.
        assert!(slopes < 30, "{slopes}");
    }

    /// A speed that follows a cosine within a hundred-thousandth of its period: explicit steps would be as short.
    #[test]
    fn what_decays_fast_is_followed_in_long_steps() {
        const RATE: f64 = 1e5;
        let wanted = |time: f64| DVec2::new(time.cos(), 0.0);
        let slope = |phase: &Phase| {
            let mut slope = Phase { time: 1.0, ..Phase::ZERO };
            let velocity = phase.balls[1].velocity;
            let sine = DVec2::new(phase.time.sin(), 0.0);
            (slope.balls[1].position, slope.balls[1].velocity) =
                (velocity, RATE * (wanted(phase.time) - velocity) - sine);
            slope
        };
        let [mut begin, mut row, mut column] = [Phase::ZERO; 3];
        begin.balls[1].velocity = wanted(0.0);
        row.balls[1].velocity = DVec2::X;
        column.balls[1].velocity = DVec2::NEG_X * RATE;
        let stiff = Stiff(vec![Mode { row, column }]);
        let played = |stiff| extrapolate(&begin, &slope(&begin), slope, stiff, 0.2, (1.0, 1e-12));
        let step = played(Some(&stiff));
        assert!(step.error <= 1e-12 && step.end.balls[1].velocity.distance(wanted(0.2)) < 1e-12, "{step:?}");
        // What the fast part leaves in its integral is beyond the estimate: a ten-thousandth of its time times the square of a step.
        assert!((step.end.balls[1].position.x - 0.2_f64.sin()).abs() < 1e-10);
        let explicit = played(None).error;
        assert!(explicit.is_nan() || explicit > 1.0, "{explicit}");
    }
}
