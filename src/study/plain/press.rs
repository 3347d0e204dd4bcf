//! A ball that the cloth presses against one cushion ("Resting contact" in the equations): the limit of its bounces.
//!
//! In the frame of the cushion, `n` into the table and `t = z×n`, the normal velocity is zero, the cushion pushes with
//! `mu_s g u_n/|u|` and rubs against its own slip `s = (v_t - R w_z, R w_t)`, which cannot end before the slip `u` does.
//! The equations are singular where `u` ends. With a time `tau` of which `dt = |u| dtau` they are smooth throughout and
//! `u` decays like an exponential; extrapolated midpoint steps (Gragg, Bulirsch and Stoer) solve them in any precision.

use super::{Ball, Motion, Numbers, Real, Vector, roots::bracketed, table::normal};
use crate::simulation::Rail;

/// Time, place along the cushion, velocity along it, spin about n, t and z, work over mass.
type State<R> = [R; 7];

/// Columns of the extrapolation: its error is of the order of 1/(2^14 14!)² for steps of the length below.
const COLUMNS: usize = 14;

/// Longest piece of a course, s: how finely its neighbours are looked at.
const LONGEST: f64 = 4e-3;

/// A piece of the course of a ball that is pressed against a cushion.
#[derive(Clone, Copy, Debug)]
pub struct Press<R> {
    numbers: Numbers<R>,
    ball: Ball<R>,
    n: Vector<R>,
    t: Vector<R>,
    /// Sign of `w_z`, by which the cloth brakes it.
    twist: R,
    /// Whether `w_z` is zero and the cloth holds it there.
    held: bool,
    end: State<R>,
}

impl<R: Real> Press<R> {
    /// The course of `ball` from now to where it ends, to where `w_z` turns or is let go, or just some way.
    pub fn new(numbers: &Numbers<R>, ball: &Ball<R>, rail: Rail) -> Self {
        let n = normal(rail);
        let (t, twist) = (Vector::up().cross(n), R::zero());
        let mut press = Self { numbers: *numbers, ball: *ball, n, t, twist, held: false, end: [twist; 7] };
        let state = press.state();
        press.held = ball.spin.z == R::zero() && press.grip(&state) >= R::zero();
        let turning = if ball.spin.z == R::zero() { press.rates(&state)[5] } else { ball.spin.z };
        if !press.held && turning != R::zero() {
            press.twist = R::of(if turning > R::zero() { 1.0 } else { -1.0 });
        }
        press.end = press.piece();
        press
    }

    /// By how much the cloth could brake `w_z` harder than the cushion drives it.
    fn grip(&self, state: &State<R>) -> R {
        let free = Self { twist: R::zero(), held: false, ..*self }.rates(state);
        self.numbers.twist * free[0] - free[5].abs()
    }

    fn piece(&self) -> State<R> {
        let speed = self.ball.slip(&self.numbers).length();
        let tau = (R::of(LONGEST) / speed).min(R::of(1.0) / (R::of(3.5) * self.numbers.slide));
        let end = self.integrate(tau);
        let turn = |state: &State<R>| if self.held { self.grip(state) } else { state[5] * self.twist };
        if turn(&end) < R::zero() {
            // Bisection: without a slope every step halves.
            let tau = bracketed(|tau| turn(&self.integrate(tau)), |_| R::zero(), R::zero(), tau);
            return self.integrate(tau);
        }
        end
    }

    /// Length of the piece, s.
    pub fn lasts(&self) -> R {
        self.end[0]
    }

    fn state(&self) -> State<R> {
        let Ball { velocity, spin, .. } = self.ball;
        [R::zero(), R::zero(), velocity.dot(self.t), spin.dot(self.n), spin.dot(self.t), spin.z, R::zero()]
    }

