//! One integration step of an ordinary differential equation with error control: extrapolation of the modified midpoint rule (Gragg 1965,
//! Bulirsch and Stoer 1966), and of the semi-implicit midpoint rule (Bader and Deuflhard 1983) if the equation is stiff.

use glam::DVec2;

use crate::{
    physics::{BallState, factorize, substitute},
    table::BALLS,
};

/// Positions, velocities and spins of all balls, or, as a slope, their time derivatives.
pub type State = [BallState; BALLS];

/// Largest number of extrapolation stages: 2, 4, … 16 midpoints, which gives order 16.
const ROUNDS: usize = 8;

/// State and time since the step's start, s. The time is one of the unknowns, so that a step can use another independent variable.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Positions, velocities and spins.
    pub balls: State,
    /// Time, s.
    pub time: f64,
}

/// Result of a step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// State at the end of the step.
    pub end: Phase,
    /// Estimated error: the largest of metres, m/s and R times rad/s.
    pub error: f64,
    /// Step length with the fastest progress, if the solution remains equally smooth.
    pub best_length: f64,
}

/// Midpoints of each stage. The semi-implicit rule uses odd multiples of two, for which stiff components decay.
const COUNTS: [usize; ROUNDS] = [2, 4, 6, 8, 10, 12, 14, 16];
const STIFF_COUNTS: [usize; ROUNDS] = [2, 6, 10, 14, 18, 22, 26, 30];

/// A fast decaying mode of the equation: a deviation of the state is measured by a row and changes the slope by a column. The stiff part of
/// the Jacobian is the sum of all products of columns and rows. The rest of the Jacobian does not affect the accuracy, only the step
/// length.
#[derive(Clone, Copy, Debug)]
pub struct Mode {
    /// Measures the deviation, as a scalar product with velocities and spins.
    pub row: Phase,
    /// Change of the slope per unit of deviation.
    pub column: Phase,
}

/// Returns a function that multiplies a change by `(1 - h J)⁻¹`, with the Jacobian `J` of these modes.
fn damper(modes: &[Mode], h: f64) -> impl Fn(&Phase) -> Phase {
    let count = modes.len();
    let mut matrix: Vec<f64> = modes.iter().flat_map(|a| modes.iter().map(|b| -h * a.row.dot(&b.column))).collect();
    (0..count).for_each(|index| matrix[index * (count + 1)] += 1.0);
    let mut pivots = vec![0; count];
    factorize(&mut matrix, &mut pivots);
    move |change| {
        let mut sizes: Vec<f64> = modes.iter().map(|mode| mode.row.dot(change)).collect();
        substitute(&matrix, &pivots, &mut sizes);
        modes.iter().zip(sizes).fold(*change, |sum, (mode, size)| plus(&sum, &mode.column, h * size))
    }
}

impl Phase {
    /// The zero element, as the start of sums.
    pub const ZERO: Self = Self { balls: [BallState::at_rest(DVec2::ZERO); BALLS], time: 0.0 };

    /// Adds a multiple of a slope.
    #[inline(always)]
    fn add(&mut self, slope: &Self, factor: f64) {
        for (sum, slope) in self.balls.iter_mut().zip(&slope.balls) {
            sum.position += factor * slope.position;
            sum.velocity += factor * slope.velocity;
            sum.spin += factor * slope.spin;
        }
        self.time += factor * slope.time;
    }

    /// Applies one step of the Aitken-Neville scheme: adds to `newer` a multiple of the difference between `newer` and this.
    #[inline(always)]
    fn neville(&mut self, newer: &Self, factor: f64) {
        for (older, newer) in self.balls.iter_mut().zip(&newer.balls) {
            older.position = newer.position + factor * (newer.position - older.position);
            older.velocity = newer.velocity + factor * (newer.velocity - older.velocity);
            older.spin = newer.spin + factor * (newer.spin - older.spin);
        }
        self.time = newer.time + factor * (newer.time - self.time);
    }

    /// Returns the scalar product of velocities and spins.
    pub fn dot(&self, other: &Self) -> f64 {
        self.balls.iter().zip(&other.balls).map(|(a, b)| a.velocity.dot(b.velocity) + a.spin.dot(b.spin)).sum()
    }
}

/// Error of a step of the proposed length as a share of the tolerance, and limits of the ratio of successive step lengths.
const CAUTION: f64 = 0.25;
const MAX_GROWTH: f64 = 4.0;
const MIN_GROWTH: f64 = 0.1;

/// Least ratio of the next step length after a step that was given up early: few stages give a poor estimate of the right length, and a
/// trial is cheap.
const MIN_GROWTH_AFTER_FEW_ROUNDS: f64 = 0.25;

/// Whether the error remains above the tolerance after `rounds` more stages, even if each reduces it by the square of the last reduction
/// factor. If the slope jumps within the step, nothing converges. The first error has no predecessor to compare with.
fn is_hopeless(error: f64, error_before: f64, rounds: usize, tolerance: f64) -> bool {
    error_before.is_finite() && error * libm::pow(error / error_before, (2 * rounds) as f64) > tolerance
}

