//! One step of an ordinary differential equation, as exact as is asked for: extrapolation of the modified midpoint rule
//! (Gragg 1965, Bulirsch and Stoer 1966).

use crate::{physics::BallState, table::BALLS};

/// Positions, velocities and spins of all balls; as a slope, their rates of change.
pub type State = [BallState; BALLS];

/// Rounds of extrapolation at most: 2, 4, … 16 midpoints, which makes order 16.
const ROUNDS: usize = 8;

/// A step's result.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// State at its end.
    pub end: State,
    /// Estimated error: the largest of metres, m/s and R times rad/s.
    pub error: f64,
    /// Rounds of extrapolation that were needed; few of them mean that a longer step would do.
    pub rounds: usize,
}

/// Steps from `begin`, whose slope is `first`, over `length` seconds, in as many rounds as bring the error below
/// `tolerance`; all of them if none does.
pub fn extrapolate(
    begin: &State,
    first: &State,
    mut slope: impl FnMut(&State) -> State,
    length: f64,
    radius: f64,
    tolerance: f64,
) -> Step {
    // The last row of the Aitken-Neville table.
    let mut row: [State; ROUNDS] = [*begin; ROUNDS];
    let mut best = Step { end: *begin, error: f64::INFINITY, rounds: ROUNDS };
    for round in 0..ROUNDS {
        let count = 2 * (round + 1);
        let mut newer = midpoints(begin, first, &mut slope, length, count);
        for column in 1..=round {
            let ratio = count as f64 / (2 * (round + 1 - column)) as f64;
            let weight = 1.0 / (ratio * ratio - 1.0);
            let older = row[column - 1];
            row[column - 1] = newer;
            newer = plus(&newer, &difference(&newer, &older), weight);
        }
        let error = if round == 0 { f64::INFINITY } else { size(&difference(&newer, &row[round - 1]), radius) };
        row[round] = newer;
        best = Step { end: newer, error, rounds: round + 1 };
        if error <= tolerance {
            break;
        }
    }
    best
}

/// Gragg's method: `count` leaps over the midpoint, smoothed at the end.
fn midpoints(
    begin: &State,
    first: &State,
    slope: &mut impl FnMut(&State) -> State,
    length: f64,
    count: usize,
) -> State {
    let h = length / count as f64;
    let mut before = *begin;
    let mut now = plus(begin, first, h);
    for _ in 1..count {
        let after = plus(&before, &slope(&now), 2.0 * h);
        (before, now) = (now, after);
    }
    let ahead = plus(&before, &slope(&now), h);
    plus(&ahead, &difference(&now, &ahead), 0.5)
}

fn plus(base: &State, slope: &State, factor: f64) -> State {
    std::array::from_fn(|ball| BallState {
        position: base[ball].position + factor * slope[ball].position,
        velocity: base[ball].velocity + factor * slope[ball].velocity,
        spin: base[ball].spin + factor * slope[ball].spin,
    })
}

fn difference(one: &State, other: &State) -> State {
    plus(one, other, -1.0)
}

fn size(state: &State, radius: f64) -> f64 {
    state.iter().fold(0.0, |size, ball| {
        size.max(ball.position.length()).max(ball.velocity.length()).max(radius * ball.spin.length())
    })
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;

    #[test]
    fn a_pendulum_swings_as_the_cosine() {
        let slope = |state: &State| {
            std::array::from_fn(|ball| BallState {
                position: state[ball].velocity,
                velocity: -state[ball].position,
                spin: DVec3::ZERO,
            })
        };
        let begin = [BallState::at_rest(DVec2::X); BALLS];
        let step = extrapolate(&begin, &slope(&begin), slope, 0.5, 1.0, 1e-14);
        assert!((step.end[1].position.x - 0.5_f64.cos()).abs() < 1e-14, "{step:?}");
        assert!((step.end[2].velocity.x + 0.5_f64.sin()).abs() < 1e-14);
        assert!(step.rounds < ROUNDS);
    }
}
