//! A piece of the course of balls in resting contact, during which the same laws are in force.
//!
//! The equations are singular at the end of a slip, because its direction is. In a new time variable `tau` with
//! `dt = dtau / (1/s1 + 1/s2 + …)` over all speeds `s` that can end, they are smooth everywhere, and each speed that ends
//! decays exponentially.

use super::{
    Numbers, Real,
    contact::Balls,
    extrapolation::{COLUMNS, State, extrapolate},
    rest::Rest,
    roots::falling_root,
    rows::movement,
    system::System,
    tolerance::{creeping, settled, slack},
};

/// Longest piece, s: the resolution at which contacts with other bodies are checked.
const LONGEST: f64 = 4e-3;

/// A piece that lasts longer than this, in units of its natural time, is slow.
const SLOW: f64 = 1e3;

/// Maximum number of halvings of a step that is too long for the extrapolation.
const MAX_HALVINGS: usize = 200;

/// A piece of the course of all balls with pressing contacts.
#[derive(Clone, Debug)]
pub struct Piece<R> {
    numbers: Numbers<R>,
    /// Its balls and contacts.
    pub rest: Rest<R>,
    /// Tolerance of each law: a small one, plus the violation by rounding at the start.
    allowed: Vec<R>,
    start: State<R>,
    tau: R,
    end: State<R>,
    /// Suggested length of the next piece, in units of the natural time in which speeds change.
    pub stride: f64,
}

impl<R: Real> Piece<R> {
    /// Integrates the course of `balls` until a law breaks, or over a limited time.
    pub fn new(numbers: &Numbers<R>, balls: &Balls<R>, rest: Rest<R>, stride: f64) -> Self {
        let start = State { time: R::zero(), work: R::zero(), balls: *balls };
        let allowed = System::new(numbers, balls, &rest.laws).margins(&rest.forces).into_iter();
        let allowed = allowed.map(|room| R::of(16.0) * slack() - R::of(2.0) * room.min(R::zero())).collect();
        let mut piece = Self { numbers: *numbers, rest, allowed, start, tau: R::zero(), end: start, stride };
        piece.advance();
        piece
    }

    fn advance(&mut self) {
        let natural = self.first_guess();
        let longest = R::of(LONGEST) / self.rates(&self.start).time;
        let slowest = self.rest.laws.ending_speeds(&self.numbers, &self.start.balls).fold(R::of(1.0), R::min);
        // The direction of a small slip has few significant digits, and so has the effect of its friction.
        let blur = R::of(1.0) / slowest;
        let mut tau = (natural * R::of(self.stride)).min(longest);
        for _ in 0..MAX_HALVINGS {
            let (end, columns) = extrapolate(&self.start, tau, blur, |state| self.rates(state));
            (self.tau, self.end) = (tau, end);
            // If slips are hardly resolved, columns may agree on a time that runs backwards: such a step is too long.
            if let Some(columns) = columns.filter(|_| end.time > R::zero()) {
                let growth = [1.0, 1.0, 1.5, 1.5, 2.0].get(COLUMNS - columns).unwrap_or(&4.0);
                self.stride = ((tau / natural).to_f64() * growth).max(0.125);
                break;
            }
            tau = tau * R::of(0.5);
        }
        if self.margin(&self.end) < R::zero() {
            let tau = falling_root(|tau| self.margin(&self.at(tau)), R::zero(), self.tau, slack());
            (self.end, self.tau) = (self.at(tau), tau);
            self.stride = self.stride.min(1.0);
        }
    }

    /// Returns the natural `tau` in which speeds change.
    fn first_guess(&self) -> R {
        let (system, forces) = self.forces(&self.start.balls);
        let changes = system.accelerations(&self.numbers, &forces);
        let fastest = changes.iter().zip(self.rest.laws.cloth).filter(|(_, cloth)| cloth.is_some());
        let fastest = fastest.fold(R::zero(), |most, ((linear, angular), _)| {
            most.max(linear.length() + self.numbers.radius * angular.length())
        });
        R::of(1.0) / fastest.max(slack())
    }

    fn forces(&self, balls: &Balls<R>) -> (System<R>, Vec<R>) {
        let system = System::new(&self.numbers, balls, &self.rest.laws);
        let lawful = if self.rest.creeps { system.solve_forces(&self.numbers) } else { None };
        let forces = lawful.unwrap_or_else(|| system.balance(&self.numbers, &self.rest.forces));
        (system, forces)
    }

    /// Returns the margin until a law breaks; negative after that.
    fn margin(&self, state: &State<R>) -> R {
        if self.rest.creeps {
            let held = self.rest.laws.largest_held(&self.numbers, &state.balls);
            return R::of(2.0) * creeping::<R>() - held;
        }
        let (system, forces) = self.forces(&state.balls);
        let rooms = system.margins(&forces).into_iter().zip(&self.allowed).map(|(room, allowed)| room + *allowed);
        let mut room = rooms.fold(R::of(1.0), R::min);
        if room < R::zero() && system.holds(&self.numbers) {
            // Frictions can share a load in several ways, and another way breaks no law.
            room = slack();
        }
        // The end of a side spin is located as exactly as that of a slip.
        let scale = slack::<R>() / settled();
        let turns = self.rest.laws.spin_speeds(&self.numbers, &state.balls).map(|speed| speed * scale);
        turns.fold(room, R::min)
    }

    /// Returns the derivatives with respect to `tau`.
    fn rates(&self, state: &State<R>) -> State<R> {
        let (system, forces) = self.forces(&state.balls);
        let inverse = self.rest.laws.ending_speeds(&self.numbers, &state.balls);
        let inverse = inverse.fold(R::zero(), |sum, speed| sum + R::of(1.0) / speed);
        let pace = if inverse > R::zero() { R::of(1.0) / inverse } else { R::of(1.0) };
        let mut rates = State { time: pace, work: system.power(&forces) * pace, ..*state };
        let changes = system.accelerations(&self.numbers, &forces);
        for (index, ball) in rates.balls.iter_mut().enumerate() {
            let moves = if self.involves(index) { pace } else { R::zero() };
            ball.position = movement(&state.balls)[index].0 * moves;
            ball.velocity = changes[index].0 * moves;
            ball.spin = changes[index].1 * moves;
        }
        rates
    }

    /// Whether a ball is part of the piece.
    pub fn involves(&self, ball: usize) -> bool {
        self.rest.laws.cloth[ball].is_some()
    }

    /// Whether a slip grows or decays much more slowly than in its natural time.
    pub fn is_slow(&self) -> bool {
        self.stride > SLOW
    }

    /// Returns the duration of the piece, s.
    pub fn duration(&self) -> R {
        self.end.time
    }

    /// Returns the state at a `tau` within the piece.
    pub fn at(&self, tau: R) -> State<R> {
        if tau == self.tau { self.end } else { extrapolate(&self.start, tau, R::zero(), |state| self.rates(state)).0 }
    }

    /// Returns the `tau` of a time, s, by Newton steps, as `dt/dtau` is known.
    pub fn tau_at(&self, time: R) -> R {
        if time == self.end.time {
            return self.tau;
        }
        let mut tau = self.tau * time / self.end.time;
        for _ in 0..12 {
            let state = self.at(tau);
            let step = (time - state.time) / self.rates(&state).time;
            tau = tau + step;
            if step.abs() <= R::of(64.0 * R::ROUNDING) * self.tau {
                break;
            }
        }
        tau
    }
}
