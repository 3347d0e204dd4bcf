//! One step of an ordinary differential equation, as exact as is asked for: extrapolation of the modified midpoint rule
//! (Gragg 1965, Bulirsch and Stoer 1966).

use crate::{physics::BallState, table::BALLS};

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

/// Slopes that have to be worked out in all rounds up to each.
const WORK: [f64; ROUNDS] = [2.0, 6.0, 12.0, 20.0, 30.0, 42.0, 56.0, 72.0];

/// The error of a step of the proposed length, as a share of the tolerance, and how much longer than the last it can be.
const CAUTION: f64 = 0.25;
const MOST_GROWTH: f64 = 4.0;
const LEAST_GROWTH: f64 = 0.1;

/// Steps from `begin`, whose slope is `first`, over `length`, in as many rounds as bring the error below `tolerance`; all of
/// them if none does. Only the `members` move.
pub fn extrapolate(
    begin: &Phase,
    first: &Phase,
    mut slope: impl FnMut(&Phase) -> Phase,
    members: [bool; BALLS],
    length: f64,
    radius: f64,
    tolerance: f64,
) -> Step {
    let plus = |base: &Phase, slope: &Phase, factor: f64| plus(base, slope, factor, members);
    // The last row of the Aitken-Neville table.
    let mut row: [Phase; ROUNDS] = [*begin; ROUNDS];
    let mut best = Step { end: *begin, error: f64::INFINITY, best_length: LEAST_GROWTH * length };
    let mut least_work = f64::INFINITY;
    for round in 0..ROUNDS {
        let count = 2 * (round + 1);
        let h = length / count as f64;
        // Gragg's method: leaps over the midpoint, smoothed at the end.
        let mut before = *begin;
        let mut now = plus(begin, first, h);
        for _ in 1..count {
            let after = plus(&before, &slope(&now), 2.0 * h);
            (before, now) = (now, after);
        }
        let ahead = plus(&before, &slope(&now), h);
        let mut newer = plus(&ahead, &plus(&now, &ahead, -1.0), 0.5);
        for column in 1..=round {
            let ratio = count as f64 / (2 * (round + 1 - column)) as f64;
            let weight = 1.0 / (ratio * ratio - 1.0);
            let older = row[column - 1];
            row[column - 1] = newer;
            newer = plus(&newer, &plus(&newer, &older, -1.0), weight);
        }
        if round > 0 {
            // An error of this round falls with the power 2 round + 1 of the length.
            best.error = distance(&newer, &row[round - 1], members, radius);
            let room = CAUTION * tolerance / best.error.max(f64::MIN_POSITIVE);
            let growth = room.powf(1.0 / (2 * round + 1) as f64).clamp(LEAST_GROWTH, MOST_GROWTH);
            let work = WORK[round] / growth;
            if work < least_work {
                // Where another round would have paid, too, it is tried next time.
                let more =
                    if work < 0.9 * least_work && round + 1 < ROUNDS { WORK[round + 1] / WORK[round] } else { 1.0 };
                (least_work, best.best_length) = (work, (growth * more).min(MOST_GROWTH) * length);
            }
        }
        row[round] = newer;
        best.end = newer;
        if best.error <= tolerance {
            break;
        }
    }
    best
}

#[inline(always)]
fn plus(base: &Phase, slope: &Phase, factor: f64, members: [bool; BALLS]) -> Phase {
    let mut sum = *base;
    for ball in (0..BALLS).filter(|&ball| members[ball]) {
        sum.balls[ball].position += factor * slope.balls[ball].position;
        sum.balls[ball].velocity += factor * slope.balls[ball].velocity;
        sum.balls[ball].spin += factor * slope.balls[ball].spin;
    }
    sum.time += factor * slope.time;
    sum
}

fn distance(one: &Phase, other: &Phase, members: [bool; BALLS], radius: f64) -> f64 {
    (0..BALLS).filter(|&ball| members[ball]).fold((one.time - other.time).abs(), |size, ball| {
        let (a, b) = (&one.balls[ball], &other.balls[ball]);
        size.max(a.position.distance(b.position))
            .max(a.velocity.distance(b.velocity))
            .max(radius * a.spin.distance(b.spin))
    })
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

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
        let step = extrapolate(&begin, &slope(&begin), slope, [false, true, true], 0.5, 1.0, 1e-14);
        assert!((step.end.balls[1].position.x - 0.5_f64.cos()).abs() < 1e-14, "{step:?}");
        assert!((step.end.balls[2].velocity.x + 0.5_f64.sin()).abs() < 1e-14);
        assert!(step.error <= 1e-14 && step.best_length > 0.1 && (step.end.time - 0.5).abs() < 1e-15);
    }
}
