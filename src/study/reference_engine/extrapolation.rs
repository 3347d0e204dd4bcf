//! Extrapolated midpoint steps (Gragg, Bulirsch and Stoer), which integrate smooth equations of motion in any precision.

use super::{Ball, Real, contact::Balls};

/// Number of columns of the extrapolation; the error of the last is of the order of `(step/4)²⁸/28!`.
pub const COLUMNS: usize = 14;

/// Two columns agree if they differ by less than this, in units of rounding: the later one is more precise by some orders of
/// magnitude.
const SAME: f64 = 256.0;

/// Limits of the factor by which `blur` widens this tolerance: an absolute one, and the power of rounding that replaces it for
/// numbers with few digits.
const BLURRED: f64 = 1e6;
const BLURRED_POWER: f64 = -0.375;

/// The integrated state, its changes since a start, or its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct State<R> {
    /// Time since the start, s.
    pub time: R,
    /// Work of friction per mass since the start.
    pub work: R,
    /// The balls.
    pub balls: Balls<R>,
}

impl<R: Real> State<R> {
    /// Returns the same balls with all numbers zero.
    #[must_use]
    pub fn zero(&self) -> Self {
        self.with(self, |x, same| x - same)
    }

    /// Returns this state after changes.
    #[must_use]
    pub fn and(&self, changes: &Self) -> Self {
        self.with(changes, |x, change| x + change)
    }

    /// Combines every number with the same number of another state.
    fn with(&self, other: &Self, combine: impl Fn(R, R) -> R + Copy) -> Self {
        let mut state = *self;
        state.time = combine(self.time, other.time);
        state.work = combine(self.work, other.work);
        for (ball, with) in state.balls.iter_mut().zip(&other.balls) {
            let Ball { position, velocity, spin, motion, band } = *ball;
            *ball = Ball {
                position: position.with(with.position, combine),
                velocity: velocity.with(with.velocity, combine),
                spin: spin.with(with.spin, combine),
                motion,
                band,
            };
        }
        state
    }

    fn numbers(&self) -> impl Iterator<Item = R> {
        let of_ball = |ball: &Ball<R>| [ball.position, ball.velocity, ball.spin].map(|v| [v.x, v.y, v.z]);
        let balls = self.balls.iter().flat_map(of_ball).flatten().collect::<Vec<_>>();
        [self.time, self.work].into_iter().chain(balls)
    }

    fn agrees(&self, other: &Self, blur: R) -> bool {
        let (same, more, most) =
            (R::of(SAME * R::ROUNDING), R::of(1.0) + blur, R::of(BLURRED.min(R::ROUNDING.powf(BLURRED_POWER))));
        self.numbers()
            .zip(other.numbers())
            .all(|(a, b)| (a - b).abs() <= same * (R::of(1.0) + (more * a.abs()).min(most)))
    }
}

/// Returns the state one step later, and the number of columns used; `None` instead of the number if the columns do not
/// converge.
///
/// Columns agree if they differ by rounding, or by rounding times `blur` times the change itself.
///
/// Changes since the start are integrated, not the state itself: large numbers in the state would leave their rounding in the
/// changes, and the extrapolation would amplify it.
pub fn extrapolate<R: Real>(
    start: &State<R>,
    step: R,
    blur: R,
    rates: impl Fn(&State<R>) -> State<R>,
) -> (State<R>, Option<usize>) {
    let (origin, zero) = (start, start.zero());
    let start = &zero;
    let rates = |changes: &State<R>| rates(&origin.and(changes));
    let first = rates(start);
    // row[k] extrapolates from the last k + 1 step counts of 2, 4, 6, …
    let mut row: Vec<State<R>> = Vec::with_capacity(COLUMNS);
    for column in 0..COLUMNS {
        let count = 2 * (column + 1);
        let short = step / R::of(count as f64);
        let along = |state: &State<R>, length: R, rates: &State<R>| state.with(rates, |x, rate| x + rate * length);
        let (mut last, mut now) = (*start, along(start, short, &first));
        for _ in 1..count {
            (last, now) = (now, along(&last, R::of(2.0) * short, &rates(&now)));
        }
        let mut best = now;
        for (k, entry) in row.iter_mut().enumerate() {
            let ratio = R::ratio(count as f64, (2 * (column - k)) as f64);
            let factor = R::of(1.0) / (ratio * ratio - R::of(1.0));
            let previous = std::mem::replace(entry, best);
            best = best.with(&previous, |best, previous| best + (best - previous) * factor);
        }
        let is_settled = row.last().is_some_and(|last| last.agrees(&best, blur));
        row.push(best);
        if is_settled {
            return (origin.and(&best), Some(column + 1));
        }
    }
    (origin.and(&row[COLUMNS - 1]), None)
}