    /// Derivatives with respect to `tau`.
    fn rates(&self, state: &State<R>) -> State<R> {
        let Numbers { radius, slide, rail_friction, .. } = self.numbers;
        let [_, _, v_t, w_n, w_t, w_z, _] = *state;
        let (u_n, u_t) = (-radius * w_t, v_t + radius * w_n);
        let u = (u_n * u_n + u_t * u_t).sqrt();
        let (s_t, s_z) = (v_t - radius * w_z, radius * w_t);
        let s = (s_t * s_t + s_z * s_z).sqrt();
        let rubbing = rail_friction * slide * u_n.max(R::zero());
        let (f_t, f_z) = (-rubbing * s_t / s, -rubbing * s_z / s);
        let lever = R::of(2.5) / radius;
        let decay = self.twist * self.numbers.twist * u;
        let twisting = R::ratio(2.0, 5.0) * radius * radius * decay * w_z;
        [
            u,
            u * v_t,
            f_t - slide * u_t,
            -lever * slide * u_t,
            lever * (slide * u_n + f_z),
            if self.held { R::zero() } else { -lever * f_t - decay },
            slide * u * u + rubbing * s + twisting,
        ]
    }

    /// The state after `tau`.
    fn integrate(&self, tau: R) -> State<R> {
        let start = self.state();
        // row[k] extrapolates the last k + 1 step counts 2, 4, 6, … to none at all.
        let mut row: Vec<State<R>> = Vec::with_capacity(COLUMNS);
        for column in 0..COLUMNS {
            let count = 2 * (column + 1);
            let step = tau / R::of(count as f64);
            let (mut last, mut now) = (start, combine(&start, step, &self.rates(&start)));
            for _ in 1..count {
                (last, now) = (now, combine(&last, R::of(2.0) * step, &self.rates(&now)));
            }
            let mut best = now;
            for (k, entry) in row.iter_mut().enumerate() {
                let ratio = R::ratio(count as f64, (2 * (column - k)) as f64);
                let factor = R::of(1.0) / (ratio * ratio - R::of(1.0));
                let previous = std::mem::replace(entry, best);
                best = std::array::from_fn(|i| best[i] + (best[i] - previous[i]) * factor);
            }
            let settled = row.last().is_some_and(|last| agree(last, &best));
            row.push(best);
            if settled {
                break;
            }
        }
        row[row.len() - 1]
    }

    fn ball_of(&self, state: &State<R>) -> Ball<R> {
        let [_, moved, v_t, w_n, w_t, w_z, _] = *state;
        Ball {
            position: self.ball.position + self.t * moved,
            velocity: self.t * v_t,
            spin: self.n * w_n + self.t * w_t + Vector::up() * w_z,
            motion: self.ball.motion,
        }
    }

    /// The `tau` of a time, s: Newton's steps, since `dt/dtau` is known.
    fn tau_at(&self, time: R) -> R {
        let mut tau = time / self.ball.slip(&self.numbers).length();
        for _ in 0..60 {
            let state = self.integrate(tau);
            let step = (time - state[0]) / self.rates(&state)[0];
            tau = tau + step;
            if step.abs() <= R::of(4.0 * R::ROUNDING) * tau {
                break;
            }
        }
        tau
    }

    /// The ball `time` later, within the piece, and the friction's work over mass.
    pub fn after(&self, time: R) -> (Ball<R>, R) {
        let state = if time == self.lasts() {
            self.end
        } else if time > R::zero() {
            self.integrate(self.tau_at(time))
        } else {
            self.state()
        };
        (self.ball_of(&state), state[6])
    }

    /// What becomes of the ball at the end of a piece.
    pub fn settle(numbers: &Numbers<R>, ball: &mut Ball<R>, rail: Rail) {
        let n = normal::<R>(rail);
        let slip = ball.slip(numbers);
        let tiny = R::of(R::ROUNDING.powf(0.75));
        if slip.length() <= tiny {
            ball.velocity = ball.velocity - slip * R::ratio(2.0, 7.0);
            ball.velocity = ball.velocity - n * ball.velocity.dot(n);
            ball.motion = Motion::Sliding.successor(ball, numbers);
        } else if slip.dot(n) <= R::zero() {
            ball.motion = Motion::Sliding;
        }
        if numbers.radius * ball.spin.z.abs() <= R::of(64.0 * R::ROUNDING) {
            ball.spin.z = R::zero();
        }
    }
}

/// Whether two columns differ by no more than rounding.
fn agree<R: Real>(one: &State<R>, other: &State<R>) -> bool {
    one.iter().zip(other).all(|(a, b)| (*a - *b).abs() <= R::of(R::ROUNDING) * a.abs())
}

fn combine<R: Real>(state: &State<R>, factor: R, rates: &State<R>) -> State<R> {
    std::array::from_fn(|i| state[i] + rates[i] * factor)
}