/// Integrates one step of `length` from `begin`, whose slope is `first`, with as many stages as bring the error below `tolerance`, or until
/// success is unlikely. `radius` is the balls' radius, m; the slope of balls that do not take part is zero. `stiff` contains the fast
/// decaying modes; without any, the step is explicit.
pub fn extrapolate(
    begin: &Phase,
    first: &Phase,
    mut slope: impl FnMut(&Phase) -> Phase,
    stiff: &[Mode],
    length: f64,
    (radius, tolerance): (f64, f64),
) -> Step {
    // The last row of the Aitken-Neville table, with the highest order first.
    let mut row = [Phase::ZERO; ROUNDS];
    let mut best = Step { end: *begin, error: f64::INFINITY, best_length: MIN_GROWTH * length };
    let (mut least_work, mut done) = (f64::INFINITY, 0.0);
    let counts = if stiff.is_empty() { COUNTS } else { STIFF_COUNTS };
    for (round, &count) in counts.iter().enumerate() {
        let h = length / count as f64;
        let error_before = best.error;
        done += count as f64;
        row[round] = if stiff.is_empty() {
            modified_midpoint(begin, first, &mut slope, (count, h))
        } else {
            semi_implicit_midpoint(begin, first, &mut slope, stiff, (count, h))
        };
        for column in (0..round).rev() {
            let ratio = count as f64 / counts[column] as f64;
            let (older, newer) = row.split_at_mut(column + 1);
            older[column].neville(&newer[0], 1.0 / (ratio * ratio - 1.0));
        }
        if round > 0 {
            // The error of this stage is proportional to the power 2 round + 1 of the length.
            best.error = distance(&row[0], &row[1], radius);
            let room = CAUTION * tolerance / best.error.max(f64::MIN_POSITIVE);
            let growth = libm::pow(room, 1.0 / (2 * round + 1) as f64).clamp(MIN_GROWTH, MAX_GROWTH);
            let work = done / growth;
            if work < least_work {
                // If another stage would also have been worthwhile, it is tried next time.
                let more = if work < 0.9 * least_work && round + 1 < ROUNDS {
                    (done + counts[round + 1] as f64) / done
                } else {
                    1.0
                };
                (least_work, best.best_length) = (work, (growth * more).min(MAX_GROWTH) * length);
            }
        }
        if best.error <= tolerance {
            break;
        }
        if is_hopeless(best.error, error_before, ROUNDS - 1 - round, tolerance) {
            best.best_length = best.best_length.max(MIN_GROWTH_AFTER_FEW_ROUNDS * length);
            break;
        }
    }
    best.end = row[0];
    best
}

/// Gragg's method: `count` midpoint steps of length `h`, with smoothing at the end.
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

/// Bader and Deuflhard's method: the midpoint rule with the stiff part of the slope implicit.
fn semi_implicit_midpoint(
    begin: &Phase,
    first: &Phase,
    slope: &mut impl FnMut(&Phase) -> Phase,
    stiff: &[Mode],
    (count, h): (usize, f64),
) -> Phase {
    let damped = damper(stiff, h);
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
    fn extrapolated_pendulum_follows_the_cosine() {
        let slope = |phase: &Phase| Phase {
            balls: std::array::from_fn(|ball| BallState {
                position: phase.balls[ball].velocity,
                velocity: -phase.balls[ball].position,
                spin: DVec3::ZERO,
            }),
            time: 1.0,
        };
        let begin = Phase { balls: [BallState::at_rest(DVec2::X); BALLS], time: 0.0 };
        let step = extrapolate(&begin, &slope(&begin), slope, &[], 0.5, (1.0, 1e-14));
        assert!((step.end.balls[1].position.x - 0.5_f64.cos()).abs() < 1e-14, "{step:?}");
        assert!((step.end.balls[2].velocity.x + 0.5_f64.sin()).abs() < 1e-14);
        assert!(step.error <= 1e-14 && step.best_length > 0.1 && (step.end.time - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_step_over_a_kink_is_given_up_early() {
        let mut slopes = 0;
        let kinked = |phase: &Phase| {
            slopes += 1;
            let pull = if phase.time < 0.3 { DVec2::X } else { DVec2::NEG_X };
            Phase { balls: phase.balls.map(|_| BallState { velocity: pull, ..BallState::at_rest(pull) }), time: 1.0 }
        };
        let first =
            Phase { balls: [BallState { velocity: DVec2::X, ..BallState::at_rest(DVec2::X) }; BALLS], time: 1.0 };
        let step = extrapolate(&Phase::ZERO, &first, kinked, &[], 0.5, (1.0, 1e-12));
        assert!(step.error > 1e-12 && step.best_length < 0.5, "{step:?}");
        // All stages need 72.
        assert!(slopes < 30, "{slopes}");
    }

    /// A speed that follows a cosine with a time constant of 1e-5 s: explicit steps would be as short.
    #[test]
    fn a_fast_mode_is_integrated_in_long_steps() {
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
        let played = |stiff: &[Mode]| extrapolate(&begin, &slope(&begin), slope, stiff, 0.2, (1.0, 1e-12));
        let step = played(&[Mode { row, column }]);
        assert!(step.error <= 1e-12 && step.end.balls[1].velocity.distance(wanted(0.2)) < 1e-12, "{step:?}");
        // The error that the fast mode leaves in its integral is not part of the estimate: a ten-thousandth of its time constant times the
        // squared step.
        assert!((step.end.balls[1].position.x - 0.2_f64.sin()).abs() < 1e-10);
        let explicit = played(&[]).error;
        assert!(explicit.is_nan() || explicit > 1.0, "{explicit}");
    }
}
