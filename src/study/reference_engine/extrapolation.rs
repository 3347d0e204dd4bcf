//! Extrapolated midpoint steps (Gragg, Bulirsch and Stoer): they solve smooth equations of motion in any precision.

use super::{Ball, Real, contact::Balls};

/// Columns of the extrapolation, the last of which has an error of the order of `(step/4)²⁸/28!`.
pub const COLUMNS: usize = 14;

/// Two columns that differ by less are the same, in units of rounding: the last one is better by some orders.
const SAME: f64 = 256.0;

/// Most by which blur makes that more, and the power of rounding that bounds it where numbers have few digits.
const BLURRED: f64 = 1e6;
const BLURRED_POWER: f64 = -0.375;

/// What is integrated, its changes since a start, or its rates of change.
#[derive(Clone, Copy, Debug)]
pub struct State<R> {
    /// Time since the start, s.
    pub time: R,
    /// Work of friction over mass since the start.
    pub work: R,
    /// The balls.
    pub balls: Balls<R>,
}

impl<R: Real> State<R> {
    /// The same balls with all numbers zero.
    #[must_use]
    pub fn zero(&self) -> Self {
        self.with(self, |x, same| x - same)
    }

    /// This state after changes.
    #[must_use]
    pub fn and(&self, changes: &Self) -> Self {
        self.with(changes, |x, change| x + change)
    }

    /// Every number by a function of itself and of its fellow in another state.
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

/// The state one step later, and how many columns it took: `None` where they do not agree in the end.
///
/// Columns agree where they differ by rounding, or by rounding times `blur` times the change itself.
///
/// Changes are integrated: what is large in the state itself would leave its rounding in them, and the extrapolation
/// amplifies that.
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
    // row[k] extrapolates the last k + 1 step counts 2, 4, 6, … to none at all.
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
